"""Answer a question with a method: densities over places, then placements.

Every method gives a density over the same places of the scene; the places that do not
fit an object are taken out the same way for all, so that errors and negative log
densities compare.

Shapes: p places, q valid poses, n objects.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from placing import dpmm, rigid
from placing.candidates import is_unoccupied
from placing.decision import choose_places
from placing.scene import Placement, SceneObject
from placing.scene_model import SceneModel
from placing.tasks import Question

Array = NDArray[np.float64]

METHODS = ("chance", "height", "room", "dp")


@dataclass(frozen=True)
class Answer:
    """What a method says to a question."""

    placements: tuple[tuple[SceneObject, Placement | None], ...]
    """The placement of each wanted object; None where no place fits."""
    densities: Mapping[str, Array]
    """(p,) per wanted category; 0 at places that fit no object of it."""
    chains: dpmm.Chains | None
    """The sampled poses of a method with humans; objects are given, then wanted."""


def answer(
    rng: Generator, model: SceneModel, question: Question, method: str
) -> Answer:
    """Return densities and placements of the wanted objects."""
    by_category: dict[str, list[SceneObject]] = {}
    for item in question.wanted:
        by_category.setdefault(item.category, []).append(item)
    given = [model.given_box(question.labels, given) for given in question.given]
    boxes = np.array(given).reshape(-1, 7)
    names = sorted(by_category)
    chains = _sample(rng, model, question, names) if method == "dp" else None
    placements, densities = [], {}
    for slot, category in enumerate(names):
        items = by_category[category]
        weight = None if chains is None else _pose_weight(chains, slot)
        density, smooth = _density(model, method, category, weight)
        allowed = [
            model.fits[item.object_id] & is_unoccupied(model.candidates, item, boxes)
            for item in items
        ]
        fitting = np.where(np.any(allowed, axis=0), density, 0.0)
        densities[category] = fitting / max(fitting.sum(), 1e-300)  # guards no place
        config = model.settings.decision
        chosen = choose_places(rng, smooth, allowed, model.candidates, config)
        placements += [
            (item, None if p is None else _placement(rng, model, item, p, weight))
            for item, p in zip(items, chosen, strict=True)
        ]
    return Answer(tuple(placements), densities, chains)


def _sample(
    rng: Generator, model: SceneModel, question: Question, categories: list[str]
) -> dpmm.Chains | None:
    """Return the poses sampled for a question, None where no pose is valid."""
    if len(model.poses.kind) == 0:
        return None
    rows = [model.given_row(question.labels, given) for given in question.given]
    rows += [dpmm.scale_row(model.use(item.category)[1]) for item in question.wanted]
    slots = [-1] * len(question.given)
    slots += [categories.index(item.category) for item in question.wanted]
    config, prior = model.settings.sampling, model.poses.prior
    return dpmm.sample(rng, np.stack(rows), prior, config, np.array(slots))


def _pose_weight(chains: dpmm.Chains, slot: int) -> Array:
    """Return how likely the wanted objects of a slot are to pick each pose, (q,)."""
    weight = chains.weight[:, slot, :-1].mean(0)
    return weight / weight.sum()


def _density(
    model: SceneModel, method: str, category: str, weight: Array | None
) -> tuple[Array, Array]:
    """Return the density of a category over all places, and it smoothed, (p,) each.

    A method with humans that has none, for want of a valid pose, is `chance`.
    """
    if weight is None:
        return model.baseline("chance" if method == "dp" else method, category)
    use, row = model.use(category)
    density = use.density(weight, row)
    return density, model.smooth(density)


def _placement(
    rng: Generator,
    model: SceneModel,
    item: SceneObject,
    place: int,
    weight: Array | None,
) -> Placement:
    """Return the placement of an object upright at a place."""
    if weight is None:
        yaw = float(rng.choice(model.yaws))
    else:
        use, row = model.use(item.category)
        yaw = use.heading(place, weight, row, model.yaws)
    location = model.candidates.location[place] + [0, 0, item.size_m[2] / 2]
    area = model.scene.areas[model.candidates.area[place]].area
    return Placement(item.object_id, area, location, rigid.yaw_quaternion(yaw))
