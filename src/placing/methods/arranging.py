"""Where an object goes, given how likely its user is at each human pose.

With the placements of wanted objects summed out, the row of a wanted object is
Z(h) = sum over places of Psi_loc(place, h), and the density of its placement is read
off the sampled poses afterwards (Rao-Blackwell):

    p(place) = sum_h w(h) Psi_loc(place, h) / Z(h)

with w(h) the probability that the object's user has pose h.

Shapes: p places, q valid poses, r chains, b bins.
"""

from functools import cached_property

import numpy as np
from numba import njit
from numpy.typing import NDArray

from placing.people.correlation import (
    cumulative_table,
    kernel_transform,
    separate,
    spread,
    spread_runs,
    sum_blocks,
)
from placing.people.lattice import Lattice
from placing.people.potential import Theta, height_factor, log_psi_ori, planar_table

Array = NDArray[np.float64]

TINY = 1e-300
"""Guards divisions by the Z of a pose, or the sum of a density, that is zero."""
MANY_SITES = 1000
"""Beyond so many sites with a pose, transforms are faster than adding them up."""
ROUNDING = 1e-10
"""A pose with so small a Z, relative to the largest, has no use of the object: below,
cumulative sums are off by more than 1e-4 of Z."""
ERROR = 1e-10
"""What a sum of weight over Z times Psi_loc may be off; the sums over all poses add up
to the number of places per place of the coarse lattice."""


class UseOfObject:
    """Psi_loc of one category between the places and the human poses of a scene."""

    def __init__(self, theta: Theta, lattice: Lattice, half_height_m: float) -> None:
        """Compute the height factor; `half_height_m` lifts the object's centre."""
        self.theta, self.lattice, self.half_height_m = theta, lattice, half_height_m
        self._height = height_factor(
            theta, lattice.levels + half_height_m, lattice.references
        )  # (levels, references)

    def row(self) -> Array:
        """Return Z of every pose up to a common factor, shape (q,), 0 without places.

        It adds up the places of the coarse lattice.
        """
        return self._row

    @cached_property
    def _row(self) -> Array:
        """Return what `row` keeps."""
        lattice = self.lattice
        blocks, n_levels = lattice.level_blocks, len(lattice.levels)
        planar = sum_blocks(self._sums(), lattice.sites, blocks, n_levels)
        row = _weigh(planar, self._height, lattice.site, lattice.reference)
        # What is smaller is the rounding of the cumulative sums.
        return np.where(row > ROUNDING * row.max(initial=0.0), row, 0.0)

    def new_person(self) -> Array:
        """Return where a user that no other object shares is, shape (q,), sum 1."""
        share = self.lattice.poses.prior * self.row()
        return share / max(share.sum(), TINY)

    def density(self, weight: Array, p_new: float = 0.0) -> Array:
        """Return the density of the object over the places, shape (p,), sum 1.

        `weight` (q,) probability that its user has each pose; the user is with `p_new`
        one that no other object shares, beyond that.
        """
        density = self._spread(weight)
        if p_new > 0:
            density = density + p_new * self._new_spread
        return density / max(density.sum(), TINY)

    def histograms(self, weights: Array, p_new: Array | None = None) -> Array:
        """Return the placements per bin and level for each chain, (r, b), rows sum 1.

        `weights` (r, q) and `p_new` (r,) as in `density`; places of the coarse lattice
        are counted.
        """
        histogram = self._counts(weights)
        if p_new is not None:
            histogram = histogram + p_new[:, None] * self._new_counts
        return histogram / np.maximum(histogram.sum(1, keepdims=True), TINY)

    def _spread(self, weight: Array) -> Array:
        """Return the density (p,) before it is normalised."""
        lattice, value = self.lattice, self.per_place(weight)
        used, gain = self._gain(value[None])
        if len(used) <= MANY_SITES:
            sites, n_places = lattice.sites[used], len(lattice.fine)
            args = gain[:, :, 0], lattice.runs, lattice.stride, n_places
            return spread_runs(self._table(), sites, *args)
        largest = float(self._table().max()) * self._height.max(initial=0.0)
        loudest = value.max(initial=0.0) * largest
        factors = separate(self._height, ERROR / max(loudest, ERROR))
        radius_m, n_headings = lattice.config.radius_m, lattice.n_headings
        key = lattice.spacing_m, lattice.stride, radius_m, n_headings
        kernel = kernel_transform(self.theta, *key, lattice.size)
        found = spread(lattice, kernel, factors, value)
        return np.maximum(found, 0)  # a transform rounds to either side of zero

    def _counts(self, weights: Array) -> Array:
        """Return the histograms (r, b) before they are normalised."""
        first = self.lattice.first_bin
        used, gain = self._gain(self.per_place(weights))
        sites = self.lattice.sites[used]
        planar = sum_blocks(self._sums(), sites, self.lattice.bin_blocks, first[-1])
        return _count(planar, gain, first)

    def _gain(self, value: Array) -> tuple[NDArray[np.intp], Array]:
        """Return the sites of poses with a value, (u,), and what they give, (u, l, r).

        `value` (r, q) is what a pose gives to each level, up to the height factor.
        """
        lattice = self.lattice
        poses = np.flatnonzero(value.any(0))
        used, site = np.unique(lattice.site[poses], return_inverse=True)
        gain = np.zeros((len(used), len(lattice.levels), len(value)))
        values = np.ascontiguousarray(value[:, poses])
        _add_gain(gain, values, self._height, site, lattice.reference[poses])
        return used, gain

    @cached_property
    def _new_spread(self) -> Array:
        """Return the density (p,) of a user of its own before it is normalised."""
        return self._spread(self.new_person())

    @cached_property
    def _new_counts(self) -> Array:
        """Return the histogram (b,) of a user of its own before it is normalised."""
        return self._counts(self.new_person()[None])[0]

    def heading_probability(self, place: int, weight: Array, yaws: Array) -> Array:
        """Return the probability of each of `yaws` at a place, (len(yaws),), sum 1."""
        lattice = self.lattice
        share = self.shares(place, weight)
        near = np.bincount(
            lattice.sites[lattice.site, 0], share, minlength=lattice.n_headings
        )
        look = np.linspace(0, 2 * np.pi, lattice.n_headings, endpoint=False)
        psi_ori = np.exp(log_psi_ori(self.theta, yaws[:, None], look))
        found = (psi_ori * near).sum(1)
        total = found.sum()
        return found / total if total > 0 else np.full(len(yaws), 1 / len(yaws))

    def shares(self, place: int, weight: Array) -> Array:
        """Return what each pose adds to the density at a place, unnormalised, (q,)."""
        lattice, table = self.lattice, self._table()
        width = table.shape[1]
        heading, *cells = lattice.sites.T
        x, y = lattice.fine[place][:, None] - np.stack(cells) * lattice.stride
        x, y = x + width // 2, y + width // 2
        is_near = (x >= 0) & (x < width) & (y >= 0) & (y < width)
        planar = np.where(is_near, table[heading, x % width, y % width], 0.0)
        height = self._height[lattice.level[place], lattice.reference]
        return planar[lattice.site] * height * self.per_place(weight)

    def per_place(self, weight: Array) -> Array:
        """Return weight over Z, 0 for a pose that has no use, shape of `weight`."""
        row = self.row()
        return np.where(row > 0, weight / np.maximum(row, TINY), 0.0)

    def _table(self) -> NDArray[np.float32]:
        """Return the planar part of Psi_loc on the fine lattice."""
        lattice = self.lattice
        key = lattice.spacing_m, lattice.config.radius_m, lattice.n_headings
        return planar_table(self.theta, *key)

    def _sums(self) -> Array:
        """Return the cumulative planar part of Psi_loc on the coarse lattice."""
        config, n_headings = self.lattice.config, self.lattice.n_headings
        key = config.row_spacing_m, config.radius_m, n_headings
        return cumulative_table(self.theta, *key)


@njit(cache=True)
def _weigh(planar, height, site, reference):  # noqa: ANN001, ANN202
    """Return the sum over levels of planar (u, l) times height, shape (q,)."""
    row = np.zeros(len(site))
    for h in range(len(site)):
        for level in range(len(height)):
            row[h] += planar[site[h], level] * height[level, reference[h]]
    return row


@njit(cache=True)
def _add_gain(gain, value, height, site, reference):  # noqa: ANN001, ANN202
    """Add to `gain` (u, l, r) what the poses of each site give to each level."""
    for r in range(len(value)):
        for h in range(len(site)):
            if value[r, h] > 0:
                for level in range(len(height)):
                    factor = height[level, reference[h]]
                    gain[site[h], level, r] += value[r, h] * factor


@njit(cache=True)
def _count(planar, gain, first_bin):  # noqa: ANN001, ANN202
    """Return the sum over sites of planar (u, b) times gain (u, l, r), shape (r, b)."""
    counts = np.zeros((gain.shape[2], planar.shape[1]))
    for s in range(len(planar)):
        for level in range(len(first_bin) - 1):
            of_level = slice(first_bin[level], first_bin[level + 1])
            source = planar[s, of_level]
            for r in range(len(counts)):
                target, factor = counts[r, of_level], gain[s, level, r]
                for b in range(len(source)):
                    target[b] += factor * source[b]
    return counts
