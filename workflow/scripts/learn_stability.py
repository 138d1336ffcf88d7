"""Learn from trials which placements stay put, and report how well that is known."""

import logging
from collections.abc import Mapping
from pathlib import Path

import pandas as pd
from tqdm import tqdm

from command import run
from placing.artifacts.formats import read_table, write_csv, write_table
from placing.artifacts.stability import write_stability
from placing.physics.bench import Bench, BenchConfig, bench_of
from placing.physics.choosing import choose, features_of, settle_chosen
from placing.physics.trials import TRIAL_COLUMNS
from placing.psi.contacts import STABILITY_FEATURES
from placing.psi.stability import Models, StabilityConfig, folds_of, learn_stability
from placing.rooms.catalogue import read_catalogue
from placing.tables.report import write_text
from placing.tables.stability_report import (
    PROTOCOLS,
    models_without,
    report_of,
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
    settings: BenchConfig,
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
        settings: Sections of the configuration that trials look at.
        stability: How stability is learned.
    """
    bench = bench_of(seed, read_catalogue(catalogue), spacing_m, settings)
    tried = read_table(trials_file, TRIAL_COLUMNS)
    features = features_of(tried, bench.grounds, bench.things)
    folds = folds_of(bench.things, stability.n_folds)
    told = features, tried, tried["object"].map(folds).to_numpy()
    args = STABILITY_FEATURES, features, tried["stays"].to_numpy(bool), told[2]
    write_stability(model, learn_stability(*args, stability))
    models = {
        protocol: models_without(STABILITY_FEATURES, *told, protocol, stability)
        for protocol in tqdm(PROTOCOLS, unit="protocol", disable=None)
    }
    likely = _likely(seed, bench, (folds, models), settings, stability)
    let_go = bench.fixed, bench.bodies, settings.settling, reach_m, n_workers
    chosen = likely.assign(stays=settle_chosen(likely, *let_go))
    write_table(chosen_file, chosen)
    report = report_of(models, *told, chosen)
    write_csv(table, report)
    write_text(markdown, stability_markdown(report))
    log.info("%s", report[report["fixture"] == "all"].to_string(index=False))


def _likely(
    seed: int,
    bench: Bench,
    learned: tuple[Mapping[str, int], Mapping[str, Models]],
    settings: BenchConfig,
    stability: StabilityConfig,
) -> pd.DataFrame:
    """Return what is chosen among fresh placements, if it is likely enough to stay."""
    args = bench.grounds, bench.things, *learned, settings.trials
    fresh = choose(seed, *args, stability.n_candidates)
    n_kinds = len({kind for kind, _, _ in bench.grounds})
    total = len(bench.things) * n_kinds * len(PROTOCOLS)
    picked = pd.DataFrame(list(tqdm(fresh, total=total, unit="choice", disable=None)))
    return picked[picked["probability"] >= stability.min_probability]


if __name__ == "__main__":
    run(main)
