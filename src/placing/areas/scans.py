"""The placing areas of a user's scan, with settings that suit how it was taken.

Settings of the study are for points drawn evenly. Where a scan is sparser or noisier,
cells and levels are as much larger, so that the same steps find its areas.
"""

from dataclasses import dataclass, replace

from placing.areas.finder import AreaConfig, find_areas
from placing.clouds.cloud import CloudConfig, crop, preprocess, thin
from placing.clouds.ply import Cloud
from placing.clouds.spacing import floor_noise_m, spacing_m
from placing.scene import PlacingArea

# ASSUME: even points, thinned, have a spacing of 1.13 voxels; somewhat more is even.
EVEN = 1.2
# ASSUME: 95 % of the points of a level are within two standard deviations of it.
LEVEL_SIGMAS = 2.0
MOST_CELLS, MOST_LEVELS = 8.0, 2.0
"""Cells and levels grow by no more: cells of a quarter of a metre find nothing, and in
levels thicker than a book it is lost."""


@dataclass(frozen=True)
class ScanAreas:
    """What was found in a scan, and with which settings."""

    cloud: Cloud
    """Cleaned and level, floor at z = 0."""
    areas: tuple[PlacingArea, ...]
    area_config: AreaConfig
    spacing_m: float
    """Width of the square of surface that most points stand for."""


def find_in_scan(raw: Cloud, cloud: CloudConfig, areas: AreaConfig) -> ScanAreas:
    """Return the placing areas of a scan; settings grow with its spacing and noise."""
    raw = crop(raw, cloud)
    spacing = spacing_m(thin(raw, cloud.voxel_m)) if len(raw) else 0.0
    cloud, areas = suit_spacing(cloud, areas, spacing)
    clean = preprocess(raw, cloud)
    noise = floor_noise_m(clean)
    thickness = min(LEVEL_SIGMAS * noise, MOST_LEVELS * areas.merge_m)
    areas = replace(areas, merge_m=max(areas.merge_m, thickness))
    return ScanAreas(clean, find_areas(clean, areas), areas, spacing)


def suit_spacing(
    cloud: CloudConfig, areas: AreaConfig, spacing_m: float
) -> tuple[CloudConfig, AreaConfig]:
    """Return the settings with cells that are as large as the spacing asks for."""
    growth = min(MOST_CELLS, max(1.0, spacing_m / (EVEN * cloud.voxel_m)))
    cell_m = growth * areas.cell_m
    return (
        replace(cloud, outlier_cell_m=growth * cloud.outlier_cell_m),
        replace(areas, cell_m=cell_m, min_width_m=max(areas.min_width_m, 2 * cell_m)),
    )
