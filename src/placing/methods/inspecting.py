"""What is said about an answer beside the placements: reasons and regions.

Shapes: p places, q valid poses, l levels.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from placing.methods.answering import Answer, Asked, Chosen
from placing.methods.explanation import Field, explain, explanation_rows
from placing.methods.regions import REGION_LEVELS, calibrate, region_areas
from placing.people.hallucinating import People

Array = NDArray[np.float64]


def reasons_of(
    asked: Asked, answer: Answer, task: str, method: str
) -> list[tuple[object, ...]]:
    """Return the rows that explain every object that was placed by its user."""
    people = answer.people
    if people is None:
        return []
    return [
        row
        for chosen in answer.chosen
        if chosen.place is not None
        for row in _reason_of(asked, people, chosen, chosen.place, task, method)
    ]


def _reason_of(
    asked: Asked, people: People, chosen: Chosen, place: int, task: str, method: str
) -> list[tuple[object, ...]]:
    """Return the rows that explain one object at its place."""
    model, item = asked.model, chosen.item
    density, smooth = asked.found(method, item.category)
    is_mixed = method == "dp_object"
    human = asked.found("dp", item.category)[0] if is_mixed else density
    share = asked.choices.object_weight if is_mixed else 1.0
    use = model.use(people.theta, item.category)
    explanation = explain(
        use,
        people.weight[item.category],
        Field(density, smooth, human, share),
        (place, chosen.heading_probability),
        model.yaws,
        (model.candidates.location, asked.allowed[item.object_id]),
    )
    key = (model.scene.scene, task, method, asked.question.name)
    names = [area.area for area in model.scene.areas]
    named = (*key, item.object_id, item.category)
    return explanation_rows(named, explanation, use, model.candidates, names)


def region_areas_of(
    densities: Mapping[str, Array], ranks: Array, spacing_m: float
) -> Mapping[str, list[float]]:
    """Return the area of the region of each level of `REGION_LEVELS` per category [m²].

    `densities` (p,) per category; `ranks` of the labelled places of training scenes
    calibrate the regions.
    """
    thresholds = calibrate(ranks, REGION_LEVELS)
    return {
        category: region_areas(density, thresholds, spacing_m).tolist()
        for category, density in densities.items()
    }
