"""A Dirichlet process mixture of Gaussians on the plane, to compare with peers.

The same two algorithms as the pose sampler: each point picks a Gaussian in use or a new
one, by its exact weight or by m auxiliary ones; then each Gaussian in use is redrawn
given its points. The prior of mean and covariance is normal-inverse-Wishart.

Shapes: n points, k Gaussians, s sweeps, u points held out.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.random import Generator
from numpy.typing import NDArray

Array = NDArray[np.float64]

MAX_GAUSSIANS = 64


class Prior(NamedTuple):
    """Normal-inverse-Wishart prior on the plane, with mean 0 and scale `scale` I."""

    kappa: float = 0.05
    nu: float = 5.0
    scale: float = 1.0


class Gaussians(NamedTuple):
    """The Gaussians of a state; arrays are changed in place."""

    n_points: NDArray[np.int64]
    """(k,) 0 marks an unused one."""
    form: Array
    """(k, 6) mean x, y; precision xx, xy, yy; log of its normaliser."""


def made_up_points(rng: Generator, n: int) -> tuple[Array, float]:
    """Return points of eight Gaussians (n, 2), and their mean log density."""
    means, scale = rng.uniform(-8, 8, (8, 2)), rng.uniform(0.4, 1.0, (8, 2))
    which = rng.integers(8, size=n)
    points = means[which] + scale[which] * rng.standard_normal((n, 2))
    z = (points[:, None] - means) / scale  # (n, 8, 2)
    density = np.exp(-0.5 * (z**2).sum(-1)) / (2 * np.pi * scale.prod(1))
    return points, float(np.log(density.mean(1)).mean())


@njit
def sample(rng, points, prior, alpha, m, n_burn_in, trace, held_out):  # noqa: ANN001, ANN201
    """Fill `trace` (s, 2) with Gaussians in use and points of the largest.

    Return the mean predictive density of the points held out, shape (u,).
    """
    n = len(points)
    used, forms = np.zeros(MAX_GAUSSIANS, np.int64), np.zeros((MAX_GAUSSIANS, 6))
    state = Gaussians(used, forms)
    choice, births = np.zeros(n, np.int64), birth_densities(points, prior)
    state.n_points[0] = n
    redraw(rng, state, choice, points, prior)
    predicted, births_out = np.zeros(len(held_out)), birth_densities(held_out, prior)
    for s in range(-n_burn_in, len(trace)):
        for i in range(n):
            choice[i] = choose(
                rng, state, choice[i], points[i], prior, alpha, m, births[i]
            )
        redraw(rng, state, choice, points, prior)
        if s >= 0:
            trace[s, 0], trace[s, 1] = (used > 0).sum(), used.max()
            for u in range(len(held_out)):
                total = alpha * births_out[u]
                for k in range(MAX_GAUSSIANS):
                    if used[k] > 0:
                        total += used[k] * density(forms[k], held_out[u])
                predicted[u] += total / (n + alpha) / len(trace)
    return predicted


@njit
def choose(rng, state, old, x, prior, alpha, m, birth):  # noqa: ANN001, ANN201
    """Return the Gaussian that a point picks, given all else."""
    state.n_points[old] -= 1
    below, total = np.empty(MAX_GAUSSIANS + max(m, 1)), 0.0
    new = -1
    for k in range(MAX_GAUSSIANS):
        if state.n_points[k] > 0:
            total += state.n_points[k] * density(state.form[k], x)
        elif new < 0:
            new = k
        below[k] = total
    offered = np.empty((m, 6))
    for j in range(m):
        draw_form(rng, np.zeros(6), prior, offered[j])
        if j == 0 and state.n_points[old] == 0:
            offered[0] = state.form[old]
        total += alpha / m * density(offered[j], x)
        below[MAX_GAUSSIANS + j] = total
    if m == 0:
        below[-1] = total + alpha * birth
    picked = np.searchsorted(below, rng.random() * below[-1], side="right")
    if picked >= MAX_GAUSSIANS:
        if m > 0:
            state.form[new] = offered[picked - MAX_GAUSSIANS]
        else:
            draw_form(rng, sums_of(x), prior, state.form[new])
        picked = new
    state.n_points[picked] += 1
    return picked


@njit
def density(form, x):  # noqa: ANN001, ANN201
    """Return the density of a Gaussian at a point."""
    dx, dy = x[0] - form[0], x[1] - form[1]
    distance = form[2] * dx * dx + 2 * form[3] * dx * dy + form[4] * dy * dy
    return np.exp(form[5] - 0.5 * distance)


@njit
def sums_of(x):  # noqa: ANN001, ANN201
    """Return the sufficient statistics of one point: 1, x, y, xx, xy, yy."""
    return np.array([1.0, x[0], x[1], x[0] * x[0], x[0] * x[1], x[1] * x[1]])


@njit
def redraw(rng, state, choice, points, prior):  # noqa: ANN001, ANN201
    """Redraw every Gaussian in use given its points."""
    sums = np.zeros((MAX_GAUSSIANS, 6))
    for i in range(len(points)):
        sums[choice[i]] += sums_of(points[i])
    for k in range(MAX_GAUSSIANS):
        if state.n_points[k] > 0:
            draw_form(rng, sums[k], prior, state.form[k])


@njit
def posterior(sums, prior):  # noqa: ANN001, ANN201
    """Return kappa, nu, mean x, y and scale xx, xy, yy given the sums of points."""
    n = sums[0]
    kappa, nu = prior.kappa + n, prior.nu + n
    mx, my = sums[1] / kappa, sums[2] / kappa
    xx = prior.scale + sums[3] - kappa * mx * mx
    yy = prior.scale + sums[5] - kappa * my * my
    return kappa, nu, mx, my, xx, sums[4] - kappa * mx * my, yy


@njit
def draw_form(rng, sums, prior, form):  # noqa: ANN001, ANN201
    """Fill `form` (6,) with a Gaussian drawn given the sums of its points.

    The precision is Wishart: with L the Cholesky factor of the inverse of the scale
    and A lower triangular (Bartlett), it is L A A' L'.
    """
    kappa, nu, mx, my, xx, xy, yy = posterior(sums, prior)
    det = xx * yy - xy * xy
    l11 = np.sqrt(yy / det)
    l21, l22 = -xy / det / l11, 1 / np.sqrt(yy)
    a11, a22 = np.sqrt(rng.chisquare(nu)), np.sqrt(rng.chisquare(nu - 1))
    a21 = rng.standard_normal()
    b11, b21, b22 = l11 * a11, l21 * a11 + l22 * a21, l22 * a22  # B = L A
    # mean + B'^-1 z / sqrt(kappa) has the covariance (kappa B B')^-1.
    zy = rng.standard_normal() / b22
    zx = (rng.standard_normal() - b21 * zy) / b11
    form[0], form[1] = mx + zx / np.sqrt(kappa), my + zy / np.sqrt(kappa)
    form[2], form[3], form[4] = b11 * b11, b11 * b21, b21 * b21 + b22 * b22
    form[5] = np.log(b11 * b22) - np.log(2 * np.pi)


@njit
def birth_densities(points, prior):  # noqa: ANN001, ANN201
    """Return the density of points under the prior, a Student t, shape (n,)."""
    dof = prior.nu - 1
    spread = prior.scale * (prior.kappa + 1) / (prior.kappa * dof)
    out = np.empty(len(points))
    for i in range(len(points)):
        squared = (points[i] ** 2).sum() / spread
        out[i] = (1 + squared / dof) ** (-(dof + 2) / 2) / (2 * np.pi * spread)
    return out
