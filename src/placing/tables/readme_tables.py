"""The averages of Tables 1 and 2 as short tables, the paper's beside ours."""

from collections.abc import Mapping

import pandas as pd

from placing.methods.names import JOINT_NAMES
from placing.plans.robot_plans import CONSTRAINTS, INSIDE, WITH, WITHOUT
from placing.tables.metrics import AVERAGE
from placing.tables.report import row_of, with_error
from placing.tables.table1 import MEASURE_OF
from placing.tables.table1_page import DIGITS, recomputed
from placing.tables.table2_page import paper_table

TABLE1_HEADS = [
    *("data set", "task", "error [m]", *(f"`{name}`" for name in CONSTRAINTS)),
    *("placed, `with` and `inside` [%]", "*paper, `without`*", "*paper, `with`*"),
]
EXECUTION_HEADS = ["scenario", "placed", "largest error [mm]", "largest error [deg]"]
TABLE2_HEADS = ["method", "`Co` [%]", "`Sc`", "*paper, `Co` [%]*", "*paper, `Sc`*"]


def table1_averages(longs: Mapping[str, pd.DataFrame], paper: pd.DataFrame) -> str:
    """Return the averages of Table 1 of every data set, by its long table."""
    said = paper[paper["source"] == "Table 1"]
    lines = [row_of(TABLE1_HEADS), "|:-|:-|:-|" + "-:|" * 6]
    for dataset, long in longs.items():
        rows = long[long["category"] == AVERAGE]
        rows = rows.set_index(["task", "metric", "constraints"])
        for task in dict.fromkeys(long["task"]):
            for metric, measure in MEASURE_OF.items():
                found = [rows.loc[(task, metric, name)] for name in CONSTRAINTS]
                cells = [f"`{dataset}`", f"`{task}`", measure]
                digits = DIGITS[metric]
                cells += [with_error(row["value"], row["se"], digits) for row in found]
                placed = [
                    f"{rows.loc[(task, 'placed_percent', name)]['value']:.0f}"
                    for name in (WITH, INSIDE)
                ]
                theirs = [recomputed(said, task, metric, n) for n in (WITHOUT, WITH)]
                published = [f"{value:.{digits}f}" for value in theirs]
                lines.append(row_of([*cells, ", ".join(placed), *published]))
    return "\n".join(lines)


def execution_summary(executed: pd.DataFrame) -> str:
    """Return how many objects of each scenario came to rest where they were planned."""
    lines = [row_of([*EXECUTION_HEADS, "not placed"]), "|:-|-:|-:|-:|:-|"]
    for scenario, rows in executed.groupby("scenario"):
        placed, others = rows[rows["placed"]], rows[~rows["placed"]]
        said = [f"{r['object']}: {r['reason']}" for r in others.to_dict("records")]
        error_mm = 1000 * placed["error_m"].max()
        cells = [str(scenario), f"{len(placed)} of {len(rows)}", f"{error_mm:.1f}"]
        cells += [f"{placed['error_deg'].max():.1f}", "; ".join(said)]
        lines.append(row_of(cells))
    return "\n".join(lines)


def table2_averages(table2: pd.DataFrame, paper: pd.DataFrame) -> str:
    """Return the averages of Table 2 by method: measured, and the paper's raters'."""
    lines = [row_of(TABLE2_HEADS), "|:-|" + "-:|" * 4]
    ours, theirs = (t.set_index("method") for t in (table2, paper_table(paper)))
    for method, name in JOINT_NAMES.items():
        cells = [
            f"{table.loc[method, f'average_{score}']:.{digits}f}"
            for table in (ours, theirs)
            for score, digits in (("co", 0), ("sc", 1))
        ]
        lines.append(row_of([name, *cells]))
    return "\n".join(lines)
