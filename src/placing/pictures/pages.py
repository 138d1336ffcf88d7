"""Figures of a paper: tiles on a page with a title, a key of colours and a scale."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import matplotlib as mpl
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from placing.pictures.labels import INK, LINE, PAPER, sheet

Picture = NDArray[np.uint8]

MARGIN, GAP, TEXT_PX = 22, 14, 24
BAR = (220, 16)
"""Width and height of a scale of colours."""


@dataclass(frozen=True)
class Key:
    """What colours mean, at the foot of a page."""

    colours: Mapping[str, tuple[int, int, int]]
    scale: str = ""
    """Name of what the scale of colours measures, from 0 to 1; empty for no scale."""
    colour_map: str = "turbo"


def page(
    tiles: Mapping[str, Picture],
    columns: int,
    tile: tuple[int, int],
    title: str,
    notes: Sequence[str],
    key: Key,
) -> Picture:
    """Return captioned tiles below a title and above notes and a key of colours."""
    grid = Image.fromarray(sheet(tiles, columns, tile, TEXT_PX))
    line = TEXT_PX + GAP
    head, foot = MARGIN + round(1.5 * line), line * (len(notes) + 1) + MARGIN
    size = (grid.width + 2 * MARGIN, head + grid.height + foot)
    image = Image.new("RGB", size, PAPER)
    image.paste(grid, (MARGIN, head))
    draw, font = ImageDraw.Draw(image), ImageFont.load_default(TEXT_PX)
    draw.text(
        (MARGIN, MARGIN), title, fill=INK, font=ImageFont.load_default(1.3 * TEXT_PX)
    )
    top = head + grid.height + GAP // 2
    _draw_key(image, draw, key, top)
    for n, note in enumerate(notes, 1):
        draw.text((MARGIN, top + n * line), note, fill=LINE, font=font)
    return np.asarray(image)


def _draw_key(
    image: Image.Image, draw: ImageDraw.ImageDraw, key: Key, top: int
) -> None:
    """Draw swatches with their names from the left, and a scale at the right."""
    font, left = ImageFont.load_default(TEXT_PX), float(MARGIN)
    for name, colour in key.colours.items():
        draw.ellipse((left, top + 4, left + TEXT_PX, top + 4 + TEXT_PX), fill=colour)
        left += TEXT_PX + 8
        draw.text((left, top), name, fill=INK, font=font)
        left += draw.textlength(name, font=font) + 2 * GAP
    if key.scale:
        shades = mpl.colormaps[key.colour_map](np.linspace(0, 1, BAR[0]), bytes=True)
        strip = np.broadcast_to(shades[None, :, :3], (BAR[1], BAR[0], 3))
        width = draw.textlength(key.scale, font=font)
        at = round(image.width - MARGIN - BAR[0] - width - GAP)
        image.paste(Image.fromarray(np.ascontiguousarray(strip)), (at, top + 8))
        draw.text((at + BAR[0] + GAP, top), key.scale, fill=INK, font=font)
