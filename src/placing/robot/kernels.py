"""Compiled kinematics of the robot: where its frames and spheres are.

Only joints of a configuration move: the base, the torso and the a joints of the arm
carry f = 2 + a frames, and every link, finger and sphere is fixed in one of them.
Letters for shapes: f frames, s spheres, g groups, l links, a joints of the arm. A frame
is (3, 4), the upper rows of a homogeneous matrix.
"""

# ruff: noqa: ANN001, ANN201, ANN202 (the compiler infers types from the arguments)

from heapq import heappop, heappush
from typing import NamedTuple

import numpy as np
from numba import njit, types
from numba.experimental import structref
from numpy.typing import NDArray

Array = NDArray[np.float64]

inner = njit(cache=True, _nrt=False, forceinline=True)  # pyright: ignore[reportCallIssue]
"""Compiles what is called for each sphere and allocates nothing: in place of the call,
and without counting who uses an array; calls and counts take most of the time else."""

# ASSUME: what moves fastest in a third of a motion moves no more above its chords.
CURVED = 1.2
"""Way along an arc, and its fastest part, against the chords of its thirds."""
ROUNDED = 1 + 1e-9
"""Guards a bound against round-off."""


class Tree(NamedTuple):
    """The moving frames of a robot: 0 base, 1 torso, then one per joint of the arm."""

    T_parent_joint: Array
    """Frame of the joint of frame i in frame i - 1 at value 0, (f, 3, 4)."""
    axis: Array
    """Unit axis of the joint in its own frame, (f, 3)."""
    is_turning: NDArray[np.bool_]
    """Whether the joint turns (or slides), (f,)."""
    along: NDArray[np.int64]
    """Along which axis of frame i - 1 that of the joint is if the frame of the joint is
    turned as that one; else -1, (f,)."""
    link_frame: NDArray[np.int64]
    """Which frame carries each link, (l,)."""
    T_frame_link: Array
    """(l, 3, 4)."""
    T_frame_tool: Array
    """The tool in the last frame, (3, 4)."""


class Spheres(NamedTuple):
    """Spheres that together contain every collision shape, tip of the arm first."""

    centre_m: Array
    """In the frame of the sphere's link, (s, 3)."""
    radius_m: Array
    """(s,)."""
    link: NDArray[np.int64]
    """Number of the link, (s,)."""
    frame: NDArray[np.int64]
    """Number of the moving frame that carries the link, (s,)."""
    at_m: Array
    """Centre in that moving frame, (s, 3)."""


@inner
def forward(tree: Tree, q: Array, out: Array, first: int = 0) -> None:
    """Write the frames of configuration `q` (4 + a,) into `out` (f, 3, 4).

    Those before `first` are there already.
    """
    if first == 0:
        c, s = np.cos(q[2]), np.sin(q[2])
        base = out[0]
        base[:] = 0.0
        base[0, 0], base[0, 1], base[1, 0], base[1, 1], base[2, 2] = c, -s, s, c, 1.0
        base[0, 3], base[1, 3] = q[0], q[1]
    for i in range(max(first, 1), len(out)):
        T_parent_joint, value = tree.T_parent_joint[i], q[i + 2]
        if tree.along[i] >= 0 and tree.is_turning[i]:
            _turn_along(out[i - 1], T_parent_joint, tree.along[i], value, out[i])
            continue
        hang(out[i - 1], T_parent_joint, out[i])
        if tree.is_turning[i]:
            _turn(out[i], tree.axis[i], value)
        else:
            _slide(out[i], tree.axis[i], value)


@inner
def _turn_along(
    before: Array, T_before_joint: Array, along: int, angle: float, out: Array
) -> None:
    """Write the frame of a joint that turns about an axis of the frame before it [rad].

    To the last digit what `hang` and `_turn` write, without what they multiply by 0.
    """
    c, s = np.cos(angle), np.sin(angle)
    u, w, one = (along + 1) % 3, (along + 2) % 3, c + (1.0 - c)
    x, y, z = T_before_joint[0, 3], T_before_joint[1, 3], T_before_joint[2, 3]
    for r in range(3):
        at = before[r, 0] * x + before[r, 1] * y + before[r, 2] * z
        out[r, 3] = at + before[r, 3]
        out[r, along] = before[r, along] * one
        out[r, u] = before[r, u] * c + before[r, w] * s
        out[r, w] = before[r, w] * c - before[r, u] * s


@inner
def hang(T_a_b: Array, T_b_c: Array, out: Array) -> None:
    """Write `T_a_c` into `out`, all (3, 4)."""
    for r in range(3):
        x, y, z = T_a_b[r, 0], T_a_b[r, 1], T_a_b[r, 2]
        for k in range(4):
            out[r, k] = x * T_b_c[0, k] + y * T_b_c[1, k] + z * T_b_c[2, k]
        out[r, 3] += T_a_b[r, 3]


@inner
def _turn(T: Array, axis: Array, angle: float) -> None:
    """Turn the frame about its own axis by Rodrigues' formula [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = axis[0], axis[1], axis[2]
    v = 1.0 - c
    for r in range(3):
        i, j, k = T[r, 0], T[r, 1], T[r, 2]
        T[r, 0] = (
            i * (c + x * x * v) + j * (y * x * v + z * s) + k * (z * x * v - y * s)
        )
        T[r, 1] = (
            i * (x * y * v - z * s) + j * (c + y * y * v) + k * (z * y * v + x * s)
        )
        T[r, 2] = (
            i * (x * z * v + y * s) + j * (y * z * v - x * s) + k * (c + z * z * v)
        )


@inner
def _slide(T: Array, axis: Array, distance_m: float) -> None:
    """Move the frame along its own axis."""
    for r in range(3):
        step = T[r, 0] * axis[0] + T[r, 1] * axis[1] + T[r, 2] * axis[2]
        T[r, 3] += distance_m * step


# Checking: whether the spheres of a configuration are clear of scene, boxes and robot.
# Letters for shapes: l links that have spheres, c clusters of them, m pairs of links.


class Trunk(NamedTuple):
    """Base and torso, frames 0 and 1, as links of the arm may hit them.

    Distances to spheres of the trunk tell at one look what is far from all of them.
    """

    origin_m: Array
    """Centre of the first cell, in the frame of base or torso, (3,)."""
    cell_m: float
    around_m: float
    """What is outside of the cells is farther than this from the trunk."""
    least_m: NDArray[np.float32]
    """No spot of a cell is nearer to a sphere of some links, (n, x, y, z)."""
    number: NDArray[np.int64]
    """Which of these are the distances to the links that a link may hit, what is held
    last, of base and of torso; -1 where it may hit none, (l, 2)."""
    first: NDArray[np.int64]
    """The first of these links, those of the torso after those of the base, and the
    end of the last, (l, 3)."""
    links: NDArray[np.int64]
    start_rad: float
    bin_rad: float
    is_apart: NDArray[np.bool_]
    """Whether no link of frame 2 may hit the torso at any angle of the first joint of
    the arm in a bin; the first bin begins at `start_rad`, (n,)."""


class Body(NamedTuple):
    """Spheres sorted by link and cluster; what is held is a further, last link."""

    at_m: Array
    """Centres in the frames that carry them, (s, 3)."""
    radius_m: Array
    """(s,)."""
    reach_m: Array
    """Least distance of a centre to the points of the cloud, (s,)."""
    cluster: NDArray[np.int64]
    """First sphere of each cluster, and the end of the last, (c + 1,)."""
    cluster_ball: Array
    """Centre, radius and reach of a ball around each cluster, (c, 5)."""
    link: NDArray[np.int64]
    """First cluster of each link, and the end of the last, (l + 1,)."""
    link_ball: Array
    """Centre, radius and reach of a ball around each link, (l, 5)."""
    frame: NDArray[np.int64]
    """Number of the frame that carries each link, (l,)."""
    is_gripper: NDArray[np.bool_]
    """Whether the link is part of the gripper or held by it, (l,)."""
    n_robot: int
    """Number of links of the robot; one more link is what is held."""
    pairs: NDArray[np.int64]
    """Links that may hit each other, those of arm and trunk left out, (m, 2)."""
    trunk: "Trunk"
    """What arm and trunk may hit of each other."""
    outer_frame: NDArray[np.int64]
    """Number of the frame that carries each of the outermost centres, (o,)."""
    outer_m: Array
    """Those centres, between which all others of their frame are, (o, 3)."""
    lever_m: Array
    """Farthest that a unit of each coordinate moves a centre, (4 + a,)."""
    span_m: float
    """No sphere reaches farther from the axis of the base."""


class Lattice(NamedTuple):
    """Base poses on a floor, and the ways between neighbours."""

    poses: Array
    """x, y [m] and yaw [rad], (n, 3)."""
    first: NDArray[np.int64]
    """First neighbour of each pose, and the end of the last, (n + 1,)."""
    other: NDArray[np.int64]
    """Neighbours, pose by pose, (m,)."""
    length_m: Array
    """Of the way to each neighbour, (m,)."""
    distance_m: Array
    """Of each pose from one of them, infinite where there is no way, (n,)."""


class Surroundings(NamedTuple):
    """What a robot may hit, and how near it may come."""

    origin_m: Array
    cell_m: float
    distance_m: NDArray[np.float32]
    ground_m: NDArray[np.float32]
    """As of a distance field."""
    floor_m: float
    """No ground is higher."""
    boxes: Array
    """Centre, half size, cosine and sine of the yaw, half diagonal of each, (b, 9)."""
    margin_m: float
    """Kept above the ground."""
    box_margin_m: float
    self_margin_m: float
    lift_m: float
    """Height of the part of what is held that may touch when putting down."""


@structref.register
class _CaseType(types.StructRef):
    """What the compiler knows of a case."""


class Case(structref.StructRefProxy):
    """A robot, what it holds and what it may hit, to be handed over as one.

    Handing over each of their arrays takes longer than a check.
    """


structref.define_proxy(Case, _CaseType, ["tree", "body", "around"])


@njit(cache=True)
def case_of(tree, body, around):
    """Return a tree, a body and surroundings as one."""
    return Case(tree, body, around)


@njit(cache=True)
def are_free(case, configurations, touching, out):
    """Write whether each configuration (t, 4 + a) is free into `out` (t,)."""
    tree, body, around = case.tree, case.body, case.around
    frames = np.empty((len(tree.axis), 3, 4))
    centres = np.empty((len(body.frame), 3))
    known = -1  # a row that is free, and so is what moves with the same joints
    for i in range(len(configurations)):
        moved = 0, len(frames)
        if known >= 0:
            moved = _moved(configurations[known], configurations[i])
        q = configurations[i]
        forward(tree, q, frames)
        _place_links(body, frames, centres)
        out[i] = not is_hit(body, around, q, frames, centres, touching, moved)
        if out[i]:
            known = i


@njit(cache=True)
def are_clear(case, configurations, touching, out):
    """Write whether each of (t, 4 + a) is free of the boxes, whatever else it hits."""
    tree, body, around = case.tree, case.body, case.around
    frames = np.empty((len(tree.axis), 3, 4))
    centres = np.empty((len(body.frame), 3))
    for i in range(len(configurations)):
        forward(tree, configurations[i], frames)
        _place_links(body, frames, centres)
        box = _first_box(body, around, frames, centres, touching, 0, 0)
        out[i] = box == len(around.boxes)


@njit(cache=True)
def edge_free(case, q0, q1, touching, step_m):
    """Return whether a straight line of configurations is free, and the checks made."""
    tree, body, around = case.tree, case.body, case.around
    frames = np.empty((len(tree.axis), 3, 4))
    centres = np.empty((len(body.frame), 3))
    stride, checks = 1, 0
    q = np.empty(len(q0))
    moved = 0, len(frames)
    for i in (1, 0):  # the ends, of which only the first shows what stands still
        checks += 1
        end = q1 if i == 1 else q0
        forward(tree, end, frames)
        _place_links(body, frames, centres)
        if is_hit(body, around, end, frames, centres, touching, moved):
            return False, checks
        moved = _moved(q0, q1)
    n = n_steps(tree, body.outer_frame, body.outer_m, body.lever_m, q0, q1, step_m)
    while stride < n:
        stride *= 2
    while stride > 1:  # halves first: what is in the way is found sooner
        for i in range(stride // 2, n, stride):
            checks += 1
            _blend(q0, q1, i / n, q)
            forward(tree, q, frames, moved[0])
            _place_links(body, frames, centres)
            if is_hit(body, around, q, frames, centres, touching, moved):
                return False, checks
        stride //= 2
    return True, checks


@njit(cache=True)
def path_clear(case, path, touching, step_m):
    """Return whether a path (t, 4 + a) is free of the boxes, whatever else it hits."""
    tree, body, around = case.tree, case.body, case.around
    frames = np.empty((len(tree.axis), 3, 4))
    centres = np.empty((len(body.frame), 3))
    q, n_boxes = np.empty(path.shape[1]), len(around.boxes)
    for row in range(len(path)):
        q0, q1 = path[max(row - 1, 0)], path[row]
        if not _are_boxes_near(body, around, q0, q1):
            continue
        n = n_steps(tree, body.outer_frame, body.outer_m, body.lever_m, q0, q1, step_m)
        for i in range(n + 1):
            _blend(q0, q1, i / n, q)
            forward(tree, q, frames)
            _place_links(body, frames, centres)
            if _first_box(body, around, frames, centres, touching, 0, 0) < n_boxes:
                return False
    return True


@inner
def _are_boxes_near(body, around, q0, q1):
    """Return whether the robot might reach a box on the base's way between two rows."""
    boxes, wx, wy = around.boxes, q1[0] - q0[0], q1[1] - q0[1]
    square = max(wx * wx + wy * wy, 1e-12)
    for b in range(len(boxes)):
        x, y = boxes[b, 0] - q0[0], boxes[b, 1] - q0[1]
        share = min(max((x * wx + y * wy) / square, 0.0), 1.0)
        away = np.hypot(x - share * wx, y - share * wy)
        if away < body.span_m + boxes[b, 8] + around.box_margin_m:
            return True
    return False


@njit(cache=True)
def n_steps(tree, frame, at_m, lever_m, q0, q1, step_m):
    """Return in how many steps of an edge no point moves farther than `step_m`.

    Points (s, 3) are fixed in their frames. The levers of all joints add up to several
    times what really moves, which is measured over every third of the steps that would
    be enough by the levers.
    """
    way = 0.0
    for i in range(len(q0)):
        way += abs(q1[i] - q0[i]) * lever_m[i]
    most = max(1, int(np.ceil(way / step_m)))
    if most < 3:
        return most
    n, farthest, q = (most + 2) // 3, 0.0, np.empty(len(q0))
    n_frames = len(tree.axis)
    before, now = np.empty((n_frames, 3, 4)), np.empty((n_frames, 3, 4))
    way = np.zeros((n_frames, 3, 4))
    radius_m, is_far = np.zeros(n_frames), np.empty(n_frames, np.bool_)
    for i in range(len(at_m)):
        x, y, z = at_m[i, 0], at_m[i, 1], at_m[i, 2]
        radius_m[frame[i]] = max(radius_m[frame[i]], np.sqrt(x * x + y * y + z * z))
    first, _ = _moved(q0, q1)
    forward(tree, q0, before)
    now[:] = before
    for k in range(1, n + 1):
        _blend(q0, q1, k / n, q)
        forward(tree, q, now, first)
        way[first:] = before[first:] - now[first:]
        _find_far(way, radius_m, np.sqrt(farthest), is_far)
        farthest = max(farthest, _farthest(way, frame, at_m, is_far))
        before, now = now, before
    return min(most, max(1, int(np.ceil(CURVED * n * np.sqrt(farthest) / step_m))))


@inner
def _find_far(way, radius_m, least_m, is_far):
    """Write of which frames a point may have gone farther than `least_m`, by their way.

    No point of a frame is farther from its origin than a radius (f,).
    """
    for f in range(len(way)):
        turned, moved = 0.0, 0.0
        for r in range(3):
            moved += way[f, r, 3] ** 2
            for k in range(3):
                turned += way[f, r, k] ** 2
        bound = np.sqrt(moved) + radius_m[f] * np.sqrt(turned)
        is_far[f] = bound * ROUNDED > least_m


@inner
def _farthest(way, frame, at_m, is_far):
    """Return the largest square of how far points (s, 3) went, by frames' way.

    Only those of some frames are looked at.
    """
    farthest = 0.0
    for i in range(len(at_m)):
        f = frame[i]
        if not is_far[f]:
            continue
        x, y, z = at_m[i, 0], at_m[i, 1], at_m[i, 2]
        square = 0.0
        for r in range(3):
            step = way[f, r, 0] * x + way[f, r, 1] * y + way[f, r, 2] * z + way[f, r, 3]
            square += step * step
        farthest = max(farthest, square)
    return farthest


@inner
def _moved(q0, q1):
    """Return the first and the last frame whose own joint differs between two rows."""
    first, last = len(q0), -1
    for i in range(len(q0)):
        if q0[i] != q1[i]:
            first, last = min(first, max(i - 2, 0)), max(i - 2, 0)
    return first, last


@njit(cache=True)
def way(case, q, lattice, goal, root, is_lost):
    """Return numbers of poses of a lattice from `goal` to `root`; none if no way is.

    Torso and arm are those of `q`, free of themselves. A* that checks a pose when it
    goes on from it: ways of furniture alone, which are known, bound what is left.
    Poses from which there is no way to `root` are known by `is_lost` (n,), and added.
    """
    tree, body, around = case.tree, case.body, case.around
    n, q = len(lattice.poses), q.copy()
    frames = np.empty((len(tree.axis), 3, 4))
    centres = np.empty((len(body.frame), 3))
    cost, back = np.full(n, np.inf), np.full(n, -1)
    is_done = np.zeros(n, np.bool_)
    left, cost[goal] = lattice.distance_m, 0.0
    if is_lost[goal] or not np.isfinite(left[goal] + left[root]):
        return np.empty(0, np.int64)
    todo = [(abs(left[goal] - left[root]), goal)]
    while len(todo) > 0 and not is_done[root]:
        _, i = heappop(todo)
        if is_done[i]:
            continue
        is_done[i] = True
        q[:3] = lattice.poses[i]
        forward(tree, q, frames)
        _place_links(body, frames, centres)
        if is_hit(body, around, q, frames, centres, False, (0, 0)):
            continue
        if i == root:
            return _chain(back, root)
        for k in range(lattice.first[i], lattice.first[i + 1]):
            j, length = lattice.other[k], cost[i] + lattice.length_m[k]
            if length < cost[j]:
                cost[j], back[j] = length, i
                heappush(todo, (length + abs(left[j] - left[root]), j))
    # What was come by is all that is joined to the goal.
    is_lost |= is_done
    return np.empty(0, np.int64)


@njit(cache=True)
def _chain(back, last):
    """Return a number and those before it in turn, in reverse."""
    chain = [last]
    while back[chain[-1]] >= 0:
        chain.append(back[chain[-1]])
    return np.array(chain[::-1])


@njit(cache=True)
def hands_free(case, wrists, touching, out):
    """Write into `out` (n,) whether what the last frame carries is free, at (n, 3, 4).

    The robot itself is not there: whatever arm brings the hand there hits no less.
    """
    body, around = case.body, case.around
    last = len(body.lever_m) - 3
    frames = np.zeros((last + 1, 3, 4))
    centres = np.empty((len(body.frame), 3))
    for i in range(len(wrists)):
        frames[last] = wrists[i]
        # Nothing of the hand is farther from its own frame than from the base's axis.
        frames[0] = wrists[i]
        _place_links(body, frames, centres)
        out[i] = not (
            _hits_scene(body, around, frames, centres, touching, last)
            or _first_box(body, around, frames, centres, touching, last, 0)
            < len(around.boxes)
        )


@njit(cache=True)
def hands_clear(case, places, wrist, out):
    """Write into `out` (n,) whether base and torso are clear of what the hand carries.

    They are at x, y, yaw and a height (n, 4), the last frame is at `wrist` (3, 4).
    """
    tree, body, around = case.tree, case.body, case.around
    last, q = len(body.lever_m) - 3, np.zeros(len(body.lever_m))
    frames = np.empty((last + 1, 3, 4))
    centres = np.empty((len(body.frame), 3))
    for i in range(len(places)):
        q[:4] = places[i]
        forward(tree, q, frames)
        frames[last] = wrist
        _place_links(body, frames, centres)
        out[i] = not _hits_itself(body, around, np.nan, frames, centres, (last, 2))


@njit(cache=True)
def hand_boxes(case, wrist, touching, boxes):
    """Write into `boxes` (b,) which are hit by what the last frame (3, 4) carries."""
    body, around = case.body, case.around
    last = len(body.lever_m) - 3
    frames = np.zeros((last + 1, 3, 4))
    centres = np.empty((len(body.frame), 3))
    frames[last] = wrist
    frames[0] = wrist
    _place_links(body, frames, centres)
    b = _first_box(body, around, frames, centres, touching, last, 0)
    while b < len(boxes):
        boxes[b] = True
        b = _first_box(body, around, frames, centres, touching, last, b + 1)


@njit(cache=True)
def state_hits(case, q, touching, boxes):
    """Return whether scene and robot are hit; write it for each of `boxes` (b,)."""
    tree, body, around = case.tree, case.body, case.around
    frames = np.empty((len(tree.axis), 3, 4))
    centres = np.empty((len(body.frame), 3))
    forward(tree, q, frames)
    _place_links(body, frames, centres)
    b = _first_box(body, around, frames, centres, touching, 0, 0)
    while b < len(boxes):
        boxes[b] = True
        b = _first_box(body, around, frames, centres, touching, 0, b + 1)
    scene = _hits_scene(body, around, frames, centres, touching, 0)
    return scene, _hits_itself(body, around, q[4], frames, centres, (0, len(frames)))


@inner
def is_hit(body, around, q, frames, centres, touching, moved):
    """Return whether anything hits anything since the joints of some frames moved.

    `moved` are the first and the last of these; without them nothing was hit.
    """
    n, first = len(around.boxes), moved[0]
    return (
        _hits_scene(body, around, frames, centres, touching, first)
        or _first_box(body, around, frames, centres, touching, first, 0) < n
        or _hits_itself(body, around, q[4], frames, centres, moved)
    )


@inner
def _hits_scene(body, around, frames, centres, touching, first):
    """Return whether a link comes too near to the scanned points or to the ground."""
    distance, origin, cell = around.distance_m, around.origin_m, around.cell_m
    # A call with many arrays costs more than sums: only what is near needs one.
    for k in range(len(body.frame)):
        f, reach = body.frame[k], body.link_ball[k, 4]
        if f < first:
            continue
        x, y, z = centres[k, 0], centres[k, 1], centres[k, 2]
        is_low = f > 0 and z - reach < around.floor_m
        is_near = is_low or _is_near(distance, origin, cell, x, y, z, reach)
        if is_near and _link_hits_scene(body, around, frames, k, touching):
            return True
    return False


@inner
def _link_hits_scene(body, around, frames, k, touching):
    """Return whether a sphere of a link is too near to the points or to the ground."""
    distance, origin, cell = around.distance_m, around.origin_m, around.cell_m
    f, is_bare = body.frame[k], touching and body.is_gripper[k]
    lowest = _lowest(body, frames, k, around.lift_m) if is_bare else -np.inf
    margin = 0.0 if is_bare else around.margin_m
    reaches = body.radius_m if is_bare else body.reach_m
    for c in range(body.link[k], body.link[k + 1]):
        x, y, z = _point(frames, f, body.cluster_ball, c)
        reach = body.cluster_ball[c, 4]
        is_low = f > 0 and z - reach < around.floor_m
        if not (is_low or _is_near(distance, origin, cell, x, y, z, reach)):
            continue
        for i in range(body.cluster[c], body.cluster[c + 1]):
            x, y, z = _point(frames, f, body.at_m, i)
            bottom = z - body.radius_m[i]
            if bottom < lowest:
                continue
            if _is_near(distance, origin, cell, x, y, z, reaches[i]):
                return True
            bottom -= margin
            is_low = f > 0 and bottom < around.floor_m
            if is_low and bottom < _ground(around.ground_m, origin, cell, x, y):
                return True
    return False


@inner
def _first_box(body, around, frames, centres, touching, first, start):
    """Return the first box from number `start` that is hit, or their count if none."""
    boxes = around.boxes
    for b in range(start, len(boxes)):
        x, y, z = boxes[b, 0], boxes[b, 1], boxes[b, 2]
        away = np.hypot(x - frames[0, 0, 3], y - frames[0, 1, 3])
        if away >= body.span_m + boxes[b, 8] + around.box_margin_m:
            continue
        for k in range(len(body.frame)):
            if body.frame[k] < first:
                continue
            reach = body.link_ball[k, 3] + boxes[b, 8] + around.box_margin_m
            is_near = _square(centres, k, x, y, z) < reach * reach
            if is_near and _link_hits_box(body, around, frames, k, b, touching):
                return b
    return len(boxes)


@inner
def _link_hits_box(body, around, frames, k, b, touching):
    """Return whether a sphere of a link comes too near to a box."""
    boxes, f = around.boxes, body.frame[k]
    is_bare = touching and body.is_gripper[k]
    margin = 0.0 if is_bare else around.box_margin_m
    lowest = _lowest(body, frames, k, around.lift_m) if is_bare else -np.inf
    for c in range(body.link[k], body.link[k + 1]):
        x, y, z = _point(frames, f, body.cluster_ball, c)
        reach = body.cluster_ball[c, 3] + margin
        if _square_to_box(boxes, b, x, y, z) >= reach * reach:
            continue
        for i in range(body.cluster[c], body.cluster[c + 1]):
            x, y, z = _point(frames, f, body.at_m, i)
            reach = body.radius_m[i] + margin
            if z - body.radius_m[i] < lowest:
                continue
            if _square_to_box(boxes, b, x, y, z) < reach * reach:
                return True
    return False


@njit(cache=True)
def _hits_itself(body, around, angle, frames, centres, moved):
    """Return whether two links with a moved joint between them come too near.

    The first joint of the arm is at an angle [rad], not a number if that is not known.
    """
    frame, pairs, ball, margin = (
        body.frame,
        body.pairs,
        body.link_ball,
        around.self_margin_m,
    )
    if _hits_trunk(body, angle, frames, centres, margin, moved):
        return True
    for n in range(len(pairs)):
        k, m = pairs[n, 0], pairs[n, 1]
        reach = ball[k, 3] + ball[m, 3] + margin
        x, y, z = centres[m, 0], centres[m, 1], centres[m, 2]
        if _square(centres, k, x, y, z) >= reach * reach:
            continue
        if max(frame[k], frame[m]) < moved[0] or min(frame[k], frame[m]) >= moved[1]:
            continue
        args = body.cluster_ball, body.at_m, body.radius_m, body.cluster, frames
        first_k, last_k = body.link[k], body.link[k + 1]
        for d in range(body.link[m], body.link[m + 1]):
            x, y, z = _point(frames, frame[m], body.cluster_ball, d)
            reach = body.cluster_ball[d, 3] + ball[k, 3] + margin
            if _square(centres, k, x, y, z) >= reach * reach:
                continue
            if _hits_cluster(args, d, first_k, last_k, frame[m], frame[k], margin):
                return True
    return False


@inner
def _hits_trunk(body, angle, frames, centres, margin, moved):
    """Return whether a link of the arm comes too near to base or torso."""
    trunk, ball = body.trunk, body.link_ball
    is_apart = _is_apart(trunk, angle)
    for k in range(len(body.frame)):
        if body.frame[k] < moved[0]:
            continue
        for f in range(min(2, moved[1])):
            t = trunk.number[k, f]
            if t < 0 or (is_apart and f == 1 and body.frame[k] == 2):
                continue
            x, y, z = centres[k, 0], centres[k, 1], centres[k, 2]
            if not _is_near_trunk(trunk, t, frames, f, x, y, z, ball[k, 3] + margin):
                continue
            if _link_hits_trunk(body, frames, centres, margin, k, f):
                return True
    return False


@inner
def _is_apart(trunk, angle):
    """Return whether frame 2 is surely clear of the torso at an angle of its joint."""
    place = (angle - trunk.start_rad) / trunk.bin_rad
    return 0.0 <= place < len(trunk.is_apart) and trunk.is_apart[int(place)]


@inner
def _link_hits_trunk(body, frames, centres, margin, k, f):
    """Return whether a link of the arm comes too near to base (f = 0) or torso (1)."""
    trunk, ball, g = body.trunk, body.cluster_ball, body.frame[k]
    t = trunk.number[k, f]
    for c in range(body.link[k], body.link[k + 1]):
        x, y, z = _point(frames, g, ball, c)
        if not _is_near_trunk(trunk, t, frames, f, x, y, z, ball[c, 3] + margin):
            continue
        for i in range(body.cluster[c], body.cluster[c + 1]):
            x, y, z = _point(frames, g, body.at_m, i)
            reach = body.radius_m[i] + margin
            if not _is_near_trunk(trunk, t, frames, f, x, y, z, reach):
                continue
            for n in range(trunk.first[k, f], trunk.first[k, f + 1]):
                m = trunk.links[n]
                if _is_near_link(body, frames, centres, m, x, y, z, reach):
                    return True
    return False


@inner
def _is_near_link(body, frames, centres, m, x, y, z, reach_m):
    """Return whether a point is nearer than `reach_m` to a sphere of link m."""
    reach = body.link_ball[m, 3] + reach_m
    if _square(centres, m, x, y, z) >= reach * reach:
        return False
    for d in range(body.link[m], body.link[m + 1]):
        u, v, w = _point(frames, body.frame[m], body.cluster_ball, d)
        reach = body.cluster_ball[d, 3] + reach_m
        if (x - u) ** 2 + (y - v) ** 2 + (z - w) ** 2 >= reach * reach:
            continue
        for j in range(body.cluster[d], body.cluster[d + 1]):
            u, v, w = _point(frames, body.frame[m], body.at_m, j)
            reach = body.radius_m[j] + reach_m
            if (x - u) ** 2 + (y - v) ** 2 + (z - w) ** 2 < reach * reach:
                return True
    return False


@inner
def _is_near_trunk(trunk, t, frames, f, x, y, z, reach_m):
    """Return whether a point may be nearer than `reach_m` to some links of frame f."""
    x, y, z = x - frames[f, 0, 3], y - frames[f, 1, 3], z - frames[f, 2, 3]
    scale, origin = 1.0 / trunk.cell_m, trunk.origin_m
    u = frames[f, 0, 0] * x + frames[f, 1, 0] * y + frames[f, 2, 0] * z - origin[0]
    v = frames[f, 0, 1] * x + frames[f, 1, 1] * y + frames[f, 2, 1] * z - origin[1]
    w = frames[f, 0, 2] * x + frames[f, 1, 2] * y + frames[f, 2, 2] * z - origin[2]
    u, v, w = u * scale + 0.5, v * scale + 0.5, w * scale + 0.5
    _, nx, ny, nz = trunk.least_m.shape
    if not (0.0 <= u < nx and 0.0 <= v < ny and 0.0 <= w < nz):
        return reach_m > trunk.around_m
    return trunk.least_m[t, int(u), int(v), int(w)] < reach_m


@inner
def least_distances(at_m, radius_m, origin_m, cell_m, out):
    """Write below which distance no spot of a cell is from spheres (s,) into `out`."""
    slack = 0.867 * cell_m  # half the diagonal of a cell
    nx, ny, nz = out.shape
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                x = origin_m[0] + i * cell_m
                y = origin_m[1] + j * cell_m
                z = origin_m[2] + k * cell_m
                least = np.inf
                for n in range(len(at_m)):
                    u, v, w = at_m[n, 0] - x, at_m[n, 1] - y, at_m[n, 2] - z
                    away = np.sqrt(u * u + v * v + w * w) - radius_m[n]
                    least = min(least, away)
                out[i, j, k] = least - slack


@inner
def _hits_cluster(args, d, first_c, last_c, g, f, margin):
    """Return whether cluster d in frame g is too near to clusters c in frame f."""
    ball, at, radius, cluster, frames = args
    u, v, w = _point(frames, g, ball, d)
    for c in range(first_c, last_c):
        x, y, z = _point(frames, f, ball, c)
        reach = ball[c, 3] + ball[d, 3] + margin
        if (x - u) ** 2 + (y - v) ** 2 + (z - w) ** 2 >= reach * reach:
            continue
        for i in range(cluster[c], cluster[c + 1]):
            x, y, z = _point(frames, f, at, i)
            reach = radius[i] + ball[d, 3] + margin
            if (x - u) ** 2 + (y - v) ** 2 + (z - w) ** 2 >= reach * reach:
                continue
            for j in range(cluster[d], cluster[d + 1]):
                a, b, e = _point(frames, g, at, j)
                reach = radius[i] + radius[j] + margin
                if (x - a) ** 2 + (y - b) ** 2 + (z - e) ** 2 < reach * reach:
                    return True
    return False


@inner
def _is_near(distance, origin, cell_m, x, y, z, reach_m):
    """Return whether a point is nearer than `reach_m` to what was scanned."""
    scale = 1.0 / cell_m
    u = (x - origin[0]) * scale
    v = (y - origin[1]) * scale
    w = (z - origin[2]) * scale
    nx, ny, nz = distance.shape
    if not (0.0 <= u < nx - 1 and 0.0 <= v < ny - 1):
        return True
    # Above the field nothing was scanned, and the ground is looked at on its own.
    w = min(max(w, 0.0), nz - 1.000001)
    nearest = distance[int(u + 0.5), int(v + 0.5), int(w + 0.5)]
    # No distance differs by more than the way to the centre of the cell.
    slack = 0.867 * cell_m
    if nearest >= reach_m + slack:
        return False
    if nearest + slack < reach_m:
        return True
    return _between(distance, u, v, w) < reach_m


@inner
def _between(distance, u, v, w):
    """Return the distance between the centres of eight cells, linear in each axis."""
    i, j, k = int(u), int(v), int(w)
    u, v, w = u - i, v - j, w - k
    total = 0.0
    for a in range(2):
        for b in range(2):
            share = (u if a else 1.0 - u) * (v if b else 1.0 - v)
            low, high = distance[i + a, j + b, k], distance[i + a, j + b, k + 1]
            total += share * (low + w * (high - low))
    return total


@inner
def _ground(ground, origin, cell_m, x, y):
    """Return the height of the ground [m]; the field holds the point."""
    i = int((x - origin[0]) / cell_m + 0.5)
    j = int((y - origin[1]) / cell_m + 0.5)
    return ground[i, j]


@inner
def _square_to_box(boxes, b, x, y, z):
    """Return the squared distance of a point to a box that is turned about z."""
    x, y, z = x - boxes[b, 0], y - boxes[b, 1], z - boxes[b, 2]
    c, s = boxes[b, 6], boxes[b, 7]
    u = max(abs(c * x + s * y) - boxes[b, 3], 0.0)
    v = max(abs(c * y - s * x) - boxes[b, 4], 0.0)
    w = max(abs(z) - boxes[b, 5], 0.0)
    return u * u + v * v + w * w


@inner
def _lowest(body, frames, k, lift_m):
    """Return below which height a held object may touch; the gripper must not [m]."""
    if k != body.n_robot:
        return -np.inf
    lowest = np.inf
    for i in range(body.cluster[body.link[k]], body.cluster[body.link[k + 1]]):
        _, _, z = _point(frames, body.frame[k], body.at_m, i)
        lowest = min(lowest, z - body.radius_m[i])
    return lowest + lift_m


@inner
def _place_links(body, frames, out):
    """Write the centres of the balls around the links into `out` (l, 3)."""
    for k in range(len(out)):
        x, y, z = _point(frames, body.frame[k], body.link_ball, k)
        out[k, 0], out[k, 1], out[k, 2] = x, y, z


@inner
def _point(frames, f, at, i):
    """Return row i of points of frame f, in the world."""
    # Views of rows cost more than the sums, so single numbers are read.
    x, y, z = at[i, 0], at[i, 1], at[i, 2]
    return (
        frames[f, 0, 0] * x
        + frames[f, 0, 1] * y
        + frames[f, 0, 2] * z
        + frames[f, 0, 3],
        frames[f, 1, 0] * x
        + frames[f, 1, 1] * y
        + frames[f, 1, 2] * z
        + frames[f, 1, 3],
        frames[f, 2, 0] * x
        + frames[f, 2, 1] * y
        + frames[f, 2, 2] * z
        + frames[f, 2, 3],
    )


@inner
def _square(points, k, x, y, z):
    """Return the squared distance of row k of points to a point."""
    u, v, w = points[k, 0] - x, points[k, 1] - y, points[k, 2] - z
    return u * u + v * v + w * w


@inner
def _blend(q0, q1, share, out):
    """Write the configuration at a share of the way into `out`."""
    for i in range(len(out)):
        out[i] = q0[i] + share * (q1[i] - q0[i])
