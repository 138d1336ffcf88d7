"""The short tables of the README hold the averages of the long ones."""

from pathlib import Path

import pandas as pd
import pytest

from placing.tables.metrics import AVERAGE
from placing.tables.readme_tables import (
    execution_summary,
    table1_averages,
    table2_averages,
)

PAPER = pd.read_csv(Path(__file__).parents[2] / "config" / "paper.csv")


def cells(line):
    return [cell.strip() for cell in line.strip("|").split("|")]


@pytest.fixture
def long():
    """Every average of one data set, each a number of its own."""
    names = ("location_m", "height_m", "placed_percent")
    keys = [
        (task, metric, constraints)
        for task in ("filled", "empty")
        for metric in names
        for constraints in ("without", "with", "inside")
    ]
    rows = [(*key, AVERAGE, float(n), 0.5, 3) for n, key in enumerate(keys)]
    columns = ["task", "metric", "constraints", "category", "value", "se", "n"]
    return pd.DataFrame(rows, columns=columns)


def test_table_1_says_what_the_robot_costs_beside_the_paper(long):
    lines = table1_averages({"rooms": long}, PAPER).splitlines()
    assert len(lines) == 2 + 4
    found = cells(lines[2])
    assert found[:3] == ["`rooms`", "`filled`", "location"]
    assert found[3:6] == ["0.00 ± 0.50", "1.00 ± 0.50", "2.00 ± 0.50"]
    assert found[6] == "7, 8"
    # The averages that were lost in print, as recomputed by hand.
    assert found[7:] == ["1.42", "1.62"]
    assert cells(lines[5])[7:] == ["0.125", "0.343"]


def test_table_2_has_our_averages_and_those_of_the_raters_of_the_paper():
    methods = ["dp", "fmm", "object_context", "dp_object_context"]
    ours = pd.DataFrame(
        {
            "method": methods,
            "average_co": [73.0, 74.0, 88.0, 77.0],
            "average_sc": [1.2, 2.2, 2.1, 1.3],
        }
    )
    lines = table2_averages(ours, PAPER).splitlines()
    found = {row[0]: row[1:] for row in map(cells, lines[2:])}
    assert found["human context (DP)"][:2] == ["73", "1.2"]
    assert found["object context"] == ["88", "2.1", "85", "3.7"]
    assert len(found) == 4


def test_scenarios_say_what_was_placed_how_well_and_what_was_not():
    executed = pd.DataFrame(
        {
            "scenario": ["kitchen"] * 3,
            "object": ["cup", "shoe", "can"],
            "error_m": [0.001, 0.002, None],
            "error_deg": [0.5, 0.1, None],
            "placed": [True, True, False],
            "reason": ["", "", "no path"],
        }
    )
    (line,) = execution_summary(executed).splitlines()[2:]
    assert cells(line) == ["kitchen", "2 of 3", "2.0", "0.5", "can: no path"]
