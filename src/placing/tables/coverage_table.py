"""The coverage of regions as a Markdown page."""

import numpy as np
import pandas as pd

from placing.methods.regions import REGION_LEVELS
from placing.tables.report import DATA, ORDER, TITLES

NOTE = (
    "Share of labelled objects inside the region that a method states to hold them "
    "with a probability, ± standard error over scenes. *As stated*: the densest places "
    "that hold this mass of the density. *Calibrated*: the limit of the mass comes "
    "from labelled objects in the training scenes, under models that have not seen "
    "these scenes (split conformal prediction), so that the stated probability holds "
    "whatever the density, if training and test scenes are exchangeable. Among regions "
    "that keep their word the smaller is the better; their area is the mean over "
    "wanted objects. Places of equal density are all inside or all outside, so the "
    "region of `chance` is everything, and coverage of the methods that tell few "
    "places apart is higher than asked for. *Only everything*: labelled objects at a "
    "place of the lowest density, as where nothing fits by what is known of the room."
)


def coverage_markdown(coverage: pd.DataFrame) -> str:
    """Return the page for the one data set of `coverage`."""
    dataset = coverage["dataset"].iloc[0]
    title = f"# Do regions hold what they state? Data set `{dataset}`"
    parts = [title, DATA[dataset], NOTE]
    for task, name in TITLES.items():
        of_task = coverage[coverage["task"] == task]
        if not of_task.empty:
            parts += [f"## {name}", _lines(of_task)]
    return "\n\n".join(parts) + "\n"


def _lines(coverage: pd.DataFrame) -> str:
    """Return the Markdown table of one task."""
    has_areas = "area_m2" in coverage
    heads = ["method", "labelled objects", "only everything"]
    for level in REGION_LEVELS:
        heads += [f"{100 * level:.0f} % as stated", "calibrated"]
        heads += ["area [m²]"] if has_areas else []
    lines = [f"| {' | '.join(heads)} |", "|:-|" + "-:|" * (len(heads) - 1)]
    rows = {
        (row["method"], round(row["level"], 6)): row for _, row in coverage.iterrows()
    }
    for method in (name for name in ORDER if name in set(coverage["method"])):
        first = rows[method, REGION_LEVELS[0]]
        cells = [
            f"`{method}`",
            f"{first['n']}",
            _percent(first["share_everything"], np.nan),
        ]
        for level in REGION_LEVELS:
            row = rows[method, level]
            for name in ("coverage_as_stated", "coverage"):
                cells.append(_percent(row[name], row[f"{name}_se"]))
            cells += [_area(row["area_m2"])] if has_areas else []
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _percent(share: float, error: float) -> str:
    """Return a share and its standard error in percent."""
    shown = f"{100 * share:.0f}"
    return f"{shown} %" if pd.isna(error) else f"{shown} ± {100 * error:.0f} %"


def _area(value: float) -> str:
    """Return an area, a dash where there is none."""
    return "–" if pd.isna(value) else f"{value:.2f}"
