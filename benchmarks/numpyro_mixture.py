"""The Gaussian mixture for NumPyro; imported where NumPyro is installed.

Shapes: n points, k Gaussians, s samples.
"""

import jax.numpy as jnp
import numpy as np
import numpyro
import numpyro.distributions as dist
from gaussian import Prior
from jax.scipy.special import logsumexp
from numpy.typing import NDArray

Array = NDArray[np.float64]


def model(points: Array, prior: Prior, truncation: int) -> None:
    """Describe sticks, precisions and means, with the choices summed out."""
    with numpyro.plate("sticks", truncation - 1):
        stick = numpyro.sample("stick", dist.Beta(1.0, 1.0))
    left = jnp.concatenate([jnp.ones(1), jnp.cumprod(1 - stick)])
    weight = left * jnp.concatenate([stick, jnp.ones(1)])
    numpyro.deterministic("weight", weight)
    with numpyro.plate("gaussians", truncation):
        root = jnp.eye(2) / prior.scale**0.5
        lower = numpyro.sample("lower", dist.WishartCholesky(prior.nu, scale_tril=root))
        spread = jnp.linalg.inv(jnp.swapaxes(lower, -1, -2)) / prior.kappa**0.5
        step = numpyro.sample("step", dist.Normal(0, 1).expand([2]).to_event(1))
        mean = jnp.einsum("kij,kj->ki", spread, step)
    numpyro.deterministic("mean", mean)
    numpyro.factor("points", log_density(points, weight, mean, lower).sum())


def log_density(points: Array, weight: Array, mean: Array, lower: Array) -> Array:
    """Return the log density of the mixture at points, shape (n,).

    `lower` (k, 2, 2) Cholesky factors of the precisions.
    """
    z = jnp.einsum("kij,nki->nkj", lower, points[:, None] - mean)
    log_det = jnp.log(lower[:, 0, 0] * lower[:, 1, 1])
    logs = jnp.log(weight) + log_det - 0.5 * (z**2).sum(-1) - jnp.log(2 * jnp.pi)
    return logsumexp(logs, axis=1)


def held_out_log_density(draws: dict[str, Array], points: Array) -> float:
    """Return the mean log predictive density of points over the samples."""
    names = ("weight", "mean", "lower")
    logs = [
        log_density(points, *(draws[name][s] for name in names))
        for s in range(len(draws["weight"]))
    ]
    return float((logsumexp(jnp.stack(logs), axis=0) - jnp.log(len(logs))).mean())
