"""How far apart and how noisy the points of a scan are, as settings depend on it.

A laser on a tripod sees the floor far away in rings, a depth camera sees a level desk
as a layer of noise: what suits points that are drawn evenly does not find these.

Letters for shapes: n points, q queries.
"""

import numpy as np
from scipy.spatial import cKDTree

from placing.clouds.ply import Cloud

N_NEIGHBORS, N_QUERIES = 8, 5000
# ASSUME: four in five points have neighbours as near as the spacing says.
QUANTILE = 0.8
LAYER_M, FACES_UP = 0.05, 0.9


def spacing_m(cloud: Cloud) -> float:
    """Return the width of the square of surface that most points stand for [m].

    The cloud must be thinned, since a scanner may hit one spot a thousand times.
    """
    step = max(1, len(cloud) // N_QUERIES)
    k = min(N_NEIGHBORS, len(cloud) - 1)
    if k < 1:
        return 0.0
    distance = cKDTree(cloud.points).query(cloud.points[::step], [k + 1])[0][:, 0]
    # The disc around a point up to its k-th neighbour holds k + 1/2 squares.
    return float(np.quantile(distance, QUANTILE) * np.sqrt(np.pi / (k + 0.5)))


def floor_noise_m(cloud: Cloud) -> float:
    """Return the spread of the heights of the floor of a level cloud [m].

    It is the standard deviation of a normal distribution with the same quartiles.
    """
    z = cloud.points[:, 2]
    heights = z[(np.abs(z) < LAYER_M) & (cloud.normals[:, 2] > FACES_UP)]
    if len(heights) == 0:
        return 0.0
    return float(np.subtract(*np.quantile(heights, [0.75, 0.25])) / 1.349)
