"""What spheres and boxes keep apart does not overlap; the rest is looked at."""

import numpy as np
import pytest
from robot_room import (
    CONFIG,
    SETTLING,
    TOP_M,
    anywhere,
    block,
    meshes,
    pieces,
    pr2,
    reaching,
    stowed,
)

from placing import rigid
from placing.physics.bodies import Piece
from placing.physics.cutting import body_of
from placing.robot import truth as module
from placing.robot.model import tool_pose
from placing.robot.nearby import near_thing, no_things, with_thing
from placing.robot.truth import Truth

MUG = body_of(block((0.06, 0.06, 0.14), (0.0, 0.01, 0.02)), 0.3, SETTLING.margin_m)
BOX = body_of(block((0.3, 0.2, 0.3), (0, 0, 0)), 1.0, SETTLING.margin_m)
HIGH = reaching()


def all_near(tree, q, solids, things, held, scratch, out):
    """Say that everything may overlap, but for what is not there and pairs allowed."""
    n_links, n_things = len(solids.link), len(things.is_here)
    out[:] = False
    out[:, :n_things] = things.is_here
    if held.thing >= 0:
        out[n_links, held.thing] = False
    out[solids.pairs[:, 0], n_things + solids.pairs[:, 1]] = True
    return out.sum()


def rows():
    """Return random configurations, most of them where there is much, (80, 11)."""
    q = anywhere(7, 80)
    q[::2, :2] = stowed(2.5, 1.5)[:2] + 0.3 * (q[::2, :2] - [2.0, 1.5])
    return q


def asked(triangles, is_holding):
    """Return what is hit at all rows, the table as triangles or as convex pieces."""
    room = dict(pieces())
    if triangles:
        table = meshes()["table"]
        room["table"] = (Piece(table.vertices, table.faces, False),)
    T = rigid.from_yaw(0.3, (0.05, 0.0, 0.0)) if is_holding else None
    with Truth(pr2(), room, CONFIG, SETTLING) as truth:
        truth.put("mug", MUG, rigid.from_yaw(1.0, (1.5, 1.2, 1.0)))
        truth.put("box", BOX, rigid.from_yaw(0.5, (3.1, 1.5, TOP_M + 0.15)))
        truth.put("gone", BOX, rigid.from_yaw(0.5, (2.5, 1.5, 0.5)))
        truth.remove("gone")
        held = "mug" if is_holding else None
        return [truth.hits(q, held, T, i % 3 == 0) for i, q in enumerate(rows())]


@pytest.mark.parametrize(("triangles", "is_holding"), [(0, 0), (0, 1), (1, 1)])
def test_all_that_is_hit_is_near(monkeypatch, triangles, is_holding):
    found = asked(triangles, is_holding)
    monkeypatch.setattr(module, "near", all_near)
    assert found == asked(triangles, is_holding)
    hits = {hit for row in found for hit in row}
    assert {hit.split("/")[1] for hit in hits} >= {"table", "box", "wall"}
    assert any(hit.startswith("mug/") for hit in hits) == bool(is_holding)
    assert any(set(pr2().links).issuperset(hit.split("/")) for hit in hits)


def test_what_is_held_is_looked_at_with_the_hand_in_the_first_row_alone(monkeypatch):
    path, seen, real = np.array([HIGH, HIGH]), [], module.near
    path[1, 0] += 0.1

    def near(*args):
        count = real(*args)
        seen.append([args[-1][:-1, k].any() for k in columns])
        return count

    monkeypatch.setattr(module, "near", near)
    T = rigid.from_yaw(0.0, (0.0, 0.0, 0.0))
    with Truth(pr2(), pieces(), CONFIG, SETTLING) as truth:
        truth.put("mug", MUG, rigid.from_yaw(0.0, (0, 0, 9)))
        truth.put("box", BOX, rigid.from_yaw(0.0, (2.42, 1.25, 0.9)))
        names = "mug", "box"
        columns = [truth._bodies.index(truth._standing[name][0]) for name in names]
        assert truth.check_path(path, "mug", T) == "mug/box after row 0"
    assert [of_mug for of_mug, _ in seen] == [True, *[False] * (len(seen) - 1)]
    assert seen[-1][1]


def test_what_is_held_is_left_where_the_path_ends():
    path, T = np.array([HIGH, HIGH]), rigid.from_yaw(0.0, (0.0, 0.0, 0.0))
    path[1, 0] += 0.1
    with Truth(pr2(), pieces(), CONFIG, SETTLING) as truth:
        truth.put("mug", MUG, rigid.from_yaw(0.0, (0, 0, 9)))
        assert truth.check_path(path, "mug", T) == ""
        at = rigid.compose(tool_pose(pr2(), path[1]), T)
        assert truth._standing["mug"][2] == pytest.approx(at)
        truth.remove("mug")
        truth.put("block", BOX, rigid.from_yaw(0.0, (0, 0, 9)))
        assert truth.check_path(path, "block", T).endswith("/block after row 0")


def cube():
    """Return a solid of edge 1 m."""
    corners = np.array(np.meshgrid([-0.5, 0.5], [-0.5, 0.5], [-0.5, 0.5]))
    return Piece(corners.reshape(3, 8).T, np.zeros((0, 3), np.int64), True)


def is_near(piece, T_world_cube):
    """Return whether a cube somewhere may overlap with a piece."""
    things = with_thing(with_thing(no_things(), (cube(),), 0.0), (piece,), 0.0)
    things.T_world_thing[0] = rigid.homogeneous(T_world_cube)[:3]
    out = np.ones(2, bool)
    near_thing(things, 0, out)
    assert not out[0]
    return bool(out[1])


@pytest.mark.parametrize(
    ("x", "yaw", "expected"),
    [(0.99, 0.0, 1), (1.19, np.pi / 4, 1), (1.19, 0.0, 0), (1.22, np.pi / 4, 0)],
)
def test_boxes_are_compared_as_they_are_turned(x, yaw, expected):
    assert is_near(cube(), rigid.from_yaw(yaw, (x, 0.0, 0.0))) == bool(expected)


@pytest.mark.parametrize(("way", "expected"), [(0.45, 1), (-0.45, 1), (0.55, 0)])
def test_a_triangle_is_flat(way, expected):
    triangle = Piece(1.5 * np.eye(3) - 0.5, np.array([[0, 1, 2]]), False)
    assert is_near(triangle, rigid.from_yaw(0.0, (way, way, way))) == bool(expected)
