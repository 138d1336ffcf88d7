"""Psi_semantics (Section 3.1): whether an object belongs on a placing area.

Learned from where labellers put objects: each object against every placing area of its
scene, from the looks of both alone (`object_descriptors`, `area_descriptors`). The
model is a logistic regression on a Gaussian kernel over pairs of object and area, whose
log odds are calibrated on scenes that it has not seen.

ASSUME: the paper names the features and not the learner. On the labelled scenes of
`rooms`, the kernel has a lower held-out log loss than logistic regressions on the
products of the two descriptors, with and without hinges.

Shapes: n objects, m areas, d and e numbers that describe an object and an area, r
pairs, k landmarks.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from placing.psi.area_descriptors import without_softness

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SemanticsConfig:
    """How semantics are learned; the values live in `config/config.yaml`."""

    n_landmarks: int
    """Pairs of object and area that every pair is compared with."""
    widths: tuple[float, ...]
    """Widths of the kernel that are tried."""
    looseness: tuple[float, ...]
    """Inverse strengths of the penalty that are tried."""
    n_parts: int
    """Parts of the training scenes, each held out once to choose and to calibrate."""


@dataclass(frozen=True)
class LabelledScene:
    """Objects and placing areas of a scene, and how often a label joins them."""

    scene: str
    objects: Array
    """(n, d)."""
    areas: Array
    """(m, e)."""
    shares: Array
    """(n, m) share of the labellers who put the object on the area."""


@dataclass(frozen=True)
class SemanticsModel:
    """What was learned: numbers only."""

    mean: Array
    """(d + e,) of the descriptors of pairs."""
    scale: Array
    """(d + e,) by which they are divided, so that the kernel's width is 1."""
    landmarks: Array
    """(k, d + e) pairs, scaled."""
    weights: Array
    """(k,) log odds per unit of the kernel."""
    intercept: float
    """Log odds of a pair that is like no landmark."""


def log_psi_semantics(model: SemanticsModel, described: Array, areas: Array) -> Array:
    """Return the log probability that an object belongs on each area, shape (m,).

    `described` (d,) is the object, `areas` (m, e) the placing areas of its scene.
    """
    odds = log_odds(model, described[None], areas)[0]
    return -np.logaddexp(0.0, -odds)


def log_odds(model: SemanticsModel, objects: Array, areas: Array) -> Array:
    """Return the log odds that objects (n, d) belong on areas (m, e), shape (n, m)."""
    scaled = (pairs(objects, areas) - model.mean) / model.scale
    odds = kernel(scaled, model.landmarks) @ model.weights + model.intercept
    return odds.reshape(len(objects), len(areas))


def learn_semantics(
    rng: Generator, labelled: Sequence[LabelledScene], config: SemanticsConfig
) -> SemanticsModel:
    """Return the model with the width and penalty of least held-out log loss."""
    # Each scene is also learned from as if nobody knew what is soft, so that the model
    # has an answer for scenes of both sorts.
    both = [(one, unaware(one)) for one in labelled]
    n_parts = min(config.n_parts, len(both))
    parts = list(np.array_split(rng.permutation(len(both)), n_parts))
    tried = {}
    for width in config.widths:
        held_out = _cross_validate(rng, both, parts, width, config)
        tried |= {(width, c): odds for c, odds in held_out.items()}
    truth = np.concatenate([one.shares.ravel() for pair in both for one in pair])
    width, looseness = min(tried, key=lambda key: log_loss(tried[key], truth))
    scenes = [one for pair in both for one in pair]
    (model,) = _fit(rng, scenes, width, (looseness,), config.n_landmarks).values()
    return _calibrated(model, tried[width, looseness], truth)


def pairs(objects: Array, areas: Array) -> Array:
    """Return the descriptors of every object with every area, shape (n * m, d + e)."""
    repeated = np.repeat(objects, len(areas), axis=0)
    return np.hstack([repeated, np.tile(areas, (len(objects), 1))])


def kernel(scaled: Array, landmarks: Array) -> Array:
    """Return how much pairs are like landmarks, 1 for the same, shape (r, k)."""
    squares = (scaled**2).sum(1)[:, None] + (landmarks**2).sum(1)
    return np.exp(-np.maximum(squares - 2 * scaled @ landmarks.T, 0.0))


def unaware(labelled: LabelledScene) -> LabelledScene:
    """Return the scene as if nobody knew what is soft."""
    areas = without_softness(labelled.areas)
    return LabelledScene(labelled.scene, labelled.objects, areas, labelled.shares)


def log_loss(odds: Array, shares: Array) -> float:
    """Return the mean negative log probability of labels under log odds, both (r,)."""
    return float(np.mean(np.logaddexp(0.0, odds) - shares * odds))


def _cross_validate(
    rng: Generator,
    both: Sequence[tuple[LabelledScene, LabelledScene]],
    parts: Sequence[NDArray[np.int64]],
    width: float,
    config: SemanticsConfig,
) -> dict[float, Array]:
    """Return the held-out log odds of all pairs in order, per looseness, each (r,)."""
    found: dict[float, dict[int, Array]] = {c: {} for c in config.looseness}
    for part in parts:
        held_out = set(part.tolist())
        # Of a single scene nothing is left to hold out.
        left = [i for i in range(len(both)) if i not in held_out] or part.tolist()
        rest = [one for i in left for one in both[i]]
        models = _fit(rng, rest, width, config.looseness, config.n_landmarks)
        for c, model in models.items():
            for i in part.tolist():
                odds = [log_odds(model, one.objects, one.areas) for one in both[i]]
                found[c][i] = np.concatenate([o.ravel() for o in odds])
    return {
        c: np.concatenate([of[i] for i in range(len(both))]) for c, of in found.items()
    }


def _fit(
    rng: Generator,
    scenes: Sequence[LabelledScene],
    width: float,
    looseness: Sequence[float],
    n_landmarks: int,
) -> dict[float, SemanticsModel]:
    """Return a model of one width for each looseness."""
    from sklearn.kernel_approximation import Nystroem
    from sklearn.linear_model import LogisticRegression

    every = np.concatenate([pairs(one.objects, one.areas) for one in scenes])
    shares = np.concatenate([one.shares.ravel() for one in scenes])
    mean, scale = _scaling(every, scenes[0].objects.shape[1], width)
    scaled = (every - mean) / scale
    chosen = _landmarks(rng, shares, n_landmarks)
    map_to = Nystroem(gamma=1.0, n_components=len(chosen), random_state=0).fit(
        scaled[chosen]
    )
    mapped: Any = map_to.transform(scaled)
    # A pair counts as a label for and as one against, by the shares of the labellers.
    is_label = shares > 0
    inputs = np.vstack([mapped, mapped[is_label]])
    labels = np.repeat([0, 1], [len(mapped), is_label.sum()])
    weights = np.concatenate([1 - shares, shares[is_label]])
    models = {}
    for c in looseness:
        learner = LogisticRegression(C=c, solver="newton-cholesky")
        learner.fit(inputs, labels, sample_weight=weights)
        per_landmark = map_to.normalization_.T @ learner.coef_[0]
        intercept = float(learner.intercept_[0])
        models[c] = SemanticsModel(
            mean, scale, map_to.components_, per_landmark, intercept
        )
    return models


def _scaling(every: Array, n_of_object: int, width: float) -> tuple[Array, Array]:
    """Return mean and scale of the descriptors of pairs (r, d + e)."""
    n_of_area = every.shape[1] - n_of_object
    spread = np.maximum(every.std(0), 1e-3)  # Guards what is the same everywhere.
    # Objects and areas have the same say, however many numbers describe them.
    counts = np.repeat([n_of_object, n_of_area], [n_of_object, n_of_area])
    return every.mean(0), spread * np.sqrt(counts) * width


def _landmarks(rng: Generator, shares: Array, n_landmarks: int) -> NDArray[np.int64]:
    """Return the pairs that are landmarks: labelled ones first, half of all."""
    labelled, rest = np.flatnonzero(shares > 0), np.flatnonzero(shares == 0)
    n_labelled = min(n_landmarks // 2, len(labelled))
    n_rest = min(n_landmarks - n_labelled, len(rest))
    first = rng.choice(labelled, n_labelled, replace=False)
    return np.concatenate([first, rng.choice(rest, n_rest, replace=False)])


def _calibrated(model: SemanticsModel, odds: Array, shares: Array) -> SemanticsModel:
    """Return the model whose log odds are stretched to fit held-out ones (r,)."""
    from sklearn.linear_model import LogisticRegression

    is_label = shares > 0
    inputs = np.concatenate([odds, odds[is_label]])[:, None]
    labels = np.repeat([0, 1], [len(odds), is_label.sum()])
    weights = np.concatenate([1 - shares, shares[is_label]])
    platt = LogisticRegression(C=1e6).fit(inputs, labels, sample_weight=weights)
    slope, shift = float(platt.coef_[0, 0]), float(platt.intercept_[0])
    intercept = slope * model.intercept + shift
    return SemanticsModel(
        model.mean, model.scale, model.landmarks, slope * model.weights, intercept
    )
