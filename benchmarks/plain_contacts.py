"""Features of placements in plain numpy: slow, to compare the compiled ones with."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from placing import rigid
from placing.psi import contact_kernels as kernels
from placing.psi.object_clouds import ObjectCloud
from placing.psi.object_grids import (
    SHAPE_FEATURES,
    around,
    object_grid,
    shape_features,
    spread_points,
)
from placing.psi.placing_field import PlacingField

Array = NDArray[np.float64]

FAR, N = kernels.FAR_M, kernels.N_AROUND
ways = around(N)


class Plain:
    """One scene and one object."""

    def __init__(self, field: PlacingField, cloud: ObjectCloud) -> None:
        """Prepare both clouds."""
        self.field, self.cloud = field, cloud
        self.points, self.normals = spread_points(cloud)
        self.scene = field.cloud.points.astype(float)
        self.tree = cKDTree(self.scene)

    def _levels(self, xy: Array) -> tuple[Array, Array]:
        """Return height and rise of the levels at one place."""
        plan, start = self.field.levels.plan, self.field.levels.start
        i, j = np.floor((xy - [plan.x_m, plan.y_m]) / plan.cell_m).astype(int)
        if not (0 <= i < plan.n_x and 0 <= j < plan.n_y):
            return np.empty(0), np.empty(0)
        c = i * plan.n_y + j
        height, rise = self.field.levels.surfaces[start[c] : start[c + 1]].T
        return height.astype(float), rise.astype(float)

    def below(self, point: Array) -> tuple[float, float]:
        """Return height and rise of what faces up below a point."""
        height, rise = self._levels(point[:2])
        is_below = (rise > 0) & (height <= point[2])
        if not is_below.any():
            return -np.inf, 1.0
        e = np.flatnonzero(is_below)[-1]
        return float(height[e]), float(rise[e])

    def above(self, point: Array) -> float:
        """Return the height of what faces down above a point."""
        height, rise = self._levels(point[:2])
        return min(height[(rise < 0) & (height >= point[2])], default=np.inf)

    def room(self, p: Array, n: Array) -> float:
        """Return how far an object can be lifted, but for a few of its points."""
        rooms = [
            self.above(at - np.array([0, 0, kernels.CONTACT_M])) - at[2]
            for at in p[n[:, 2] > -kernels.DOWN]
        ]
        k = int(kernels.STRAY * len(p))
        return sorted([*rooms, *[np.inf] * (k + 1)])[k]

    def rest_height(self, orientation: Array, xy: Array, area_height: float) -> float:
        """Return the height of the object's frame after lowering it [m]."""
        R = rigid.matrix(orientation)
        p, n = self.points @ R.T, self.normals @ R.T
        stands = area_height - p[:, 2].min()
        room = self.room(p + np.array([*xy, stands]), n)
        start = stands + np.clip(room, kernels.LEAST_DROP_M, kernels.DROP_M)
        touches = [
            self.below(at + np.array([*xy, start]))[0] - at[2]
            for at in p[n[:, 2] < kernels.DOWN]
        ]
        k = int(kernels.STRAY * len(p))
        first = sorted([*touches, *[-np.inf] * (k + 1)])[-1 - k]
        return first if first > stands + kernels.SNAP_M else stands

    def features(self, T: Array, area_height: float) -> Array:
        """Return the features of one placement, shape (f,)."""
        R = rigid.matrix(T[:4])
        p, n = rigid.apply(T, self.points), self.normals @ R.T
        m = rigid.apply(T, self.cloud.mass_centre[None])[0]
        bottom = p[:, 2].min()
        down = p[n[:, 2] < kernels.DOWN]
        sunk = np.array([0, 0, kernels.SUNK_M])
        found = np.array([self.below(at + sunk) for at in down])
        found = found.reshape(-1, 2)
        gap, rise = np.minimum(down[:, 2] - found[:, 0], FAR), found[:, 1]
        touches = down[gap <= kernels.CONTACT_M]
        support = touches[:, 2].mean() if len(touches) else bottom
        reach = reaches(touches, m)
        near = reaches(down[gap <= kernels.NEAR_CONTACT_M], m)
        height = max(np.ptp(p[:, 2]), kernels.BASE_M)
        below_mass = self.below(np.array([*m[:2], bottom + kernels.SUNK_M]))[0]
        room = self.room(p, n)
        held, cuts = self._surroundings(T, p)
        return np.array(
            [
                *contacts(down, gap, rise, bottom),
                (support - m[2]) / height,
                touches[:, 2].std() if len(touches) else 0.0,
                *hull(reach, near, m[2] - support),
                min(bottom - below_mass, FAR),
                np.clip(bottom - area_height, -FAR, FAR),
                np.clip(room, -FAR, kernels.MAX_CLEARANCE_M),
                *cuts,
                *holds(held, reach, m[2] - bottom, m[2] - support),
                *shape_features(self.cloud, R[2:])[0],
            ]
        )

    def _surroundings(self, T: Array, p: Array) -> tuple[list[list], list[float]]:
        """Return, for each direction, heights and gaps of what holds, and the cuts."""
        low, high = p.min(0) - kernels.HELD_M, p.max(0) + kernels.HELD_M
        radius = float(np.linalg.norm(high - low)) / 2
        near = self.scene[self.tree.query_ball_point((low + high) / 2, radius)]
        near = near[((near >= low) & (near <= high)).all(axis=1)]
        far, way = self._distance(rigid.apply(rigid.inverse(T), near))
        far, way, near = far[far <= 0.02], way[far <= 0.02], near[far <= 0.02]
        deepest = np.sort(np.concatenate([np.maximum(-far, 0), np.zeros(3)]))
        n_cut = int((far < -kernels.CUT_M).sum())
        cuts = [deepest[-3], deepest[-1], n_cut / max(len(far), 1), np.log1p(n_cut)]
        x, y, _ = (way @ rigid.matrix(T[:4]).T).T
        above = near[:, 2] - (low[2] + kernels.HELD_M)
        holds = (far >= -kernels.HELD_M) & (above > kernels.FOOT_M)
        holds &= np.hypot(x, y) >= 0.5
        at = np.floor(np.arctan2(y, x) / (2 * np.pi) * N + 0.5).astype(int) % N
        held = []
        for d in range(N):
            off = np.abs((at - d + N // 2) % N - N // 2)
            by = holds & (off <= kernels.WITHIN)
            held.append([above[by], np.maximum(far[by], 0)])
        return held, cuts

    def _distance(self, q: Array) -> tuple[Array, Array]:
        """Return distance and the way out of points in the object's frame."""
        grid = object_grid(self.cloud)
        low = np.array([grid.x_m, grid.y_m, grid.z_m])
        at = np.floor((q - low) * grid.per_m).astype(int)
        inside = ((at >= 0) & (at < grid.cells.shape[:3])).all(axis=1)
        at[~inside] = 0
        cell = grid.cells[tuple(at.T)].astype(float)
        centre = low + (at + 0.5) / grid.per_m
        far = cell[:, 0] + ((q - centre) * cell[:, 1:]).sum(axis=1)
        return np.where(inside, far, np.inf), cell[:, 1:]


def reaches(contacts: Array, m: Array) -> Array:
    """Return how far contacts reach beyond the mass centre, shape (d,)."""
    far = (contacts[:, :2] - m[:2]) @ ways.T
    return np.concatenate([far, np.full((1, N), -FAR)]).max(axis=0)


def tipping(margin: float, lever: float) -> float:
    """Return the angle at which a body tips over [rad]."""
    return float(np.arctan2(margin, max(lever, 0) + 1e-3))


def contacts(down: Array, gap: Array, rise: Array, bottom: float) -> list[float]:
    """Return the first nine features."""
    touch = gap <= kernels.CONTACT_M
    is_base = down[:, 2] <= bottom + kernels.BASE_M
    base = gap[is_base]
    slope = np.arccos(np.minimum(rise[touch], 1))
    return [
        touch.mean() if len(down) else 0.0,
        (base <= kernels.CONTACT_M).mean() if len(base) else 0.0,
        float(np.log1p(touch.sum())),
        (base > 3 * kernels.CONTACT_M).mean() if len(base) else 1.0,
        slope.mean() if touch.any() else 0.0,
        max(slope, default=0.0),
        base.mean() if len(base) else FAR,
        base.std() if len(base) else 0.0,
        max(base.max(), 0.0) if len(base) else FAR,
    ]


def hull(reach: Array, near: Array, lever: float) -> list[float]:
    """Return margins and widths of the hull of the contacts."""
    width = np.maximum(reach[: N // 2] + reach[N // 2 :], 0)
    margins = [reach.min(), near.min()]
    tips = [tipping(margin, lever) for margin in margins]
    return [margins[0], tips[0], margins[1], tips[1], width.min(), width.max()]


def holds(held: list[list], reach: Array, mass: float, lever: float) -> list[float]:
    """Return from how many sides, and how high, an object is held."""
    top = np.array([max(above, default=0.0) for above, _ in held])
    gap = np.array([min(gap, default=kernels.HELD_M) for _, gap in held])
    is_held = top > 0
    is_high = is_held & (top > kernels.HIGH_ENOUGH * mass)
    margin = max(min([FAR, *reach[~is_high]]), -FAR)
    opposed = is_held & np.roll(is_held, N // 2)
    return [
        is_held.mean(),
        is_high.mean(),
        opposed.mean(),
        gap.mean(),
        margin,
        tipping(margin, lever),
    ]


N_FEATURES = len(kernels.PLACED_FEATURES) + len(SHAPE_FEATURES)
