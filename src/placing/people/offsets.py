"""Where labelled objects are in the frames of the valid poses, and their potentials.

Learning asks for the potential of the same objects and poses round after round while
only Theta changes. All headings and kinds at one spot share the distance and the
direction to an object, which are found once; a round then costs two products, two
sums and one exponential per object and pose.

Shapes: n objects, q valid poses, g spots.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from placing.people.dpmm import MIN_WEIGHT
from placing.people.potential import MIN_DISTANCE_M, Theta, log_constants

Array = NDArray[np.float64]
Floats = NDArray[np.float32]

HALVINGS = 6
"""`_exp` halves its argument so often, and squares its result as often."""
# The argument is then within 0.22 of the middle of its range, where five terms of the
# series about the middle leave an error of 1e-8, and 1e-6 after the squares.
_MIDDLE = np.log(MIN_WEIGHT) / 2**HALVINGS / 2
_SERIES = tuple(np.float32(np.exp(_MIDDLE) / f) for f in (1, 1, 2, 6, 24, 120))


class Spots(NamedTuple):
    """The reference points of the valid poses of a scene, without repetition."""

    location: Array
    """(g, 3) reference points."""
    of_pose: NDArray[np.uint32]
    """(q,) spot of each pose."""
    look: Floats
    """(2, q) cosine and sine of the yaw of each pose."""


class Offsets(NamedTuple):
    """Where objects are as seen from the spots, along the axes of the world."""

    log_distance: Floats
    """(n, g) log of the distance on the floor plane [m]."""
    direction: Floats
    """(2, n, g) unit vector from spot to object."""
    height: Floats
    """(n, g) height of the object above the reference point [m]."""
    front: Floats
    """(2, n) cosine and sine of the yaw of each object."""


def find_spots(references: Array) -> Spots:
    """Return the spots of poses `references` (q, 5) of `HumanPoses.references`."""
    order = np.lexsort(references[:, 2::-1].T)
    sorted_points = references[order, :3]
    is_first = np.ones(len(order), np.bool_)
    is_first[1:] = (sorted_points[1:] != sorted_points[:-1]).any(1)
    of_pose = np.empty(len(order), np.uint32)
    of_pose[order] = np.cumsum(is_first) - 1
    look = np.ascontiguousarray(references[:, 3:].T, np.float32)
    return Spots(sorted_points[is_first], of_pose, look)


def find_offsets(objects: Array, spots: Spots) -> Offsets:
    """Return the offsets of `objects` (n, 4) x, y, z, yaw from all spots."""
    away = objects[:, None, :3] - spots.location  # (n, g, 3)
    x, y, height = np.moveaxis(away, 2, 0)
    distance = np.maximum(np.sqrt(x * x + y * y), MIN_DISTANCE_M)
    direction = np.stack([x, y]) / distance
    yaw = objects[:, 3]
    found = np.log(distance), direction, height, np.stack([np.cos(yaw), np.sin(yaw)])
    return Offsets(*(array.astype(np.float32) for array in found))


def parameters_of(thetas: Sequence[Theta]) -> Array:
    """Return what `weight_rows` needs of each Theta, shape (n, 10).

    Its vector, and the log normalisers of Psi_loc and Psi_ori.
    """
    return np.array([[*t.vector(), *log_constants(t)] for t in thetas])


def weight_rows(
    offsets: Offsets, spots: Spots, parameters: Array, has_front: NDArray[np.bool_]
) -> tuple[Floats, Array]:
    """Return Psi_human of objects with their `parameters`, rows scaled to 1, (n, q).

    The second array (n,) is the log of what each row was divided by.
    """
    rows = np.empty((len(parameters), len(spots.of_pose)), np.float32)
    top = np.empty(len(parameters))
    _fill(rows, top, offsets, spots, parameters, has_front)
    return rows, top


@njit(cache=True)
def _fill(rows, top, offsets, spots, parameters, has_front):  # noqa: ANN001, ANN202
    """Fill `rows` (n, q) and `top` (n,); see `weight_rows`."""
    cos, sin = spots.look
    for i in range(len(rows)):
        terms = _terms(offsets, i, parameters[i], has_front[i])
        still, along_x, along_y = terms
        row, highest = rows[i], np.float32(-np.inf)
        for h in range(len(row)):
            g = spots.of_pose[h]
            row[h] = still[g] + cos[h] * along_x[g] + sin[h] * along_y[g]
            highest = max(highest, row[h])
        top[i] = highest
        _exp(row, highest)


@njit(cache=True)
def _terms(offsets, i, parameters, has_front):  # noqa: ANN001, ANN202
    """Return the log potential of an object per spot, (g,) each.

    The part of any heading, and what the cosine and the sine of a heading add: bearing
    and orientation are von Mises, whose logs are linear in both.
    """
    m_d, s_d, m_r, k_r, m_h, s_h, m_o, k_o, base, log_ori = parameters.astype(
        np.float32
    )
    log_d, height = offsets.log_distance[i], offsets.height[i]
    x, y = offsets.direction[0, i], offsets.direction[1, i]
    still, along_x, along_y = np.empty_like(x), np.empty_like(x), np.empty_like(x)
    ahead, left = k_r * np.cos(m_r), k_r * np.sin(m_r)
    faced_x, faced_y = np.float32(0), np.float32(0)
    if has_front:
        front_x, front_y = offsets.front[0, i], offsets.front[1, i]
        faced_x = k_o * (front_x * np.cos(m_o) + front_y * np.sin(m_o))
        faced_y = k_o * (front_y * np.cos(m_o) - front_x * np.sin(m_o))
        base += log_ori
    half, two = np.float32(0.5), np.float32(2)
    for g in range(len(x)):
        u, v = (log_d[g] - m_d) / s_d, (height[g] - m_h) / s_h
        # The planar density f(d) / d g(r) of a log-normal f has 1 / d twice.
        still[g] = base - two * log_d[g] - half * (u * u + v * v)
        along_x[g] = ahead * x[g] + left * y[g] + faced_x
        along_y[g] = ahead * y[g] - left * x[g] + faced_y
    return still, along_x, along_y


@njit(cache=True)
def _exp(row, highest):  # noqa: ANN001, ANN202
    """Replace a row (q,) by exp(row - highest), at least `MIN_WEIGHT`.

    Sums and products alone, which vectorise and are the same on every machine.
    """
    floor, middle = np.float32(np.log(MIN_WEIGHT)), np.float32(_MIDDLE)
    shrink = np.float32(0.5**HALVINGS)
    a, b, c, d, e, f = _SERIES
    for h in range(len(row)):
        x = row[h] - highest
        x = (x if x > floor else floor) * shrink - middle
        y = a + x * (b + x * (c + x * (d + x * (e + x * f))))
        for _ in range(HALVINGS):
            y *= y
        row[h] = y


def sufficient_statistics(
    offsets: Offsets,
    spots: Spots,
    has_front: NDArray[np.bool_],
    pose: NDArray[np.integer],
) -> Array:
    """Return what the fit needs to know of objects and their sampled poses, (n, 10).

    `pose` (s, n) is the pose that each object picked in each sample; the columns are
    `fitting.STATISTICS`, means over the samples.
    """
    found = np.zeros((pose.shape[1], 10))
    _add_up(found, offsets, spots, has_front, pose)
    return found / len(pose)


@njit(cache=True)
def _add_up(found, offsets, spots, has_front, pose):  # noqa: ANN001, ANN202
    """Add the statistics of every sample to `found` (n, 10)."""
    for s in range(pose.shape[0]):
        for i in range(pose.shape[1]):
            g = spots.of_pose[pose[s, i]]
            cos, sin = spots.look[0, pose[s, i]], spots.look[1, pose[s, i]]
            log_d = np.float64(offsets.log_distance[i, g])
            height = np.float64(offsets.height[i, g])
            x, y = offsets.direction[0, i, g], offsets.direction[1, i, g]
            to = found[i]
            to[0] += 1
            to[1] += log_d
            to[2] += log_d**2
            to[3] += cos * x + sin * y
            to[4] += cos * y - sin * x
            to[5] += height
            to[6] += height**2
            if has_front[i]:
                x, y = offsets.front[0, i], offsets.front[1, i]
                to[7] += 1
                to[8] += cos * x + sin * y
                to[9] += cos * y - sin * x
