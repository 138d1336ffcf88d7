"""What a robot that replays a certificate, and what it holds, may touch and how deep.

Both are where they were put, among what stands; the last collision detection was after.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from placing.physics.simulator import (
    MAX_STEEPNESS,
    Overlap,
    World,
    near_pairs,
    overlaps,
)
from placing.robot.certificates import Segment
from placing.robot.puppet import Puppet
from placing.robot.replay_config import ReplayConfig

AT_SUPPORT = ("lower", "lift")
"""Segments in which an object leaves or reaches what carries it."""
AT_OBJECT = ("approach", "retreat")
"""Segments in which the open fingers are around an object that stands."""


@dataclass(frozen=True)
class Stage:
    """What is in the world of a replay."""

    world: World
    puppet: Puppet
    item: int
    """Number of the body that is carried."""
    config: ReplayConfig


def faults(stage: Stage, segment: Segment) -> Iterator[str]:
    """Yield what touches what it may not, in words."""
    yield from _faults_of_robot(stage, segment)
    if segment.is_holding:
        yield from _faults_of_item(stage, segment)


def _faults_of_robot(stage: Stage, segment: Segment) -> Iterator[str]:
    """Yield what links of the robot may not touch, the robot itself included."""
    robot, links = stage.puppet.body, stage.puppet.names()
    for pair in near_pairs(stage.world, robot):
        number, body, other_link = pair
        link, is_self = links[number], body == robot
        other = links[other_link] if is_self else stage.world.names[body]
        for found in overlaps(stage.world, robot, pair):
            most = stage.config.touch_m
            if not is_self:
                most = _allowed(stage, segment, pair, link, found)
            if found.depth_m > most:
                yield f"{link} in {other} by {found.depth_m * 1e3:.1f} mm"


def _allowed(
    stage: Stage,
    segment: Segment,
    pair: tuple[int, int, int],
    link: str,
    found: Overlap,
) -> float:
    """Return how deep a link may be in what is not the robot [m]."""
    (number, body, _), config, puppet = pair, stage.config, stage.puppet
    if body == stage.item and link in puppet.settings.gripper_links:
        is_near = segment.is_holding or segment.name.endswith(AT_OBJECT)
        return config.finger_m if is_near else config.touch_m
    is_below = found.normal[2] > MAX_STEEPNESS and found.at_m[2] < config.wheel_m
    is_rolling = is_below and not puppet.is_lifted(number)
    return config.wheel_m if is_rolling else config.touch_m


def _faults_of_item(stage: Stage, segment: Segment) -> Iterator[str]:
    """Yield what the held object may not touch; the robot is looked at before."""
    config = stage.config
    for pair in near_pairs(stage.world, stage.item):
        if pair[1] == stage.puppet.body:
            continue
        for found in overlaps(stage.world, stage.item, pair):
            is_below = found.normal[2] > MAX_STEEPNESS
            is_at = segment.name.endswith(AT_SUPPORT) and is_below
            if found.depth_m > (config.support_m if is_at else config.touch_m):
                other = stage.world.names[pair[1]]
                yield f"object in {other} by {found.depth_m * 1e3:.1f} mm"
