"""Pictures of an arrangement for raters: from two corners of the room and from above.

Every placed object has its number beside it; the page also gets the point in each
picture where the object is, so that it can point there.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from io import BytesIO

import numpy as np
from PIL import Image

from placing.dressing import meshes_of, object_meshes
from placing.pictures.cameras import Camera, corners_of, framing
from placing.pictures.labels import labelled
from placing.pictures.renderer import Picture, render
from placing.pictures.rooms import anchor_of, room_camera, seen_meshes
from placing.scene import Arrangement, Layout, Placement

SIZE = (1280, 960)
"""Width and height of a picture [px]; ASSUME: a mouse has ten pixels, a page 10 MB."""
QUALITY = 82
"""Of the JPEG, of 100."""
NUMBER_PX = 15
ABOVE_DEG = 80.0
"""Elevation of the view from above; straight above has no side that is up."""
SHOWN_M = 1.0
"""What is higher may be cut off at the sides of the view from above."""
TITLES = ("from one corner", "from the other corner", "from above")


@dataclass(frozen=True)
class View:
    """One picture of an arrangement."""

    title: str
    jpeg: bytes
    points: dict[str, tuple[float, float]]
    """Where each object is: shares of the width from the left, height from the top."""


def views_of(layout: Layout, placements: Iterable[Placement]) -> Iterator[View]:
    """Yield the views of an arrangement; objects are numbered in their order."""
    placed = tuple(placements)
    objects = object_meshes(layout, Arrangement("", "", placed))
    room = meshes_of(layout)
    for title, camera in zip(TITLES, cameras_of(layout), strict=True):
        meshes = [*seen_meshes(layout, camera, room), *objects.values()]
        anchors = np.array([anchor_of(mesh) for mesh in objects.values()])
        pixels = camera.project(anchors.reshape(-1, 3), SIZE)
        numbers = {str(n): pixel for n, pixel in enumerate(pixels, 1)}
        picture = labelled(render(meshes, camera, SIZE), numbers, NUMBER_PX)
        shares = (pixels / np.array(SIZE)).round(4).tolist()
        points = {name: (u, v) for name, (u, v) in zip(objects, shares, strict=True)}
        yield View(title, jpeg_of(picture), points)


def cameras_of(layout: Layout) -> tuple[Camera, Camera, Camera]:
    """Return a camera in the corner that hides least, one opposite, one above."""
    first = room_camera(layout, SIZE)
    back = np.subtract(first.eye, first.target)
    azimuth_deg = float(np.degrees(np.arctan2(back[1], back[0])))
    low, high = np.min(layout.outline_m, axis=0), np.max(layout.outline_m, axis=0)
    corners = corners_of(np.append(low, 0.0), np.append(high, layout.height_m))
    other = framing(corners, azimuth_deg + 180, 52.0, SIZE, 34.0, 0.02)
    # The longer side of the room is as wide as the picture.
    sides_deg = np.array(
        [-90.0, 90.0] if np.ptp(corners[:, 0]) > np.ptp(corners[:, 1]) else [0.0, 180.0]
    )
    side_deg = float(sides_deg[np.argmax(np.cos(np.radians(sides_deg - azimuth_deg)))])
    corners[:, 2] = np.minimum(corners[:, 2], SHOWN_M)
    return first, other, framing(corners, side_deg, ABOVE_DEG, SIZE, 34.0, 0.02)


def jpeg_of(picture: Picture) -> bytes:
    """Return a picture as JPEG."""
    buffer = BytesIO()
    Image.fromarray(picture).save(buffer, "JPEG", quality=QUALITY, optimize=True)
    return buffer.getvalue()
