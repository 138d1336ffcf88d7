"""What a fold has learned, applied to one scene: computed once, used by all questions.

Shapes: p places, q valid poses.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placing import rigid
from placing.candidates import Candidates, CandidatesConfig, fits
from placing.learning.fitting import BROAD
from placing.learning.learned import Learned
from placing.learning.likelihoods import nearest_places
from placing.methods.arranging import UseOfObject
from placing.methods.baselines import BaselinesConfig, chance_density, histogram_density
from placing.methods.decision import DecisionConfig, Smoother
from placing.methods.object_context import given_object, mix, pair_density
from placing.people import dpmm
from placing.people.diagnostics import DiagnosticsConfig
from placing.people.human import HumanPoses, headings
from placing.people.lattice import ArrangingConfig, Lattice
from placing.people.potential import Theta, log_psi_human
from placing.scene import Placement, Scene, standing_box

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Settings:
    """The sections of the configuration that answering looks at."""

    candidates: CandidatesConfig
    sampling: dpmm.DpmmConfig
    diagnostics: DiagnosticsConfig
    arranging: ArrangingConfig
    decision: DecisionConfig
    baselines: BaselinesConfig


class SceneModel:
    """A scene with everything that does not depend on the question."""

    def __init__(
        self,
        scene: Scene,
        candidates: Candidates,
        poses: HumanPoses,
        learned: Learned,
        settings: Settings,
    ) -> None:
        """Find the places that each object fits; the rest is computed when asked."""
        self.scene, self.candidates, self.poses = scene, candidates, poses
        self.learned, self.settings = learned, settings
        self.items = {item.object_id: item for item in scene.objects}
        spacing = settings.candidates.spacing_m
        self.smooth = Smoother(candidates, spacing, settings.decision.smoothing_m)
        self.fits = {
            item.object_id: fits(candidates, item, settings.candidates.min_overlap)
            for item in scene.objects
        }
        self.nearest = nearest_places(scene, candidates.location)
        self.yaws = headings(settings.candidates.n_headings)
        self._references = poses.references()
        self._lattice = Lattice(candidates, poses, spacing, settings.arranging)
        self._uses: dict[tuple[str, str], UseOfObject] = {}
        self._wanted_rows: dict[tuple[str, str], NDArray[np.float32]] = {}
        self._given_rows: dict[tuple[str, str, str], NDArray[np.float32]] = {}
        self._boxes: dict[tuple[str, str], Array] = {}
        self._baselines: dict[tuple[str, str], tuple[Array, Array]] = {}
        self._random: dict[str, tuple[Array, Array]] = {}
        self._suggested: dict[
            tuple[str, str, str], tuple[NDArray[np.float32], float]
        ] = {}

    def use(self, theta: str, category: str) -> UseOfObject:
        """Return how people use a category here, under the Theta of that name."""
        if (theta, category) not in self._uses:
            self._uses[theta, category] = UseOfObject(
                self.theta(theta, category), self._lattice, self._half_height(category)
            )
        return self._uses[theta, category]

    def theta(self, theta: str, category: str) -> Theta:
        """Return the Theta of a category, the broad one where none was learned."""
        return self.learned.thetas[theta].get(category, BROAD)

    def wanted_row(self, theta: str, category: str) -> NDArray[np.float32]:
        """Return Z of every pose for a wanted object, scaled, shape (q,)."""
        if (theta, category) not in self._wanted_rows:
            row = dpmm.scale_row(self.use(theta, category).row())
            self._wanted_rows[theta, category] = row
        return self._wanted_rows[theta, category]

    def given_row(
        self, theta: str, labels: str, placement: Placement
    ) -> NDArray[np.float32]:
        """Return Psi_human of a given object with every pose, scaled, shape (q,)."""
        key = theta, labels, placement.object_id
        if key not in self._given_rows:
            item = self.items[placement.object_id]
            yaw = float(rigid.yaw_of(placement.orientation))
            log_psi = log_psi_human(
                self.theta(theta, item.category),
                np.array([[*placement.location, yaw]]),
                np.array([item.has_front]),
                self._references,
            )
            self._given_rows[key] = dpmm.weight_rows(log_psi)[0]
        return self._given_rows[key]

    def given_box(self, labels: str, placement: Placement) -> Array:
        """Return centre, size and yaw of a given object, shape (7,)."""
        key = labels, placement.object_id
        if key not in self._boxes:
            item = self.items[placement.object_id]
            self._boxes[key] = standing_box(item, placement)
        return self._boxes[key]

    def baseline(self, method: str, category: str) -> tuple[Array, Array]:
        """Return the density of a method without humans, and it smoothed, (p,) each."""
        if (method, category) not in self._baselines:
            histogram = self.learned.histograms.get(method, {}).get(category)
            if histogram is None:
                density = chance_density(self.candidates)
            else:
                config = self.settings.baselines
                args = (histogram, self.candidates, method, config)
                density = histogram_density(*args)
            self._baselines[method, category] = density, self.smooth(density)
        return self._baselines[method, category]

    def random_density(self, category: str) -> tuple[Array, Array]:
        """Return the density by people drawn from P0, and it smoothed, (p,) each."""
        if category not in self._random:
            density = self.use("dp", category).density(self.poses.prior)
            self._random[category] = density, self.smooth(density)
        return self._random[category]

    def object_density(
        self, labels: str, category: str, given: Sequence[Placement]
    ) -> tuple[Array, Array]:
        """Return the density of the object context, and it smoothed, (p,) each."""
        parts = []
        for placement in given:
            key = labels, placement.object_id, category
            if key not in self._suggested:
                self._suggested[key] = pair_density(
                    self.learned.relations,
                    category,
                    given_object(self.items[placement.object_id], placement),
                    self.candidates,
                    self._half_height(category),
                )
            parts.append(self._suggested[key])
        n_places = len(self.candidates.location)
        density = mix(parts, n_places, self.learned.relations.sharpness)
        return density, self.smooth(density)

    def _half_height(self, category: str) -> float:
        """Return half the mean height of the objects of a category [m]."""
        sizes = [o.size_m for o in self.scene.objects if o.category == category]
        return float(np.mean(sizes, axis=0)[2]) / 2
