"""Psi_stability (eq. 1): the learned probability that a placement stays put.

Boosted trees over features of two clouds, with a calibrated output. Learning uses
scikit-learn; the model itself is a few arrays of numbers and needs only a short loop.

Letters for shapes: c placements, f features, t trees, k nodes of a tree.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Truths = NDArray[np.bool_]

LEAF = -1
"""Feature of a node that has no children."""
MAX_LOGIT = 30.0
"""Guards exponentials."""


@dataclass(frozen=True)
class StabilityConfig:
    """How stability is learned; the values live in `config/config.yaml`."""

    n_trees: int
    max_depth: int
    learning_rate: float
    min_leaf: int
    """Fewest trials in a leaf."""
    tried_share: float
    """Share of the trials that each tree sees."""
    tried_features: float
    """Share of the features that each cut of a tree chooses from."""
    n_folds: int
    """Folds of the objects for calibration and for the report."""
    n_candidates: int
    """Fresh placements from which one is chosen and settled again for the report."""
    min_probability: float
    """A placement that stays with less probability is not chosen."""


@dataclass(frozen=True)
class StabilityModel:
    """What was learned: an ensemble of trees and how its sum becomes a probability."""

    features: tuple[str, ...]
    """Names of the columns it reads."""
    start: float
    """Log odds before the first tree."""
    cut: NDArray[np.int64]
    """(t, k) number of the feature that a node compares, `LEAF` for leaves."""
    threshold: Array
    """(t, k) a placement goes left where its feature is at most this."""
    left: NDArray[np.int64]
    """(t, k) number of the child node."""
    right: NDArray[np.int64]
    value: Array
    """(t, k) what a leaf adds to the log odds."""
    slope: float
    """Of the calibrated log odds over the sum of the trees."""
    intercept: float


Models = Mapping[tuple[str, int], StabilityModel]
"""A model per kind of fixture and fold of objects, learned without either."""


def log_psi_stability(model: StabilityModel, features: NDArray) -> Array:
    """Return the log probability that each placement stays put, shape (c,)."""
    log_odds = model.slope * sum_trees(model, features) + model.intercept
    return -np.logaddexp(0.0, -np.clip(log_odds, -MAX_LOGIT, MAX_LOGIT))


def sum_trees(model: StabilityModel, features: NDArray) -> Array:
    """Return the log odds before calibration, shape (c,)."""
    if features.ndim != 2 or features.shape[1] != len(model.features):
        expected = f"expected {len(model.features)} columns"
        raise ValueError(f"features have shape {features.shape}; {expected}")
    # Trees compare single precision, as in learning.
    rows = np.ascontiguousarray(features, np.float32)
    trees = model.cut, model.threshold, model.left, model.right, model.value
    return model.start + _sum(rows, *trees)


@njit(cache=True)
def _sum(rows, cut, threshold, left, right, value):  # noqa: ANN001, ANN202
    """Return the sum of the leaves that each row reaches, shape (c,)."""
    total = np.zeros(len(rows))
    for t in range(len(cut)):
        for c in range(len(rows)):
            k = 0
            while cut[t, k] >= 0:
                goes_left = rows[c, cut[t, k]] <= threshold[t, k]
                k = left[t, k] if goes_left else right[t, k]
            total[c] += value[t, k]
    return total


def learn_stability(
    names: Sequence[str],
    features: NDArray,
    stays: Truths,
    folds: NDArray[np.integer],
    config: StabilityConfig,
) -> StabilityModel:
    """Return the model of trials (c, f), calibrated across the folds of its objects.

    The probability is that of objects which were not learned from.
    """
    sums = np.zeros(len(stays))
    for fold in np.unique(folds):
        out = folds == fold
        sums[out] = sum_trees(
            fit_trees(names, features[~out], stays[~out], config), features[out]
        )
    model = fit_trees(names, features, stays, config)
    return calibrated(model, sums, stays)


def fit_trees(
    names: Sequence[str], features: NDArray, stays: Truths, config: StabilityConfig
) -> StabilityModel:
    """Return trees that are not calibrated."""
    from sklearn.ensemble import GradientBoostingClassifier

    # ASSUME: boosted trees: on held-out objects their log loss was 0.24, that of a
    # logistic regression on hinges at quantiles 0.29.
    learner = GradientBoostingClassifier(
        n_estimators=config.n_trees,
        max_depth=config.max_depth,
        learning_rate=config.learning_rate,
        min_samples_leaf=config.min_leaf,
        subsample=config.tried_share,
        max_features=config.tried_features,
        random_state=0,
    )
    learner.fit(features.astype(np.float32), stays)
    trees = [estimator.tree_ for estimator in learner.estimators_[:, 0]]
    rate = stays.mean()
    return StabilityModel(
        features=tuple(names),
        start=float(np.log(rate / (1 - rate))),
        cut=_padded([tree.feature for tree in trees], LEAF).astype(np.int64).clip(LEAF),
        threshold=_padded([tree.threshold for tree in trees], 0.0),
        left=_padded([tree.children_left for tree in trees], 0)
        .astype(np.int64)
        .clip(0),
        right=_padded([tree.children_right for tree in trees], 0)
        .astype(np.int64)
        .clip(0),
        value=config.learning_rate
        * _padded([tree.value[:, 0, 0] for tree in trees], 0.0),
        slope=1.0,
        intercept=0.0,
    )


def _padded(rows: Sequence[NDArray], filler: float) -> Array:
    """Return rows of different lengths as one array, shape (t, k)."""
    longest = max(len(row) for row in rows)
    filled = np.full((len(rows), longest), filler, np.float64)
    for i, row in enumerate(rows):
        filled[i, : len(row)] = row
    return filled


def calibrated(model: StabilityModel, sums: Array, stays: Truths) -> StabilityModel:
    """Return the model with the slope that makes held-out sums log odds (Platt)."""
    from sklearn.linear_model import LogisticRegression

    # ASSUME: a straight line: isotonic steps would tie the best placements.
    line = LogisticRegression(C=1e6).fit(sums[:, None], stays)
    slope, intercept = float(line.coef_[0, 0]), float(line.intercept_[0])
    return replace(model, slope=max(slope, 1e-3), intercept=intercept)


def folds_of(names: Iterable[str], n_folds: int) -> dict[str, int]:
    """Return a fold for each name, of about equal sizes."""
    return {name: i % n_folds for i, name in enumerate(sorted(set(names)))}
