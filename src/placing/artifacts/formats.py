"""Files of three formats, checked when read and atomic when written.

JSON for what people read, npz for dense arrays, parquet for long tables, CSV for
tables that people read. A missing or damaged file is a `BadArtifact` that names it.
"""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing.artifacts.atomic import replacing
from placing.errors import BadArtifact


def read_json(path: Path) -> Any:  # noqa: ANN401 (a JSON document can be anything)
    """Read a JSON document."""
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError) as error:
        raise BadArtifact(f"{path}: cannot be read as JSON: {error}") from error


def write_json(path: Path, document: object) -> None:
    """Write a document as JSON; arrays become lists and infinity becomes null."""
    with replacing(path) as part:
        text = json.dumps(_plain(document), indent=1, sort_keys=True, allow_nan=False)
        part.write_text(text + "\n")


def read_arrays(path: Path, names: Sequence[str]) -> dict[str, NDArray[Any]]:
    """Read the arrays called `names` from an npz file."""
    try:
        with np.load(path, allow_pickle=False) as arrays:
            return {name: arrays[name] for name in names}
    except (OSError, KeyError, ValueError) as error:
        raise BadArtifact(f"{path}: {error}; expected arrays {list(names)}") from error


def write_arrays(path: Path, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Write arrays to a compressed npz file, the same bytes for the same arrays."""
    with replacing(path) as part:
        np.savez_compressed(part, allow_pickle=False, **arrays)


def read_table(path: Path, columns: Sequence[str]) -> pd.DataFrame:
    """Read a parquet table that has at least `columns`."""
    try:
        return pd.read_parquet(path, columns=list(columns))
    except (OSError, ValueError, KeyError) as error:
        raise BadArtifact(f"{path}: {error}; expected {list(columns)}") from error


def write_table(path: Path, table: pd.DataFrame) -> None:
    """Write a table as parquet."""
    with replacing(path) as part:
        table.to_parquet(part, index=False)


def write_csv(path: Path, table: pd.DataFrame) -> None:
    """Write a table for people: CSV with six significant digits."""
    with replacing(path) as part:
        table.to_csv(part, index=False, float_format="%.6g", lineterminator="\n")


def _plain(value: object) -> object:
    """Return `value` made of dicts, lists, strings and rounded finite numbers."""
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [_plain(item) for item in value]
    if isinstance(value, np.bool_):
        return bool(value)
    if isinstance(value, float | np.floating):
        return None if np.isinf(value) else round(float(value), 9)
    return int(value) if isinstance(value, np.integer) else value
