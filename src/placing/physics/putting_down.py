"""Put objects down as a robot does: straight down until they touch something.

A placement found in a scan is as high as the scan says, a centimetre more or less; who
puts an object down feels when it touches. The hand goes no further than it can trust.
"""

from collections.abc import Callable, Mapping

import numpy as np
import pybullet

from placing import rigid
from placing.physics.bodies import Body
from placing.physics.simulator import World, deepest_overlap
from placing.rigid import Array

STEP_M = 0.002
"""By which an object is moved between two looks at what it touches."""
AWAY_M = 20.0
"""Distance above the scene, and of each other, of bodies that wait."""
TOUCH_M = 0.0005
"""Guards the comparison of what touches with what overlaps."""


def deepest(world: World, i: int) -> float:
    """Return how deep a body overlaps with anything where it is now [m]."""
    pybullet.performCollisionDetection(world.client)
    return deepest_overlap(world, i)[0]


def put_down(
    world: World,
    starts: Mapping[int, tuple[Body, Array]],
    reach_m: float,
    depth_of: Callable[[World, int], float] = deepest,
) -> dict[int, tuple[Body, Array]]:
    """Return bodies with the poses at which they touch, put down lowest first.

    `depth_of` says how deep a body overlaps with anything where it is [m].
    """
    for number, i in enumerate(starts):  # out of each other's way
        away = (0.0, 0.0, AWAY_M * (1 + number))
        pybullet.resetBasePositionAndOrientation(i, away, (0, 0, 0, 1), world.client)
    order = sorted(starts, key=lambda i: starts[i][1][6])
    args = reach_m, depth_of
    touching = {i: _put_down(world, i, *starts[i], *args) for i in order}
    return {i: (body, touching[i]) for i, (body, _) in starts.items()}


def _put_down(
    world: World,
    i: int,
    body: Body,
    T_world_body: Array,
    reach_m: float,
    depth_of: Callable[[World, int], float],
) -> Array:
    """Return the pose at which a body touches what is below, shape (7,).

    It is lifted out of what it overlaps with, or lowered until it would overlap, by at
    most `reach_m`; where it overlaps all the way up, it stays where it is.
    """
    n_steps = round(reach_m / STEP_M)
    args = world, i, body, T_world_body

    def is_free(n: int) -> bool:
        _moved(n, *args)
        return depth_of(world, i) <= TOUCH_M

    free = next((n for n in range(n_steps + 1) if is_free(n)), None)
    if free is None:
        return _moved(0, *args)
    while free > -n_steps and is_free(free - 1):
        free -= 1
    return _moved(free, *args)


def _moved(n: int, world: World, i: int, body: Body, T_world_body: Array) -> Array:
    """Move a body to `n` steps above a pose and return where that is, shape (7,)."""
    T = T_world_body + np.array([0, 0, 0, 0, 0, 0, n * STEP_M])
    w, x, y, z = T[:4]
    centre = rigid.apply(T, body.mass_centre_m[None])[0]
    pybullet.resetBasePositionAndOrientation(i, centre, (x, y, z, w), world.client)
    return T
