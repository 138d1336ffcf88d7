"""Transforms as CDR, which the encoder for any message takes most of a log's time for.

A tf2_msgs/TFMessage of known frames always has its numbers at the same places, so that
all of it is packed at once.
"""

import struct
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Edges = tuple[tuple[str, str], ...]
"""Names of parent and child of each transform."""

ENCAPSULATION = b"\0\1\0\0"
"""Plain CDR, little endian."""


def transforms(edges: Edges, time_ns: int, poses: NDArray[np.float64]) -> bytes:
    """Return a tf2_msgs/TFMessage; poses are (n, 7), xyz [m] and quaternion xyzw."""
    stamp = divmod(time_ns, 10**9)
    values: list[object] = [len(edges)]
    for (parent, child), pose in zip(edges, poses.tolist(), strict=True):
        values += stamp
        for name in (parent, child):
            text = name.encode() + b"\0"
            values += len(text), text
        values += pose
    return ENCAPSULATION + _format(edges).pack(*values)


@lru_cache(maxsize=4096)
def _format(edges: Edges) -> struct.Struct:
    """Return how the numbers and names of transforms lie, aligned by their sizes."""
    code, at = "<I", 4
    for parent, child in edges:
        at, code = _aligned(at, code, 4, "iI", 8)
        for name in (parent, child):
            n = len(name.encode()) + 1
            at, code = _aligned(at, code, 4, f"I{n}s", 4 + n)
        at, code = _aligned(at, code, 8, "7d", 56)
    return struct.Struct(code)


def _aligned(at: int, code: str, step: int, more: str, size: int) -> tuple[int, str]:
    """Return end and code after padding to a multiple of `step` and adding `more`."""
    n_pad = -at % step
    return at + n_pad + size, f"{code}{n_pad}x{more}"
