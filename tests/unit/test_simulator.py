"""What overlaps in the simulator is what overlaps in space, however it came there."""

import numpy as np
import pybullet
import pytest
import trimesh

from placing import rigid
from placing.physics.bodies import Piece
from placing.physics.cutting import body_of
from placing.physics.simulator import (
    add_body,
    add_fixed,
    contacts_of,
    deepest_overlap,
    new_world,
)

TOP_M, HALF_M = 0.72, 0.05
TOP = trimesh.creation.box((0.8, 0.8, 0.04)).apply_translation((0, 0, TOP_M - 0.02))
FOOT = trimesh.creation.box((0.4, 0.4, 0.04)).apply_translation((0, 0, 0.02))
CUBE = trimesh.creation.box((2 * HALF_M,) * 3)


@pytest.fixture
def world():
    """Return a world with a table of triangles and a cube."""
    table = TOP + FOOT
    with new_world(240, 0.7, 0.001) as world:
        add_fixed(world, "table", Piece(table.vertices, table.faces, False))
        at = rigid.from_yaw(0.0, (0, 0, 5))
        add_body(world, "cube", body_of(CUBE, 1.0, 0.001), at)
        yield world


def put(world, xyz):
    """Put the cube somewhere and return its number."""
    i = next(i for i, name in world.names.items() if name == "cube")
    pybullet.resetBasePositionAndOrientation(i, xyz, (0, 0, 0, 1), world.client)
    pybullet.performCollisionDetection(world.client)
    return i


def test_a_cube_that_went_through_a_table_does_not_stick_to_it(world):
    i = put(world, (0.2, 0.1, TOP_M + HALF_M - 0.003))
    depth_m, name = deepest_overlap(world, i)
    assert (depth_m, name) == (pytest.approx(0.003, abs=1e-4), "table")
    put(world, (0.2, 0.1, 0.4))
    assert min(c[8] for c in contacts_of(world, i)) < -0.2  # what the simulator says
    assert deepest_overlap(world, i) == (0.0, "")


def test_no_overlap_is_missed_or_invented_wherever_a_cube_is_put(world):
    rng, n_over = np.random.default_rng(0), 0
    for _ in range(400):
        at = rng.uniform((-0.5, -0.5, 0.5), (0.5, 0.5, 0.9))
        ways = np.abs(at - TOP.bounds.mean(0)) - TOP.extents / 2 - HALF_M  # boxes apart
        if abs(ways.max()) < 0.002:
            continue
        overlaps = deepest_overlap(world, put(world, at))[0] > 0
        assert overlaps == (ways.max() < 0)
        n_over += overlaps
    assert n_over > 50
