"""Figures 4 and 5 of the paper as pages of pictures."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from trimesh import Trimesh

from placing.pictures.cameras import Camera, corners_of, framing
from placing.pictures.labels import labelled
from placing.pictures.office_content import Office
from placing.pictures.pages import Key, page
from placing.pictures.people import HEAT, KIND_COLOURS, body, heat
from placing.pictures.renderer import Picture, render
from placing.pictures.rooms import anchor_of, room_camera, seen_meshes

Array = NDArray[np.float64]

FULL, THIN = 0.8, 0.45
"""Thickness of people, and where there is something behind them to be seen."""
MASS = 0.8
"""A close-up shows where this share of a density is,"""
AROUND_M = np.array([0.45, 0.45, 0.3])
"""and so much around it."""
ABOUT = {
    "rooms": "Data set rooms: written for this project by language models, not the "
    "data set of the paper"
}


def draw_people(office: Office, size: tuple[int, int]) -> Picture:
    """Return Figure 4: random people, sampled people, and where an object goes."""
    camera = room_camera(office.layout, size)
    room = [*seen_meshes(office.layout, camera), *office.given.values()]
    wanted, n = office.figure.category, len(office.random)
    random = [body(person, FULL) for person in office.random]
    sampled = [body(person, FULL) for person in office.sampled]
    thin = [body(person, THIN) for person in office.sampled]
    near = close_up(camera, office.places[likeliest(office.density)], size)
    drawn = {
        f"(a) the room as {office.labels} left it, {wanted} taken out": render(
            room, camera, size
        ),
        f"(b) {n} people drawn from the prior P0": render(
            [*room, *random], camera, size
        ),
        f"(c) {len(office.sampled)} people sampled given the objects": render(
            [*room, *sampled], camera, size
        ),
        f"(d) density of the {wanted} given such people, from closer": render(
            [*room, *thin, heat_of(office)], near, size
        ),
    }
    title = f"Figure 4: human poses and the place of a {wanted} in {named(office)}"
    key = Key(kind_names(), f"density of the {wanted}, 0 to highest", HEAT)
    return page(drawn, 2, size, title, notes(office), key)


def draw_arranged(office: Office, size: tuple[int, int]) -> Picture:
    """Return Figure 5: the empty room arranged, and the people who use it."""
    camera = room_camera(office.layout, size)
    room = [*seen_meshes(office.layout, camera), *office.placed.values()]
    people = [body(person, FULL) for person in office.users]
    anchors = np.array([anchor_of(mesh) for mesh in office.placed.values()])
    near = close_up(camera, anchors, size)
    n = len(office.placed)
    whole = render([*room, *people], camera, size)
    heads = np.array([person.joints()[0] for person in office.users]).reshape(-1, 3)
    uses = [f"{p.kind.replace('_', ' ')}: {p.n_objects} objects" for p in office.users]
    whole = with_names(whole, uses, heads, camera, 21)
    closer = with_names(
        render(room, near, size), list(office.placed), anchors, near, 19
    )
    drawn = {
        f"(a) {n} objects and the people imagined to use them": whole,
        "(b) the objects alone, from closer": closer,
    }
    title = f"Figure 5: {n} objects arranged in the empty {named(office)}"
    return page(drawn, 2, size, title, notes(office), Key(kind_names()))


def likeliest(density: Array) -> NDArray[np.int64]:
    """Return the fewest places that hold the share `MASS` of a density."""
    order = np.argsort(-density, kind="stable")
    n = np.searchsorted(np.cumsum(density[order]), MASS * density.sum()) + 1
    return order[:n]


def close_up(camera: Camera, points: Array, size: tuple[int, int]) -> Camera:
    """Return a camera that looks the same way, but only at points and around them."""
    back = np.subtract(camera.eye, camera.target)
    azimuth = np.degrees(np.arctan2(back[1], back[0]))
    elevation = np.degrees(np.arcsin(back[2] / np.linalg.norm(back)))
    corners = corners_of(points.min(axis=0) - AROUND_M, points.max(axis=0) + AROUND_M)
    return framing(corners, float(azimuth), float(elevation), size, camera.fov_deg, 0.0)


def with_names(
    picture: Picture,
    names: Sequence[str],
    points: Array,
    camera: Camera,
    text_px: int,
) -> Picture:
    """Return the picture with names beside points of the world."""
    pixels = camera.project(points, (picture.shape[1], picture.shape[0]))
    return labelled(picture, dict(zip(names, pixels, strict=True)), text_px)


def heat_of(office: Office) -> Trimesh:
    """Return the density of Figure 4 as tiles on the lattice of places."""
    steps = np.diff(np.unique(np.round(office.places[:, 0], 6)))
    return heat(office.places, office.density, float(steps.min()))


def named(office: Office) -> str:
    """Return data set and room."""
    return f"{office.layout.scene} (data set {office.figure.dataset})"


def notes(office: Office) -> list[str]:
    """Return what stands at the foot of both figures."""
    dataset = office.figure.dataset
    method = f"Method {office.figure.method}, learned without this room."
    return [f"{ABOUT.get(dataset, f'Data set {dataset}')}. {method}"]


def kind_names() -> dict[str, tuple[int, int, int]]:
    """Return the colours of the kinds of people by their names for people."""
    return {kind.replace("_", " "): c for kind, c in KIND_COLOURS.items()}
