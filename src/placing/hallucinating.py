"""Hallucinate the people of a scene: who uses each wanted object of a question.

Shapes: n objects, given then wanted; q valid poses; r chains; c wanted categories.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from placing import dpmm
from placing.learned import theta_name
from placing.scene_model import SceneModel
from placing.tasks import Question

Array = NDArray[np.float64]

HUMAN_METHODS = ("random_human", "fmm", "dp", "dp_object")
"""The methods whose density goes through human poses."""


@dataclass(frozen=True)
class People:
    """Where the users of the wanted objects are."""

    theta: str
    """Name of the Theta by which they use objects."""
    weight: Mapping[str, Array]
    """Per wanted category, the probability that its user has each pose, (q,)."""
    by_chain: Mapping[str, Array]
    """The same for each chain, (r, q)."""
    chains: dpmm.Chains | None
    """None where poses are not inferred."""


def random_people(model: SceneModel, question: Question) -> People:
    """Return people drawn from P0, whatever objects there are."""
    prior = model.poses.prior
    weight = dict.fromkeys(categories_of(question), prior)
    return People("dp", weight, {name: prior[None] for name in weight}, None)


def hallucinate(
    rng: Generator, model: SceneModel, question: Question, n_components: int = 0
) -> People:
    """Return people sampled with the given objects, wanted ones summed out (eq. 3).

    `n_components` poses of the finite mixture, 0 for the Dirichlet process. A wanted
    object without a place in the scene tells nothing about people.
    """
    theta = theta_name("fmm" if n_components else "dp", n_components)
    names = categories_of(question)
    rows = [model.given_row(theta, question.labels, p) for p in question.given]
    rows += [model.wanted_row(theta, item.category) for item in question.wanted]
    slots = [-1] * len(question.given)
    slots += [names.index(item.category) for item in question.wanted]
    args = np.stack(rows), model.poses.prior, model.settings.sampling
    chains = dpmm.sample(rng, *args, np.array(slots), n_components)
    by_chain = {}
    for slot, name in enumerate(names):
        seen, new = chains.weight[:, slot, :-1], chains.weight[:, slot, -1:]
        by_chain[name] = seen + new * model.use(theta, name).new_person()
    weight = {name: rows.mean(0) for name, rows in by_chain.items()}
    return People(theta, weight, by_chain, chains)


def categories_of(question: Question) -> list[str]:
    """Return the wanted categories, sorted."""
    return sorted({item.category for item in question.wanted})
