"""What the joint placement chooses from: options of every object, with their scores.

The places that any method finds likely, each with every heading, and at each of them
the orientation that stays best; what the methods think of them is kept apart, so that
they are mixed later.

Shapes: n objects, p places, k places kept, y headings, o options of all objects.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from placing import rigid
from placing.joint.options import Options, thin_options
from placing.methods.answering import Asked, only_on
from placing.psi.elbow_room import has_room
from placing.psi.psi_object import PsiObject, box_of
from placing.scene import SceneObject

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

HUMAN = ("fmm", "dp")
"""Methods of human context whose densities are kept."""
DENSITIES = (*HUMAN, "object_context")


@dataclass(frozen=True)
class ProposalConfig:
    """Which placements are proposed; the values live in `config/config.yaml`."""

    n_best: int
    """Places that a method finds likeliest for an object."""
    n_spread: int
    """Places beside them, far from each other."""
    room_m: float
    """Free width beside an object."""
    lift_m: float
    """What is lower above its bottom is what it stands on, not beside it."""


@dataclass(frozen=True)
class Proposals:
    """The options of all objects of a scene, by object."""

    object: Indices
    """(o,) number of the object."""
    place: Indices
    """(o,)."""
    orientation: NDArray[np.str_]
    """(o,) its name."""
    T_world_object: Array
    """(o, 7)."""
    box: Array
    """(o, 7) centre, size and yaw."""
    has_room: NDArray[np.bool_]
    """(o,) whether nothing is too near beside it, see `elbow_room`."""
    log_stability: Array
    """(o,) log Psi_stability."""
    log_semantics: Array
    """(o,) log Psi_semantics."""
    log_fmm: Array
    """(o,) log density of place and heading under the finite mixture."""
    log_dp: Array
    """(o,) the same under the Dirichlet process mixture."""
    log_object_context: Array
    """(o,) the same under Psi_object."""


def densities_of(
    asked: Asked, psi: PsiObject, item: SceneObject
) -> dict[str, tuple[Array, Array]]:
    """Return the density of an object by method, and it as places are chosen, (p,)."""
    model, allowed = asked.model, asked.allowed[item.object_id]
    found = {}
    for method in HUMAN:
        density, smooth = asked.density(asked.stream(method), method, item.category)
        found[method] = only_on(allowed, density), only_on(allowed, smooth)
    density = psi.density(item, allowed, model.yaws)
    return found | {"object_context": (density, density)}


def propose(
    asked: Asked,
    psi: PsiObject,
    number: int,
    densities: Mapping[str, tuple[Array, Array]],
    config: ProposalConfig,
) -> Proposals:
    """Return the options of one object, the `number`-th of the scene."""
    model = asked.model
    item = model.scene.objects[number]
    smooth = {name: chosen_by for name, (_, chosen_by) in densities.items()}
    places = _likely(model.candidates.location, item, smooth, config)  # (k,)
    stands = psi.stands(item, places, model.yaws)
    shape = k, y = stands.orientation.shape
    ways = psi.ways(item)
    names = np.array([way.name for way in ways])
    boxes = [box_of(psi.cloud(item), way.quaternion) for way in ways]
    area = model.candidates.area[places]
    args = stands.orientation, stands.T_world_object, model.yaws
    box = _boxes(boxes, *args).reshape(-1, 7)
    human = {m: _log_human(asked, item, m, places, smooth[m]) for m in HUMAN}
    turn = _log_shares(stands.log_psi)
    with np.errstate(divide="ignore"):  # a place that no method likes stays so
        log_context = np.log(smooth["object_context"][places])[:, None] + turn
    return Proposals(
        object=np.full(k * y, number),
        place=np.repeat(places, y),
        orientation=names[stands.orientation.ravel()],
        T_world_object=stands.T_world_object.reshape(-1, 7),
        box=box,
        has_room=has_room(
            *(psi.field.points, model.scene.areas, box, np.repeat(area, y)),
            *(config.room_m, config.lift_m),
        ),
        log_stability=stands.log_stability.ravel(),
        log_semantics=np.broadcast_to(
            psi.log_semantics(item)[area][:, None], shape
        ).ravel(),
        log_fmm=human["fmm"].ravel(),
        log_dp=human["dp"].ravel(),
        log_object_context=log_context.ravel(),
    )


def together(parts: list[Proposals]) -> Proposals:
    """Return the options of several objects as one table."""
    columns = {
        f.name: [getattr(part, f.name) for part in parts] for f in fields(Proposals)
    }
    return Proposals(**{name: np.concatenate(c) for name, c in columns.items()})


def _likely(
    location: Array,
    item: SceneObject,
    smooth: Mapping[str, Array],
    config: ProposalConfig,
) -> Indices:
    """Return the places that some method finds likely, and some far from them, (k,)."""
    kept = []
    size = np.tile(item.size_m, (len(location), 1))
    for density in smooth.values():
        at = np.flatnonzero(density > 0)
        zeros = np.zeros(len(at), np.int32)
        places = Options(
            *(location[at], size[at], zeros.astype(float), zeros, at.astype(np.int32)),
            *(np.full(len(at), np.inf), np.log(density[at])),
        )
        kept.append(at[thin_options(places, config.n_best, config.n_spread)])
    return np.unique(np.concatenate(kept))


def _log_human(
    asked: Asked, item: SceneObject, method: str, places: Indices, smooth: Array
) -> Array:
    """Return the log density of places and headings under a human context, (k, y)."""
    model, people = asked.model, asked.people(asked.stream(method), method)
    share = np.full((len(places), len(model.yaws)), 1 / len(model.yaws))
    if people is not None:
        use = model.use(people.theta, item.category)
        weight = people.weight[item.category]
        rows = [use.heading_probability(int(p), weight, model.yaws) for p in places]
        share = np.array(rows).reshape(share.shape)
    with np.errstate(divide="ignore"):  # a place that no method likes stays so
        return np.log(smooth[places])[:, None] + np.log(share)


def _log_shares(log_psi: Array) -> Array:
    """Return the log share of each heading at its place, shape (k, y)."""
    highest = log_psi.max(1, keepdims=True)
    total = np.log(np.exp(log_psi - highest).sum(1, keepdims=True)) + highest
    return log_psi - total


def _boxes(
    boxes: list[tuple[Array, Array]], orientation: Indices, T: Array, yaws: Array
) -> Array:
    """Return centre, size and yaw of the boxes of placements, shape (k, y, 7).

    `boxes` holds centre and size of the object in each orientation before the yaw.
    """
    centre = np.array([middle for middle, _ in boxes])[orientation]  # (k, y, 3)
    size = np.array([extent for _, extent in boxes])[orientation]
    turned = rigid.turn_about_z(yaws, centre)
    yaw = np.broadcast_to(yaws, orientation.shape)[..., None]
    return np.concatenate([T[..., 4:] + turned, size, yaw], axis=2)
