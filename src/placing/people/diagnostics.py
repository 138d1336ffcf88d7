"""Whether the chains of a question agree: R-hat, effective sample size, variation.

Rank-normalised split R-hat and bulk ESS of Vehtari, Gelman, Simpson, Carpenter and
Bürkner (2021), "Rank-normalization, folding, and localization: An improved R-hat", of
three traces at once; and the largest total variation between the placement histograms
of two chains. A question outside the gates is marked and stays in every table.

Shapes: m statistics, r chains, s samples, b bins of a placement histogram.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import pdist
from scipy.special import ndtri

from placing.people.dpmm import Chains

Array = NDArray[np.float64]

STATISTICS = ("n_poses", "log_joint", "p_new")
"""Traces of `Chains` that are diagnosed."""

DIAGNOSTIC_COLUMNS = [
    *("scene", "task", "method", "question", "n_objects"),
    *(f"{kind}_{name}" for name in STATISTICS for kind in ("rhat", "ess")),
    *("variation", "is_mixed"),
]

CONSTANT = 1e-6
"""A trace that spans less of its magnitude is constant: sums have such rounding."""


@dataclass(frozen=True)
class DiagnosticsConfig:
    """Gates of the diagnostics; the values live in `config/config.yaml`."""

    max_rhat: float
    """R-hat of a mixed question is below."""
    max_variation: float
    """Total variation between two chains of a mixed question is below."""
    n_doublings: int
    """How often chains outside the gates are run again with twice the sweeps."""


@dataclass(frozen=True)
class Diagnosis:
    """How far the chains of one question agree."""

    rhat: dict[str, float]
    """Rank-normalised split R-hat of each statistic; 1 where a trace is constant."""
    ess: dict[str, float]
    """Bulk effective sample size of each statistic."""
    variation: float
    """Largest total variation of a placement histogram between two chains, 0 to 1."""

    def is_mixed(self, config: DiagnosticsConfig) -> bool:
        """Return whether all diagnostics are within the gates; NaN is outside."""
        agree = all(value < config.max_rhat for value in self.rhat.values())
        return agree and self.variation < config.max_variation


def diagnose(chains: Chains, histograms: list[Array]) -> Diagnosis:
    """Return the diagnosis of one question.

    `histograms` placement histogram of every chain, rows (r, b) of sum 1, for each
    wanted category.
    """
    traces = np.stack([np.asarray(getattr(chains, n), float) for n in STATISTICS])
    rhat, ess = rhat_and_ess(traces)
    variations = [total_variation(rows) for rows in histograms]
    variation = float(np.max(variations, initial=0.0))  # NaN if any is
    return Diagnosis(
        dict(zip(STATISTICS, rhat.tolist(), strict=True)),
        dict(zip(STATISTICS, ess.tolist(), strict=True)),
        variation,
    )


def diagnosis_row(
    key: tuple[str, str, str, str],
    n_objects: int,
    diagnosis: Diagnosis,
    config: DiagnosticsConfig,
) -> tuple[object, ...]:
    """Return the row of a question, `key` its scene, task, method and name."""
    values = [of[name] for name in STATISTICS for of in (diagnosis.rhat, diagnosis.ess)]
    is_mixed = diagnosis.is_mixed(config)
    return (*key, n_objects, *values, diagnosis.variation, is_mixed)


def total_variation(histograms: Array) -> float:
    """Return the largest total variation between two rows of (r, b), 0 to 1."""
    return float(pdist(histograms, "cityblock").max(initial=0.0)) / 2


def rhat_and_ess(traces: Array) -> tuple[Array, Array]:
    """Return R-hat (m,) and bulk ESS (m,) of traces (m, r, s).

    R-hat is the larger one of location (bulk) and scale (tail). Both are NaN where a
    chain has fewer than four samples or a sample is not finite.
    """
    n_half = traces.shape[2] // 2
    if n_half < 2:
        unknown = np.full(len(traces), np.nan)
        return unknown, unknown.copy()
    halves = np.concatenate([traces[..., :n_half], traces[..., -n_half:]], 1)
    values = halves.reshape(len(traces), -1)  # (m, 2 r n_half)
    is_known = np.all(np.isfinite(values), axis=1)
    values = np.where(is_known[:, None], values, 0.0)
    is_flat = np.ptp(values, 1) <= CONSTANT * np.abs(values).max(1)
    values = np.where(is_flat[:, None], 0.0, values)
    folded = np.abs(values - np.median(values, 1, keepdims=True))
    scores = normal_scores(np.concatenate([values, folded]))
    scores = scores.reshape(2, *halves.shape)
    rhat = _rhat(scores).max(0)
    ess = np.where(is_flat, values.shape[1], _ess(scores[0]))
    return np.where(is_known, rhat, np.nan), np.where(is_known, ess, np.nan)


def normal_scores(values: Array) -> Array:
    """Return the normal scores of the ranks within each row, ties averaged, (k, n)."""
    order = values.argsort(1, kind="stable")
    ordered = np.take_along_axis(values, order, 1)
    k, n = values.shape
    is_step = ordered[:, 1:] != ordered[:, :-1]
    edge = np.ones((k, 1), bool)
    at = np.arange(n)
    starts = np.where(np.hstack([edge, is_step]), at, 0)
    ends = np.where(np.hstack([is_step, edge]), at, n)
    first = np.maximum.accumulate(starts, 1)
    last = np.minimum.accumulate(ends[:, ::-1], 1)[:, ::-1]
    scores = np.empty_like(values)
    np.put_along_axis(scores, order, _blom(n)[first + last], 1)
    return scores


@cache
def _blom(n: int) -> Array:
    """Return the normal score of the ranks 1, 1.5, ..., n, shape (2 n - 1,)."""
    rank = 1 + np.arange(2 * n - 1) / 2
    return ndtri((rank - 3 / 8) / (n + 1 / 4))


def _rhat(scores: Array) -> Array:
    """Return split R-hat of half chains (..., c, n), shape (...)."""
    n = scores.shape[-1]
    # Measured from a score of the chain, so that a constant one varies by exactly 0.
    within = (scores - scores[..., :1]).var(-1, ddof=1).mean(-1)
    means = (scores - scores[..., :1, :1]).mean(-1)
    between = means.var(-1, ddof=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        rhat = np.sqrt(between / within + (n - 1) / n)
    return np.where((within == 0) & (between == 0), 1.0, rhat)


def _ess(scores: Array) -> Array:
    """Return the effective sample size of half chains (m, c, n), shape (m,)."""
    m, c, n = scores.shape
    means = scores.mean(2, keepdims=True)
    spectrum = np.fft.rfft(scores - means, 2 * n)
    power = (spectrum.real**2 + spectrum.imag**2).mean(1)
    covariance = np.fft.irfft(power, 2 * n)[:, :n] / n  # (m, n) by lag
    within = covariance[:, :1] * n / (n - 1)
    total = covariance[:, :1] + means[..., 0].var(1, ddof=1)[:, None]
    rho = 1 - (within - covariance) / np.maximum(total, 1e-300)
    rho[:, 0] = 1
    # Geyer's initial monotone sequence: pairs of lags up to the first sum below 0.
    n_pairs = max((n - 1) // 2, 1)
    pairs = rho[:, 0 : 2 * n_pairs : 2] + rho[:, 1 : 2 * n_pairs : 2]
    is_over = pairs <= 0
    is_over[:, -1] = True
    end = is_over.argmax(1)
    used = np.arange(n_pairs) < end[:, None]
    summed = np.where(used, np.minimum.accumulate(pairs, 1), 0).sum(1)
    tau = 2 * summed - 1 + np.maximum(rho[np.arange(m), 2 * end], 0)
    return c * n / np.maximum(tau, 1 / np.log10(c * n))
