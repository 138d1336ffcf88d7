"""The figure draws every number of its task once, and always the same way."""

from itertools import pairwise

import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_hex

from placing.errors import BadInput, UnknownName
from placing.methods.names import ORDER
from placing.tables.figures import LABELS, METHODS, plot_figure6, save_figure

CATEGORIES = ("book", "trash_bin", "AVG")


def table_of(methods: tuple[str, ...], tasks: tuple[str, ...] = ("filled", "empty")):
    """Return a table with another number in every cell."""
    keys = [(t, m, c) for t in tasks for m in methods for c in CATEGORIES]
    table = pd.DataFrame(keys, columns=["task", "method", "category"])
    table.insert(0, "dataset", "rooms")
    value = 1 + np.arange(len(table)) / 100
    return table.assign(
        n=10,
        location_m=value,
        location_se_m=0.1,
        height_m=value / 4,
        height_se_m=0.02,
        unmixed=np.nan,
    )


def heights_of_bars(axes, method: str) -> list[float]:
    """Return the heights of the bars in the colour of a method, left to right."""
    bars = [p for p in axes.patches if to_hex(p.get_facecolor()) == color_of(method)]
    return [bar.get_height() for bar in bars]


def color_of(method: str) -> str:
    """Return the colour of a method as it is compared here."""
    return METHODS[method][1].lower()


@pytest.mark.parametrize("task", ["filled", "empty"])
def test_each_bar_is_as_high_as_its_number(task):
    table = table_of(("dp", "chance", "height", LABELS))
    location, height = plot_figure6(table, task).axes
    for method in ("chance", "height", "dp"):
        rows = table[(table["task"] == task) & (table["method"] == method)]
        assert heights_of_bars(location, method) == rows["location_m"].tolist()
        assert heights_of_bars(height, method) == rows["height_m"].tolist()


def test_the_labels_are_lines_and_not_bars():
    table = table_of(("chance", LABELS))
    location, _ = plot_figure6(table, "filled").axes
    (lines,) = [c for c in location.collections if c.get_label() == METHODS[LABELS][0]]
    rows = table[(table["task"] == "filled") & (table["method"] == LABELS)]
    drawn = [segment[0, 1] for segment in lines.get_segments()]
    assert drawn == rows["location_m"].tolist()


def test_methods_keep_order_and_colour_whichever_are_in_the_table():
    figure = plot_figure6(table_of((LABELS, "dp_object", "dp", "chance")), "filled")
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names == ["chance", "DP", "DP + object", "spread of labels"]


def test_the_average_is_last_and_apart_whatever_its_row():
    table = table_of(("chance", "dp")).iloc[::-1]
    location, height = plot_figure6(table, "filled").axes
    labels = [label.get_text() for label in height.get_xticklabels()]
    assert labels == ["trash bin", "book", "AVG"]
    first, second, average = location.get_xticks()
    assert average - second > second - first


def test_the_bars_of_a_category_stand_side_by_side_about_its_tick():
    location, _ = plot_figure6(table_of(("chance", "height", "dp")), "filled").axes
    for c, tick in enumerate(location.get_xticks()):
        bars = [container[c] for container in location.containers[::2]]
        edges = [(bar.get_x(), bar.get_x() + bar.get_width()) for bar in bars]
        assert edges == sorted(edges)
        assert all(a[1] < b[0] for a, b in pairwise(edges))
        assert (edges[0][0] + edges[-1][1]) / 2 == pytest.approx(tick)


def test_a_category_that_a_method_lacks_leaves_a_gap():
    table = table_of(("chance", "dp"))
    lacking = table.drop(
        table.index[(table["method"] == "dp") & (table["category"] == "book")]
    )
    location, _ = plot_figure6(lacking, "filled").axes
    assert np.isnan(heights_of_bars(location, "dp")[0])
    assert not np.isnan(heights_of_bars(location, "dp")[1:]).any()


def test_the_numbers_of_the_average_stand_over_its_bars():
    table = table_of(("chance", "dp"))
    location, _ = plot_figure6(table, "filled").axes
    average = table[(table["task"] == "filled") & (table["category"] == "AVG")]
    written = [text.get_text() for text in location.texts]
    assert written == [f"{value:.2f}" for value in average["location_m"]]


def test_chains_outside_the_gates_are_named_with_their_share():
    table = table_of(("chance", "dp"))
    assert "gates" not in plot_figure6(table, "filled").get_suptitle()
    table.loc[table["method"] == "dp", "unmixed"] = 0.125
    assert "DP 12.5 %" in plot_figure6(table, "filled").get_suptitle()


def test_every_method_has_its_own_colour_in_the_order_of_the_tables():
    assert tuple(METHODS) == ORDER
    assert len({colour for _, colour in METHODS.values()}) == len(METHODS)


def test_the_data_set_is_named_in_the_title():
    figure = plot_figure6(table_of(("chance",)), "empty")
    assert "empty" in figure.get_suptitle()
    assert "data set rooms" in figure.get_suptitle()


@pytest.mark.parametrize("suffix", ["png", "svg"])
def test_the_same_table_gives_the_same_bytes(tmp_path, suffix):
    table = table_of(("chance", "dp", LABELS))
    for name in "ab":
        save_figure(plot_figure6(table, "filled"), tmp_path / f"{name}.{suffix}")
    a, b = (tmp_path / f"{name}.{suffix}" for name in "ab")
    assert a.read_bytes() == b.read_bytes()
    assert b"<dc:date>" not in a.read_bytes()


def test_what_cannot_be_drawn_is_refused_in_one_line():
    table = table_of(("chance",))
    with pytest.raises(UnknownName, match="unknown task 'full'; known are empty, f"):
        plot_figure6(table, "full")
    with pytest.raises(UnknownName, match="unknown method 'magic'"):
        plot_figure6(table.assign(method="magic"), "filled")
    both = pd.concat([table, table.assign(dataset="thor")])
    with pytest.raises(BadInput, match="dataset is rooms, thor; expected only one"):
        plot_figure6(both, "filled")
