"""A small world with a certificate that holds: a can is carried between two pillars."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import trimesh

from placing import rigid
from placing.physics.cutting import bodies_of, fixed_pieces
from placing.physics.settling import SettleConfig
from placing.robot.certificates import Certificate, World
from placing.robot.inverse import arm_solutions, follow
from placing.robot.model import load_robot
from placing.robot.planning import Segment
from placing.robot.replay_config import ReplayConfig
from placing.robot.settings import read_robot
from placing.rooms.file import read_yaml
from placing.scene import SceneObject

ROOT = Path(__file__).parents[2]
ROBOT = ROOT / "config" / "robots" / "pr2.yaml"
CONFIG = read_yaml(ROOT / "config" / "config.yaml")
SETTLING = SettleConfig(**CONFIG["settling"])
REPLAY = ReplayConfig(**CONFIG["replay"])
CAN = SceneObject("can1", "food", "soda_can", (0.066, 0.066, 0.122), 0.36, False, True)
BLOCK = SceneObject("block1", "food", "box", (0.1, 0.1, 0.05), 1.0, False, True)
OPEN_M, CLOSED_M = 0.086, 0.066
WAY_M, SIDE_M, LOW_M, HIGH_M = 0.70, -0.25, 0.85, 0.95
"""Where the can stands before the robot, and how high its centre is; where lifted."""


def settings():
    return read_robot(ROBOT, read_yaml(ROOT / "workflow/schemas/robot.schema.yaml"))


def bodies():
    return bodies_of((CAN, BLOCK), SETTLING.margin_m)


def pillar(x, y, top):
    box = trimesh.creation.box((0.12, 0.12, top))
    return box.apply_translation((x, y, top / 2))


def fixed():
    """Return a floor and two pillars, the second one turned about the robot."""
    floor = trimesh.creation.box((6, 6, 0.1)).apply_translation((0, 0, -0.05))
    top = LOW_M - CAN.size_m[2] / 2
    meshes = {
        "walls": floor,
        "pillar1": pillar(WAY_M, SIDE_M, top),
        "pillar2": pillar(-SIDE_M, WAY_M, top),
    }
    return {n: fixed_pieces(m, SETTLING.margin_m) for n, m in meshes.items()}


def at(x, z):
    return np.array([1.0, 0, 0, 0, x, SIDE_M, z])


def certificate() -> Certificate:
    """Return a certificate that holds."""
    model = load_robot(settings())
    arm = arm_solutions(model, at(0.6, LOW_M), 0.16)[0]
    q = np.array([0, 0, 0, 0.16, *arm])
    reach = follow(model, q, np.array([at(x, LOW_M) for x in np.linspace(0.6, 0.7, 6)]))
    lift = follow(
        model, reach[-1], np.array([at(0.7, z) for z in np.linspace(LOW_M, HIGH_M, 6)])
    )
    turned = np.zeros(11)
    turned[2] = np.pi / 2
    segments = (
        Segment("pick approach", reach, False, OPEN_M),
        Segment("pick lift", lift, True, CLOSED_M),
        Segment("put drive", np.array([lift[-1], lift[-1] + turned]), True, CLOSED_M),
        Segment("put lower", lift[::-1] + turned, True, CLOSED_M),
        Segment("put retreat", reach[::-1] + turned, False, OPEN_M),
    )
    start = at(WAY_M, LOW_M)
    turn = rigid.from_yaw(np.pi / 2, (0, 0, 0))
    return Certificate(
        world=World("test", "pillars", "empty", "all", "with"),
        object_id=CAN.object_id,
        grasp="side1",
        T_tool_object=np.array([1.0, 0, 0, 0, 0, 0, 0]),
        T_world_start=start,
        T_world_object=rigid.compose(turn, start),
        standing={},
        segments=segments,
    )


def with_segment(given: Certificate, i: int, **changes) -> Certificate:
    """Return a certificate with a segment changed."""
    segments = list(given.segments)
    segments[i] = replace(segments[i], **changes)
    return replace(given, segments=tuple(segments))
