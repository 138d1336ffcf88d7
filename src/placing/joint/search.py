"""The search for the best joint placement: cuts, prices and branch and bound.

Shapes: n objects, c columns, s of them standing on areas, r rows.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.optimize import Bounds, LinearConstraint, milp

from placing.joint.assignment_config import AssignmentConfig
from placing.joint.cliques import violated_cliques
from placing.joint.exchanges import exchange
from placing.joint.incumbent import as_choice, build
from placing.joint.joint_columns import (
    Columns,
    conflicts,
    fixed_rows,
    point_rows,
    standing_boxes,
)
from placing.joint.options import Options
from placing.joint.relaxation import Relaxed, essential, once_rows, price, relax
from placing.joint.stack_cuts import Cut, stack_cuts
from placing.joint.stacking import stacked_boxes
from placing.overlap import grown, overlaps

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

SAME = 1e-6
"""Sums of log scores that differ by less are equal: the tolerance of HiGHS."""


MIN_GAIN = 0.02
"""Share of the gap by which a round of cuts lowers the bound, or it was the last."""


class Search:
    """The best arrangement so far, a bound, and the columns that may be in a better."""

    def __init__(
        self,
        objects: Sequence[Options],
        columns: Columns,
        limits: AssignmentConfig,
    ) -> None:
        """Begin with a greedy arrangement."""
        self._objects, self._columns = objects, columns
        self._limits = limits
        self._boxes = standing_boxes(objects, columns, limits.margin_m)
        self._conflict = conflicts(columns, self._boxes)
        # Scores are counted from the best of each object, which sums up to no loss.
        self._best = np.full(len(objects), -np.inf)
        np.maximum.at(self._best, columns.owner, columns.value)
        self._value = columns.value - self._best[columns.owner]  # (c,)
        self._rows, self._free = fixed_rows(columns, objects)
        self._cliques: set[bytes] = set()
        # No arrangement with a column is better than this.
        self._reach = np.full(len(columns.owner), np.inf)
        self._loss = -np.inf  # of the best arrangement, 0 or less
        self._limit = 0.0  # bound of the same
        self.n_nodes = self.n_solved = 0
        self.picked = np.empty(0, np.int64)
        self._try(self._value)

    @property
    def bound(self) -> float:
        """A sum of log scores that no arrangement exceeds."""
        return self._limit + float(self._best.sum())

    @property
    def _is_done(self) -> bool:
        most = self._limits.mip_rel_gap * abs(self._loss)
        return self._limit <= self._loss + max(most, SAME)

    def run(self) -> None:
        """Search until the best arrangement is known or a limit is reached."""
        self._price()
        for _ in range(self._limits.n_cut_rounds):
            before = self._limit
            if self._is_done or not self._cut_relaxed():
                break
            if before - self._limit < MIN_GAIN * (self._limit - self._loss):
                break
        self._branch_in_cores()

    def _branch_in_cores(self) -> None:
        """Solve the integer program in ever larger parts of the columns.

        What is left out is of no use if the best of a part is better than its reach.
        """
        size = self._limits.n_core
        for _ in range(self._limits.n_rounds):
            if self._is_done:
                break
            core, reach = self._core(size)
            if not self._branch(core, reach):
                if reach == -np.inf or size == self._limits.max_core:
                    break
                size = min(2 * size, self._limits.max_core)

    def _alive(self) -> Ints:
        """Return the columns that may be in an arrangement better than the best."""
        return np.flatnonzero(self._reach >= self._loss - SAME)

    def _core(self, size: int) -> tuple[Ints, float]:
        """Return the columns of largest reach, and the reach of the others alive."""
        alive = self._alive()
        alive = alive[np.argsort(-self._reach[alive], kind="stable")]
        reach = float(self._reach[alive[size]]) if len(alive) > size else -np.inf
        return np.union1d(alive[:size], self.picked), reach

    def _price(self) -> None:
        """Price the points that boxes cover; keep the rows that have a price."""
        points = point_rows(self._columns, self._boxes, self._limits.point_spacing_m)
        rows = sparse.vstack([self._rows, points], format="csr")
        free = np.append(self._free, np.ones(points.shape[0]))
        owner = self._columns.owner
        relaxed = price(self._value, owner, rows, free, self._limits.n_price_steps)
        n_fixed = len(self._free)
        self._learn(np.arange(len(owner)), relaxed)
        dear = np.r_[np.arange(n_fixed), np.flatnonzero(relaxed.prices > 0)]
        dear = np.unique(dear)
        self._rows, self._free = rows[dear], free[dear]

    def _learn(self, at: Ints, relaxed: Relaxed) -> None:
        """Take what a relaxation of the columns `at` shows and proves."""
        self._limit = min(self._limit, relaxed.bound)
        self._guess(at, relaxed)
        self._reach[at] = np.minimum(self._reach[at], relaxed.bound - relaxed.loss)

    def _cut_relaxed(self) -> bool:
        """Solve the relaxation and add cuts; return whether there were any."""
        at = self._alive()
        owner = self._columns.owner[at]
        relaxed = relax(self._value[at], owner, self._rows[:, at], self._free)
        self.n_solved += 1
        if relaxed is None:
            return False
        self._learn(at, relaxed)
        chosen = np.zeros(len(self._value))
        chosen[at] = relaxed.chosen
        return self._add_cliques(chosen)

    def _guess(self, at: Ints, relaxed: Relaxed) -> None:
        """Round a solution of the relaxation to arrangements."""
        for weight in (0.0, 10.0):
            priority = np.full(len(self._value), -np.inf)
            priority[at] = weight * relaxed.chosen - relaxed.loss
            self._try(priority)

    def _try(self, priority: Array) -> None:
        """Build an arrangement and keep it if it is the best one."""
        self._keep(
            build(
                self._objects,
                self._columns,
                self._conflict,
                priority,
                self._limits.margin_m,
            )
        )

    def _keep(self, picked: Ints) -> None:
        """Keep an arrangement without overlap, after exchanges, if it is the best."""
        picked = self._exchanged(picked)
        loss = float(self._value[picked].sum())
        if loss > self._loss:
            self._loss, self.picked = loss, picked

    def _exchanged(self, picked: Ints) -> Ints:
        """Return the arrangement after exchanges among objects in no stack, (n,)."""
        columns, s, n = self._columns, self._columns.n_standing, len(picked)
        lower = columns.lower[picked]
        is_stacked = (lower >= 0) | np.isin(np.arange(n), lower)
        standing = np.where(columns.level[picked] == 0, picked, -1)
        standing[is_stacked] = -2
        is_free = np.ones(s, np.bool_)
        if is_stacked.any():
            boxes = stacked_boxes(self._objects, *as_choice(columns, picked))
            wide = grown(boxes[is_stacked], self._limits.margin_m)
            is_free = ~overlaps(self._boxes, wide).any(1)
            # One place has one stack, whatever its boxes.
            is_free &= ~np.isin(columns.place[:s], columns.place[picked[is_stacked]])
        value, nowhere = self._value[:s], self._value[-n:]
        moved = exchange(
            value, columns.owner[:s], self._conflict, is_free, standing, nowhere
        )
        c = len(columns.owner)
        there = np.where(moved >= 0, moved, np.arange(c - n, c))
        return np.where(is_stacked, picked, there)

    def _branch(self, at: Ints, reach: float) -> bool:
        """Solve the integer program of some columns; return whether rows were added.

        No arrangement with any other column is better than `reach`.
        """
        limits = self._limits
        once = once_rows(self._columns.owner[at])
        n, rows = once.shape[0], self._rows[:, at]
        kept = essential(rows, self._free)
        found = milp(
            -self._value[at],
            integrality=np.ones(len(at)),
            bounds=Bounds(0, 1),
            constraints=[
                LinearConstraint(once, np.ones(n), np.ones(n)),
                LinearConstraint(rows[kept], -np.inf, self._free[kept]),
            ],
            options={
                "node_limit": limits.node_limit,
                "mip_rel_gap": limits.mip_rel_gap,
            },
        )
        self.n_solved += 1
        self.n_nodes += int(found.mip_node_count or 0)
        if found.mip_dual_bound is not None:
            limit = max(-float(found.mip_dual_bound), reach)
            self._limit = min(self._limit, limit)
        if found.x is None:
            return False
        chosen = np.zeros(len(self._value))
        chosen[at] = np.round(found.x)
        return self._add_violated(chosen)

    def _add_violated(self, chosen: Array) -> bool:
        """Add rows that a whole solution violates; keep it if there are none."""
        picked = np.flatnonzero(chosen)
        picked = picked[np.argsort(self._columns.owner[picked])]
        cuts = stack_cuts(self._objects, self._columns, picked, self._limits.margin_m)
        self._add_rows(cuts)
        if self._add_cliques(chosen) or cuts:
            self._try(self._value + 1000 * chosen)
            return True
        self._keep(picked)
        return False

    def _add_cliques(self, chosen: Array) -> bool:
        """Add the cliques that a solution violates; return whether there were any."""
        s = self._columns.n_standing
        found = violated_cliques(self._conflict, chosen[:s], self._value[:s])
        self._add_rows([(clique, 1) for clique in found])
        return len(found) > 0

    def _add_rows(self, cuts: Sequence[Cut]) -> None:
        """Add rows of ones, each with its own right-hand side."""
        if not cuts:
            return
        row = np.repeat(np.arange(len(cuts)), [len(at) for at, _ in cuts])
        at = (row, np.concatenate([at for at, _ in cuts]))
        shape = (len(cuts), len(self._value))
        rows = sparse.coo_array((np.ones(len(row)), at), shape=shape)
        self._rows = sparse.vstack([self._rows, rows], format="csr")
        self._free = np.append(self._free, [float(most) for _, most in cuts])
