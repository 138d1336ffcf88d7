"""A small room for tests of the robot: its meshes, its cloud, and the PR2."""

from functools import cache
from pathlib import Path

import numpy as np
import trimesh

from placing import rigid
from placing.physics.cutting import fixed_pieces
from placing.physics.settling import SettleConfig
from placing.robot.checker import CheckerConfig, SceneChecker
from placing.robot.distance_field import distance_field
from placing.robot.inverse import arm_solutions
from placing.robot.model import load_robot, tool_pose
from placing.robot.settings import read_robot
from placing.rooms.file import read_yaml

ROOT = Path(__file__).parents[2]
DOCUMENT = read_yaml(ROOT / "config" / "config.yaml")
CONFIG = CheckerConfig(**DOCUMENT["checking"])
SETTLING = SettleConfig(**DOCUMENT["settling"])
SIZE_M = (4.0, 3.0)
TOP_M = 0.72


@cache
def pr2():
    """Return the model of the PR2."""
    rules = read_yaml(ROOT / "workflow" / "schemas" / "robot.schema.yaml")
    return load_robot(read_robot(ROOT / "config" / "robots" / "pr2.yaml", rules))


def block(size, centre):
    """Return a box as a mesh."""
    return trimesh.creation.box(size).apply_translation(centre)


@cache
def meshes():
    """Return floor, two walls, a table on one leg and a shelf, by name."""
    x, y = SIZE_M
    leg = block((0.1, 0.1, TOP_M - 0.03), (3.2, 1.5, TOP_M / 2 - 0.015))
    top = block((0.8, 1.4, 0.03), (3.2, 1.5, TOP_M - 0.015))
    boards = [block((0.3, 1.0, 0.02), (0.15, 0.5, z)) for z in (0.4, 0.8, 1.2)]
    return {
        "floor": block((x, y, 0.1), (x / 2, y / 2, -0.05)),
        "wall": block((0.1, y, 2.5), (-0.05, y / 2, 1.25)),
        "wall2": block((x, 0.1, 2.5), (x / 2, -0.05, 1.25)),
        "table": trimesh.util.concatenate([leg, top]),
        "shelf": trimesh.util.concatenate(boards),
    }


@cache
def pieces():
    """Return the meshes as the simulator wants them."""
    return {k: fixed_pieces(m, SETTLING.margin_m) for k, m in meshes().items()}


@cache
def points():
    """Return a cloud of the meshes, one point in each cell of 2.5 cm."""
    every = [
        trimesh.sample.sample_surface_even(m, 60_000, seed=0)[0]
        for m in meshes().values()
    ]
    cloud = np.concatenate(every)
    _, first = np.unique(np.floor(cloud / 0.025), axis=0, return_index=True)
    return cloud[first]


@cache
def checker():
    """Return the planner's checker of the room."""
    return SceneChecker(pr2(), distance_field(points(), CONFIG), CONFIG)


def anywhere(seed, n):
    """Return random configurations with the base in the room, (n, 11)."""
    model = pr2()
    low = np.where(np.isfinite(model.lower), model.lower, -np.pi)
    high = np.where(np.isfinite(model.upper), model.upper, np.pi)
    low[:2], high[:2] = 0.0, SIZE_M
    return np.random.default_rng(seed).uniform(low, high, (n, len(low)))


def stowed(x, y, yaw=0.0):
    """Return a configuration with the arm folded, (11,)."""
    return np.array([x, y, yaw, 0.1, *pr2().settings.stow])


@cache
def reaching():
    """Return a configuration in the open whose gripper is level and reaches out."""
    T_base_tool = rigid.from_yaw(0.0, (0.65, -0.25, 0.9))
    for arm in arm_solutions(pr2(), T_base_tool, 0.2):
        q = np.array([1.5, 1.5, 0.0, 0.2, *arm])
        if not checker().hits(q).self:
            assert np.allclose(tool_pose(pr2(), q)[4:], [2.15, 1.25, 0.9], atol=1e-3)
            return q
    raise AssertionError("expected a solution")
