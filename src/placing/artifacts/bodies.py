"""What is really in a scene, cut for a simulator, as arrays.

Letters for shapes: n things, the furniture first; p pieces; v vertices; f faces.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placing.artifacts.formats import read_arrays, write_arrays
from placing.errors import BadArtifact
from placing.physics.bodies import Body, Piece, Solids

NAMES = ("fixed", "objects", "mass_kg", "mass_centre_m", "inertia_kg_m2")
PIECES = ("thing", "is_convex", "n_vertices", "n_faces", "vertices_m", "faces")


def write_solids(path: Path, solids: Solids) -> None:
    """Write what is in a scene."""
    bodies = list(solids.bodies.values())
    things = [*solids.fixed.values(), *(body.pieces for body in bodies)]
    pieces = [piece for some in things for piece in some]
    arrays = {
        "fixed": np.array(list(solids.fixed), np.str_),
        "objects": np.array(list(solids.bodies), np.str_),
        "mass_kg": np.array([body.mass_kg for body in bodies], float),
        "mass_centre_m": np.array([b.mass_centre_m for b in bodies]).reshape(-1, 3),
        "inertia_kg_m2": np.array([b.inertia_kg_m2 for b in bodies]).reshape(-1, 3),
        "thing": np.repeat(np.arange(len(things)), [len(some) for some in things]),
        "is_convex": np.array([piece.is_convex for piece in pieces], bool),
        "n_vertices": np.array([len(piece.vertices_m) for piece in pieces], int),
        "n_faces": np.array([len(piece.faces) for piece in pieces], int),
        "vertices_m": np.concatenate([piece.vertices_m for piece in pieces]),
        "faces": np.concatenate([piece.faces for piece in pieces]),
    }
    write_arrays(path, arrays)


def read_solids(path: Path) -> Solids:
    """Read what is in a scene after checking that the arrays belong together."""
    arrays = read_arrays(path, NAMES + PIECES)
    n_fixed, n = len(arrays["fixed"]), len(arrays["fixed"]) + len(arrays["objects"])
    _check(path, arrays, n)
    pieces: list[list[Piece]] = [[] for _ in range(n)]
    for thing, piece in zip(arrays["thing"].tolist(), _pieces(arrays), strict=True):
        pieces[thing].append(piece)
    masses = (arrays[name] for name in NAMES[2:])
    bodies = [
        Body(tuple(some), float(mass_kg), centre, inertia)
        for some, mass_kg, centre, inertia in zip(
            pieces[n_fixed:], *masses, strict=True
        )
    ]
    fixed = map(tuple, pieces[:n_fixed])
    return Solids(
        dict(zip(arrays["fixed"].tolist(), fixed, strict=True)),
        dict(zip(arrays["objects"].tolist(), bodies, strict=True)),
    )


def _pieces(arrays: dict[str, NDArray[Any]]) -> Iterator[Piece]:
    """Yield the pieces one after the other."""
    v, f = 0, 0
    rows = zip(*(arrays[name].tolist() for name in PIECES[1:4]), strict=True)
    for is_convex, n_vertices, n_faces in rows:
        vertices_m = arrays["vertices_m"][v : v + n_vertices]
        yield Piece(vertices_m, arrays["faces"][f : f + n_faces], is_convex)
        v, f = v + n_vertices, f + n_faces


def _check(path: Path, arrays: dict[str, NDArray[Any]], n: int) -> None:
    """Raise `BadArtifact` for arrays that do not belong together."""
    m, p = len(arrays["objects"]), len(arrays["thing"])
    shapes = {"mass_kg": (m,), "mass_centre_m": (m, 3), "inertia_kg_m2": (m, 3)}
    shapes |= {name: (p,) for name in PIECES[:4]}
    shapes |= {"vertices_m": (arrays["n_vertices"].sum(), 3)}
    shapes |= {"faces": (arrays["n_faces"].sum(), 3)}
    for name, shape in shapes.items():
        if arrays[name].shape != shape:
            raise BadArtifact(
                f"{path}: {name}: shape {arrays[name].shape}; expected {shape}"
            )
    most = np.repeat(arrays["n_vertices"], arrays["n_faces"])[:, None]
    wrong = {
        "thing": not np.array_equal(np.unique(arrays["thing"]), np.arange(n)),
        "faces": np.any((arrays["faces"] < 0) | (arrays["faces"] >= most)),
        "mass_kg": not np.all(arrays["mass_kg"] > 0) or _is_endless(arrays["mass_kg"]),
    }
    for name in ("mass_centre_m", "inertia_kg_m2", "vertices_m"):
        wrong[name] = _is_endless(arrays[name])
    for name, is_wrong in wrong.items():
        if is_wrong:
            raise BadArtifact(f"{path}: {name}: not what cut_bodies writes")


def _is_endless(values: NDArray[np.floating]) -> bool:
    """Return whether a number is not finite."""
    return not np.isfinite(values).all()
