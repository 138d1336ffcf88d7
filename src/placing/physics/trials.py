"""Trials of placements: objects are lowered onto fixtures, let go, and watched.

Every trial draws from a stream of its own and settles in a world of its own: results
depend neither on their order nor on the number of workers.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.random import Generator
from numpy.typing import NDArray

from placing import rigid
from placing.physics.grounds import Ground, Key
from placing.physics.things import Thing
from placing.psi.contacts import rest_heights
from placing.rigid import Array
from placing.scene import PlacingArea
from placing.seeds import generator

SLOT_ERROR_M = 0.01
"""Spread of places around the middle of a slot."""
POSE = ("qw", "qx", "qy", "qz", "x_m", "y_m", "z_m")
"""Columns of a table that hold a pose, in the order of `rigid`."""
MEASURED = ("penetration_m", "moved_m", "dropped_m", "tilted_deg", "speed_m_s")
TRIAL_COLUMNS = (
    "trial",
    "fixture",
    "instance",
    "is_noisy",
    "object",
    "orientation",
    "area_height_m",
    *POSE,
    *MEASURED,
    "stays",
)

# ASSUME: of a kind of fixture that is made for few shapes, half of the trials are with
# these: stemmed glasses are too rare among all objects to learn how they hang.
SUITED = {
    "dish_rack": ("plate", "bowl", "mug", "cup", "frying_pan", "saucepan"),
    "stemware_holder": ("wine_glass", "martini_glass"),
    "hooks": ("ladle", "spatula", "mug", "broom"),
    "pen_holder": ("pen", "spatula", "ladle", "remote"),
}


@dataclass(frozen=True)
class TrialsConfig:
    """What is tried; the values live in `config/config.yaml`."""

    n_trials: int
    noise_m: float
    """Noise of the points of a fixture as a depth camera sees it."""
    noisy_share: float
    """Share of the trials in which the cloud of the fixture is noisy."""
    upright_share: float
    """Share of the trials that are upright before all orientations are drawn alike."""
    aligned_share: float
    """Share of the trials whose yaw is a multiple of 45 degrees from the fixture's."""
    suited_share: float
    """Share of the trials with objects that a fixture is made for."""
    beyond_m: float
    """How far outside a placing area the centre of an object may be."""


def draw_trial(
    rng: Generator,
    grounds: Mapping[Key, Ground],
    things: Mapping[str, Thing],
    config: TrialsConfig,
) -> dict[str, object]:
    """Return a row of the table of trials without its height and its outcome."""
    kinds = list(dict.fromkeys(kind for kind, _, _ in grounds))
    kind = kinds[rng.integers(len(kinds))]
    instance = int(rng.integers(len({i for name, i, _ in grounds if name == kind})))
    is_noisy = bool(rng.random() < config.noisy_share)
    is_suited = bool(rng.random() < config.suited_share)
    shapes = SUITED.get(kind, ()) if is_suited else ()
    names = [name for name, t in things.items() if t.item.shape in shapes]
    names = names or list(things)
    thing = things[names[rng.integers(len(names))]]
    ground = grounds[kind, instance, is_noisy]
    placement = draw_placement(rng, ground, thing, config, is_suited)
    return {"fixture": kind, "instance": instance, "is_noisy": is_noisy, **placement}


def draw_placement(
    rng: Generator,
    ground: Ground,
    thing: Thing,
    config: TrialsConfig,
    is_suited: bool = False,
) -> dict[str, object]:
    """Return how an object comes down on a fixture: place, rotation, start height.

    What suits a fixture goes into its slots, where it has some.
    """
    slots_m = ground.fixture.slots_m if is_suited else ()
    turned = _special(thing) if slots_m else list(range(len(thing.ways)))
    is_upright = rng.random() < config.upright_share
    at = 0 if is_upright else turned[rng.integers(len(turned))]
    area = ground.areas[rng.integers(len(ground.areas))]
    is_aligned = rng.random() < config.aligned_share
    turn = rng.integers(8) * np.pi / 4 if is_aligned else rng.uniform(0, 2 * np.pi)
    yaw = rigid.yaw_quaternion(ground.fixture.yaw_rad + turn)
    quaternion = rigid.multiply(yaw, thing.ways[at].quaternion)
    xy = _draw_xy(rng, area, ground.fixture.yaw_rad, config.beyond_m, slots_m)
    return {
        "object": thing.item.object_id,
        "orientation": thing.ways[at].name,
        "area_height_m": area.height_m - thing.drops_m[at],
        **dict(zip(POSE, (*quaternion, *xy, 0.0), strict=True)),
    }


def _special(thing: Thing) -> list[int]:
    """Return the numbers of the orientations for slots, of all where it has none."""
    names = [way.name for way in thing.ways]
    found = [i for i, name in enumerate(names) if name[:4] in ("edge", "hung", "lean")]
    return found or list(range(len(names)))


def _draw_xy(
    rng: Generator,
    area: PlacingArea,
    yaw_rad: float,
    beyond_m: float,
    slots_m: tuple[float, ...],
) -> Array:
    """Return a place near a slot, or in the box of an area, shape (2,) [m]."""
    c, s = np.cos(yaw_rad), np.sin(yaw_rad)
    R_world_fixture = np.array([[c, -s], [s, c]])
    corners = area.polygon_m @ R_world_fixture
    low, high = corners.min(0), corners.max(0)
    if slots_m:
        y = slots_m[rng.integers(len(slots_m))] + rng.normal(0.0, SLOT_ERROR_M)
        return R_world_fixture @ np.array([rng.uniform(low[0], high[0]), y])
    return R_world_fixture @ rng.uniform(low - beyond_m, high + beyond_m)


def draw_trials(
    seed: int,
    grounds: Mapping[Key, Ground],
    things: Mapping[str, Thing],
    config: TrialsConfig,
) -> pd.DataFrame:
    """Return the table of trials with their poses, each from its own stream."""
    rows = [
        {
            "trial": i,
            **draw_trial(
                generator(seed, "run_trials", str(i)), grounds, things, config
            ),
        }
        for i in range(config.n_trials)
    ]
    return lowered(pd.DataFrame(rows), grounds, things)


def lowered(
    table: pd.DataFrame, grounds: Mapping[Key, Ground], things: Mapping[str, Thing]
) -> pd.DataFrame:
    """Return the table with the heights to which the objects are lowered."""
    z = np.zeros(len(table))
    for key, name, rows in groups_of(table):
        part = table.iloc[rows]
        z[rows] = rest_heights(
            grounds[key].field,
            things[name].cloud,
            part[list(POSE[:4])].to_numpy(float),
            part[["x_m", "y_m"]].to_numpy(float),
            part["area_height_m"].to_numpy(float),
        )
    return table.assign(z_m=z)


def groups_of(
    table: pd.DataFrame,
) -> Iterator[tuple[Key, str, NDArray[np.intp]]]:
    """Yield fixture, object and row numbers of all trials that share both.

    Object by object, since what is prepared of an object is kept for a while only.
    """
    columns = ["object", "fixture", "instance", "is_noisy"]
    for (name, kind, instance, is_noisy), rows in table.groupby(
        columns
    ).indices.items():
        yield (str(kind), int(instance), bool(is_noisy)), str(name), rows
