"""Learn from trials which placements stay put, and report how well that is known."""

import logging
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from tqdm import tqdm

from command import run
from placing.artifacts.formats import read_table, write_csv, write_table
from placing.artifacts.stability import write_stability
from placing.clouds.cloud import CloudConfig
from placing.contacts import STABILITY_FEATURES
from placing.object_clouds import LookingConfig
from placing.orientations import OrientationsConfig
from placing.physics.arrangements import bodies_of
from placing.physics.choosing import choose, features_of, settle_chosen
from placing.physics.grounds import grounds_of, pieces_of_fixtures
from placing.physics.settling import SettleConfig
from placing.physics.things import things_of
from placing.physics.trials import TRIAL_COLUMNS, TrialsConfig
from placing.report import write_text
from placing.rooms.catalogue import read_catalogue
from placing.stability import (
    StabilityConfig,
    folds_of,
    learn_stability,
    log_psi_stability,
)
from placing.stability_report import (
    PROTOCOLS,
    REPORT_COLUMNS,
    held_out,
    models_without,
    report_rows,
    stability_markdown,
)

log = logging.getLogger(__name__)


def main(
    catalogue: Path,
    trials_file: Path,
    model: Path,
    chosen_file: Path,
    table: Path,
    markdown: Path,
    seed: int,
    spacing_m: float,
    reach_m: float,
    n_workers: int,
    cloud: CloudConfig,
    orientations: OrientationsConfig,
    looking: LookingConfig,
    trials: TrialsConfig,
    settling: SettleConfig,
    stability: StabilityConfig,
) -> None:
    """Learn from trials which placements stay put, and report how well that is known.

    Args:
        catalogue: Table of objects.
        trials_file: Table of the trials.
        model: What was learned, to write.
        chosen_file: Table to write of what was chosen and settled again.
        table: Report to write as a table.
        markdown: Report to write as text.
        seed: Root of all random streams.
        spacing_m: Mean distance of the points of a scan.
        reach_m: How far an object is moved up or down until it touches.
        n_workers: Processes that simulate; results do not depend on it.
        cloud: Preprocessing of the scans.
        orientations: How objects are turned.
        looking: How closely objects and scenes are looked at.
        trials: What was tried.
        settling: What counts as staying put.
        stability: How stability is learned.
    """
    things = things_of(
        read_catalogue(catalogue), looking.object_spacing_m, orientations
    )
    grounds = grounds_of(seed, trials.noise_m, looking.cell_m, cloud, spacing_m)
    tried = read_table(trials_file, TRIAL_COLUMNS)
    features, names = features_of(tried, grounds, things), STABILITY_FEATURES
    fold_of = folds_of(things, stability.n_folds)
    folds = np.array([fold_of[name] for name in tried["object"]])
    stays = tried["stays"].to_numpy(bool)
    learned = learn_stability(names, features, stays, folds, stability)
    write_stability(model, learned)
    models = {
        protocol: models_without(names, features, tried, folds, protocol, stability)
        for protocol in tqdm(PROTOCOLS, unit="protocol", disable=None)
    }
    settle = partial(
        settle_chosen, config=settling, reach_m=reach_m, n_workers=n_workers
    )
    parts = grounds, things, fold_of, models
    chosen = _chosen_again(seed, parts, trials, settling.margin_m, stability, settle)
    write_table(chosen_file, chosen)
    told = features, tried, folds, log_psi_stability
    scores = {protocol: held_out(models[protocol], *told) for protocol in PROTOCOLS}
    report = _report(tried, scores, chosen)
    write_csv(table, report)
    write_text(markdown, stability_markdown(report))
    overall = report[report["fixture"] == "all"]
    log.info("%s", overall.to_string(index=False))


def _chosen_again(
    seed: int,
    parts: tuple[Any, ...],
    trials: TrialsConfig,
    margin_m: float,
    stability: StabilityConfig,
    settle: Callable[..., Any],
) -> pd.DataFrame:
    """Return what is chosen among fresh placements, and whether it stays."""
    grounds, things, fold_of, models = parts
    args = grounds, things, fold_of, models, trials
    fresh = choose(seed, *args, stability.n_candidates)
    total = len(things) * len({kind for kind, _, _ in grounds}) * len(models)
    picked = pd.DataFrame(list(tqdm(fresh, total=total, unit="choice", disable=None)))
    chosen = picked[picked["probability"] >= stability.min_probability]
    bodies = bodies_of([thing.item for thing in things.values()], margin_m)
    fixed = pieces_of_fixtures(grounds, margin_m)
    return chosen.assign(stays=settle(chosen, fixed, bodies))


def _report(
    tried: pd.DataFrame, scores: Mapping[str, NDArray[np.float64]], chosen: pd.DataFrame
) -> pd.DataFrame:
    """Return the report on all protocols."""
    rows = []
    for protocol in PROTOCOLS:
        mine = chosen[chosen["protocol"] == protocol]
        rows += report_rows(protocol, tried, scores[protocol], mine)
    return pd.DataFrame(rows, columns=list(REPORT_COLUMNS))


if __name__ == "__main__":
    run(main)
