"""Variations differ from the study in one number; coarse lattices are sublattices."""

import numpy as np
import pytest
from study import SETTINGS, study

from placing.learning.variations import (
    BASE,
    SensitivityConfig,
    coarser_places,
    coarser_poses,
    variations,
)

CONFIG = SensitivityConfig((0.3, 3.0), (8,), (0.1,), (2,))


def test_each_variation_changes_one_number():
    varied = list(variations(SETTINGS, CONFIG))
    assert varied[0].name == BASE
    assert varied[0].settings == SETTINGS
    assert len(varied) == 6
    for variation in varied[1:]:
        sections = vars(variation.settings)
        changed = [n for n in sections if sections[n] != getattr(SETTINGS, n)]
        assert len(changed) == 1, variation.name


def test_coarser_places_are_the_places_on_the_coarser_lattice():
    _, candidates, _ = study()
    coarse = coarser_places(candidates, 0.1)
    cells = coarse.location[:, :2] / 0.1
    np.testing.assert_allclose(cells, cells.round(), atol=1e-6)
    assert len(coarse.location) == pytest.approx(len(candidates.location) / 4, rel=0.15)
    all_rows = {tuple(row) for row in candidates.location.round(6)}
    assert {tuple(row) for row in coarse.location.round(6)} <= all_rows


def test_coarser_poses_keep_every_kind_and_a_prior():
    _, _, poses = study()
    coarse = coarser_poses(poses, 2)
    assert set(coarse.kind) == set(poses.kind)
    assert len(coarse.kind) < len(poses.kind) / 2
    assert coarse.prior.sum() == pytest.approx(1)
