"""The two tasks of Section 4.1 as questions: which objects are given, which wanted.

`filled`: the objects of one category are wanted, all others stand where one labelled
arrangement has them, for every category and arrangement in turn. `empty`: all objects
are wanted and none is given.
"""

from dataclasses import dataclass

from placing.errors import unknown
from placing.scene import Placement, Scene, SceneObject

TASKS = ("filled", "empty")


@dataclass(frozen=True)
class Question:
    """One question to a method about a scene."""

    name: str
    """Unique within scene and task; part of the name of the random stream."""
    labels: str
    """Labelled arrangement whose objects are given; empty where none is."""
    given: tuple[Placement, ...]
    wanted: tuple[SceneObject, ...]

    @property
    def categories(self) -> list[str]:
        """The wanted categories, sorted."""
        return sorted({item.category for item in self.wanted})

    def of_category(self, category: str) -> list[SceneObject]:
        """Return the wanted objects of a category."""
        return [item for item in self.wanted if item.category == category]


def questions(scene: Scene, task: str) -> list[Question]:
    """Return the questions of a task about a scene."""
    if task not in TASKS:
        raise unknown("task", task, list(TASKS))
    if task == "empty":
        return [Question("all", "", (), scene.objects)] if scene.objects else []
    # ASSUME: the paper does not say which of the labelled arrangements fills a room;
    # each does in turn, and is what the answer is compared with.
    return [
        _filled(scene, arrangement.name, arrangement.placements, category)
        for arrangement in scene.arrangements
        for category in sorted({item.category for item in scene.objects})
    ]


def _filled(
    scene: Scene, labels: str, placements: tuple[Placement, ...], category: str
) -> Question:
    """Return the question for one category, given one labelled arrangement."""
    wanted = tuple(item for item in scene.objects if item.category == category)
    wanted_ids = {item.object_id for item in wanted}
    given = tuple(p for p in placements if p.object_id not in wanted_ids)
    return Question(f"{labels}/{category}", labels, given, wanted)
