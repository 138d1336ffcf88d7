"""What objects look like: shape, mass and colour, whatever they are called."""

from dataclasses import replace

import numpy as np
import pytest

from placing.psi.object_descriptors import (
    OBJECT_DESCRIPTORS,
    appearance,
    describe_object,
    describe_objects,
    sample_object,
)
from placing.scene import SceneObject

SPACING_M = 0.01


def item(shape, size_m, mass_kg=1.0):
    """Return an object of a shape."""
    return SceneObject("x", "x", shape, size_m, mass_kg, True, True)


def described(shape, size_m, mass_kg=1.0):
    """Return the numbers of an object by name."""
    (row,) = describe_objects([item(shape, size_m, mass_kg)], SPACING_M)
    return {name: row[i] for i, name in enumerate(OBJECT_DESCRIPTORS)}


def test_sizes_are_those_of_the_box():
    of = described("book", (0.24, 0.17, 0.03), 0.55)
    sizes = [of[f"log_{name}_m"] for name in ("long", "middle", "short", "height")]
    np.testing.assert_allclose(np.exp(sizes), [0.24, 0.17, 0.03, 0.03], rtol=0.1)
    assert np.exp(of["log_mass_kg"]) == pytest.approx(0.55)
    assert np.exp(of["log_density"]) == pytest.approx(
        0.55 / 0.24 / 0.17 / 0.03, rel=0.2
    )


def test_shapes_are_told_apart_by_shape():
    can = described("soda_can", (0.066, 0.066, 0.122))
    book = described("book", (0.24, 0.17, 0.03))
    bowl = described("bowl", (0.165, 0.165, 0.07))
    assert can["roundness"] > 0.95 > 0.9 > book["roundness"]
    assert can["upright"] > 0 > book["upright"]
    assert book["hull_fill"] > 0.9 > can["hull_fill"]
    assert bowl["solidity"] < book["solidity"]
    assert book["flat_underside"] > 0.7 > 0.3 > bowl["flat_underside"]


def test_names_do_not_matter():
    one = item("mug", (0.084, 0.118, 0.098))
    other = replace(one, object_id="sofa", category="cushion", has_front=False)
    first, second = describe_objects([one, other], SPACING_M)
    np.testing.assert_array_equal(first, second)


def test_a_finer_cloud_shows_the_same_object():
    one = item("vase", (0.15, 0.15, 0.28))
    coarse, fine = (describe_object(one, sample_object(one, s)) for s in (0.01, 0.004))
    np.testing.assert_allclose(coarse, fine, atol=0.12)


def test_grey_has_no_saturation_and_red_has_all():
    colors = np.array([[90, 90, 90], [200, 0, 0], [0, 0, 0]], np.uint8)
    found = [appearance(color[None]) for color in colors]
    np.testing.assert_allclose(found, [(0, 90 / 255), (1, 200 / 255), (0, 0)])
