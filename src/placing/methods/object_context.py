"""Object context between pairs of objects: Psi_obj(O, G) of Section 4.1 and Figure 6.

Seen from a given object of category b, an object of category a lies at a distance, in a
direction (where b has a front) and at a height that the labelled arrangements teach per
ordered pair of categories. Each given object spreads the wanted one over the places of
the scene, and these densities are mixed.

ASSUME: the paper gives Psi_obj no formula. The families are those of Psi_human, with
the given object in place of the person; pairs seen seldom lean a little on all pairs,
and a density that says more weighs more. That mixture has a larger held-out likelihood
on the training folds of `rooms` than one with weights learned by EM and than a product
over the given objects, whichever fold is held out.

Shapes: p places.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from placing import rigid
from placing.candidates import Candidates
from placing.learning.fitting import FittingConfig, expected_statistics, fit
from placing.methods.pair_statistics import NO_PAIRS, pair_sums
from placing.people.potential import MIN_DISTANCE_M, Theta
from placing.scene import Arrangement, Placement, Scene, SceneObject

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ObjectContextConfig:
    """Settings of the object context; the values live in `config/config.yaml`."""

    prior_strength: float
    """How many scenes the relation of all pairs counts for in a pair of categories."""
    max_kappa: float
    min_log_distance_sigma: float
    min_height_sigma_m: float
    sharpness: float
    """A given object weighs exp(-sharpness * entropy of its density)."""


@dataclass(frozen=True)
class Relations:
    """Where objects lie in the frames of others, as a fold has learned it.

    Distances, bearings and heights are from the centre of the given object to that of
    the wanted one; the bearing counts only where the given object has a front.
    """

    common: Theta
    """Of all pairs; stands in for categories that were never seen together."""
    pairs: Mapping[str, Mapping[str, Theta]]
    """By wanted, then by given category."""
    sharpness: float


class Given(NamedTuple):
    """An object that stands in the scene already."""

    category: str
    location: Array
    """(3,) centre [m]."""
    yaw_rad: float
    """NaN where the object has no front."""


# ASSUME: two objects of a room are a metre or two apart, at any side of each other.
BROAD_RELATION = Theta(np.log(1.5), 0.8, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0)


def given_object(item: SceneObject, placement: Placement) -> Given:
    """Return a placed object as the relations see it."""
    yaw = float(rigid.yaw_of(placement.orientation)) if item.has_front else np.nan
    return Given(item.category, placement.location, yaw)


def learn_relations(
    arrangements: Sequence[tuple[Scene, Arrangement]], config: ObjectContextConfig
) -> Relations:
    """Return the relation of every ordered pair of categories seen together.

    All arrangements of a scene count as much as one, since they resemble each other.
    """
    names = [scene.scene for scene, _ in arrangements]
    sums: dict[tuple[str, str], Array] = {}
    for scene, arrangement in arrangements:
        weight = 1 / names.count(scene.scene)
        for key, statistics in _sums(scene, arrangement).items():
            sums[key] = sums.get(key, NO_PAIRS) + weight * statistics
    common = _fit(sum(sums.values(), NO_PAIRS), BROAD_RELATION, config)
    pairs: dict[str, dict[str, Theta]] = {}
    for (wanted, given), total in sorted(sums.items()):
        pairs.setdefault(wanted, {})[given] = _fit(total, common, config)
    return Relations(common, pairs, config.sharpness)


def pair_density(
    relations: Relations,
    category: str,
    given: Given,
    candidates: Candidates,
    half_height_m: float,
) -> tuple[NDArray[np.float32], float]:
    """Return the density that one given object suggests, (p,), and its entropy [nats].

    It depends on the given object alone, so that questions can share it.
    """
    theta = relations.pairs.get(category, {}).get(given.category, relations.common)
    if len(candidates.location) == 0:
        return np.empty(0, np.float32), 0.0
    lowered = given.location - [0.0, 0.0, half_height_m]
    offset = np.subtract(candidates.location.T, lowered[:, None], order="C")
    logs = _log_psi(theta, offset.astype(np.float32), given.yaw_rad)
    logs -= logs.max()
    density = np.exp(logs)
    total = float(density.sum(dtype=float))
    density /= np.float32(total)
    return density, float(np.log(total) - density @ logs)


def mix(
    parts: Sequence[tuple[NDArray[np.float32], float]],
    n_places: int,
    sharpness: float,
) -> Array:
    """Return the mixture of what the given objects suggest, shape (p,), sum 1.

    `parts` holds what `pair_density` returns for each given object.
    """
    if not parts:
        return np.full(n_places, 1 / max(n_places, 1))
    entropy = np.array([value for _, value in parts])
    weight = np.exp(-sharpness * (entropy - entropy.min()))
    density = np.zeros(n_places)
    for share, (part, _) in zip(weight, parts, strict=True):
        density += np.float32(share) * part
    return density / max(density.sum(), 1e-300)  # guards a scene without places


def _log_psi(
    theta: Theta, offset: NDArray[np.float32], yaw_rad: float
) -> NDArray[np.float32]:
    """Return log Psi_loc up to a constant at offsets (3, p) from a given object, (p,).

    The formula of `potential`, written for one object and all places in single
    precision, which takes a third of the time.
    """
    m_d, s_d, m_r, k_r, m_h, s_h, _, _ = theta.vector().astype(np.float32)
    dx, dy, dz = offset
    squared = np.maximum(dx * dx + dy * dy, np.float32(MIN_DISTANCE_M**2))
    log_squared = np.log(squared)
    u, v = (np.float32(0.5) * log_squared - m_d) / s_d, (dz - m_h) / s_h
    logs = np.float32(-0.5) * (u * u + v * v) - log_squared
    if np.isfinite(yaw_rad):
        ahead = np.float32(yaw_rad) + m_r
        logs += k_r * (np.cos(ahead) * dx + np.sin(ahead) * dy) / np.sqrt(squared)
    return logs


def _sums(scene: Scene, arrangement: Arrangement) -> dict[tuple[str, str], Array]:
    """Return the statistics of an arrangement by wanted and given category."""
    items = {item.object_id: item for item in scene.objects}
    placements = sorted(arrangement.placements, key=lambda p: p.object_id)
    placed = [given_object(items[p.object_id], p) for p in placements]
    return pair_sums(
        [one.category for one in placed],
        np.array([one.location for one in placed]).reshape(-1, 3),
        np.array([one.yaw_rad for one in placed]),
    )


def _fit(sums: Array, prior: Theta, config: ObjectContextConfig) -> Theta:
    """Return the relation of some pairs, which leans on a prior."""
    bounds = FittingConfig(
        0.0,
        config.max_kappa,
        config.min_log_distance_sigma,
        config.min_height_sigma_m,
    )
    return fit(sums + config.prior_strength * expected_statistics(prior), bounds)
