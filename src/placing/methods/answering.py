"""Answer a question with every method: densities over places, then placements.

Every method gives a density over the same places of the scene; the places that do not
fit an object are taken out the same way for all, so that errors and negative log
densities compare.

Shapes: p places, q valid poses, n objects.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from placing import rigid
from placing.candidates import is_unoccupied
from placing.learning.learned import Choices, theta_name
from placing.methods.decision import choose_places
from placing.methods.names import HUMAN_METHODS
from placing.methods.scene_model import SceneModel
from placing.people.hallucinating import People, hallucinate, random_people
from placing.scene import Placement, SceneObject
from placing.tasks import Question

Array = NDArray[np.float64]

NO_PLACE = "no place fits"
NO_POSE = "no valid human pose: chance"
NO_EXAMPLE = "no training example: common prior"
"""Reasons why an answer is not what it could be."""


@dataclass(frozen=True)
class Chosen:
    """What a method chose for one wanted object."""

    item: SceneObject
    place: int | None
    """Index of the place; None where no place fits."""
    heading: int
    """Index into the headings that placements may have."""
    heading_probability: float
    placement: Placement | None
    reason: str
    """Why the answer is not what it could be; empty where nothing is amiss."""


@dataclass(frozen=True)
class Answer:
    """What a method says to a question."""

    chosen: tuple[Chosen, ...]
    """One per wanted object."""
    densities: Mapping[str, Array]
    """(p,) per wanted category; 0 at places that fit no object of it."""
    people: People | None
    """Where the users are; None for a method without humans."""


class Asked:
    """A question put to a scene: what the methods that answer it share."""

    def __init__(
        self,
        stream: Callable[[str], Generator],
        model: SceneModel,
        question: Question,
        choices: Choices,
    ) -> None:
        """Find where each wanted object fits; `stream` gives the stream of a method."""
        self.model, self.question, self.choices = model, question, choices
        self.stream = stream
        self._people: dict[str, People] = {}
        self._found: dict[tuple[str, str], tuple[Array, Array]] = {}
        given = [model.given_box(question.labels, p) for p in question.given]
        boxes = np.array(given).reshape(-1, 7)
        self.allowed = {
            item.object_id: model.fits[item.object_id]
            & is_unoccupied(model.candidates, item, boxes)
            for item in question.wanted
        }

    def answer(self, method: str) -> Answer:
        """Return densities and placements of the wanted objects."""
        rng = self.stream(method)
        people = self.people(rng, method)
        chosen, densities = [], {}
        for category in self.question.categories:
            items = self.question.of_category(category)
            allowed = [self.allowed[item.object_id] for item in items]
            density, smooth = self.density(rng, method, category)
            densities[category] = self.fitting(category, density)
            config = self.model.settings.decision
            args = smooth, allowed, self.model.candidates, config
            places = choose_places(rng, *args)
            chosen += [
                self._chosen(rng, method, item, place, people)
                for item, place in zip(items, places, strict=True)
            ]
        return Answer(tuple(chosen), densities, people)

    def fitting(self, category: str, density: Array) -> Array:
        """Return a density without places that fit no object of a category, (p,)."""
        items = self.question.of_category(category)
        allowed = np.any([self.allowed[item.object_id] for item in items], axis=0)
        return only_on(allowed, density)

    def people(self, rng: Generator, method: str) -> People | None:
        """Return who uses the wanted objects; None without humans or a valid pose."""
        if method not in HUMAN_METHODS or len(self.model.poses.kind) == 0:
            return None
        if method == "dp_object":
            return self.people(self.stream("dp"), "dp")
        if method not in self._people:
            k = self.choices.n_components if method == "fmm" else 0
            self._people[method] = (
                random_people(self.model, self.question)
                if method == "random_human"
                else hallucinate(rng, self.model, self.question, k)
            )
        return self._people[method]

    def density(
        self, rng: Generator, method: str, category: str
    ) -> tuple[Array, Array]:
        """Return the density of a category over all places, and it smoothed, (p,).

        A method with humans that has none, for want of a valid pose, is `chance`.
        """
        key = method, category
        if key not in self._found:
            self._found[key] = self._density(rng, method, category)
        return self._found[key]

    def found(self, method: str, category: str) -> tuple[Array, Array]:
        """Return a density that was asked for before, and it smoothed, (p,) each."""
        return self._found[method, category]

    def _density(
        self, rng: Generator, method: str, category: str
    ) -> tuple[Array, Array]:
        """Return what `density` keeps."""
        model, question = self.model, self.question
        if method == "object":
            return model.object_density(question.labels, category, question.given)
        if method == "dp_object":
            w = self.choices.object_weight
            parts = [self.density(self.stream(m), m, category) for m in _MIXED]
            return tuple(w * h + (1 - w) * o for h, o in zip(*parts, strict=True))
        people = self.people(rng, method)
        if people is None:
            name = "chance" if method in HUMAN_METHODS else method
            return model.baseline(name, category)
        if method == "random_human":
            return model.random_density(category)
        parts = people.seen[category], people.p_new[category]
        density = model.use(people.theta, category).density(*parts)
        return density, model.smooth(density)

    def _chosen(
        self,
        rng: Generator,
        method: str,
        item: SceneObject,
        place: int | None,
        people: People | None,
    ) -> Chosen:
        """Return the placement of an object upright at a place, likeliest heading."""
        yaws = self.model.yaws
        share = np.full(len(yaws), 1 / len(yaws))
        if place is None:
            return Chosen(item, None, 0, share[0], None, NO_PLACE)
        if people is None:
            heading = int(rng.integers(len(yaws)))
        else:
            use = self.model.use(people.theta, item.category)
            share = use.heading_probability(place, people.weight[item.category], yaws)
            heading = int(np.argmax(share))
        location = self.model.candidates.location[place] + [0, 0, item.size_m[2] / 2]
        area = self.model.scene.areas[self.model.candidates.area[place]].area
        turned = rigid.yaw_quaternion(float(yaws[heading]))
        placement = Placement(item.object_id, area, location, turned)
        reason = self.reason(method, item.category)
        return Chosen(item, place, heading, float(share[heading]), placement, reason)

    def reason(self, method: str, category: str) -> str:
        """Return why a method had to fall back on something for a category."""
        model = self.model
        if method in HUMAN_METHODS and len(model.poses.kind) == 0:
            return NO_POSE
        learned = model.learned
        if method in HUMAN_METHODS:
            k = self.choices.n_components
            is_known = category in learned.thetas[theta_name(method, k)]
        elif method in learned.histograms:
            is_known = category in learned.histograms[method]
        else:
            is_known = method != "object" or category in learned.relations.pairs
        return "" if is_known else NO_EXAMPLE


def only_on(allowed: NDArray[np.bool_], density: Array) -> Array:
    """Return a density on the allowed places only, (p,), sum 1."""
    left = np.where(allowed, density, 0.0)
    return left / max(left.sum(), 1e-300)  # guards an object that fits nowhere


_MIXED = ("dp", "object")
"""The parts of `dp_object`: human context and object context."""
