"""Settings that differ from the study's in one number, to see how much it matters.

Shapes: p places, q valid poses.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from placing.candidates import Candidates
from placing.methods.scene_model import Settings
from placing.people.human import HumanPoses, prior_of
from placing.tables.sensitivity import BASE

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SensitivityConfig:
    """What is varied; the values live in `config/config.yaml`."""

    concentrations: tuple[float, ...]
    """Concentrations alpha."""
    n_auxiliaries: tuple[int, ...]
    """Auxiliary poses m of algorithm 8, in place of the exact birth."""
    smoothings_m: tuple[float, ...]
    """Smoothings of the density."""
    coarsenings: tuple[int, ...]
    """Factors by which the lattices of places and poses are made coarser."""


@dataclass(frozen=True)
class Variation:
    """One set of settings, and how much coarser its lattices are."""

    name: str
    settings: Settings
    coarsening: int = 1


def variations(settings: Settings, config: SensitivityConfig) -> Iterator[Variation]:
    """Yield the settings of the study, then those that differ in one number."""
    sampling, decision = settings.sampling, settings.decision
    yield Variation(BASE, settings)
    for alpha in config.concentrations:
        varied = replace(sampling, concentration=alpha)
        yield Variation(f"alpha={alpha}", replace(settings, sampling=varied))
    for m in config.n_auxiliaries:
        varied = replace(sampling, sampler="algorithm8", n_auxiliary=m)
        yield Variation(f"algorithm8 m={m}", replace(settings, sampling=varied))
    for sigma in config.smoothings_m:
        varied = replace(decision, smoothing_m=sigma)
        yield Variation(f"smoothing={sigma} m", replace(settings, decision=varied))
    for factor in config.coarsenings:
        spacing = factor * settings.candidates.spacing_m
        coarse = replace(settings.candidates, spacing_m=spacing)
        yield Variation(
            f"lattices x{factor}", replace(settings, candidates=coarse), factor
        )


def coarser_places(candidates: Candidates, spacing_m: float) -> Candidates:
    """Return the places on a coarser lattice."""
    kept = _is_on(candidates.location, spacing_m)
    return Candidates(
        candidates.location[kept], candidates.area[kept], candidates.features[kept]
    )


def coarser_poses(poses: HumanPoses, factor: int) -> HumanPoses:
    """Return the poses on lattices that are coarser by a factor, each kind on its own.

    A kind that would lose all its poses keeps them.
    """
    kept = np.ones(len(poses.kind), np.bool_)
    for kind in np.unique(poses.kind):
        of_kind = poses.kind == kind
        spacing = _spacing(poses.location[of_kind])
        left = _is_on(poses.location, factor * spacing) & of_kind
        if left.any():
            kept[of_kind & ~left] = False
    kind = poses.kind[kept]
    return HumanPoses(kind, poses.location[kept], poses.yaw[kept], prior_of(kind))


def _spacing(location: Array) -> float:
    """Return the spacing of a lattice on which points lie [m]."""
    steps = np.diff(np.unique(location[:, :2].round(6)))
    steps = steps[steps > 1e-3]
    return float(steps.min()) if len(steps) else 1.0


def _is_on(location: Array, spacing_m: float) -> NDArray[np.bool_]:
    """Return which points lie on multiples of a spacing, shape (n,)."""
    turns = location[:, :2] / spacing_m
    return np.all(np.abs(turns - turns.round()) < 1e-6, axis=1)
