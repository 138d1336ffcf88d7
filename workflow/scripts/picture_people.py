"""Draw Figures 4 and 5 of the paper for one office, and record them."""

from pathlib import Path

from command import run
from placing.artifacts.densities import read_densities
from placing.artifacts.features import read_features
from placing.artifacts.formats import read_table
from placing.artifacts.scenes import read_scene
from placing.methods.answer_tables import PLACEMENT_COLUMNS, POSE_COLUMNS
from placing.pictures.office import draw_arranged, draw_people
from placing.pictures.office_content import Figure, Tables, office_of
from placing.pictures.renderer import write_picture
from placing.recordings.office import write_arranged, write_people
from placing.rooms.catalogue import read_catalogue
from placing.rooms.file import read_yaml
from placing.rooms.reader import read_layout

SIZE = (1000, 960)
"""Width and height of each picture of a figure."""


def main(
    dataset: str,
    method: str,
    category: str,
    room: Path,
    schema: Path,
    catalogue: Path,
    scene: Path,
    features: Path,
    poses_filled: Path,
    poses_empty: Path,
    arrangements: Path,
    densities: Path,
    figure4: Path,
    figure5: Path,
    recording4: Path,
    recording5: Path,
    seed: int,
) -> None:
    """Draw Figures 4 and 5 of the paper for one office, and record them.

    Args:
        dataset: Data set of the office, to be named on the figures.
        method: Method whose people, densities and placements are shown.
        category: Category whose density Figure 4 shows, such as `monitor`.
        room: Room file of the office.
        schema: JSON Schema of room files.
        catalogue: Table of objects.
        scene: The office as the model sees it.
        features: Its places and valid human poses.
        poses_filled: Sampled poses of the task `filled`.
        poses_empty: Sampled poses of the task `empty`.
        arrangements: Placements of the task `empty`.
        densities: Densities of the task `filled` in the office.
        figure4: PNG to write with random and sampled people and a density.
        figure5: PNG to write with the arranged room and who uses it.
        recording4: Recording to write with what Figure 4 shows.
        recording5: Recording to write with what Figure 5 shows.
        seed: Root of the random streams.
    """
    layout = read_layout(room, read_catalogue(catalogue), read_yaml(schema))
    figure = Figure(dataset, method, category, seed)
    model = (read_scene(scene), *read_features(features))
    tables = _tables(poses_filled, poses_empty, arrangements, layout.scene, method)
    office = office_of(figure, layout, model, tables, read_densities(densities))
    write_picture(draw_people(office, SIZE), figure4)
    write_picture(draw_arranged(office, SIZE), figure5)
    write_people(recording4, office)
    write_arranged(recording5, office)


def _tables(
    poses_filled: Path, poses_empty: Path, arrangements: Path, scene: str, method: str
) -> Tables:
    """Return the rows of one scene and method of the three tables."""
    tables = [
        read_table(poses_filled, POSE_COLUMNS),
        read_table(poses_empty, POSE_COLUMNS),
        read_table(arrangements, PLACEMENT_COLUMNS),
    ]
    rows = [t[(t["scene"] == scene) & (t["method"] == method)] for t in tables]
    return Tables(*rows)


if __name__ == "__main__":
    run(main)
