"""What a fold has learned, applied to one scene: computed once, used by all questions.

Shapes: p places, q valid poses.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placing import dpmm, rigid
from placing.arranging import ArrangingConfig, UseOfObject
from placing.baselines import BaselinesConfig, chance_density, histogram_density
from placing.candidates import Candidates, CandidatesConfig, fits
from placing.decision import DecisionConfig, Smoother
from placing.fitting import BROAD
from placing.human import HumanPoses, headings
from placing.potential import Theta, log_psi_human
from placing.scene import Placement, Scene, extents

Array = NDArray[np.float64]


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
        self.yaws = headings(settings.candidates.n_headings)
        self._references = poses.references()
        self._uses: dict[str, tuple[UseOfObject, Array]] = {}
        self._given_rows: dict[tuple[str, str], NDArray[np.float32]] = {}
        self._boxes: dict[tuple[str, str], Array] = {}
        self._baselines: dict[tuple[str, str], tuple[Array, Array]] = {}

    def use(self, category: str) -> tuple[UseOfObject, Array]:
        """Return how people use a category here, and Z of every pose."""
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

    def given_row(self, labels: str, placement: Placement) -> NDArray[np.float32]:
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

    def given_box(self, labels: str, placement: Placement) -> Array:
        """Return centre, size and yaw of a given object, shape (7,)."""
        key = labels, placement.object_id
        if key not in self._boxes:
            item = self.items[placement.object_id]
            size, yaw = extents(item, placement), 0.0
            if abs(size[2] - item.size_m[2]) < 1e-6:  # it stands upright
                size, yaw = item.size_m, float(rigid.yaw_of(placement.orientation))
            self._boxes[key] = np.array([*placement.location, *size, yaw])
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
