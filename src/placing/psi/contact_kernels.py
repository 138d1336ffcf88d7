"""Compiled loops over placements: lower an object, and measure what holds it.

Letters for shapes: c placements, s points of the object, d directions, f features.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from placing.psi.object_grids import ObjectGrid, around
from placing.psi.placing_field import Levels, Points

# ASSUME: 3 cm is above what lies on an area unseen, and below what rises out of it,
# such as the hoops of a rack: an object that does not fit between them is cut.
DROP_M, LEAST_DROP_M = 0.03, 0.02
"""How far above its area an object starts at most and at least."""
STRAY = 0.03
"""Share of an object's points that may touch by mistake before it rests."""
# ASSUME: what is this close to an area belongs to it: noise of a scan.
SNAP_M = 0.012
CONTACT_M, NEAR_CONTACT_M = 0.008, 0.016
"""Points of an object this close above a surface rest on it, or nearly do."""
SUNK_M = 0.025
"""A surface no higher above a point of the object is what the point has sunk into."""
FAR_M = 0.1
"""Gaps beyond this are as good as endless."""
HELD_M, CUT_M = 0.02, 0.008
"""What is this close beside an object holds it; what is this deep inside is cut."""
BASE_M = 0.01
"""What is no higher above the lowest point of an object is its base."""
FOOT_M = 0.025
"""What is lower above the object's lowest point does not hold it sideways."""
DOWN = -0.1
"""Points whose unit normal has less height than this face down."""
HIGH_ENOUGH = 0.4
"""What holds an object must reach this share of the height of its mass centre."""
MAX_CLEARANCE_M = 0.5
N_AROUND = 24
WITHIN = 3
"""A thing holds against motions up to so many directions of 15 degrees off its own."""
AROUND_X, AROUND_Y = np.ascontiguousarray(around(N_AROUND).T)
CONTACT_FEATURES = (
    "contact_share",
    "base_contact_share",
    "log_contacts",
    "overhang",
    "slope",
    "slope_max",
    "gap_mean_m",
    "gap_spread_m",
    "gap_max_m",
    "support_height",
    "contact_spread_m",
)
HULL_FEATURES = (
    "margin_m",
    "tipping",
    "near_margin_m",
    "near_tipping",
    "contact_width_m",
    "contact_length_m",
)
SPACE_FEATURES = ("gap_below_mass_m", "above_area_m", "clearance_m")
CUT_FEATURES = ("cut_m", "cut_deepest_m", "cut_share", "log_cut")
HELD_FEATURES = (
    "held",
    "held_high",
    "held_opposed",
    "held_gap_m",
    "held_margin_m",
    "held_tipping",
)
PLACED_FEATURES = (
    CONTACT_FEATURES + HULL_FEATURES + SPACE_FEATURES + CUT_FEATURES + HELD_FEATURES
)
"""Features of a placement that need the scene's cloud, in five groups."""
_N_PLACED = len(PLACED_FEATURES)
_HULL = len(CONTACT_FEATURES)
_SPACE = _HULL + len(HULL_FEATURES)
_CUT = _SPACE + len(SPACE_FEATURES)
_HELD = _CUT + len(CUT_FEATURES)


@njit(cache=True)
def _rotation(q: NDArray) -> NDArray:
    """Return the rotation matrix of a quaternion wxyz, shape (3, 3)."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    R = np.empty((3, 3))
    R[0, 0], R[0, 1], R[0, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 0.0
    R[1, 0], R[1, 1], R[1, 2] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 0.0
    R[2, 0], R[2, 1], R[2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), 0.0
    R[0, 2], R[1, 2] = 2 * (x * z + w * y), 2 * (y * z - w * x)
    R[2, 2] = 1 - 2 * (x * x + y * y)
    return R


@njit(cache=True)
def _turn(R: NDArray, vectors: NDArray, turned: NDArray) -> None:
    """Write vectors turned by a rotation."""
    for s in range(len(vectors)):
        for k in range(3):
            turned[s, k] = (
                R[k, 0] * vectors[s, 0]
                + R[k, 1] * vectors[s, 1]
                + R[k, 2] * vectors[s, 2]
            )


@njit(cache=True)
def _cell(levels: Levels, x: float, y: float) -> tuple[int, int]:
    """Return the first level at a place and the end of them."""
    plan = levels.plan
    i, j = (x - plan.x_m) * plan.per_m, (y - plan.y_m) * plan.per_m
    if 0 <= i < plan.n_x and 0 <= j < plan.n_y:
        c = int(i) * plan.n_y + int(j)
        return levels.start[c], levels.start[c + 1]
    return 0, 0


@njit(cache=True)
def _below(levels: Levels, x: float, y: float, z: float) -> tuple[float, float]:
    """Return height and rise of the highest level that faces up, not above z."""
    first, end = _cell(levels, x, y)
    for e in range(end - 1, first - 1, -1):
        if levels.surfaces[e, 0] <= z and levels.surfaces[e, 1] > 0:
            return levels.surfaces[e, 0], levels.surfaces[e, 1]
    return -np.inf, 1.0


@njit(cache=True)
def _above(levels: Levels, x: float, y: float, z: float) -> float:
    """Return the height of the lowest level that faces down, not below z."""
    first, end = _cell(levels, x, y)
    for e in range(first, end):
        if levels.surfaces[e, 0] >= z and levels.surfaces[e, 1] < 0:
            return levels.surfaces[e, 0]
    return np.inf


@njit(cache=True)
def _insert(largest: NDArray, value: float) -> None:
    """Keep a value among the largest, which are sorted from large to small."""
    k = len(largest)
    if value <= largest[k - 1]:
        return
    k -= 1
    while k > 0 and largest[k - 1] < value:
        largest[k] = largest[k - 1]
        k -= 1
    largest[k] = value


@njit(cache=True)
def rest(
    levels: Levels,
    points: NDArray,
    normals: NDArray,
    orientation: NDArray,
    xy: NDArray,
    area_height: NDArray,
) -> NDArray:
    """Return the height of the object's frame after lowering it, shape (c,) [m]."""
    height = np.empty(len(xy))
    p, n = np.empty_like(points), np.empty_like(normals)
    largest = np.empty(1 + int(STRAY * len(points)))
    for c in range(len(xy)):
        R = _rotation(orientation[c])
        _turn(R, points, p)
        _turn(R, normals, n)
        lowest = p[:, 2].min()
        stands = area_height[c] - lowest
        room = _room_above(levels, p, n, xy[c], stands, largest)
        start = stands + min(max(room, LEAST_DROP_M), DROP_M)
        largest[:] = -np.inf
        for s in range(len(p)):
            if n[s, 2] < DOWN:
                x, y = xy[c, 0] + p[s, 0], xy[c, 1] + p[s, 1]
                _insert(largest, _below(levels, x, y, start + p[s, 2])[0] - p[s, 2])
        touches = largest[len(largest) - 1]
        height[c] = touches if touches > stands + SNAP_M else stands
    return height


@njit(cache=True)
def _room_above(
    levels: Levels,
    p: NDArray,
    n: NDArray,
    xy: NDArray,
    z: float,
    largest: NDArray,
) -> float:
    """Return how far an object at height z can be lifted before it touches [m]."""
    largest[:] = -np.inf
    for s in range(len(p)):
        if n[s, 2] > -DOWN:
            x, y, at = xy[0] + p[s, 0], xy[1] + p[s, 1], z + p[s, 2]
            _insert(largest, at - _above(levels, x, y, at - CONTACT_M))
    return -largest[len(largest) - 1]


@njit(cache=True)
def measure(
    clouds: tuple[Levels, Points, ObjectGrid],
    points: NDArray,
    normals: NDArray,
    mass: NDArray,
    T: NDArray,
    area_height: NDArray,
) -> NDArray:
    """Return the features of placements in the order of their names, shape (c, f)."""
    levels, scene, grid = clouds
    features = np.zeros((len(T), _N_PLACED))
    p, n = np.empty_like(points), np.empty_like(normals)
    gaps, rises = np.empty(len(points)), np.empty(len(points))
    few = np.empty(1 + int(STRAY * len(points)))
    reach, near_reach = np.empty(N_AROUND), np.empty(N_AROUND)
    held_by, box = np.empty((N_AROUND, 2)), np.empty((2, 3))
    for c in range(len(T)):
        R, row = _rotation(T[c, :4]), features[c]
        _turn(R, points, p)
        _turn(R, normals, n)
        room = _room_above(levels, p, n, T[c, 4:6], T[c, 6], few)
        p += T[c, 4:]
        m = R @ mass + T[c, 4:]
        _find_box(p, box)
        bottom = box[0, 2] + HELD_M
        _find_gaps(levels, p, n, gaps, rises)
        reach[:] = -FAR_M
        _reach(p, gaps, (-np.inf, CONTACT_M), m, reach)
        near_reach[:] = reach
        _reach(p, gaps, (CONTACT_M, NEAR_CONTACT_M), m, near_reach)
        support = _describe_contacts(p, box, gaps, rises, m, row)
        lever = m[2] - support
        _describe_hull(reach, near_reach, lever, row[_HULL:_SPACE])
        below = bottom - _below(levels, m[0], m[1], bottom + SUNK_M)[0]
        row[_SPACE] = min(below, FAR_M)
        row[_SPACE + 1] = min(max(bottom - area_height[c], -FAR_M), FAR_M)
        row[_SPACE + 2] = min(max(room, -FAR_M), MAX_CLEARANCE_M)
        _describe_cuts(scene, grid, R, T[c, 4:], box, held_by, row[_CUT:_HELD])
        _describe_holds(held_by, reach, m[2] - bottom, lever, row[_HELD:])
    return features


@njit(cache=True)
def _find_gaps(
    levels: Levels, p: NDArray, n: NDArray, gaps: NDArray, rises: NDArray
) -> None:
    """Write the gap below each point that faces down, inf for others, and its slope."""
    for s in range(len(p)):
        gaps[s], rises[s] = np.inf, 1.0
        if n[s, 2] < DOWN:
            z, rises[s] = _below(levels, p[s, 0], p[s, 1], p[s, 2] + SUNK_M)
            gaps[s] = min(p[s, 2] - z, FAR_M)


@njit(cache=True)
def _reach(
    p: NDArray, gaps: NDArray, between: tuple[float, float], m: NDArray, reach: NDArray
) -> None:
    """Add how far contacts reach beyond the mass centre in each direction."""
    for s in range(len(p)):
        if between[0] < gaps[s] <= between[1]:
            dx, dy = p[s, 0] - m[0], p[s, 1] - m[1]
            for d in range(N_AROUND):
                far = AROUND_X[d] * dx + AROUND_Y[d] * dy
                reach[d] = far if far > reach[d] else reach[d]


@njit(cache=True)
def _describe_contacts(
    p: NDArray, box: NDArray, gaps: NDArray, rises: NDArray, m: NDArray, row: NDArray
) -> float:
    """Write the features of the contacts, return the mean height of them [m]."""
    bottom, top = box[0, 2] + HELD_M, box[1, 2] - HELD_M
    n_down, n_base, n_base_contacts, n_open, n_contacts = 0, 0, 0, 0, 0
    gap_sum, gap_squares, gap_max = 0.0, 0.0, 0.0
    slope_sum, slope_max, z_sum, z_squares = 0.0, 0.0, 0.0, 0.0
    for s in range(len(p)):
        if gaps[s] == np.inf:
            continue
        n_down += 1
        if gaps[s] <= CONTACT_M:
            n_contacts += 1
            slope = np.arccos(min(rises[s], 1.0))
            slope_sum, slope_max = slope_sum + slope, max(slope_max, slope)
            above = p[s, 2] - bottom
            z_sum, z_squares = z_sum + above, z_squares + above * above
        if p[s, 2] <= bottom + BASE_M:
            n_base += 1
            n_base_contacts += gaps[s] <= CONTACT_M
            n_open += gaps[s] > 3 * CONTACT_M
            gap_sum, gap_squares = gap_sum + gaps[s], gap_squares + gaps[s] ** 2
            gap_max = max(gap_max, gaps[s])
    row[0] = n_contacts / max(n_down, 1)
    row[1] = n_base_contacts / max(n_base, 1)
    row[2] = np.log1p(n_contacts)
    row[3] = n_open / n_base if n_base else 1.0
    row[4], row[5] = slope_sum / max(n_contacts, 1), slope_max
    row[6] = gap_sum / n_base if n_base else FAR_M
    row[7] = np.sqrt(max(gap_squares / max(n_base, 1) - row[6] ** 2, 0.0))
    row[8] = gap_max if n_base else FAR_M
    z = z_sum / max(n_contacts, 1)
    row[9] = (bottom + z - m[2]) / max(top - bottom, BASE_M)
    row[10] = np.sqrt(max(z_squares / max(n_contacts, 1) - z * z, 0.0))
    return bottom + z


@njit(cache=True)
def _tipping(margin: float, lever: float) -> float:
    """Return by which angle a body may lean before it tips over, signed [rad]."""
    return np.arctan2(margin, max(lever, 0.0) + 1e-3)


@njit(cache=True)
def _describe_hull(
    reach: NDArray, near_reach: NDArray, lever: float, row: NDArray
) -> None:
    """Write where the mass centre is in the hull of the contacts, and its extent."""
    row[0], row[2] = max(reach.min(), -FAR_M), max(near_reach.min(), -FAR_M)
    row[1], row[3] = _tipping(row[0], lever), _tipping(row[2], lever)
    half = N_AROUND // 2
    width = reach[:half] + reach[half:]
    row[4], row[5] = max(width.min(), 0.0), max(width.max(), 0.0)


@njit(cache=True)
def _find_box(p: NDArray, box: NDArray) -> None:
    """Write the lower and the upper corner of what may hold or cut, shape (2, 3)."""
    box[0], box[1] = np.inf, -np.inf
    for s in range(len(p)):
        for k in range(3):
            low, high = p[s, k] - HELD_M, p[s, k] + HELD_M
            box[0, k] = low if low < box[0, k] else box[0, k]
            box[1, k] = high if high > box[1, k] else box[1, k]


@njit(cache=True)
def _describe_cuts(
    scene: Points,
    grid: ObjectGrid,
    R: NDArray,
    t: NDArray,
    box: NDArray,
    held_by: NDArray,
    row: NDArray,
) -> None:
    """Write how the scene's points cut the object, and in held_by what holds it.

    `held_by` (d, 2): the greatest height above the foot, 0 for none, and the least gap.
    """
    held_by[:, 0], held_by[:, 1] = 0.0, HELD_M
    plan, bottom = scene.plan, box[0, 2] + HELD_M
    deepest = np.zeros(3)
    n_cut, n_near = 0, 0
    i_first = max(int((box[0, 0] - plan.x_m) * plan.per_m), 0)
    i_last = min(int((box[1, 0] - plan.x_m) * plan.per_m), plan.n_x - 1)
    j_first = max(int((box[0, 1] - plan.y_m) * plan.per_m), 0)
    j_last = min(int((box[1, 1] - plan.y_m) * plan.per_m), plan.n_y - 1)
    points = scene.points
    for i in range(i_first, i_last + 1):
        for j in range(j_first, j_last + 1):
            column = i * plan.n_y + j
            first, end = scene.start[column], scene.start[column + 1]
            for q in range(_first_at(points, first, end, box[0, 2]), end):
                x, y, z = points[q, 0], points[q, 1], points[q, 2]
                if z > box[1, 2]:
                    break
                if not (box[0, 0] <= x <= box[1, 0] and box[0, 1] <= y <= box[1, 1]):
                    continue
                far, way = _distance(grid, R, x - t[0], y - t[1], z - t[2])
                if far > HELD_M:
                    continue
                n_near += 1
                if far < 0:
                    n_cut += far < -CUT_M
                    _insert(deepest, -far)
                if far >= -HELD_M and z > bottom + FOOT_M:
                    _hold(R, way, far, z - bottom, held_by)
    if held_by[:, 0].any():
        _widen(held_by)
    row[0], row[1] = deepest[2], deepest[0]
    row[2], row[3] = n_cut / max(n_near, 1), np.log1p(n_cut)


@njit(cache=True)
def _first_at(points: NDArray, first: int, end: int, z: float) -> int:
    """Return the first of the points of a column that is not below z."""
    while first < end:
        middle = (first + end) // 2
        if points[middle, 2] < z:
            first = middle + 1
        else:
            end = middle
    return first


@njit(cache=True)
def _distance(
    grid: ObjectGrid, R: NDArray, dx: float, dy: float, dz: float
) -> tuple[float, tuple[float, float, float]]:
    """Return how far a point is from the object's surface, and the way out there.

    The point is given from the object's centre in the world, the way in its own frame.
    """
    x = (R[0, 0] * dx + R[1, 0] * dy + R[2, 0] * dz - grid.x_m) * grid.per_m
    y = (R[0, 1] * dx + R[1, 1] * dy + R[2, 1] * dz - grid.y_m) * grid.per_m
    z = (R[0, 2] * dx + R[1, 2] * dy + R[2, 2] * dz - grid.z_m) * grid.per_m
    n_x, n_y, n_z, _ = grid.cells.shape
    if not (0 <= x < n_x and 0 <= y < n_y and 0 <= z < n_z):
        return np.inf, (0.0, 0.0, 0.0)
    i, j, k = int(x), int(y), int(z)
    a, b, c = grid.cells[i, j, k, 1], grid.cells[i, j, k, 2], grid.cells[i, j, k, 3]
    off = (x - i - 0.5) * a + (y - j - 0.5) * b + (z - k - 0.5) * c
    return grid.cells[i, j, k, 0] + off / grid.per_m, (a, b, c)


@njit(cache=True)
def _hold(
    R: NDArray,
    way: tuple[float, float, float],
    far: float,
    above: float,
    held_by: NDArray,
) -> None:
    """Note that a point holds the object against motions its way."""
    x = R[0, 0] * way[0] + R[0, 1] * way[1] + R[0, 2] * way[2]
    y = R[1, 0] * way[0] + R[1, 1] * way[1] + R[1, 2] * way[2]
    if x * x + y * y < 0.25:
        return  # It is above or below.
    d = int(np.floor(np.arctan2(y, x) / (2 * np.pi) * N_AROUND + 0.5)) % N_AROUND
    held_by[d, 0] = max(held_by[d, 0], above)
    held_by[d, 1] = min(held_by[d, 1], max(far, 0.0))


@njit(cache=True)
def _widen(held_by: NDArray) -> None:
    """Let what holds against one direction hold against those next to it."""
    own = held_by.copy()
    for d in range(N_AROUND):
        for k in range(-WITHIN, WITHIN + 1):
            held_by[d, 0] = max(held_by[d, 0], own[(d + k) % N_AROUND, 0])
            held_by[d, 1] = min(held_by[d, 1], own[(d + k) % N_AROUND, 1])


@njit(cache=True)
def _describe_holds(
    held_by: NDArray, reach: NDArray, mass_height: float, lever: float, row: NDArray
) -> None:
    """Write from how many sides, and how high, the object is held."""
    half = N_AROUND // 2
    n_held, n_high, n_opposed, gaps = 0, 0, 0, 0.0
    margin = FAR_M
    for d in range(N_AROUND):
        is_held = held_by[d, 0] > 0
        is_high = held_by[d, 0] > HIGH_ENOUGH * mass_height
        n_held += is_held
        n_high += is_held and is_high
        gaps += held_by[d, 1]
        if is_held and held_by[(d + half) % N_AROUND, 0] > 0:
            n_opposed += 1
        if not (is_held and is_high):
            margin = min(margin, reach[d])
    row[0], row[1] = n_held / N_AROUND, n_high / N_AROUND
    row[2], row[3] = n_opposed / N_AROUND, gaps / N_AROUND
    row[4] = max(margin, -FAR_M)
    row[5] = _tipping(row[4], lever)
