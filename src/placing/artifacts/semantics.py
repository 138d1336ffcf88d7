"""What was learned of object and placing area (`placing.psi.semantics`) as JSON.

Numbers only, and the names of the descriptors they belong to, so that a file of other
descriptors is told apart. What is read is checked: anything out of place is a
`BadArtifact` that names the file, the field, its value and what was expected.
"""

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from placing.artifacts.formats import read_json, write_json
from placing.errors import BadArtifact
from placing.psi.area_descriptors import AREA_DESCRIPTORS
from placing.psi.object_descriptors import OBJECT_DESCRIPTORS
from placing.psi.semantics import SemanticsModel

NAMES = {"objects": list(OBJECT_DESCRIPTORS), "areas": list(AREA_DESCRIPTORS)}
LARGEST = 1e9
"""No number in a file is larger."""


def write_semantics(
    path: Path, model: SemanticsModel, training_scenes: Sequence[str]
) -> None:
    """Write what was learned and the scenes it was learned from."""
    names = {"descriptors": NAMES, "training_scenes": list(training_scenes)}
    write_json(path, names | asdict(model))


def read_semantics(path: Path) -> SemanticsModel:
    """Read what was learned."""
    document = read_json(path)
    if not isinstance(document, dict):
        raise _bad(path, "the document", document, "an object, as learn_semantics does")
    if document.get("descriptors") != NAMES:
        found = document.get("descriptors")
        raise _bad(path, "descriptors", found, "those of this version")
    n = sum(len(names) for names in NAMES.values())
    weights = _numbers(path, document, "weights", (-1,))
    intercept = _numbers(path, document, "intercept", ())
    return SemanticsModel(
        mean=_numbers(path, document, "mean", (n,)),
        scale=_numbers(path, document, "scale", (n,), low=1e-9),
        landmarks=_numbers(path, document, "landmarks", (len(weights), n)),
        weights=weights,
        intercept=float(intercept),
    )


def _numbers(
    path: Path,
    document: dict[str, object],
    field: str,
    shape: tuple[int, ...],
    low: float = -LARGEST,
) -> NDArray[np.float64]:
    """Return a field as numbers of a shape, whose -1 stands for any length above 0."""
    value = document.get(field)
    expected = f"numbers from {low:g} to {LARGEST:g} of shape {shape}"
    try:
        numbers = np.array(value)
    except ValueError:  # Rows of several lengths.
        raise _bad(path, field, value, expected) from None
    if shape == (-1,):
        is_shape = numbers.ndim == 1 and len(numbers) > 0
    else:
        is_shape = numbers.shape == shape
    if not is_shape or numbers.dtype.kind not in "if":
        raise _bad(path, field, value, expected)
    for place, number in np.ndenumerate(numbers):
        if not low <= number <= LARGEST:  # true for NaN
            where = field + "".join(f"[{i}]" for i in place)
            raise _bad(path, where, float(number), expected)
    return numbers.astype(float)


def _bad(path: Path, place: str, value: object, expected: str) -> BadArtifact:
    """Return the error for a value, in one line."""
    text = repr(value)
    shown = text if len(text) <= 60 else f"{text[:57]}..."
    return BadArtifact(f"{path}: {place}: value {shown}; expected {expected}")
