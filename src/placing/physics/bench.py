"""What all trials are made with: fixtures, objects, and both as the simulator wants."""

from collections.abc import Mapping
from dataclasses import dataclass

from placing.clouds.cloud import CloudConfig
from placing.physics.bodies import Body, Piece
from placing.physics.cutting import bodies_of
from placing.physics.grounds import Ground, Key, grounds_of, pieces_of_fixtures
from placing.physics.settling import SettleConfig
from placing.physics.things import Thing, things_of
from placing.physics.trials import TrialsConfig
from placing.psi.object_clouds import LookingConfig
from placing.psi.orientations import OrientationsConfig
from placing.scene import SceneObject


@dataclass(frozen=True)
class BenchConfig:
    """The sections of the configuration that trials look at."""

    cloud: CloudConfig
    orientations: OrientationsConfig
    looking: LookingConfig
    trials: TrialsConfig
    settling: SettleConfig


@dataclass(frozen=True)
class Bench:
    """What is tried, and where."""

    things: Mapping[str, Thing]
    grounds: Mapping[Key, Ground]
    bodies: Mapping[str, Body]
    fixed: Mapping[str, Mapping[str, tuple[Piece, ...]]]


def bench_of(
    seed: int,
    catalogue: Mapping[str, SceneObject],
    spacing_m: float,
    config: BenchConfig,
) -> Bench:
    """Return what is tried where; `spacing_m` is that of the points of a scan."""
    looking, margin_m = config.looking, config.settling.margin_m
    things = things_of(catalogue, looking.object_spacing_m, config.orientations)
    args = config.trials.noise_m, looking.cell_m, config.cloud, spacing_m
    grounds = grounds_of(seed, *args)
    bodies = bodies_of([thing.item for thing in things.values()], margin_m)
    return Bench(things, grounds, bodies, pieces_of_fixtures(grounds, margin_m))
