"""Proposed placements of a scene, and the densities they come from, as arrays."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from placing.artifacts.formats import read_arrays, write_arrays
from placing.errors import BadArtifact
from placing.joint.joint_options import DENSITIES, Proposals

Array = NDArray[np.float64]

SINGLE = ("log_stability", "log_semantics")
"""Columns whose rounding to single precision moves nothing."""


@dataclass(frozen=True)
class Proposed:
    """What is proposed for a scene."""

    densities: Mapping[str, Array]
    """(n, p) by method: where each object is likely, every place that fits."""
    proposals: Proposals
    stacks: Array
    """(s, 3) number of the upper and the lower object, log Psi_stability."""


def read_proposals(path: Path) -> Proposed:
    """Read what is proposed for a scene, checked."""
    names = [field.name for field in fields(Proposals)]
    arrays = read_arrays(path, [*DENSITIES, *names, "stacks"])
    lengths = {name: len(arrays[name]) for name in names}
    if len(set(lengths.values())) > 1:
        raise BadArtifact(f"{path}: {lengths}; expected columns of one length")
    for name in ("T_world_object", "box", "stacks", *DENSITIES):
        if not np.isfinite(arrays[name]).all():
            raise BadArtifact(f"{path}: {name}: expected finite numbers")
    columns = {
        name: arrays[name].astype(float) if name in SINGLE else arrays[name]
        for name in names
    }
    densities = {name: arrays[name].astype(float) for name in DENSITIES}
    return Proposed(densities, Proposals(**columns), arrays["stacks"])


def write_proposals(path: Path, proposed: Proposed) -> None:
    """Write what is proposed for a scene; densities in single precision."""
    columns = {
        name: values.astype(np.float32) if name in SINGLE else values
        for name, values in vars(proposed.proposals).items()
    }
    densities = {n: d.astype(np.float32) for n, d in proposed.densities.items()}
    write_arrays(path, {**densities, **columns, "stacks": proposed.stacks})
