"""What a fold has learned and chosen, as the stages that use it see it."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placing.methods.object_context import Relations
from placing.people.potential import Theta

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Choices:
    """What the training scenes of a fold chose for one task."""

    n_components: int
    """Poses K of the finite mixture `fmm`."""
    object_weight: float
    """omega of `dp_object`: the share of the human context."""


@dataclass(frozen=True)
class Learned:
    """What a fold has learned from its training scenes."""

    thetas: Mapping[str, Mapping[str, Theta]]
    """Theta per category, for `dp` and for `fmm<K>` of every K tried."""
    histograms: Mapping[str, Mapping[str, Array]]
    """Per baseline and category."""
    relations: Relations
    """The object context: where objects of a category lie beside others."""


def theta_name(method: str, n_components: int) -> str:
    """Return the name of the Theta that a method with humans looks up."""
    return f"fmm{n_components}" if method == "fmm" else "dp"
