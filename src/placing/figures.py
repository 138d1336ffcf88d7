"""The bar chart of errors per category and method, after the paper's Figure 6.

One figure per task: the error of the location above, that of the height below, one bar
per method with one standard error. The spread among the labels themselves is a black
tick over each group of bars, the noise floor of the comparison.
"""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from placing.artifacts.atomic import replacing
from placing.errors import BadInput, unknown

AVERAGE = "AVG"
"""The category of the rows that average over all categories."""
LABELS = "labels"
"""The method of the rows that hold the spread of the labels."""

# SOURCE: Paul Tol, "Colour schemes", muted, which colour-blind people tell apart too.
METHODS = {
    "chance": ("chance", "#BBBBBB"),
    "area": ("area", "#999933"),
    "height": ("height", "#88CCEE"),
    "room": ("room", "#44AA99"),
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
SIZE_INCH, DPI = (7.2, 4.6), 200
GROUP_WIDTH, AVERAGE_GAP = 0.82, 0.45
"""Width of a group of bars and extra space before the average, in categories."""


def plot_figure6(table: pd.DataFrame, task: str) -> Figure:
    """Return the figure of one task from the table of errors."""
    rows = table.loc[table["task"] == task]
    if rows.empty:
        raise unknown("task", task, sorted(set(table["task"])))
    datasets = sorted(set(rows["dataset"]))
    if len(datasets) > 1:
        raise BadInput(f"table: dataset is {', '.join(datasets)}; expected only one")
    for method in sorted(set(rows["method"])):
        if method not in METHODS:
            raise unknown("method", method, list(METHODS))
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=SIZE_INCH, layout="constrained")
        panels = figure.subplots(2, 1, sharex=True, height_ratios=[3, 2])
        for axes, (value, error, label) in zip(panels, PANELS, strict=True):
            _draw_panel(axes, rows, value, error)
            axes.set_ylabel(label)
        handles, names = panels[0].get_legend_handles_labels()
        if LABELS in set(rows["method"]):  # drawn as lines, which come first
            handles, names = [*handles[1:], handles[0]], [*names[1:], names[0]]
        n_columns = len(names) if len(names) <= 6 else -(-len(names) // 2)
        figure.legend(
            handles, names, loc="outside lower center", ncols=n_columns, frameon=False
        )
        title = (
            f"Arranging {task} rooms, data set {datasets[0]}: mean and standard error"
        )
        figure.suptitle(title, fontsize=9)
        figure.align_ylabels()
    return figure


def save_figure(figure: Figure, path: Path) -> None:
    """Write a figure as PNG or SVG, the same bytes whenever it is the same figure."""
    metadata = {"Date": None} if path.suffix == ".svg" else {"Software": None}
    with mpl.rc_context(STYLE), replacing(path) as part:
        figure.savefig(part, dpi=DPI, metadata=metadata)


def _draw_panel(axes: Axes, rows: pd.DataFrame, value: str, error: str) -> None:
    """Draw the bars of all methods and the ticks of the labels."""
    categories, x = _positions(rows)
    bars = [m for m in METHODS if m in set(rows["method"]) and m != LABELS]
    width = GROUP_WIDTH / max(len(bars), 1)
    for b, method in enumerate(bars):
        part = rows[rows["method"] == method].set_index("category").reindex(categories)
        at = x + (b - (len(bars) - 1) / 2) * width
        name, color = METHODS[method]
        axes.bar(at, part[value], 0.92 * width, color=color, label=name)
        axes.errorbar(
            at, part[value], part[error], fmt="none", ecolor="#333333", elinewidth=0.5
        )
    spread = rows[rows["method"] == LABELS].set_index("category").reindex(categories)
    if np.isfinite(spread[value].to_numpy()).any():
        half = GROUP_WIDTH / 2
        name, color = METHODS[LABELS]
        axes.hlines(spread[value], x - half, x + half, color, lw=1.4, label=name)
    axes.set_xticks(x, [name.replace("_", " ") for name in categories], rotation=40)
    _finish(axes, categories, x)


def _positions(rows: pd.DataFrame) -> tuple[list[str], np.ndarray]:
    """Return categories in the order of the table, the average last, and their x."""
    names = list(dict.fromkeys(rows["category"]))
    names.sort(key=lambda name: name == AVERAGE)
    return names, np.arange(len(names)) + AVERAGE_GAP * (np.array(names) == AVERAGE)


def _finish(axes: Axes, categories: list[str], x: np.ndarray) -> None:
    """Set the average apart and rule the ground."""
    for label in axes.get_xticklabels():
        label.set(ha="right", rotation_mode="anchor")
        if label.get_text() == AVERAGE:
            label.set_fontweight("bold")
    if categories[-1] == AVERAGE:
        axes.axvspan(x[-1] - 0.6, x[-1] + 0.6, color="#F1F1EE", zorder=-1)
    axes.set_xlim(x[0] - 0.6, x[-1] + 0.6)
    axes.set_ylim(bottom=0)
    axes.grid(axis="y", color="#DDDDDD", linewidth=0.5)
