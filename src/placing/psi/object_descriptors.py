"""What an object looks like, as numbers: no name and no category goes in.

Shape and appearance of an object are read off a cloud of it alone; its mass is what
its user states.

Shapes: n points, n objects in a table of descriptors, d numbers.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from placing.clouds.cloud import sample_cloud
from placing.clouds.ply import Cloud
from placing.scene import SceneObject
from placing.seeds import generator
from placing.shapes.objects import object_shape

Array = NDArray[np.float64]

OBJECT_DESCRIPTORS = (
    "log_long_m",
    "log_middle_m",
    "log_short_m",
    "log_height_m",
    "log_foot_m2",
    "log_box_m3",
    "upright",
    "foot_aspect",
    "hull_fill",
    "solidity",
    "roundness",
    "flat_side_up",
    "flat_underside",
    "log_mass_kg",
    "log_density",
    "saturation",
    "brightness",
)
"""Names of the numbers that describe an object, in order."""
NEAR_FOOT = 0.03
"""Share of an object's height that counts as its under side."""
LEVEL = 0.9
"""Least vertical part of a unit normal of what is level: 26 degrees."""


def describe_objects(items: Sequence[SceneObject], spacing_m: float) -> Array:
    """Return what objects look like, shape (n, d)."""
    rows = [describe_object(item, sample_object(item, spacing_m)) for item in items]
    return np.array(rows).reshape(len(rows), len(OBJECT_DESCRIPTORS))


def sample_object(item: SceneObject, spacing_m: float) -> Cloud:
    """Return points on an object in its own frame."""
    mesh = object_shape(item.shape, item.size_m).mesh
    rng = generator(0, "sample_object")  # One cloud per object, whatever the seed.
    return sample_cloud(rng, [mesh], spacing_m)


def describe_object(item: SceneObject, cloud: Cloud) -> Array:
    """Return what an object looks like in a cloud in its frame, shape (d,)."""
    sizes = np.ptp(cloud.points.astype(float), axis=0) + 1e-4  # A guard for sheets.
    short, middle, long = np.sort(sizes)
    foot, height = sizes[0] * sizes[1], sizes[2]
    saturation, brightness = appearance(cloud.colors)
    hull_fill, solidity = _fill(cloud.points, sizes)
    values = {
        "log_long_m": np.log(long),
        "log_middle_m": np.log(middle),
        "log_short_m": np.log(short),
        "log_height_m": np.log(height),
        "log_foot_m2": np.log(foot),
        "log_box_m3": np.log(foot * height),
        "upright": np.log(height / np.sqrt(foot)),
        "foot_aspect": np.log(sizes[:2].max() / sizes[:2].min()),
        "hull_fill": hull_fill,
        "solidity": solidity,
        "roundness": _roundness(cloud.points[:, :2]),
        "flat_side_up": np.mean(cloud.normals[:, 2] > LEVEL),
        "flat_underside": _flat_underside(cloud, sizes),
        "log_mass_kg": np.log(item.mass_kg),
        "log_density": np.log(item.mass_kg / (foot * height)),
        "saturation": saturation,
        "brightness": brightness,
    }
    return np.array([values[name] for name in OBJECT_DESCRIPTORS], float)


def appearance(colors: NDArray[np.uint8]) -> tuple[float, float]:
    """Return mean saturation and brightness, each from 0 to 1."""
    shades = colors.astype(float) / 255
    bright, dark = shades.max(1), shades.min(1)
    saturation = (bright - dark) / np.maximum(bright, 1e-9)  # Black has none.
    return float(saturation.mean()), float(bright.mean())


def _fill(points: NDArray[np.floating], sizes: Array) -> tuple[float, float]:
    """Return the shares of box and of hull: the hull's volume, the points' reach.

    The reach of a point is how far out it lies on the way from the centre to the hull:
    1 for every point of a convex object, less for what is hollow or has handles.
    """
    centred = points - points.mean(0)
    hull = ConvexHull(centred, qhull_options="QJ")  # Joggled, so that sheets pass.
    normals, offsets = hull.equations[:, :3], hull.equations[:, 3]
    step = max(len(centred) // 500, 1)  # Some hundred points give the mean.
    reach = (centred[::step] @ normals.T / -offsets).max(1)
    return float(hull.volume / sizes.prod()), float(np.clip(reach, 0, 1).mean())


def _roundness(xy: NDArray[np.floating]) -> float:
    """Return 1 for an outline that is a circle seen from above, less for others."""
    hull = ConvexHull(xy, qhull_options="QJ")
    # In the plane, scipy calls the area `volume` and the perimeter `area`.
    return float(4 * np.pi * hull.volume / hull.area**2)


def _flat_underside(cloud: Cloud, sizes: Array) -> float:
    """Return the share of the footprint's box that meets a plane below."""
    z = cloud.points[:, 2]
    near = z < z.min() + max(NEAR_FOOT * sizes[2], 0.002)
    is_down = near & (cloud.normals[:, 2] < -LEVEL)
    if is_down.sum() < 3:
        return 0.0
    cells = np.floor((cloud.points[is_down, :2] / sizes[:2]) * 20).astype(int)
    return len(np.unique(cells, axis=0)) / 400
