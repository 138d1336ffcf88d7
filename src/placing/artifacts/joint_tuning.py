"""What labelled scenes chose for the joint placement, as JSON."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from placing.artifacts.formats import read_json
from placing.errors import BadArtifact


@dataclass(frozen=True)
class JointChoices:
    """What the joint placement was told by labelled scenes."""

    object_weight: float
    """omega of `dp_object_context`: the share of the human context."""
    stack_shares: Mapping[str, float]
    """How often an object of a category stands on another of its kind."""


def read_joint_tuning(path: Path) -> JointChoices:
    """Read omega and the shares, checked."""
    document = read_json(path)
    try:
        weight, shares = document["object_weight"], dict(document["stack_shares"])
    except (KeyError, TypeError, ValueError) as error:
        message = f"{path}: {error}; expected a file of tune_joint"
        raise BadArtifact(message) from error
    for name, value in {"object_weight": weight, **shares}.items():
        if not (isinstance(value, int | float) and 0 < value <= 1):
            raise BadArtifact(
                f"{path}: {name}: value {value!r}; expected a number above 0, at most 1"
            )
    return JointChoices(float(weight), shares)
