"""What the recording of a joint arrangement holds, put together; nothing of rerun.

Shapes: n objects, p places, k places that an object is drawn on.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from trimesh import Trimesh

from placing import rigid
from placing.candidates import Candidates
from placing.clouds.ply import Cloud
from placing.errors import BadArtifact
from placing.methods.answer_tables import LOCATION, ORIENTATION
from placing.scene import PlacingArea, Scene, SceneObject
from placing.shapes.objects import object_shape
from placing.tables.table2_answers import check_objects

Array = NDArray[np.float64]

COLDEST = 0.01
"""Places below this share of the highest density are not drawn."""
HEAT_PLACES = 1500
"""At most so many places, the likeliest, are drawn of an object."""


@dataclass(frozen=True)
class Heat:
    """Where an object is likely before the arrangement is made."""

    places: Array
    """(k, 3) [m]."""
    warmth: Array
    """(k,) from 0 at `COLDEST` of the highest density to 1 there, as its logarithm."""


@dataclass(frozen=True)
class Chosen:
    """Where an object is put, or why it is not."""

    item: SceneObject
    is_placed: bool
    reason: str
    """Why it is not placed."""
    T_world_object: Array
    """(7,) NaN where it is not placed."""
    area: PlacingArea | None
    """Where it stands, or what it stands on."""
    orientation: str
    on: str
    """The object it stands on, or nothing."""
    level: int
    log_psi: float
    log_psi_stability: float
    log_psi_semantics: float
    settled: str
    """Whether it stays when all is settled, or why not; empty where unknown."""
    mesh: Trimesh | None
    """In the world."""
    heat: Heat

    @property
    def half_extents(self) -> Array:
        """Half the size of its box along the world's axes, shape (3,) [m]."""
        turned = rigid.matrix(self.T_world_object[:4])
        return np.abs(turned) @ np.array(self.item.size_m) / 2


@dataclass(frozen=True)
class JointRecording:
    """All that one recording shows: one scene arranged by one method."""

    dataset: str
    scene: str
    method: str
    fold: int
    cloud: Cloud
    areas: tuple[PlacingArea, ...]
    spacing_m: float
    """Of the places."""
    objects: tuple[Chosen, ...]
    """(n,) in the order of the steps."""
    objective: float
    gap: float

    @property
    def placed(self) -> tuple[Chosen, ...]:
        """The objects that are placed."""
        return tuple(chosen for chosen in self.objects if chosen.is_placed)


def method_density(
    densities: Mapping[str, Array], method: str, object_weight: float
) -> Array:
    """Return the density of each object over places under a method, shape (n, p)."""
    if method != "dp_object_context":
        return densities[method]
    human, context = densities["dp"], densities["object_context"]
    return object_weight * human + (1 - object_weight) * context


def joint_recording(
    names: tuple[str, int, str],
    scene: Scene,
    cloud: Cloud,
    candidates: Candidates,
    spacing_m: float,
    density: Array,
    joint: pd.DataFrame,
    checks: pd.DataFrame | None,
) -> JointRecording:
    """Return the recording of a scene arranged by one method.

    `names` are data set, fold and method, `density` is (n, p), `joint` and `checks`
    hold the rows of this scene and method.
    """
    dataset, fold, method = names
    ids, shape = [item.object_id for item in scene.objects], density.shape
    check_objects(joint["object"], ids, scene.scene, method)
    if shape != (len(ids), len(candidates.location)):
        raise BadArtifact(
            f"densities of {scene.scene} by {method}: shape {shape}; expected "
            f"{(len(ids), len(candidates.location))}, objects by places"
        )
    rows, settled = joint.set_index("object"), settled_of(checks)
    areas = {area.area: area for area in scene.areas}
    objects = [
        _chosen(item, rows.loc[item.object_id], areas, settled, heat)
        for item, heat in zip(
            scene.objects,
            [heat_of(candidates.location, row) for row in density],
            strict=True,
        )
    ]
    first = joint.iloc[0] if len(joint) else {"objective": np.nan, "gap": np.nan}
    return JointRecording(
        *(dataset, scene.scene, method, fold, cloud, scene.areas, spacing_m),
        objects=tuple(objects),
        objective=float(first["objective"]),
        gap=float(first["gap"]),
    )


def heat_of(places: Array, density: Array) -> Heat:
    """Return where a density is high, as the logarithm of its share of the highest."""
    warmest = np.argsort(-density, kind="stable")[:HEAT_PLACES]
    highest = density[warmest[:1]].sum()
    kept = warmest[density[warmest] > COLDEST * highest]
    warmth = 1 - np.log(density[kept] / highest) / np.log(COLDEST)
    return Heat(places[kept], warmth)


def settled_of(checks: pd.DataFrame | None) -> dict[str, str]:
    """Return whether each object stays when all is settled, or why it does not."""
    if checks is None:
        return {}
    columns = [checks[name] for name in ("object", "stays", "reason")]
    return {
        str(name): "stays" if stays else str(reason)
        for name, stays, reason in zip(*columns, strict=True)
    }


def _chosen(
    item: SceneObject,
    row: pd.Series,
    areas: Mapping[str, PlacingArea],
    settled: Mapping[str, str],
    heat: Heat,
) -> Chosen:
    """Return where an object is put by its row of the joint table."""
    is_placed = bool(row["is_placed"])
    T = row[[*ORIENTATION, *LOCATION]].to_numpy(float)
    return Chosen(
        *(item, is_placed, str(row["reason"]), T),
        area=areas[row["area"]] if is_placed else None,
        orientation=str(row["orientation"]),
        on=str(row["on"]),
        level=int(row["level"]),
        log_psi=float(row["log_psi"]),
        log_psi_stability=float(row["log_psi_stability"]),
        log_psi_semantics=float(row["log_psi_semantics"]),
        settled=settled.get(item.object_id, "") if is_placed else "",
        mesh=_mesh(item, T) if is_placed else None,
        heat=heat,
    )


def _mesh(item: SceneObject, T_world_object: Array) -> Trimesh:
    """Return the mesh of an object in the world."""
    mesh = _mesh_of(item.shape, item.size_m).copy()
    return mesh.apply_transform(rigid.homogeneous(T_world_object))


@cache
def _mesh_of(shape: str, size_m: tuple[float, float, float]) -> Trimesh:
    """Return the mesh of an object, made once for all methods."""
    return object_shape(shape, size_m).mesh
