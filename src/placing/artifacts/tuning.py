"""What the training scenes of a fold chose, as JSON."""

from pathlib import Path

from placing.artifacts.formats import read_json
from placing.errors import BadArtifact
from placing.learning.learned import Choices
from placing.tables.coverage import Ranks, read_calibration


def read_tuning(path: Path, task: str) -> tuple[Choices, Ranks]:
    """Read the choices for a task, and the calibration ranks by task and method."""
    document = read_json(path)
    ranks = read_calibration(document, str(path))
    try:
        chosen = document["choices"][task]
        k, weight = chosen["n_components"], chosen["object_weight"]
    except (KeyError, TypeError) as error:
        message = f"{path}: choices.{task}: {error}; expected a file of tune_methods"
        raise BadArtifact(message) from error
    if not (isinstance(k, int) and k > 0):
        place = f"{path}: choices.{task}.n_components"
        raise BadArtifact(f"{place}: value {k!r}; expected a whole number above 0")
    if not (isinstance(weight, int | float) and 0 <= weight <= 1):
        place = f"{path}: choices.{task}.object_weight"
        raise BadArtifact(f"{place}: value {weight!r}; expected a number from 0 to 1")
    return Choices(k, float(weight)), ranks
