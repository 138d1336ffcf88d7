"""Draw a picture of every object of the catalogue, and a sheet of them all."""

from pathlib import Path

import numpy as np
from tqdm import tqdm

from command import run
from placing.pictures.cameras import framing
from placing.pictures.labels import sheet
from placing.pictures.renderer import Light, Picture, render, write_picture
from placing.rooms.catalogue import read_catalogue
from placing.scene import SceneObject
from placing.shapes.objects import object_shape

COLUMNS, TILE = 8, (240, 180)


def main(
    catalogue: Path,
    pictures: Path,
    contact_sheet: Path,
    size: tuple[int, int] = (480, 360),
) -> None:
    """Draw a picture of every object of the catalogue, and a sheet of them all.

    Args:
        catalogue: Table of objects.
        pictures: Directory to write a PNG for each object to.
        contact_sheet: PNG to write with all of them.
        size: Width and height of a picture.
    """
    tiles = {}
    for name, item in tqdm(read_catalogue(catalogue).items(), disable=None):
        tiles[name] = picture_of(item, size)
        write_picture(tiles[name], pictures / f"{name}.png")
    write_picture(sheet(tiles, COLUMNS, TILE), contact_sheet)


def picture_of(item: SceneObject, size: tuple[int, int]) -> Picture:
    """Return a picture of an object; what is flat is seen from higher up."""
    mesh = object_shape(item.shape, item.size_m).mesh
    is_flat = item.size_m[2] < 0.3 * max(item.size_m[:2])
    elevation = 48.0 if is_flat else 28.0
    camera = framing(np.asarray(mesh.vertices), 35.0, elevation, size, 25.0, 0.08)
    return render([mesh], camera, size, Light(ground_m=-item.size_m[2] / 2))


if __name__ == "__main__":
    run(main)
