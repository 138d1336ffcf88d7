"""Figures 4 and 5 of the paper as recordings: one view per picture of the figure."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import rerun as rr
import rerun.blueprint as rrb
from trimesh import Trimesh

from placing.artifacts.atomic import replacing
from placing.dressing import WALLS, meshes_of
from placing.pictures.cameras import Camera
from placing.pictures.office import close_up, heat_of, likeliest, named, notes
from placing.pictures.office_content import Office
from placing.pictures.people import KIND_COLOURS, Person, body
from placing.pictures.rooms import cut_away, room_camera
from placing.pictures.shading import face_colours, joined
from placing.recordings import blueprint
from placing.recordings.content import Mesh
from placing.recordings.entities import AMBIENT, LIGHT, triangles
from placing.recordings.stream import recording_stream

COLOUR_NAMES = dict(
    zip(KIND_COLOURS, ("blue", "cyan", "green", "purple", "red", "yellow"), strict=True)
)
SQUARE = (100, 100)
THICKNESS, DETAIL = 0.6, 1
"""Of people; fewer triangles than in pictures, since they take most of the file."""
OVER_HEAD_M = np.array([0.0, 0.0, 0.2])
WIDE, TALL = 0.62, 0.78
"""Share of a camera's distance at which a view of that shape sees the same."""


def write_people(path: Path, office: Office) -> None:
    """Write Figure 4: random people, sampled people, and where an object goes."""
    wanted, camera = office.figure.category, room_camera(office.layout, SQUARE)
    near = close_up(camera, office.places[likeliest(office.density)], SQUARE)
    given = ("room", "given")
    views = {
        f"(a) {office.labels}'s room, {wanted} taken out": (camera, given),
        "(b) people drawn from the prior P0": (camera, (*given, "random")),
        "(c) people sampled given the objects": (camera, (*given, "sampled")),
        f"(d) density of the {wanted}": (near, (*given, "sampled", "density")),
    }
    with replacing(path) as part:
        stream = _stream(part, office, 4)
        log_mesh(stream, "given", list(office.given.values()))
        log_people(stream, "random", office.random)
        log_people(stream, "sampled", office.sampled)
        log_mesh(stream, "density", [heat_of(office)], is_shaded=False)
        title = f"Human poses and the place of a {wanted}"
        log_words(stream, f"Figure 4: {title} in {named(office)}", office)
        _finish(stream, views, WIDE)


def write_arranged(path: Path, office: Office) -> None:
    """Write Figure 5: the empty room arranged, and the people who use it."""
    camera = room_camera(office.layout, SQUARE)
    middles = np.array([mesh.bounds.mean(axis=0) for mesh in office.placed.values()])
    near = close_up(camera, middles.reshape(-1, 3), SQUARE)
    views = {
        "(a) objects and the people who use them": (
            camera,
            ("room", "placed", "users"),
        ),
        "(b) the objects alone": (near, ("room", "placed", "names")),
    }
    with replacing(path) as part:
        stream = _stream(part, office, 5)
        log_mesh(stream, "placed", list(office.placed.values()))
        names = rr.Points3D(middles, labels=list(office.placed), radii=0.004)
        stream.log("world/names", names, static=True)
        log_people(stream, "users", office.users)
        title = f"{len(office.placed)} objects arranged in the empty {named(office)}"
        log_words(stream, f"Figure 5: {title}", office)
        _finish(stream, views, TALL)


def _stream(path: Path, office: Office, number: int) -> rr.RecordingStream:
    """Return the stream of a figure to a file, with the room in it."""
    of, layout = office.figure, office.layout
    name = f"figure{number}"
    names = (of.dataset, layout.scene, name, of.method, f"seed{of.seed}")
    stream = recording_stream(names)
    stream.save(path)
    stream.send_recording_name(f"Figure {number}: {named(office)}, {of.method}")
    stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    meshes, eye = meshes_of(layout), np.array(room_camera(layout, SQUARE).eye)
    walls = cut_away(meshes.pop(WALLS), layout.outline_m, eye)
    log_mesh(stream, "room", [walls, *meshes.values()])
    return stream


def _finish(
    stream: rr.RecordingStream,
    views: Mapping[str, tuple[Camera, Sequence[str]]],
    share: float,
) -> None:
    """Send views of parts of the room, beside the words, and close the file."""
    drawn = []
    for title, (camera, parts) in views.items():
        target = np.array(camera.target)
        eye = blueprint.Eye(target + share * (camera.eye - target), target)
        contents = [f"world/{part}/**" for part in parts]
        drawn.append(blueprint.room(eye, (), title, contents))
    words = rrb.TextDocumentView(origin="summary", name="Summary")
    grid = rrb.Grid(*drawn, grid_columns=2)
    stream.send_blueprint(
        blueprint.views(rrb.Horizontal(grid, words, column_shares=[5, 1])),
        make_active=True,
        make_default=True,
    )
    stream.flush()
    stream.disconnect()


def log_mesh(
    stream: rr.RecordingStream,
    name: str,
    meshes: Sequence[Trimesh],
    is_shaded: bool = True,
) -> None:
    """Log meshes as one, shaded as if lit from above: the viewer has no light."""
    if not meshes:
        return
    mesh = joined(meshes)
    colours = face_colours(mesh)[:, :3].astype(float)
    if is_shaded:
        lit = np.abs(mesh.face_normals @ np.array(LIGHT)) / np.linalg.norm(LIGHT)
        colours *= (AMBIENT + (1 - AMBIENT) * lit)[:, None]
    drawn = Mesh(name, mesh.vertices, mesh.faces, colours.astype(np.uint8))
    stream.log(f"world/{name}", triangles(drawn), static=True)


def log_people(stream: rr.RecordingStream, name: str, people: Sequence[Person]) -> None:
    """Log people as bodies, with their kinds and numbers of objects over heads."""
    bodies = [body(one, THICKNESS, DETAIL) for one in people]
    log_mesh(stream, f"{name}/bodies", bodies)
    heads = np.array([one.joints()[0] for one in people]).reshape(-1, 3)
    kinds = [one.kind.replace("_", " ") for one in people]
    counts = [f": {one.n_objects}" if one.n_objects else "" for one in people]
    said = rr.Points3D(
        heads + OVER_HEAD_M,
        labels=[kind + count for kind, count in zip(kinds, counts, strict=True)],
        radii=0.001,
        show_labels=name == "users",
    )
    stream.log(f"world/{name}/names", said, static=True)


def log_words(stream: rr.RecordingStream, title: str, office: Office) -> None:
    """Log what the figure shows and what its colours mean."""
    kinds = [
        f"- {COLOUR_NAMES[kind]}: {kind.replace('_', ' ')}" for kind in KIND_COLOURS
    ]
    text = "\n".join([f"# {title}", *notes(office), "", *kinds])
    document = rr.TextDocument(text, media_type=rr.MediaType.MARKDOWN)
    stream.log("summary", document, static=True)
