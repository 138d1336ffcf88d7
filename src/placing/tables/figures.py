"""The bar chart of errors per category and method, after the paper's Figure 6.

One figure per task: the error of the location above, that of the height below, one bar
per method with one standard error, the average wide and with its numbers. The spread
among the labels themselves is a black line over each group of bars, the noise floor of
the comparison.
"""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import Normal, Stroke
from numpy.typing import NDArray

from placing.artifacts.atomic import replacing
from placing.errors import BadInput, unknown
from placing.methods.names import LABELS
from placing.tables.metrics import AVERAGE

Array = NDArray[np.float64]

# SOURCE: Paul Tol, "Colour schemes", muted, which colour-blind people tell apart too.
METHODS = {
    "chance": ("chance", "#BBBBBB"),
    "height": ("height", "#88CCEE"),
    "room": ("room", "#44AA99"),
    "area": ("area", "#999933"),
    "random_human": ("random human", "#332288"),
    "object": ("object", "#117733"),
    "fmm": ("FMM", "#DDCC77"),
    "dp": ("DP", "#CC6677"),
    "dp_object": ("DP + object", "#882255"),
    LABELS: ("spread of labels", "black"),
}
"""Name in the legend and colour of each method, in the order of the bars."""

PANELS = (
    ("location_m", "location_se_m", "location error [m]"),
    ("height_m", "height_se_m", "height error [m]"),
)
STYLE: Any = {
    "font.size": 8,
    "font.family": "DejaVu Sans",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "axes.axisbelow": True,
    "axes.edgecolor": "#555555",
    "xtick.major.size": 0,
    "ytick.major.width": 0.6,
    "svg.hashsalt": "placing",
}
SIZE_INCH, DPI = (13.0, 6.2), 160
GROUP_WIDTH, AVERAGE_WIDTH, AVERAGE_GAP = 0.84, 3.2, 0.3
"""Width of a group of bars, how many times as wide that of the average is, and the
space before it, in categories."""
HALO = [Stroke(linewidth=2.4, foreground="white"), Normal()]


def plot_figure6(table: pd.DataFrame, task: str) -> Figure:
    """Return the figure of one task from the table of errors."""
    rows = _rows_of(table, task)
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=SIZE_INCH, layout="constrained")
        panels = figure.subplots(2, 1, sharex=True, height_ratios=[3, 2])
        for axes, (value, error, label) in zip(panels, PANELS, strict=True):
            _draw_panel(axes, rows, value, error)
            axes.set_ylabel(label, fontsize=9)
        handles, names = panels[0].get_legend_handles_labels()
        if LABELS in set(rows["method"]):  # drawn as lines, which come first
            handles, names = [*handles[1:], handles[0]], [*names[1:], names[0]]
        figure.legend(
            *(handles, names),
            **{"loc": "outside lower center", "ncols": len(names), "fontsize": 9},
            **{"frameon": False, "handlelength": 1.4, "columnspacing": 1.6},
        )
        about = f"Arranging {task} rooms, data set {rows['dataset'].iloc[0]}"
        title = f"{about}: mean over scenes and one standard error"
        figure.suptitle(title + _unmixed(rows), fontsize=10)
        figure.align_ylabels()
    return figure


def save_figure(figure: Figure, path: Path) -> None:
    """Write a figure as PNG or SVG, the same bytes whenever it is the same figure."""
    metadata = {"Date": None} if path.suffix == ".svg" else {"Software": None}
    with mpl.rc_context(STYLE), replacing(path) as part:
        figure.savefig(part, dpi=DPI, metadata=metadata)


def _rows_of(table: pd.DataFrame, task: str) -> pd.DataFrame:
    """Return the rows of a task, which must be of one data set and known methods."""
    rows = table.loc[table["task"] == task]
    if rows.empty:
        raise unknown("task", task, sorted(set(table["task"])))
    datasets = sorted(set(rows["dataset"]))
    if len(datasets) > 1:
        raise BadInput(f"table: dataset is {', '.join(datasets)}; expected only one")
    for method in sorted(set(rows["method"])):
        if method not in METHODS:
            raise unknown("method", method, list(METHODS))
    return rows


def _unmixed(rows: pd.DataFrame) -> str:
    """Return a line with the share of questions outside the gates, if any is."""
    average = rows[(rows["category"] == AVERAGE) & (rows["unmixed"] > 0)]
    share = average.set_index("method")["unmixed"]
    named = [f"{METHODS[m][0]} {100 * share[m]:.1f} %" for m in METHODS if m in share]
    said = "questions whose chains are outside the gates of the diagnostics"
    return f"\n{said}: {', '.join(named)}" if named else ""


def _draw_panel(axes: Axes, rows: pd.DataFrame, value: str, error: str) -> None:
    """Draw the bars of all methods and the lines of the labels."""
    categories, x, group = _positions(rows)
    bars = [m for m in METHODS if m in set(rows["method"]) and m != LABELS]
    width = group / max(len(bars), 1)
    for b, method in enumerate(bars):
        part = rows[rows["method"] == method].set_index("category").reindex(categories)
        at = x + (b - (len(bars) - 1) / 2) * width
        name, color = METHODS[method]
        axes.bar(at, part[value], 0.92 * width, color=color, label=name)
        axes.errorbar(
            at, part[value], part[error], fmt="none", ecolor="#333333", elinewidth=0.7
        )
        if AVERAGE in categories:
            _write_average(axes, float(at[-1]), part.loc[AVERAGE], value, error)
    spread = rows[rows["method"] == LABELS].set_index("category").reindex(categories)
    if np.isfinite(spread[value].to_numpy()).any():
        ends, (name, color) = (x - group / 2, x + group / 2), METHODS[LABELS]
        lines = axes.hlines(spread[value], *ends, color, lw=1.4, label=name)
        lines.set_path_effects(HALO)
    axes.set_xticks(x, [name.replace("_", " ") for name in categories], rotation=35)
    _finish(axes, categories, x)


def _write_average(
    axes: Axes, x: float, average: pd.Series, value: str, error: str
) -> None:
    """Write the number of an average over its bar."""
    if np.isfinite(average[value]):
        top = average[value] + np.nan_to_num(average[error])
        text = f"{average[value]:.2f}"
        offset = {"xytext": (0, 2), "textcoords": "offset points", "rotation": 90}
        axes.annotate(text, (x, top), ha="center", va="bottom", fontsize=7, **offset)


def _positions(rows: pd.DataFrame) -> tuple[list[str], Array, Array]:
    """Return categories, the average last, their x and the widths of their groups."""
    names = list(dict.fromkeys(rows["category"]))
    names.sort(key=lambda name: name == AVERAGE)
    is_average = np.array(names) == AVERAGE
    times = np.where(is_average, AVERAGE_WIDTH, 1.0)
    x = np.arange(len(names)) + is_average * (AVERAGE_GAP + (AVERAGE_WIDTH - 1) / 2)
    return names, x, GROUP_WIDTH * times


def _finish(axes: Axes, categories: list[str], x: Array) -> None:
    """Set the average apart and rule the ground."""
    for label in axes.get_xticklabels():
        label.set(ha="right", rotation_mode="anchor", fontsize=9)
        if label.get_text() == AVERAGE:
            label.set(fontweight="bold", ha="center", va="top", rotation=0)
    right = x[-1] + 0.6
    if categories[-1] == AVERAGE:
        right = x[-1] + AVERAGE_WIDTH / 2
        left = x[-1] - AVERAGE_WIDTH / 2 - 0.05
        axes.axvspan(left, right, color="#F4F4F1", zorder=-1)
    axes.set_xlim(x[0] - 0.6, right)
    axes.set_ylim(bottom=0)
    axes.grid(axis="y", color="#DDDDDD", linewidth=0.5)
