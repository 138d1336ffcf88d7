"""What every shape function returns: a mesh, and where things can stand on it."""

from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray


@dataclass(frozen=True)
class Support:
    """A horizontal patch of a mesh that holds objects: a true placing area."""

    name: str
    """Unique in its shape: `top`, `shelf1` (from below), `seat`, `basin`, ..."""
    polygon_m: NDArray[np.float64]
    """(v, 2) corners in the frame of the furniture, counter-clockwise."""
    height_m: float
    clearance_m: float
    """Free height above inside the shape; `inf` where it is open."""
    softness: float
    """0 hard to 1 soft."""


@dataclass(frozen=True)
class Shape:
    """A coloured mesh in the frame of its furniture or object, and its supports."""

    mesh: trimesh.Trimesh
    """Closed wherever a solid is meant; `visual.face_colors` holds its colours."""
    supports: tuple[Support, ...]
