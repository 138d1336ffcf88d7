"""Propose placements for all objects of one empty scene.

Shapes: n objects, p places, s pairs.
"""

from collections.abc import Callable
from itertools import permutations

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from placing.artifacts.proposals import Proposed
from placing.joint.joint_options import (
    DENSITIES,
    ProposalConfig,
    densities_of,
    propose,
    together,
)
from placing.learning.learned import Choices
from placing.methods.answering import Asked
from placing.methods.scene_model import SceneModel
from placing.psi.psi_object import PsiObject
from placing.tasks import questions

Array = NDArray[np.float64]


def propose_for(
    stream: Callable[[str], Generator],
    model: SceneModel,
    psi: PsiObject,
    choices: Choices,
    config: ProposalConfig,
) -> Proposed:
    """Return densities and options of all objects of a scene.

    `stream` gives the random stream of a method.
    """
    (question,) = questions(model.scene, "empty")
    asked = Asked(stream, model, question, choices)
    found = [densities_of(asked, psi, item) for item in model.scene.objects]
    parts = [propose(asked, psi, i, of, config) for i, of in enumerate(found)]
    densities = {name: np.array([of[name][0] for of in found]) for name in DENSITIES}
    return Proposed(densities, together(parts), stacks_of(psi))


def stacks_of(psi: PsiObject) -> Array:
    """Return upper and lower object and log Psi_stability of pairs alike, (s, 3)."""
    objects = psi.scene.objects
    found = [
        (i, j, psi.log_stack(objects[i], objects[j]))
        for i, j in permutations(range(len(objects)), 2)
        if objects[i].category == objects[j].category
    ]
    return np.array(found, float).reshape(-1, 3)
