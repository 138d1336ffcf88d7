"""The page of Figure 6 says every number, what it rests on and what the paper says."""

from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from placing.methods.names import ORDER
from placing.tables.metrics import SUMMARY_COLUMNS
from placing.tables.report import MARK, averages_by_task, figure6_markdown

PAPER = Path(__file__).parents[2] / "config" / "paper.csv"


def figure6(methods=ORDER, dataset="rooms"):
    """Return a table with another location in every cell."""
    keys = list(product([dataset], ("filled", "empty"), methods, ("book", "tv", "AVG")))
    table = pd.DataFrame(keys, columns=list(SUMMARY_COLUMNS[:4]))
    table["n"] = 8
    for number, name in enumerate(SUMMARY_COLUMNS[5:], 1):
        table[name] = number + np.arange(len(table)) / 100
    no_front = table["category"] == "book"
    table.loc[no_front, ["orientation_deg", "orientation_se_deg"]] = np.nan
    return table.assign(unmixed=np.nan)


@pytest.fixture
def paper():
    return pd.read_csv(PAPER)


def test_every_location_of_every_method_and_category_is_said(paper):
    table = figure6()
    page = figure6_markdown(table, paper)
    for row in table.itertuples():
        assert f"{row.location_m:.2f} ± {row.location_se_m:.2f}" in page
    assert "Data set `rooms`" in page


def test_the_papers_numbers_stand_beside_the_category_it_has(paper):
    page = figure6_markdown(figure6(), paper)
    location = page.split("### Location error")[1]
    book, tv = (
        next(line for line in location.splitlines() if line.startswith(f"| {name} "))
        for name in ("book", "tv")
    )
    assert book.endswith("| 1.63 |")
    assert tv.endswith("| – |")


def test_unmixed_cells_are_marked_and_the_share_is_said(paper):
    table = figure6()
    is_hit = (table["method"] == "fmm") & (table["task"] == "empty")
    table.loc[is_hit, "unmixed"] = [0.0, 0.25, 0.125]
    filled, empty = figure6_markdown(table, paper).split("## Arranging empty rooms")
    assert MARK not in filled
    assert "12.5 % of the questions to `fmm`" in empty
    marked = [line for line in empty.splitlines() if f" {MARK} |" in line]
    first = [line.split("|")[1].strip() for line in marked]
    assert first == ["`fmm`", "tv", "**AVG**", "tv", "**AVG**"]


def test_shares_of_several_tasks_are_said_as_a_range():
    table = figure6(("chance", "dp"))
    is_dp = (table["method"] == "dp") & (table["category"] == "AVG")
    table.loc[is_dp, "unmixed"] = [0.02, 0.1]
    text = averages_by_task(table)
    assert "2.0 to 10.0 % of the questions to `dp`" in text
    assert text.count(f" {MARK} |") == 2 * 4


def test_averages_name_data_set_task_and_method(paper):
    tables = pd.concat([figure6(), figure6(("chance", "dp"), "thor")])
    lines = averages_by_task(tables).splitlines()
    heads = [line.split("|")[1:4] for line in lines if line.startswith("| `")]
    assert len(heads) == 2 * len(ORDER) + 2 * 2
    assert [cell.strip() for cell in heads[0]] == ["`rooms`", "`filled`", "`chance`"]
    assert len({line.count("|") for line in lines if line.startswith("|")}) == 1


def test_methods_are_in_one_order_whichever_come_first_in_the_table(paper):
    shuffled = figure6().sample(frac=1, random_state=0)
    assert figure6_markdown(shuffled, paper) == figure6_markdown(figure6(), paper)
