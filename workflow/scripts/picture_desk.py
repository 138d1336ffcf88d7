"""Draw one desk as object context and as human context arrange it (Figure 7)."""

from pathlib import Path

from command import run
from placing.artifacts.formats import read_table
from placing.errors import unknown
from placing.methods.names import JOINT_NAMES
from placing.pictures.desk import draw_desk
from placing.pictures.renderer import write_picture
from placing.rooms.reader import layout_reader
from placing.tables.table2_answers import ANSWER_COLUMNS, placements_of

PANELS = {method: JOINT_NAMES[method] for method in ("object_context", "dp")}
SIZE = (1000, 750)


def main(
    dataset: str,
    scene: str,
    desk: str,
    joint: Path,
    rooms: Path,
    schema: Path,
    catalogue: Path,
    figure: Path,
) -> None:
    """Draw one desk as object context and as human context arrange it.

    Args:
        dataset: Data set of the scene, to be named on the figure.
        scene: Scene with the desk.
        desk: Id of the desk in the room file.
        joint: Table of joint arrangements.
        rooms: Directory of room files.
        schema: JSON Schema of room files.
        catalogue: Table of objects.
        figure: PNG to write.
    """
    table = read_table(joint, ANSWER_COLUMNS)
    scenes = sorted(table["scene"].unique())
    if scene not in scenes:
        raise unknown(f"scene of {joint}", scene, scenes)
    layout = layout_reader(rooms, schema, catalogue)(scene)
    rows = table[table["scene"] == scene]
    arranged = {
        caption: list(placements_of(rows[rows["method"] == method]))
        for method, caption in PANELS.items()
    }
    notes = [f"Data set {dataset}, written for this project."]
    write_picture(draw_desk(layout, desk, arranged, notes, SIZE), figure)


if __name__ == "__main__":
    run(main)
