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
from placing.arranging import ArrangingConfig, UseOfObject
from placing.baselines import BaselinesConfig, chance_density, histogram_density
from placing.candidates import Candidates, CandidatesConfig, fits, is_unoccupied
from placing.decision import DecisionConfig, Smoother, choose_places
from placing.fitting import BROAD
from placing.human import HumanPoses, headings
from placing.potential import Theta, log_psi_human
from placing.scene import Placement, Scene, SceneObject, extents
from placing.tasks import Question

Array = NDArray[np.float64]

METHODS = ("chance", "height", "room", "dp")


@dataclass(frozen=True)
class Learned:
    """What a fold has learned from its training scenes."""

    thetas: Mapping[str, Theta]
    histograms: Mapping[str, Mapping[str, Array]]
    """Per baseline and category."""


@dataclass(frozen=True)
class Settings:
    """The sections of the configuration that answering looks at."""

    candidates: CandidatesConfig
    sampling: dpmm.DpmmConfig
    arranging: ArrangingConfig
    decision: DecisionConfig
    baselines: BaselinesConfig


@dataclass(frozen=True)
class Answer:
    """What a method says to a question."""

    placements: tuple[tuple[SceneObject, Placement | None], ...]
    """The placement of each wanted object; None where no place fits."""
    densities: Mapping[str, Array]
    """(p,) per wanted category; 0 at places that fit no object of it."""
    chain: dpmm.Chain | None
    """The sampled poses of a method with humans; columns are given, then wanted."""


class Answerer:
    """Answers the questions about one scene."""

    def __init__(
        self,
        scene: Scene,
        candidates: Candidates,
        poses: HumanPoses,
        learned: Learned,
        settings: Settings,
    ) -> None:
        """Keep what all questions about the scene share."""
        self.scene, self.candidates, self.poses = scene, candidates, poses
        self.learned, self.settings = learned, settings
        self.items = {item.object_id: item for item in scene.objects}
        spacing = settings.candidates.spacing_m
        self._smoother = Smoother(candidates, spacing, settings.decision.smoothing_m)
        self._fits = {
            item.object_id: fits(candidates, item, settings.candidates.min_overlap)
            for item in scene.objects
        }
        self._references = poses.references()
        self._uses: dict[str, tuple[UseOfObject, Array]] = {}
        self._given_rows: dict[tuple[str, str], NDArray[np.float32]] = {}
        self._yaws = headings(settings.candidates.n_headings)

    def answer(self, rng: Generator, question: Question, method: str) -> Answer:
        """Return densities and placements of the wanted objects."""
        by_category: dict[str, list[SceneObject]] = {}
        for item in question.wanted:
            by_category.setdefault(item.category, []).append(item)
        boxes = self._boxes(question.given)
        chain = self._sample(rng, question) if method == "dp" else None
        placements, densities = [], {}
        for category, items in sorted(by_category.items()):
            weight = self._pose_weight(question, chain, category)
            density = self._density(method, category, weight)
            allowed = [
                self._fits[item.object_id] & is_unoccupied(self.candidates, item, boxes)
                for item in items
            ]
            density = np.where(np.any(allowed, axis=0), density, 0.0)
            densities[category] = density / max(density.sum(), 1e-300)
            placements += self._place(rng, items, densities[category], allowed, weight)
        return Answer(tuple(placements), densities, chain)

    def _boxes(self, given: tuple[Placement, ...]) -> Array:
        """Return centre, size and yaw of given objects, shape (n, 7)."""
        boxes = np.empty((len(given), 7))
        for box, placement in zip(boxes, given, strict=True):
            item = self.items[placement.object_id]
            is_upright = abs(extents(item, placement)[2] - item.size_m[2]) < 1e-6
            size = item.size_m if is_upright else extents(item, placement)
            yaw = rigid.yaw_of(placement.orientation) if is_upright else 0.0
            box[:3], box[3:6], box[6] = placement.location, size, yaw
        return boxes

    def _use(self, category: str) -> tuple[UseOfObject, Array]:
        """Return the use of a category in this scene and its row, computed once."""
        if category not in self._uses:
            sizes = [o.size_m for o in self.scene.objects if o.category == category]
            use = UseOfObject(
                self.learned.thetas.get(category, BROAD),
                self.candidates,
                self.poses,
                self.settings.candidates.spacing_m,
                float(np.mean(sizes, axis=0)[2]) / 2,
                self.settings.arranging,
            )
            self._uses[category] = use, use.row()
        return self._uses[category]

    def _sample(self, rng: Generator, question: Question) -> dpmm.Chain | None:
        """Return the poses sampled for a question, None where no pose is valid."""
        if len(self.poses.kind) == 0:
            return None
        rows = [self._given_row(question.labels, given) for given in question.given]
        rows += [dpmm.scale_row(self._use(o.category)[1]) for o in question.wanted]
        prior, config = self.poses.prior, self.settings.sampling
        return dpmm.sample(rng, np.stack(rows), prior, config)

    def _given_row(self, labels: str, placement: Placement) -> NDArray[np.float32]:
        """Return Psi_human of a given object with every pose, scaled, shape (q,)."""
        key = labels, placement.object_id
        if key not in self._given_rows:
            item = self.items[placement.object_id]
            yaw = float(rigid.yaw_of(placement.orientation))
            log_psi = log_psi_human(
                self.learned.thetas.get(item.category, BROAD),
                np.array([[*placement.location, yaw]]),
                np.array([item.has_front]),
                self._references,
            )
            self._given_rows[key] = dpmm.weight_rows(log_psi)[0]
        return self._given_rows[key]

    def _pose_weight(
        self, question: Question, chain: dpmm.Chain | None, category: str
    ) -> Array | None:
        """Return how often the category's wanted objects picked each pose, (q,)."""
        if chain is None:
            return None
        n_given = len(question.given)
        columns = [
            n_given + i
            for i, item in enumerate(question.wanted)
            if item.category == category
        ]
        picked = chain.pose[:, columns].ravel()
        return np.bincount(picked, minlength=len(self.poses.kind)) / len(picked)

    def _density(self, method: str, category: str, weight: Array | None) -> Array:
        """Return the density of a category over all places, shape (p,)."""
        if weight is not None:
            use, row = self._use(category)
            return use.density(weight, row)
        histogram = self.learned.histograms.get(method, {}).get(category)
        if histogram is None:
            return chance_density(self.candidates)
        config = self.settings.baselines
        return histogram_density(histogram, self.candidates, method, config)

    def _place(
        self,
        rng: Generator,
        items: list[SceneObject],
        density: Array,
        allowed: list[NDArray[np.bool_]],
        weight: Array | None,
    ) -> list[tuple[SceneObject, Placement | None]]:
        """Return a placement per object of one category."""
        config, smooth = self.settings.decision, self._smoother(density)
        chosen = choose_places(rng, smooth, allowed, self.candidates, config)
        return [
            (item, None if p is None else self._placement(rng, item, p, weight))
            for item, p in zip(items, chosen, strict=True)
        ]

    def _placement(
        self, rng: Generator, item: SceneObject, place: int, weight: Array | None
    ) -> Placement:
        """Return the placement of an object upright at a place."""
        if weight is None:
            yaw = float(rng.choice(self._yaws))
        else:
            use, row = self._use(item.category)
            yaw = use.heading(place, weight, row, self._yaws)
        location = self.candidates.location[place] + [0, 0, item.size_m[2] / 2]
        area = self.scene.areas[self.candidates.area[place]].area
        return Placement(item.object_id, area, location, rigid.yaw_quaternion(yaw))
