"""The diagnostics are those of the literature, and flag chains that disagree."""

import numpy as np
import pandas as pd
import pytest
from scipy.stats import norm, rankdata

from placing.people.diagnostics import (
    DIAGNOSTIC_COLUMNS,
    STATISTICS,
    DiagnosticsConfig,
    diagnose,
    diagnosis_row,
    normal_scores,
    rhat_and_ess,
    total_variation,
)
from placing.people.dpmm import Chains
from placing.tables.diagnostics_table import (
    diagnostics_markdown,
    summarise_diagnostics,
    worst_scenes,
)

GATES = DiagnosticsConfig(1.05, 0.05, 0)


def traces():
    """Return six kinds of traces (6, 4, 150): see REFERENCE."""
    rng = np.random.default_rng(2012)
    noise = rng.normal(size=(6, 4, 150))
    x = np.zeros_like(noise)
    for t in range(1, 150):
        x[..., t] = 0.6 * x[..., t - 1] + noise[..., t]
    x[1] = np.floor(np.exp(x[1] / 2))
    x[2, 0] += 1.5
    x[3] = 1 / (1 + np.exp(-3 * x[3]))
    x[4, 2] *= 3
    x[5] = noise[5] * np.where(np.arange(150) % 2, 1, -1)
    return x


# SOURCE: arviz-stats 0.8.0, `array_stats.rhat` and `array_stats.ess` of `traces()`,
# the first 150 and the first 131 samples of each chain.
REFERENCE = {
    150: (
        [1.002040329, 1.001522674, 1.133925999, 1.012836821, 1.120419481, 1.002641734],
        [226.1105285, 194.1936817, 22.88099961, 161.0450468, 136.9953674, 532.8796723],
    ),
    131: (
        [1.007590901, 1.003521067, 1.133240952, 1.010989333, 1.112879348, 1.004939807],
        [189.0891139, 174.3642728, 27.02073476, 158.8733715, 121.2081802, 451.9537698],
    ),
    5: (
        [1.299807078, 1.252976312, 1.433078880, 1.171993945, 1.428086260, 1.389435082],
        [19.26591972] * 6,
    ),
}


@pytest.mark.parametrize("n_samples", list(REFERENCE))
def test_rhat_and_ess_are_those_of_arviz(n_samples):
    rhat, ess = rhat_and_ess(traces()[..., :n_samples])
    np.testing.assert_allclose(rhat, REFERENCE[n_samples][0], rtol=1e-9)
    np.testing.assert_allclose(ess, REFERENCE[n_samples][1], rtol=1e-8)


def test_normal_scores_are_those_of_average_ranks():
    values = np.random.default_rng(0).integers(0, 9, (3, 50)).astype(float)
    values[2] = 4
    direct = [norm.ppf((rankdata(row) - 3 / 8) / (50 + 1 / 4)) for row in values]
    np.testing.assert_allclose(normal_scores(values), direct)


def test_a_trace_that_never_changes_has_rhat_1():
    constant = np.full((3, 4, 40), 0.1)
    constant[1] = -7.3
    constant[2] += 1e-12 * np.random.default_rng(0).normal(size=(4, 40))
    rhat, ess = rhat_and_ess(constant)
    np.testing.assert_array_equal(rhat, 1)
    np.testing.assert_array_equal(ess, 160)


def test_a_trace_that_flips_between_two_values_alike_has_rhat_near_1():
    flips = np.random.default_rng(0).integers(1, 3, (1, 4, 150)).astype(float)
    rhat, _ = rhat_and_ess(flips)
    assert 0.99 < rhat[0] < 1.02


def test_chains_that_are_stuck_apart_have_infinite_rhat():
    stuck = np.repeat([1.0, 2.0, 1.0, 2.0], 40).reshape(1, 4, 40)
    rhat, ess = rhat_and_ess(stuck)
    assert rhat[0] == np.inf
    assert ess[0] < 10


def test_what_cannot_be_known_is_nan_and_spoils_nothing_else():
    values = traces()
    values[1, 2, 3] = np.nan
    values[4, 0, 0] = -np.inf
    rhat, ess = rhat_and_ess(values)
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(rhat)), [1, 4])
    np.testing.assert_array_equal(np.isnan(rhat), np.isnan(ess))
    assert rhat[0] == pytest.approx(REFERENCE[150][0][0])
    assert np.isnan(rhat_and_ess(values[..., :3])).all()


def test_total_variation_is_the_largest_of_all_pairs_of_chains():
    rows = np.random.default_rng(0).dirichlet(np.ones(9), 4)
    direct = max(np.abs(a - b).sum() / 2 for a in rows for b in rows)
    assert total_variation(rows) == pytest.approx(direct)
    assert total_variation(rows[:1]) == 0
    assert total_variation(np.eye(3)) == 1


def chains(shift=0.0):
    """Return four chains of 150 samples, the third of them off by `shift`."""
    rng = np.random.default_rng(5)
    log_joint = rng.normal(-30, 1, (4, 150))
    log_joint[2] += shift
    n_poses = rng.integers(1, 4, (4, 150)).astype(np.int32)
    none, weight = np.zeros((4, 150, 1), np.int32), np.full((4, 1, 2), 0.5)
    p_new = rng.beta(2, 5, (4, 150))
    return Chains(none, none, log_joint, n_poses, p_new, weight)


ALIKE = [np.tile([0.5, 0.5], (4, 1)), np.tile([0.1, 0.9], (4, 1))]
APART = [ALIKE[0], np.array([[0.1, 0.9], [0.1, 0.9], [0.3, 0.7], [0.1, 0.9]])]


def test_chains_that_agree_are_mixed():
    diagnosis = diagnose(chains(), ALIKE)
    assert max(diagnosis.rhat.values()) < 1.05
    assert min(diagnosis.ess.values()) > 200
    assert diagnosis.variation == 0
    assert diagnosis.is_mixed(GATES)


def test_a_chain_that_disagrees_is_flagged_by_its_trace():
    diagnosis = diagnose(chains(shift=2.0), ALIKE)
    assert diagnosis.rhat["log_joint"] > 1.2
    assert diagnosis.rhat["n_poses"] < 1.05
    assert not diagnosis.is_mixed(GATES)


def test_a_chain_that_disagrees_is_flagged_by_its_placements():
    diagnosis = diagnose(chains(), APART)
    assert diagnosis.variation == pytest.approx(0.2)
    assert not diagnosis.is_mixed(GATES)
    assert diagnose(chains(), []).is_mixed(GATES)


def test_what_is_not_known_is_not_mixed():
    unknown = chains()
    unknown.p_new[0, 0] = np.nan
    assert not diagnose(unknown, ALIKE).is_mixed(GATES)
    empty = np.full((4, 2), np.nan)
    assert not diagnose(chains(), [ALIKE[0], empty]).is_mixed(GATES)
    assert not diagnose(chains(), [empty, ALIKE[0]]).is_mixed(GATES)


def questions():
    """Return the diagnostics of four questions about two scenes."""
    given = [
        ("kitchen1", "dp", chains(), ALIKE),
        ("kitchen1", "fmm", chains(), ALIKE),
        ("office1", "dp", chains(2.0), ALIKE),
        ("office1", "fmm", chains(), APART),
    ]
    rows = [
        diagnosis_row((scene, "filled", method, "all"), 3, diagnose(c, h), GATES)
        for scene, method, c, h in given
    ]
    return pd.DataFrame(rows, columns=DIAGNOSTIC_COLUMNS)


def test_the_row_of_a_question_has_its_diagnosis_under_its_names():
    row = questions().iloc[2]
    diagnosis = diagnose(chains(2.0), ALIKE)
    for name in STATISTICS:
        assert row[f"rhat_{name}"] == diagnosis.rhat[name]
        assert row[f"ess_{name}"] == diagnosis.ess[name]
    named = ("scene", "task", "method", "question", "n_objects", "is_mixed")
    assert tuple(row[list(named)]) == ("office1", "filled", "dp", "all", 3, False)


def test_the_page_counts_what_is_mixed_and_names_the_worst_scenes():
    summary = summarise_diagnostics(questions(), "rooms")
    assert summary["method"].tolist() == ["fmm", "dp"]
    assert summary["share_mixed"].tolist() == [0.5, 0.5]
    assert summary["questions"].tolist() == [2, 2]
    assert summary["variation_worst"].tolist() == pytest.approx([0.2, 0.0])
    worst = worst_scenes(questions(), GATES)
    assert worst["scene"].tolist() == ["office1", "kitchen1"]
    assert worst["unmixed"].tolist() == [2, 0]
    page = diagnostics_markdown(summary, worst, GATES)
    assert "Data set `rooms`" in page
    assert "| `dp` | 2 | 50.0 % |" in page
    assert "| `office1` | 2 | 2 |" in page
    assert "below 1.05" in page


def test_a_scene_of_unknown_diagnosis_is_among_the_worst():
    table = questions()
    table.loc[0, ["rhat_p_new", "is_mixed"]] = [np.nan, False]
    worst = worst_scenes(table, GATES)
    assert worst["scene"].iloc[0] == "kitchen1"
