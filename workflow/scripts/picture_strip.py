"""Draw a strip of pictures of a robot that carries out its plans in a scene."""

from pathlib import Path

from command import run
from placing.artifacts.films import read_film
from placing.pictures.renderer import write_picture
from placing.pictures.strip import Stage, draw_strip, moments, moved_farthest
from placing.robot.model import load_robot
from placing.robot.settings import read_robot
from placing.rooms.file import read_yaml
from placing.rooms.reader import layout_reader

SIZE = (480, 600)


def main(
    scene: str,
    film: Path,
    rooms: Path,
    schema: Path,
    catalogue: Path,
    robot: Path,
    robot_schema: Path,
    picture: Path,
    object_id: str = "",
) -> None:
    """Draw what the robot does with one object, and the scene before and after all.

    Args:
        scene: Scene of the film.
        film: What was seen of the robot that carried out its plans.
        rooms: Directory of room files.
        schema: Schema of such files.
        catalogue: Table of objects.
        robot: Robot that moves.
        robot_schema: Schema of such files.
        picture: PNG to write.
        object_id: Object whose way is shown; left out: the one moved farthest.
    """
    seen, layout = read_film(film), layout_reader(rooms, schema, catalogue)(scene)
    model = load_robot(read_robot(robot, read_yaml(robot_schema)))
    shown = object_id or moved_farthest(seen)
    title = f"{scene}: the robot {model.settings.robot} and the {shown}, in simulation"
    stage = Stage(layout, model, seen)
    drawn = draw_strip(stage, moments(seen, shown), shown, SIZE, title)
    write_picture(drawn, picture)


if __name__ == "__main__":
    run(main)
