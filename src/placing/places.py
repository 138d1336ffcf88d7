"""Find the placement candidates of a scene: places on every placing area.

Shapes: p places.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from shapely import distance, points

from placing.areas.columns import free_heights, sort_columns
from placing.areas.finder import PIN_RADIUS_M
from placing.areas.outlines import heal
from placing.candidates import OPEN_M, Candidates, CandidatesConfig
from placing.clouds.ply import Cloud
from placing.people.valid_poses import lattice
from placing.scene import PlacingArea

Array = NDArray[np.float64]


def find_candidates(
    cloud: Cloud, areas: tuple[PlacingArea, ...], config: CandidatesConfig
) -> Candidates:
    """Return the places on all placing areas of a scene."""
    wall_distance = _wall_distance(cloud.points, config.wall_cell_m)
    blocks: list[Array] = [np.empty((0, 4))]
    edges: list[Array] = [np.empty(0)]
    for number, area in enumerate(areas):
        xy = lattice(area.polygon_m, config.spacing_m)  # (p, 2)
        rest = np.tile([area.height_m, number], (len(xy), 1))
        blocks.append(np.column_stack([xy, rest]))
        edge = distance(heal(area.polygon_m).boundary, points(xy))
        edges.append(np.asarray(edge))
    table = np.concatenate(blocks)  # (p, 4)
    xy, height = table[:, :2], table[:, 2]
    columns = sort_columns(cloud, 2 * PIN_RADIUS_M)
    clearance = np.minimum(free_heights(columns, xy, height, PIN_RADIUS_M), OPEN_M)
    features = [height, clearance, np.concatenate(edges), wall_distance(xy)]
    area = table[:, 3].astype(np.int32)
    return Candidates(table[:, :3], area, np.column_stack(features))


def _wall_distance(
    cloud_points: NDArray[np.floating], cell_m: float
) -> Callable[[Array], Array]:
    """Return a function from places (p, 2) to their distance to the walls (p,).

    What the cloud covers, seen from above and with its holes filled, is the inside.
    """
    origin = cloud_points[:, :2].min(0) - cell_m
    cells = ((cloud_points[:, :2] - origin) / cell_m).astype(np.int64)
    covered = np.zeros(cells.max(0) + 3, np.bool_)
    covered[tuple(cells.T)] = True
    inside = ndimage.binary_fill_holes(ndimage.binary_closing(covered, iterations=2))
    to_wall = ndimage.distance_transform_edt(inside) * cell_m

    def distance_of(xy: Array) -> Array:
        return to_wall[tuple(((xy - origin) / cell_m).astype(np.int64).T)]

    return distance_of
