"""Straight edges for the ring of an outline that was drawn along cells.

Most furniture has edges in two directions: a ring that has too gets exact ones, each
moved to the outermost points. A ring that has not, such as that of a round table, is
only simplified. A ring has its material on the left and the outside on the right.

Letters for shapes: v corners, n points.
"""

from itertools import pairwise
from math import dist, hypot
from typing import NamedTuple

import numpy as np
import shapely
from numba import njit
from numpy.typing import NDArray
from shapely import Polygon

Array = NDArray[np.float64]


class Edge(NamedTuple):
    """A straight edge of a ring."""

    start: Array
    """(2,) where it begins [m]."""
    end: Array
    """(2,) where it ends [m]."""
    along: Array
    """(2,) unit vector of the line, near that from start to end."""

    @property
    def outward(self) -> Array:
        """Return the unit vector to the right, shape (2,)."""
        return np.array([self.along[1], -self.along[0]])

    @property
    def length(self) -> float:
        """Return the distance from start to end [m]."""
        return dist(self.start, self.end)


def fit_ring(ring: Array, rim_m: Array, cell_m: float) -> Array:
    """Return the corners of a closed ring (v + 1, 2) with straight edges, (w, 2)."""
    # Simplifying keeps the first corner: the farthest one is surely a true corner.
    distance = np.hypot(*(ring[:-1] - ring[:-1].mean(axis=0)).T)
    outline = Polygon(np.roll(ring[:-1], -int(distance.argmax()), axis=0))
    plain = shapely.get_coordinates(outline.simplify(cell_m / 2))[:-1]
    rough = shapely.get_coordinates(outline.simplify(1.5 * cell_m))
    edges = [Edge(a, b, _unit(b - a)) for a, b in pairwise(rough)]
    direction = _main_direction(edges, rim_m, cell_m)
    if direction is None:
        return plain
    edges = _merge(_snap(edges, direction, cell_m))
    if len(edges) < 3:
        return plain
    corners = _intersect(edges, np.array([_shift(e, rim_m, cell_m) for e in edges]))
    fitted = Polygon(corners)
    if not fitted.is_valid:
        return plain
    # The fit moves edges by less than a cell: more means that it is no polygon.
    change = fitted.symmetric_difference(outline).area
    return corners if change < 0.75 * cell_m * outline.length else plain


def _unit(vector: Array) -> Array:
    """Return the vector with length 1."""
    return vector / max(hypot(*vector), 1e-12)


def _main_direction(edges: list[Edge], rim_m: Array, cell_m: float) -> float | None:
    """Return the angle that most edges have up to right angles, if any [rad]."""
    long = [edge for edge in edges if edge.length > 4 * cell_m]
    if not long:
        return None
    # Four times the angle is the same for edges at right angles.
    turns = np.exp(4j * np.array([_heading(edge, rim_m, cell_m) for edge in long]))
    lengths = np.array([edge.length for edge in long])
    mean = np.average(turns, weights=lengths)
    agrees = np.abs(np.angle(turns * np.conj(mean))) < 4 * np.radians(10)
    if lengths[agrees].sum() < 0.6 * sum(edge.length for edge in edges):
        return None
    return float(np.angle(np.average(turns[agrees], weights=lengths[agrees])) / 4)


def _heading(edge: Edge, rim_m: Array, cell_m: float) -> float:
    """Return the direction of a line through the outermost points [rad]."""
    heading = float(np.arctan2(edge.along[1], edge.along[0]))
    slope = _slope(edge.start, edge.along, edge.length, rim_m, cell_m)
    # The distance grows to the right, so positive slopes turn the edge clockwise.
    return heading - float(np.arctan(slope))


def _snap(edges: list[Edge], direction: float, cell_m: float) -> list[Edge]:
    """Return the edges turned to the main directions, without short slanted ones."""
    snapped = []
    for edge in edges:
        heading = np.arctan2(edge.along[1], edge.along[0])
        quarter = np.round((heading - direction) / (np.pi / 2))
        axis = direction + quarter * np.pi / 2
        if abs(heading - axis) < np.radians(20):
            along = np.array([np.cos(axis), np.sin(axis)])
            snapped.append(Edge(edge.start, edge.end, along))
        elif edge.length > 4 * cell_m:
            snapped.append(edge)
    return snapped


def _merge(edges: list[Edge]) -> list[Edge]:
    """Return the edges with neighbours of one direction joined to one edge."""
    merged: list[Edge] = []
    for edge in edges:
        if merged and merged[-1].along @ edge.along > 0.99:
            merged[-1] = Edge(merged[-1].start, edge.end, merged[-1].along)
        else:
            merged.append(edge)
    if len(merged) > 1 and merged[-1].along @ merged[0].along > 0.99:
        last = merged.pop()
        merged[0] = Edge(last.start, merged[0].end, merged[0].along)
    return merged


def _shift(edge: Edge, rim_m: Array, cell_m: float) -> float:
    """Return how far an edge, through its middle, moves outward to the points [m]."""
    length = edge.length
    start = (edge.start + edge.end - edge.along * length) / 2
    return _distance(start, edge.along, length, rim_m, cell_m)


def _intersect(edges: list[Edge], shifts: Array) -> Array:
    """Return the corners between the shifted lines of successive edges, (w, 2)."""
    outward = np.array([e.outward for e in edges])  # (w, 2)
    middle = np.array([(e.start + e.end) / 2 for e in edges])
    offset = np.sum(outward * middle, axis=1) + shifts  # outward . x = offset
    before = np.roll(outward, 1, axis=0)
    turn = np.abs(before[:, 0] * outward[:, 1] - before[:, 1] * outward[:, 0])
    sides = np.stack([np.roll(offset, 1), offset], axis=1)
    corners = np.array([e.start for e in edges])
    # Lines that are nearly parallel have no stable intersection.
    is_corner = turn > 0.2
    pairs = np.stack([before, outward], axis=1)[is_corner]  # (., 2, 2)
    corners[is_corner] = np.linalg.solve(pairs, sides[is_corner, :, None])[:, :, 0]
    return corners


@njit(cache=True)
def _outermost(
    start: Array, along: Array, length: float, rim_m: Array, cell_m: float
) -> tuple[Array, Array]:
    """Return position along and distance outward of points at an edge, each (n,).

    Of the points within one and a half cells these are the outermost of each stretch
    as long as a cell.
    """
    n_stretches = int(length / cell_m) + 1
    position, distance = np.zeros(n_stretches), np.full(n_stretches, -np.inf)
    for p in range(len(rim_m)):
        x, y = rim_m[p, 0] - start[0], rim_m[p, 1] - start[1]
        s, d = x * along[0] + y * along[1], x * along[1] - y * along[0]
        if 0 < s < length and abs(d) < 1.5 * cell_m:
            stretch = int(s / cell_m)
            if d > distance[stretch]:
                position[stretch], distance[stretch] = s, d
    is_met = distance > -np.inf
    return position[is_met], distance[is_met]


@njit(cache=True)
def _slope(
    start: Array, along: Array, length: float, rim_m: Array, cell_m: float
) -> float:
    """Return how fast the outermost points leave an edge to its right."""
    s, d = _outermost(start, along, length, rim_m, cell_m)
    if len(s) < 5:
        return 0.0
    s, d = s - s.mean(), d - d.mean()
    return np.sum(s * d) / np.sum(s * s)


@njit(cache=True)
def _distance(
    start: Array, along: Array, length: float, rim_m: Array, cell_m: float
) -> float:
    """Return how far the material reaches beyond an edge on its right [m]."""
    d = _outermost(start, along, length, rim_m, cell_m)[1]
    # A point is the mean of its voxel: the edge is a third of a cell further out.
    return np.median(d) + cell_m / 3 if len(d) > 2 else 0.0
