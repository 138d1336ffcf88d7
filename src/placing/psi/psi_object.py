"""Psi_object of the objects of a scene (eq. 1): stability times semantics.

Psi_semantics says on which placing area an object belongs; Psi_stability says, for a
place, a heading and an orientation, whether it stays there. Both see clouds alone.

Shapes: p places, k of them, y headings, m areas, c placements.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placing import rigid
from placing.candidates import Candidates
from placing.clouds.ply import Cloud
from placing.errors import BadArtifact
from placing.psi.area_descriptors import describe_areas
from placing.psi.contacts import (
    STABILITY_FEATURES,
    PlacingField,
    rest_heights,
    stability_features,
)
from placing.psi.object_clouds import LookingConfig, ObjectCloud, object_cloud
from placing.psi.object_descriptors import describe_object, sample_object
from placing.psi.orientations import Orientation, OrientationsConfig, orientations
from placing.psi.semantics import SemanticsModel, log_psi_semantics
from placing.psi.stability import StabilityModel, log_psi_stability
from placing.scene import Scene, SceneObject

Array = NDArray[np.float64]

HELD = ("edge", "hung")
"""Orientations in which racks and holders hold what does not stand upright there."""
UPRIGHT = 0
"""Number of the orientation `upright`, the first of every object."""


@dataclass(frozen=True)
class PsiObjectConfig:
    """Settings of the object context; the values live in `config/config.yaml`."""

    probe_m: float
    """Edge of the squares whose places share one look for the density."""
    min_upright: float
    """Where an object stays upright with less probability, other ways are tried."""
    upright_share: float
    """Share of objects that stand upright; all other orientations share the rest."""


@dataclass(frozen=True)
class Stands:
    """The best way of an object to stand at each place and heading it was asked for."""

    orientation: NDArray[np.int64]
    """(k, y) number of the orientation."""
    T_world_object: Array
    """(k, y, 7) wxyz + xyz."""
    log_stability: Array
    """(k, y) log Psi_stability."""
    log_share: Array
    """(k, y) log share of the orientation among those of objects."""

    @property
    def log_psi(self) -> Array:
        """Psi_stability times the share of the orientation, in logs, shape (k, y)."""
        return self.log_stability + self.log_share


class PsiObject:
    """The object context of one scene."""

    def __init__(
        self,
        scene: Scene,
        cloud: Cloud,
        candidates: Candidates,
        models: tuple[StabilityModel, SemanticsModel],
        config: tuple[PsiObjectConfig, LookingConfig, OrientationsConfig],
    ) -> None:
        """Look at the cloud once for all objects."""
        self.scene, self.candidates = scene, candidates
        self.config, self.looking, self._orienting = config
        self._stability, self._semantics = models
        if self._stability.features != STABILITY_FEATURES:
            names = ", ".join(self._stability.features)
            raise BadArtifact(
                f"model of stability: features: {names}; expected those of this"
                " version: learn it again"
            )
        self.field = PlacingField(cloud, self.looking.cell_m)
        self._areas = describe_areas(cloud, scene.areas, candidates)
        self._clouds: dict[str, ObjectCloud] = {}
        self._ways: dict[str, tuple[Orientation, ...]] = {}
        self._belongs: dict[str, Array] = {}

    def ways(self, item: SceneObject) -> tuple[Orientation, ...]:
        """Return the orientations of an object."""
        if item.object_id not in self._ways:
            found = orientations(self.cloud(item), self._orienting)
            self._ways[item.object_id] = found
        return self._ways[item.object_id]

    def cloud(self, item: SceneObject) -> ObjectCloud:
        """Return the cloud of an object."""
        if item.object_id not in self._clouds:
            spacing = self.looking.object_spacing_m
            self._clouds[item.object_id] = object_cloud(item, spacing)
        return self._clouds[item.object_id]

    def log_semantics(self, item: SceneObject) -> Array:
        """Return log Psi_semantics of an object on each placing area, shape (m,)."""
        if not self.scene.areas:
            return np.empty(0)
        if item.object_id not in self._belongs:
            shown = sample_object(item, self.looking.object_spacing_m)
            args = describe_object(item, shown), self._areas
            found = log_psi_semantics(self._semantics, *args)
            self._belongs[item.object_id] = found
        return self._belongs[item.object_id]

    def stands(
        self,
        item: SceneObject,
        places: NDArray[np.int64],
        yaws: Array,
        others: tuple[str, ...] = (),
    ) -> Stands:
        """Return how an object best stands at places (k,) with headings (y,).

        Upright where it stays so; other orientations, or those called `others` alone,
        are tried at the places where it does not.
        """
        ways = self.ways(item)
        rest = (1 - self.config.upright_share) / max(len(ways) - 1, 1)
        shares = np.log([self.config.upright_share] + [rest] * (len(ways) - 1))
        best = self._standing(item, UPRIGHT, float(shares[UPRIGHT]), places, yaws)
        falls = best.log_stability.max(1, initial=-np.inf) < np.log(
            self.config.min_upright
        )
        for way in range(1, len(ways)):
            if not falls.any() or (others and ways[way].name not in others):
                continue
            args = float(shares[way]), places[falls], yaws
            _take_better(best, falls, self._standing(item, way, *args))
        return best

    def density(
        self, item: SceneObject, allowed: NDArray[np.bool_], yaws: Array
    ) -> Array:
        """Return the density of an object over the places, (p,), sum 1 unless all is 0.

        Psi_semantics of the area times Psi_stability at the best heading.
        """
        places = np.flatnonzero(allowed)
        probed, of_square = self._squares(places)
        turns = yaws[[0, len(yaws) // 4]]  # boxes look alike from opposite sides
        log_psi = np.full(len(allowed), -np.inf)
        if len(places):
            stable = self.stands(item, probed, turns, HELD).log_psi.max(1)
            area = self.candidates.area[places]
            log_psi[places] = stable[of_square] + self.log_semantics(item)[area]
        psi = np.exp(log_psi - log_psi.max(initial=-700.0))
        return psi / max(psi.sum(), 1e-300)

    def log_stack(self, upper: SceneObject, lower: SceneObject) -> float:
        """Return log Psi_stability of an object upright on the middle of another."""
        shown = sample_object(lower, self.looking.object_spacing_m)
        top = np.array([lower.size_m[2] / 2])
        upright, middle = np.array([rigid.IDENTITY]), np.zeros((1, 2))
        field = PlacingField(shown, self.looking.cell_m)
        cloud = self.cloud(upper)
        height = rest_heights(field, cloud, upright, middle, top)
        T = np.column_stack([upright, middle, height])
        features = stability_features(field, cloud, T, top)
        return float(log_psi_stability(self._stability, features)[0])

    def _squares(
        self, places: NDArray[np.int64]
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return one place of each square of places, (s,), and the square of each."""
        square = np.floor(self.candidates.location[places, :2] / self.config.probe_m)
        key = np.column_stack([self.candidates.area[places], square])
        _, first, of = np.unique(key, axis=0, return_index=True, return_inverse=True)
        return places[first], of.ravel()

    def _standing(
        self,
        item: SceneObject,
        way: int,
        log_share: float,
        places: NDArray[np.int64],
        yaws: Array,
    ) -> Stands:
        """Return how an object stands at places and headings in one orientation."""
        shape = len(places), len(yaws)
        turned = self.ways(item)[way].quaternion
        of_yaw = [rigid.multiply(rigid.yaw_quaternion(y), turned) for y in yaws]
        quaternion = np.tile(of_yaw, (len(places), 1))  # (c, 4)
        at = np.repeat(self.candidates.location[places], len(yaws), axis=0)  # (c, 3)
        cloud = self.cloud(item)
        args = self.field, cloud, quaternion, at[:, :2], at[:, 2]
        T = np.column_stack([quaternion, at[:, :2], rest_heights(*args)])
        features = stability_features(self.field, cloud, T, at[:, 2])
        log_stability = log_psi_stability(self._stability, features)
        return Stands(
            np.full(shape, way),
            T.reshape(*shape, 7),
            log_stability.reshape(shape),
            np.full(shape, log_share),
        )


def _take_better(best: Stands, rows: NDArray[np.bool_], other: Stands) -> None:
    """Put another orientation into the rows of `best` where its Psi is larger."""
    at = np.flatnonzero(rows)
    i, j = np.nonzero(other.log_psi > best.log_psi[at])
    for name, values in vars(best).items():
        values[at[i], j] = getattr(other, name)[i, j]


def box_of(cloud: ObjectCloud, quaternion: Array) -> tuple[Array, Array]:
    """Return centre (3,) and size (3,) of the box around an object so turned [m]."""
    points = cloud.points @ rigid.matrix(quaternion).T
    low, high = points.min(0), points.max(0)
    return (low + high) / 2, high - low
