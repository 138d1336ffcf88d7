"""Words on pictures: labels with leader lines, and sheets of captioned tiles."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

Picture = NDArray[np.uint8]
Box = tuple[float, float, float, float]

INK, PAPER, LINE = (34, 38, 44), (255, 255, 255), (90, 96, 104)
RINGS_PX = (14, 26, 40, 58, 80, 108, 140)
"""Distances from its point at which a label is tried, nearest first."""
N_HEADINGS = 16


def labelled(
    picture: Picture, points: Mapping[str, NDArray[np.float64]], text_px: int = 12
) -> Picture:
    """Return the picture with a label beside each point (u, v), none over another."""
    image = Image.fromarray(picture)
    draw, font = ImageDraw.Draw(image), ImageFont.load_default(text_px)
    inside = {
        name: (float(u), float(v))
        for name, (u, v) in points.items()
        if 0 <= u < image.width and 0 <= v < image.height
    }
    taken = [(u - 4, v - 4, u + 4, v + 4) for u, v in inside.values()]
    boxes = {}
    for name in sorted(inside, key=lambda name: inside[name][1]):  # from the top
        _, _, right, bottom = draw.textbbox((0, 0), name, font=font)
        extent = (right + 6, bottom + 4)
        boxes[name] = _free_box(inside[name], extent, image.size, taken)
        taken.append(boxes[name])
    for name, box in boxes.items():
        _draw_leader(draw, inside[name], box)
    for name, box in boxes.items():
        draw.rounded_rectangle(box, 3, fill=PAPER, outline=LINE)
        draw.text((box[0] + 3, box[1] + 1), name, fill=INK, font=font)
    return np.asarray(image)


def _free_box(
    point: tuple[float, float],
    extent: tuple[float, float],
    size: tuple[int, int],
    taken: Sequence[Box],
) -> Box:
    """Return the place of a label near its point that overlaps least."""
    angles = -np.pi / 2 + 2 * np.pi * np.arange(N_HEADINGS) / N_HEADINGS  # up first
    best, least = (0.0, 0.0, 0.0, 0.0), np.inf
    for ring in RINGS_PX:
        for angle in angles:
            u = point[0] + (ring + extent[0] / 2) * np.cos(angle)
            v = point[1] + (ring + extent[1] / 2) * np.sin(angle)
            u = np.clip(u, extent[0] / 2 + 1, size[0] - extent[0] / 2 - 2)
            v = np.clip(v, extent[1] / 2 + 1, size[1] - extent[1] / 2 - 2)
            half = (extent[0] / 2, extent[1] / 2)
            box = (u - half[0], v - half[1], u + half[0], v + half[1])
            cost = sum(_overlap(box, other) for other in taken)
            if cost < least:
                best, least = box, cost
        if least == 0:
            break
    return best


def _overlap(a: Box, b: Box) -> float:
    """Return the area that two boxes share, shape () [px2]."""
    width = min(a[2], b[2]) - max(a[0], b[0]) + 2
    height = min(a[3], b[3]) - max(a[1], b[1]) + 2
    return max(width, 0) * max(height, 0)


def _draw_leader(
    draw: ImageDraw.ImageDraw, point: tuple[float, float], box: Box
) -> None:
    """Draw a dot at the point and a thin line from it to the label."""
    u, v = point
    end = (np.clip(u, box[0], box[2]), np.clip(v, box[1], box[3]))
    draw.line([(u, v), end], fill=LINE, width=1)
    draw.ellipse((u - 2, v - 2, u + 2, v + 2), fill=INK)


def sheet(
    tiles: Mapping[str, Picture], columns: int, tile: tuple[int, int], text_px: int = 14
) -> Picture:
    """Return a grid of pictures with their names below, each shrunk to fit `tile`."""
    gap, caption = 6, text_px + 8
    rows = -(-len(tiles) // columns)
    cell = (tile[0] + gap, tile[1] + caption + gap)
    page = Image.new("RGB", (columns * cell[0] + gap, rows * cell[1] + gap), PAPER)
    draw, font = ImageDraw.Draw(page), ImageFont.load_default(text_px)
    for n, (name, picture) in enumerate(tiles.items()):
        left, top = gap + n % columns * cell[0], gap + n // columns * cell[1]
        image = Image.fromarray(picture)
        image.thumbnail(tile, Image.Resampling.LANCZOS)
        page.paste(image, (left + (tile[0] - image.width) // 2, top))
        middle = (left + tile[0] / 2, top + tile[1] + caption / 2)
        draw.text(middle, name, fill=INK, font=font, anchor="mm")
    return np.asarray(page)
