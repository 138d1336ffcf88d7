"""Lines for rerun, packed at once: one by one they take most of a recording's time."""

from collections.abc import Sequence

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from rerun.components import LineStrip3DBatch
from rerun.encodings import Vec3DBatch


def strips(lines: Sequence[NDArray] | NDArray) -> pa.ListArray:
    """Return lines through points (m, 3) of any number each."""
    points = np.concatenate([np.empty((0, 3)), *lines])
    ends = np.cumsum([0, *[len(line) for line in lines]])
    return packed(points, ends)


def packed(points: NDArray[np.floating], ends: NDArray[np.integer]) -> pa.ListArray:
    """Return the lines through points[ends[k]:ends[k + 1]]."""
    kind = LineStrip3DBatch._ARROW_DATATYPE
    inner = Vec3DBatch(points.astype(np.float32)).as_arrow_array()
    offsets = pa.array(ends, pa.int32())
    return pa.ListArray.from_arrays(offsets, inner, type=kind)
