"""What may overlap at a configuration: looked at with spheres, before true meshes are.

Spheres contain the links of the robot; boxes and flat triangles contain what is there.
Two things that these keep apart do not overlap. Letters for shapes: l solid links,
s spheres, k things, t leaves (triangles or convex pieces), p pairs of links, f frames.
"""

# ruff: noqa: ANN001, ANN201, ANN202 (the compiler infers types from the arguments)

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from placing.physics.bodies import Piece
from placing.robot.kernels import Spheres, forward, hang, inner

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

SPARE_M = 0.002
"""Guards what the simulator rounds; spheres contain its shells already."""


class Solids(NamedTuple):
    """The links that can be hit, as spheres sorted by link."""

    at_m: Array
    """Centres in the frames that carry them, (s, 3)."""
    radius_m: Array
    """(s,)."""
    first: Numbers
    """First sphere of each link, and the end of the last, (l + 1,)."""
    ball: Array
    """Centre in the frame and radius of a ball around the spheres of a link, (l, 4)."""
    frame: Numbers
    """Number of the frame that carries each link, (l,)."""
    link: Numbers
    """Number of each link in the model, (l,)."""
    pairs: Numbers
    """Links that must not touch each other, counted as here, (p, 2)."""


class Things(NamedTuple):
    """What a robot may hit: boxes in frames of their own, with smaller boxes inside."""

    T_world_thing: Array
    """(k, 3, 4)."""
    is_here: NDArray[np.bool_]
    """Whether a thing is in the scene, (k,)."""
    box: Array
    """Least and greatest corner of each thing, (k, 6)."""
    first: Numbers
    """First leaf of each thing, and the end of the last, (k + 1,)."""
    leaf_box: Array
    """Least and greatest corner of each leaf, (t, 6)."""
    plane: Array
    """Unit normal and offset of the plane of a triangle, 0 for a solid, (t, 4)."""


class Held(NamedTuple):
    """A thing that moves with the last frame of the arm."""

    thing: int
    """Its number; -1 if nothing is held."""
    T_frame_thing: Array
    """(3, 4)."""
    is_known: bool
    """Whether it was looked at with the links of that frame, which move along."""


NOTHING_HELD = Held(-1, np.zeros((3, 4)), False)


class Scratch(NamedTuple):
    """What a look at one configuration writes."""

    frames: Array
    """(f, 3, 4)."""
    centres: Array
    """Centres of all spheres in the world, (s, 3)."""
    balls: Array
    """Centres of all balls in the world, (l, 3)."""
    seen: Array
    """Centres of the spheres of a link as a thing sees them, (s, 3)."""


def solids_of(spheres: Spheres, pairs: Numbers) -> Solids:
    """Return the spheres of a robot by link; `pairs` (p, 2) are links of the model."""
    order = np.argsort(spheres.link, kind="stable")
    at_m, radius_m = spheres.at_m[order], spheres.radius_m[order] + SPARE_M
    link, first = np.unique(spheres.link[order], return_index=True)
    ends = np.append(first, len(order))
    balls = []
    for a, b in pairwise(ends):
        low = (at_m[a:b] - radius_m[a:b, None]).min(0)
        high = (at_m[a:b] + radius_m[a:b, None]).max(0)
        centre = (low + high) / 2
        away = np.linalg.norm(at_m[a:b] - centre, axis=1)
        balls.append([*centre, (away + radius_m[a:b]).max()])
    return Solids(
        at_m=np.ascontiguousarray(at_m),
        radius_m=radius_m,
        first=ends.astype(np.int64),
        ball=np.array(balls),
        frame=spheres.frame[order][first],
        link=link,
        pairs=np.searchsorted(link, pairs).astype(np.int64).reshape(-1, 2),
    )


def scratch_of(solids: Solids, n_frames: int) -> Scratch:
    """Return room for one look at a configuration."""
    return Scratch(
        np.empty((n_frames, 3, 4)),
        np.empty_like(solids.at_m),
        np.empty((len(solids.ball), 3)),
        np.empty_like(solids.at_m),
    )


def no_things() -> Things:
    """Return an empty scene."""
    return Things(
        T_world_thing=np.empty((0, 3, 4)),
        is_here=np.empty(0, np.bool_),
        box=np.empty((0, 6)),
        first=np.zeros(1, np.int64),
        leaf_box=np.empty((0, 6)),
        plane=np.empty((0, 4)),
    )


def with_thing(things: Things, pieces: Sequence[Piece], margin_m: float) -> Things:
    """Return things and one more; `margin_m` is the shell around its convex pieces."""
    leaves = [_leaves(piece, margin_m) for piece in pieces]
    boxes = np.concatenate([box for box, _ in leaves])
    planes = np.concatenate([plane for _, plane in leaves])
    whole = np.concatenate([boxes[:, :3].min(0), boxes[:, 3:].max(0)])
    return Things(
        T_world_thing=np.concatenate([things.T_world_thing, np.eye(4)[None, :3]]),
        is_here=np.append(things.is_here, True),
        box=np.concatenate([things.box, whole[None]]),
        first=np.append(things.first, things.first[-1] + len(boxes)),
        leaf_box=np.concatenate([things.leaf_box, boxes]),
        plane=np.concatenate([things.plane, planes]),
    )


def _leaves(piece: Piece, margin_m: float) -> tuple[Array, Array]:
    """Return boxes (n, 6) around the parts of a piece, and their planes (n, 4)."""
    if piece.is_convex:
        low, high = piece.vertices_m.min(0), piece.vertices_m.max(0)
        box = np.concatenate([low - margin_m, high + margin_m])
        return box[None], np.zeros((1, 4))
    corners = piece.vertices_m[piece.faces]  # (n, 3, 3)
    boxes = np.hstack([corners.min(1), corners.max(1)])
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)
    offset = -np.einsum("ni,ni->n", normals, corners[:, 0])
    return boxes, np.column_stack([normals, offset])


@njit(cache=True)
def near(tree, q, solids, things, held, scratch, out):
    """Return how many pairs may overlap at a configuration (4 + a,).

    `out` (l + 1, k + l) says which: a link, or last what is held, with a thing or a
    link. What is held is moved.
    """
    frames, n_things = scratch.frames, len(things.is_here)
    forward(tree, q, frames)
    if held.thing >= 0:
        hang(frames[-1], held.T_frame_thing, things.T_world_thing[held.thing])
    _place(solids, scratch)
    out[:] = False
    count = _near_itself(solids, scratch, n_things, out)
    reach = _reach(scratch.balls, solids.ball)
    for k in range(n_things):
        if not things.is_here[k]:
            continue
        at = _seen_from(things.T_world_thing[k], scratch.balls[0])
        if _square(things.box[k], at) <= reach * reach:
            is_known = held.is_known and k == held.thing
            count += _near_links(solids, things, scratch, k, is_known, out)
        if held.thing >= 0 and k != held.thing and _is_held_near(things, held.thing, k):
            out[len(solids.frame), k] = True
            count += 1
    return count


@njit(cache=True)
def near_thing(things, h, out):
    """Write into `out` (at least k,) with which things a thing `h` may overlap."""
    out[:] = False
    for k in range(len(things.is_here)):
        if k != h and things.is_here[k]:
            out[k] = _is_held_near(things, h, k)


@inner
def _reach(balls, ball):
    """Return the radius of a ball around all balls, about the centre of the first."""
    reach = 0.0
    for i in range(len(balls)):
        reach = max(reach, np.sqrt(_apart(balls[0], balls[i])) + ball[i, 3])
    return reach


@inner
def _near_links(solids, things, scratch, k, is_known, out):
    """Mark the links that may overlap with a thing and return how many there are.

    Those of the last frame are left out if `is_known`.
    """
    T, box, count = things.T_world_thing[k], things.box[k], 0
    first, end = things.first[k], things.first[k + 1]
    for i in range(len(solids.frame)):
        if is_known and solids.frame[i] == len(scratch.frames) - 1:
            continue
        radius = solids.ball[i, 3]
        if _square(box, _seen_from(T, scratch.balls[i])) > radius * radius:
            continue
        spheres = solids.first[i], solids.first[i + 1]
        bounds = _see(T, scratch.centres, solids.radius_m, spheres, scratch.seen)
        for t in range(first, end):
            if _do_boxes_meet(things.leaf_box[t], bounds) and _is_leaf_near(
                things.leaf_box[t], things.plane[t], scratch, solids.radius_m, spheres
            ):
                out[i, k] = True
                count += 1
                break
    return count


@inner
def _see(T, centres, radius, spheres, seen):
    """Write spheres as the frame (3, 4) sees them; return the box around them."""
    a = b = c = np.inf
    d = e = f = -np.inf
    for s in range(spheres[0], spheres[1]):
        x, y, z = _seen_from(T, centres[s])
        seen[s, 0], seen[s, 1], seen[s, 2] = x, y, z
        r = radius[s]
        a, b, c = min(a, x - r), min(b, y - r), min(c, z - r)
        d, e, f = max(d, x + r), max(e, y + r), max(f, z + r)
    return a, b, c, d, e, f


@inner
def _do_boxes_meet(one, other):
    """Return whether two boxes (6,) of one frame meet."""
    return (
        one[0] <= other[3]
        and one[3] >= other[0]
        and one[1] <= other[4]
        and one[4] >= other[1]
        and one[2] <= other[5]
        and one[5] >= other[2]
    )


@inner
def _is_leaf_near(box, plane, scratch, radius, spheres):
    """Return whether a sphere that a thing sees may overlap with a leaf of it."""
    for s in range(spheres[0], spheres[1]):
        at, r = scratch.seen[s], radius[s]
        height = plane[0] * at[0] + plane[1] * at[1] + plane[2] * at[2] + plane[3]
        if abs(height) <= r and _square(box, at) <= r * r:
            return True
    return False


@inner
def _place(solids, scratch):
    """Write where the spheres and balls are in the world."""
    for i in range(len(solids.frame)):
        T = scratch.frames[solids.frame[i]]
        _carry(T, solids.ball[i], scratch.balls[i])
        for s in range(solids.first[i], solids.first[i + 1]):
            _carry(T, solids.at_m[s], scratch.centres[s])


@inner
def _carry(T, at, out):
    """Write a point of a frame (3, 4) into `out`, seen from where the frame is."""
    for r in range(3):
        out[r] = T[r, 0] * at[0] + T[r, 1] * at[1] + T[r, 2] * at[2] + T[r, 3]


@inner
def _seen_from(T, at):
    """Return a point as the frame (3, 4) sees it."""
    x, y, z = at[0] - T[0, 3], at[1] - T[1, 3], at[2] - T[2, 3]
    return (
        T[0, 0] * x + T[1, 0] * y + T[2, 0] * z,
        T[0, 1] * x + T[1, 1] * y + T[2, 1] * z,
        T[0, 2] * x + T[1, 2] * y + T[2, 2] * z,
    )


@inner
def _square(box, at):
    """Return the squared distance of a point to a box (6,)."""
    total = 0.0
    for i in range(3):
        way = max(box[i] - at[i], at[i] - box[i + 3], 0.0)
        total += way * way
    return total


@inner
def _is_held_near(things, h, k):
    """Return whether the box around a thing `h` may overlap with another thing."""
    own, T_h, T_k = things.box[h], things.T_world_thing[h], things.T_world_thing[k]
    x = (own[0] + own[3]) / 2, (own[1] + own[4]) / 2, (own[2] + own[5]) / 2
    middle = (
        T_h[0, 0] * x[0] + T_h[0, 1] * x[1] + T_h[0, 2] * x[2] + T_h[0, 3],
        T_h[1, 0] * x[0] + T_h[1, 1] * x[1] + T_h[1, 2] * x[2] + T_h[1, 3],
        T_h[2, 0] * x[0] + T_h[2, 1] * x[1] + T_h[2, 2] * x[2] + T_h[2, 3],
    )
    at = _seen_from(T_k, middle)
    half = (
        _half_along(own, T_h, T_k[:, 0]),
        _half_along(own, T_h, T_k[:, 1]),
        _half_along(own, T_h, T_k[:, 2]),
    )
    bounds = (
        at[0] - half[0],
        at[1] - half[1],
        at[2] - half[2],
        at[0] + half[0],
        at[1] + half[1],
        at[2] + half[2],
    )
    if not _do_boxes_meet(things.box[k], bounds):
        return False
    for t in range(things.first[k], things.first[k + 1]):
        if _do_boxes_meet(things.leaf_box[t], bounds) and _does_cut(
            things.plane[t], own, T_h, T_k, at
        ):
            return True
    return False


@inner
def _half_along(box, T, axis):
    """Return half of the width of a box (6,) in a frame along an axis of the world."""
    total = SPARE_M
    for i in range(3):
        along = T[0, i] * axis[0] + T[1, i] * axis[1] + T[2, i] * axis[2]
        total += abs(along) * (box[i + 3] - box[i]) / 2
    return total


@inner
def _does_cut(plane, own, T_h, T_k, at):
    """Return whether a plane (4,) of one thing cuts the box of another; 0 always."""
    normal = (
        T_k[0, 0] * plane[0] + T_k[0, 1] * plane[1] + T_k[0, 2] * plane[2],
        T_k[1, 0] * plane[0] + T_k[1, 1] * plane[1] + T_k[1, 2] * plane[2],
        T_k[2, 0] * plane[0] + T_k[2, 1] * plane[1] + T_k[2, 2] * plane[2],
    )
    height = plane[0] * at[0] + plane[1] * at[1] + plane[2] * at[2] + plane[3]
    return abs(height) <= _half_along(own, T_h, normal)


@inner
def _near_itself(solids, scratch, n_things, out):
    """Mark the pairs of links that may overlap and return how many there are."""
    count, balls, centres = 0, scratch.balls, scratch.centres
    for p in range(len(solids.pairs)):
        i, j = solids.pairs[p, 0], solids.pairs[p, 1]
        reach = solids.ball[i, 3] + solids.ball[j, 3]
        if _apart(balls[i], balls[j]) > reach * reach:
            continue
        for a in range(solids.first[i], solids.first[i + 1]):
            reach = solids.radius_m[a] + solids.ball[j, 3]
            if _apart(centres[a], balls[j]) > reach * reach:
                continue
            spheres = solids.first[j], solids.first[j + 1]
            if _is_sphere_near(centres, solids.radius_m, a, spheres):
                out[i, n_things + j] = True
                count += 1
                break
    return count


@inner
def _is_sphere_near(centres, radius, a, spheres):
    """Return whether one sphere overlaps with one of several."""
    for b in range(spheres[0], spheres[1]):
        reach = radius[a] + radius[b]
        if _apart(centres[a], centres[b]) <= reach * reach:
            return True
    return False


@inner
def _apart(one, other):
    """Return the squared distance of two points."""
    x, y, z = one[0] - other[0], one[1] - other[1], one[2] - other[2]
    return x * x + y * y + z * z
