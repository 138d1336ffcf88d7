"""A desk of a scene as two contexts arrange it, side by side (Figure 7)."""

from collections.abc import Mapping, Sequence

import numpy as np

from placing.dressing import meshes_of, object_meshes
from placing.errors import unknown
from placing.pictures.cameras import corners_of, framing
from placing.pictures.labels import labelled
from placing.pictures.pages import Key, Picture, page
from placing.pictures.renderer import render
from placing.pictures.rooms import anchor_of, seen_meshes
from placing.scene import Arrangement, Furniture, Layout, Placement

ELEVATION_DEG = 48.0
ABOVE_M = 0.45
"""What is seen above the desk's top."""
BEHIND_DEG = 25.0
"""Turn of the camera from straight behind the person at the desk."""


def draw_desk(
    layout: Layout,
    desk: str,
    arranged: Mapping[str, Sequence[Placement]],
    notes: Sequence[str],
    size: tuple[int, int],
) -> Picture:
    """Return a page with the desk as each context arranges it, by caption.

    Objects elsewhere in the room are drawn, those on the desk are named.
    """
    piece = piece_of(layout, desk)
    tiles = {
        caption: desk_picture(layout, piece, placements, size)
        for caption, placements in arranged.items()
    }
    title = f"Figure 7: one desk of {layout.scene} by each context"
    return page(tiles, len(tiles), size, title, notes, Key({}))


def piece_of(layout: Layout, furniture_id: str) -> Furniture:
    """Return a piece of furniture by its id."""
    pieces = {item.furniture_id: item for item in layout.furniture}
    if furniture_id not in pieces:
        raise unknown(f"furniture of {layout.scene}", furniture_id, sorted(pieces))
    return pieces[furniture_id]


def desk_picture(
    layout: Layout,
    piece: Furniture,
    placements: Sequence[Placement],
    size: tuple[int, int],
) -> Picture:
    """Return a picture of a desk with what stands on it, seen by who sits there."""
    meshes = meshes_of(layout)
    low, high = meshes[piece.furniture_id].bounds
    top = np.array([*low[:2], high[2] - 0.05])
    seen = corners_of(top, np.array([*high[:2], high[2] + ABOVE_M]))
    w, _, _, z = piece.T_world_furniture[:4]
    azimuth = np.rad2deg(2 * np.arctan2(z, w)) + BEHIND_DEG
    camera = framing(seen, azimuth, ELEVATION_DEG, size, 34.0, 0.03)
    room = seen_meshes(layout, camera, meshes)
    chosen = object_meshes(layout, Arrangement("", "", tuple(placements)))
    on_desk = {
        name: mesh
        for name, mesh in chosen.items()
        if np.all(mesh.centroid[:2] >= low[:2])
        and np.all(mesh.centroid[:2] <= high[:2])
        and mesh.bounds[0, 2] > high[2] - 0.1
    }
    drawn = render([*room, *chosen.values()], camera, size)
    anchors = np.array([anchor_of(m) for m in on_desk.values()]).reshape(-1, 3)
    points = camera.project(anchors, size)
    return labelled(drawn, dict(zip(on_desk, points, strict=True)), 18)
