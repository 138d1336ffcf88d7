"""Other libraries on the same Gaussian mixture; none of them is needed by this project.

Each returns what it took and how well it predicts points held out, or None where it is
not installed.
"""

import importlib.util
import time
from typing import Any

import numpy as np
from gaussian import Prior
from numpy.typing import NDArray

Array = NDArray[np.float64]

INSTALL = "uv pip install --python .venv/bin/python"
TRUNCATION = 20
"""Gaussians that the peers allow at most."""


def is_missing(module: str, package: str) -> bool:
    """Say how to install a package that is not there; return whether it is missing."""
    if importlib.util.find_spec(module):
        return False
    print(f"{package}: not installed, left out; to compare: {INSTALL} {package}")
    return True


def scikit_learn(points: Array, held_out: Array, prior: Prior) -> dict[str, Any] | None:
    """Fit BayesianGaussianMixture: variational, one plug-in answer, no samples."""
    if is_missing("sklearn", "scikit-learn"):
        return None
    from sklearn.mixture import BayesianGaussianMixture

    start = time.process_time()
    model = BayesianGaussianMixture(
        n_components=TRUNCATION,
        weight_concentration_prior_type="dirichlet_process",
        weight_concentration_prior=1.0,
        mean_prior=np.zeros(2),
        mean_precision_prior=prior.kappa,
        degrees_of_freedom_prior=prior.nu,
        covariance_prior=prior.scale * np.eye(2),
        max_iter=1000,
        random_state=0,
    ).fit(points)
    taken = time.process_time() - start
    return {
        "what": "variational, to convergence",
        "seconds": taken,
        "ms_per_sweep": 1000 * taken / model.n_iter_,
        "held_out": float(model.score(held_out)),
    }


def numpyro(
    points: Array, held_out: Array, prior: Prior, n_steps: int
) -> dict[str, Any] | None:
    """Run NUTS over a truncated stick-breaking process with the labels summed out.

    `n_steps` are kept after as many to warm up, which are not in the time.
    """
    if is_missing("numpyro", "numpyro"):
        return None
    import jax
    from numpyro.infer import MCMC, NUTS
    from numpyro_mixture import held_out_log_density, model

    run = MCMC(
        NUTS(model),
        num_warmup=n_steps,
        num_samples=n_steps,
        progress_bar=False,
    )
    run.warmup(jax.random.key(0), points, prior, TRUNCATION)
    start = time.process_time()
    run.run(run.post_warmup_state.rng_key, points, prior, TRUNCATION)
    taken = time.process_time() - start
    draws = {k: np.asarray(v) for k, v in run.get_samples().items()}
    return {
        "what": f"NUTS, {n_steps} steps after as many",
        "seconds": taken,
        "ms_per_sweep": 1000 * taken / n_steps,
        "largest": draws["weight"].max(1),
        "held_out": held_out_log_density(draws, held_out),
    }
