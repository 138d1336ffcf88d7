"""Find the placing areas in a user's own point cloud, list them and draw them."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from command import run
from placing.areas.finder import AreaConfig
from placing.areas.outlines import heal
from placing.areas.scans import ScanAreas, find_in_scan
from placing.clouds.cloud import CloudConfig
from placing.clouds.ply import read_ply
from placing.errors import BadInput
from placing.pictures.areas import draw_areas
from placing.rooms.file import read_yaml
from placing.scene import PlacingArea
from placing.schema import check
from placing.tables.figures import save_figure

ROOT = Path(__file__).parents[2]
ENDINGS = (".png", ".svg")


def main(
    cloud: Path,
    picture: Path,
    up: tuple[float, float, float] | None = None,
    crop_m: tuple[tuple[float, float, float], tuple[float, float, float]] | None = None,
    voxel_m: float | None = None,
    merge_m: float | None = None,
    min_width_m: float | None = None,
    config: Path = ROOT / "config" / "config.yaml",
    schema: Path = ROOT / "workflow" / "schemas" / "config.schema.yaml",
) -> None:
    """Find the placing areas in a point cloud, print one line for each, draw them.

    The cloud is thinned, cleaned, levelled and moved until its lowest well-filled
    level, which is taken for the floor, is at height 0. Lengths are metres; a cloud in
    millimetres is refused. Normals are estimated where the file has none. Cells grow
    where the points of the cloud are sparse, and levels thicken where they are noisy.

    Args:
        cloud: PLY file with x, y, z [m] and perhaps nx, ny, nz and red, green, blue.
        picture: Picture to write, PNG or SVG.
        up: Direction of the ceiling in the cloud, right to 15 degrees; z if not given.
        crop_m: Lower and upper corner [m] of the part that counts, six numbers.
        voxel_m: Edge of the voxels that hold one point each [m].
        merge_m: Points closer in height are one level [m].
        min_width_m: Width of the smallest square that an area holds [m].
        config: Values of the study, for all that is not given here.
        schema: JSON Schema of those values.
    """
    given = {
        "cloud": {"up": up, "crop_m": crop_m, "voxel_m": voxel_m},
        "areas": {"merge_m": merge_m, "min_width_m": min_width_m},
    }
    if picture.suffix not in ENDINGS:
        raise BadInput(f"{picture}: ends in {picture.suffix!r}, expected .png or .svg")
    settings = _settings(config, schema, given)
    points = read_ply(cloud)
    try:
        found = find_in_scan(points, *settings)
    except BadInput as error:
        raise BadInput(f"{cloud}: {str(error).removeprefix('cloud: ')}") from error
    if not found.areas:
        raise BadInput(f"{cloud}: nothing in it is level and wide, expected a floor")
    save_figure(draw_areas(found, cloud.stem), picture)
    for line in _lines(found):
        print(line)


def _settings(
    config: Path, schema: Path, given: dict[str, dict[str, Any]]
) -> tuple[CloudConfig, AreaConfig]:
    """Return the settings of a configuration, but for those that are given."""
    document, rules = read_yaml(config), read_yaml(schema)
    check(document, rules, str(config))
    for section, values in given.items():
        said = {key: value for key, value in values.items() if value is not None}
        document[section] |= json.loads(json.dumps(said))  # tuples become lists
    check(document, rules, "command line")
    if not any(document["cloud"]["up"]):
        raise BadInput("command line: cloud.up: value [0, 0, 0]; expected a direction")
    cloud = document["cloud"] | {"up": tuple(document["cloud"]["up"])}
    return CloudConfig(**cloud), AreaConfig(**document["areas"])


def _lines(found: ScanAreas) -> list[str]:
    """Return what was found: the cloud, then each area."""
    extent = " x ".join(f"{e:.1f}" for e in np.ptp(found.cloud.points, axis=0))
    lines = [
        f"{len(found.cloud)} points, {extent} m, spacing {found.spacing_m:.3f} m;"
        f" cells of {found.area_config.cell_m:.3f} m,"
        f" levels of {found.area_config.merge_m:.3f} m"
    ]
    if not any(area.is_floor for area in found.areas):
        lines.append("no floor: the lowest level is too narrow for a placing area")
    return lines + [_line(area) for area in found.areas]


def _line(area: PlacingArea) -> str:
    """Return height, size, middle and free height of an area."""
    outline = heal(area.polygon_m)
    x, y = np.array(outline.centroid.coords)[0] + 0.0
    free = "open" if np.isinf(area.clearance_m) else f"{area.clearance_m:.2f} m free"
    return (
        f"{area.area}: height {area.height_m + 0.0:.3f} m, {outline.area:.3f} m2"
        f" around ({x:.2f}, {y:.2f}), {free}"
    )


if __name__ == "__main__":
    run(main)
