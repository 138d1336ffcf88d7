"""Fixtures as they are known before anything is placed: scanned, clean and noisy."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator

from placing.clouds.cloud import CloudConfig, preprocess, sample_cloud
from placing.clouds.ply import Cloud
from placing.physics.bodies import Piece
from placing.physics.cutting import fixed_pieces
from placing.physics.fixtures import INSTANCES, KINDS, Fixture, fixture_of
from placing.psi.contacts import PlacingField
from placing.scene import PlacingArea
from placing.seeds import generator

Key = tuple[str, int, bool]
"""Kind and number of a fixture, and whether its cloud is noisy."""


@dataclass(frozen=True)
class Ground:
    """What is known of a fixture before anything is placed: its cloud and areas."""

    fixture: Fixture
    field: PlacingField
    areas: tuple[PlacingArea, ...]
    """With heights as precise as the cloud."""


def grounds_of(
    seed: int,
    noise_m: float,
    cell_m: float,
    cloud: CloudConfig,
    spacing_m: float,
    kinds: Sequence[str] = KINDS,
) -> dict[Key, Ground]:
    """Return the fixtures of some kinds, each as a clean and as a noisy scan.

    `noise_m` is the noise of the points of the noisy one, `cell_m` the cell in which
    clouds are looked up, `spacing_m` the distance of the points of a scan.
    """
    found = {}
    for kind in kinds:
        for instance in range(len(INSTANCES[kind])):
            # ASSUME: the first of each kind stands along the axes, as in most rooms.
            rng = generator(seed, "fixture", kind, str(instance))
            yaw_rad = rng.uniform(-np.pi, np.pi) if instance else 0.0
            fixture = fixture_of(kind, instance, yaw_rad)
            for spread_m in (0.0, noise_m):
                scan = scan_of(rng, fixture, spread_m, spacing_m, cloud)
                areas = tuple(_seen(rng, area, spread_m) for area in fixture.areas)
                ground = Ground(fixture, PlacingField(scan, cell_m), areas)
                found[kind, instance, spread_m > 0] = ground
    return found


def scan_of(
    rng: Generator,
    fixture: Fixture,
    noise_m: float,
    spacing_m: float,
    config: CloudConfig,
) -> Cloud:
    """Return the cloud of a fixture, preprocessed as those of scenes are."""
    scan = sample_cloud(rng, list(fixture.meshes.values()), spacing_m)
    if noise_m > 0:
        # ASSUME: a camera held by a person sees no undersides; its normals are fitted.
        scan = scan.take(scan.normals[:, 2] > -0.5)
        noise = rng.normal(0.0, noise_m, scan.points.shape)
        points = (scan.points + noise).astype(np.float32)
        scan = Cloud(points, np.zeros_like(scan.normals), scan.colors)
    return preprocess(scan, config)


def _seen(rng: Generator, area: PlacingArea, noise_m: float) -> PlacingArea:
    """Return the area with its height as a scan gives it."""
    # ASSUME: an area is a mean of many points, so its height errs less than a point.
    error_m = rng.normal(0.0, 0.3 * noise_m) if noise_m > 0 else 0.0
    return replace(area, height_m=area.height_m + error_m)


def pieces_of_fixtures(
    grounds: Mapping[Key, Ground], margin_m: float
) -> dict[str, dict[str, tuple[Piece, ...]]]:
    """Return the pieces of each fixture for the simulator, by name."""
    return {
        ground.fixture.name: {
            name: fixed_pieces(mesh, margin_m)
            for name, mesh in ground.fixture.meshes.items()
        }
        for (_, _, is_noisy), ground in grounds.items()
        if not is_noisy
    }
