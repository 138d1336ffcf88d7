"""Hallucinate the people of a scene: who uses each wanted object of a question.

Shapes: n objects, given then wanted; q valid poses; r chains; c wanted categories.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from placing.learning.learned import theta_name
from placing.methods.scene_model import SceneModel
from placing.people import dpmm
from placing.people.diagnostics import Diagnosis, diagnose
from placing.tasks import Question

Array = NDArray[np.float64]


@dataclass(frozen=True)
class People:
    """Where the users of the wanted objects are."""

    theta: str
    """Name of the Theta by which they use objects."""
    seen: Mapping[str, Array]
    """Per wanted category, the probability that its user is one that was sampled and
    has each pose, (q,)."""
    p_new: Mapping[str, float]
    """The rest: the probability that its user is a new one."""
    weight: Mapping[str, Array]
    """Per wanted category, the probability that its user has each pose, (q,)."""
    chains: dpmm.Chains | None
    """None where poses are not inferred."""
    diagnosis: Diagnosis | None
    """How far the chains agree; None without chains."""


def random_people(model: SceneModel, question: Question) -> People:
    """Return people drawn from P0, whatever objects there are."""
    prior = model.poses.prior
    weight = dict.fromkeys(question.categories, prior)
    return People("dp", weight, dict.fromkeys(weight, 0.0), weight, None, None)


def hallucinate(
    rng: Generator, model: SceneModel, question: Question, n_components: int = 0
) -> People:
    """Return people sampled with the given objects, wanted ones summed out (eq. 3).

    `n_components` poses of the finite mixture, 0 for the Dirichlet process. A wanted
    object without a place in the scene tells nothing about people. Chains that
    disagree are run again, longer; what still disagrees is kept with its diagnosis.
    """
    theta = theta_name("fmm" if n_components else "dp", n_components)
    rows = _rows(model, question, theta)
    config, gates = model.settings.sampling, model.settings.diagnostics
    for doubling in range(gates.n_doublings + 1):
        longer = replace(
            config,
            n_burn_in=config.n_burn_in * 2**doubling,
            n_samples=config.n_samples * 2**doubling,
        )
        people = _run_chains(rng, model, question, theta, rows, n_components, longer)
        if people.diagnosis is None or people.diagnosis.is_mixed(gates):
            break
    return people


def _rows(model: SceneModel, question: Question, theta: str) -> NDArray[np.float32]:
    """Return the weight of every pose for each object of a question, shape (n, q)."""
    rows = [model.given_row(theta, question.labels, p) for p in question.given]
    rows += [model.wanted_row(theta, item.category) for item in question.wanted]
    return np.stack(rows)


def _run_chains(
    rng: Generator,
    model: SceneModel,
    question: Question,
    theta: str,
    rows: NDArray[np.float32],
    n_components: int,
    config: dpmm.DpmmConfig,
) -> People:
    """Return people sampled with chains of one length."""
    names = question.categories
    slots = [-1] * len(question.given)
    slots += [names.index(item.category) for item in question.wanted]
    args = rows, model.poses.prior, config, np.array(slots)
    chains = dpmm.sample(rng, *args, n_components)
    seen, p_new, weight, histograms = {}, {}, {}, []
    for slot, name in enumerate(names):
        use, of_slot = model.use(theta, name), chains.weight[:, slot]
        seen[name], p_new[name] = of_slot[:, :-1].mean(0), float(of_slot[:, -1].mean())
        weight[name] = seen[name] + p_new[name] * use.new_person()
        histograms.append(use.histograms(of_slot[:, :-1], of_slot[:, -1]))
    diagnosis = diagnose(chains, histograms) if config.n_chains > 1 else None
    return People(theta, seen, p_new, weight, chains, diagnosis)
