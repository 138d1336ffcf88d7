"""The reliability plot: how often regions hold the labelled object, and should.

Above, the regions that a method states: a line under the diagonal belongs to a method
that is surer than it should be. Below, how far the regions calibrated in training
scenes miss what they state.
"""

from collections.abc import Iterator

import matplotlib as mpl
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MultipleLocator, PercentFormatter

from placing.errors import BadInput, unknown
from placing.tables.figures import METHODS, STYLE
from placing.tables.report import TITLES

WITHOUT = ("chance",)
"""Methods whose only region is everything."""
IN_FRONT = "dp"
"""The method that has a band of one standard error."""
SIZE_INCH = (7.2, 5.9)
LEAST_MISS = 0.12
"""Half the height of the panels below, more where a line needs it."""


def plot_coverage(table: pd.DataFrame) -> Figure:
    """Return the figure of the one data set of `table`."""
    datasets = sorted(set(table["dataset"]))
    if len(datasets) != 1:
        raise BadInput(f"table: dataset is {', '.join(datasets)}; expected only one")
    for method in sorted(set(table["method"])):
        if method not in METHODS:
            raise unknown("method", method, list(METHODS))
    tasks = [task for task in TITLES if task in set(table["task"])]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=SIZE_INCH)
        figure.set_layout_engine("constrained", wspace=0.08)
        panels = figure.subplots(
            2,
            len(tasks),
            sharex=True,
            sharey="row",
            squeeze=False,
            height_ratios=[2, 1],
        )
        for (above, below), task in zip(panels.T, tasks, strict=True):
            rows = table[table["task"] == task]
            _draw_stated(above, rows)
            _draw_miss(below, rows)
            above.set_title(TITLES[task], fontsize=8)
            below.set_xlabel("stated probability of the region")
        panels[0, 0].set_ylabel("labelled objects inside")
        panels[1, 0].set_ylabel("inside − stated")
        handles, names = panels[0, 0].get_legend_handles_labels()
        figure.legend(
            handles, names, loc="outside lower center", ncols=5, frameon=False
        )
        title = f"Labelled objects inside regions, data set {datasets[0]}"
        figure.suptitle(f"{title}; bands: one standard error of DP", fontsize=9)
        figure.align_ylabels()
    return figure


def _draw_stated(axes: Axes, rows: pd.DataFrame) -> None:
    """Draw measured against stated probability and the diagonal."""
    axes.plot([0, 1], [0, 1], color="#333333", lw=0.8, ls=(0, (4, 3)), label="ideal")
    column = "coverage_as_stated"
    for method, part in _methods(rows):
        _draw_line(axes, method, part["level"], part[column], part[f"{column}_se"])
    axes.set(xlim=(0, 1), ylim=(0, 1))
    axes.set_xticks([0, 0.25, 0.5, 0.75, 1])
    axes.set_yticks([0, 0.25, 0.5, 0.75, 1])
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(PercentFormatter(1, decimals=0, symbol=" %"))
    _finish(axes, "regions: densest places of the stated mass")


def _draw_miss(axes: Axes, rows: pd.DataFrame) -> None:
    """Draw how far calibrated regions hold more or less than they state."""
    axes.axhline(0, color="#333333", lw=0.8, ls=(0, (4, 3)))
    highest = LEAST_MISS
    for method, part in _methods(rows):
        miss = part["coverage"] - part["level"]
        _draw_line(axes, method, part["level"], miss, part["coverage_se"])
        highest = max(highest, 1.1 * miss.abs().max(), abs(axes.get_ylim()[1]))
    axes.set_ylim(-highest, highest)
    axes.yaxis.set_major_locator(MultipleLocator(0.05 if highest < 0.2 else 0.1))
    axes.yaxis.set_major_formatter(FuncFormatter(_signed_percent))
    _finish(axes, "regions: calibrated in training scenes")


def _methods(rows: pd.DataFrame) -> Iterator[tuple[str, pd.DataFrame]]:
    """Yield the methods that are drawn and their rows by rising level."""
    for method in METHODS:
        part = rows[rows["method"] == method]
        if method not in WITHOUT and not part.empty:
            yield method, part.sort_values("level")


def _draw_line(
    axes: Axes, method: str, level: pd.Series, value: pd.Series, error: pd.Series
) -> None:
    """Draw one method, the one in front bolder and with a band."""
    name, color = METHODS[method]
    is_front = method == IN_FRONT
    width, order = (2.0, 4) if is_front else (1.1, 3)
    axes.plot(level, value, color=color, lw=width, zorder=order, label=name)
    if is_front:
        low, high = value - error, value + error
        axes.fill_between(level, low, high, color=color, alpha=0.25, lw=0)


def _finish(axes: Axes, regions: str) -> None:
    """Rule the ground and say which regions these are."""
    axes.grid(color="#DDDDDD", linewidth=0.5)
    axes.annotate(
        regions,
        (0.03, 0.96),
        xycoords="axes fraction",
        va="top",
        color="#555555",
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1},
    )


def _signed_percent(value: float, _: int) -> str:
    """Return a difference of shares as the label of a tick."""
    sign = "−" if value < 0 else "+"
    return f"{sign}{abs(100 * value):.0f} %" if round(value, 6) else "0 %"
