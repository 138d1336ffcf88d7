"""Try placements of every object on pieces of furniture and watch whether they stay."""

import logging
from pathlib import Path

from tqdm import tqdm

from command import run
from placing.artifacts.formats import write_table
from placing.physics.bench import BenchConfig, bench_of
from placing.physics.running import run_trials, with_outcomes
from placing.physics.trials import draw_trials
from placing.rooms.catalogue import read_catalogue

log = logging.getLogger(__name__)


def main(
    catalogue: Path,
    trials_file: Path,
    seed: int,
    spacing_m: float,
    reach_m: float,
    n_workers: int,
    settings: BenchConfig,
) -> None:
    """Try placements of every object on pieces of furniture and watch them.

    Args:
        catalogue: Table of objects.
        trials_file: Table to write, one line for each trial.
        seed: Root of all random streams.
        spacing_m: Mean distance of the points of a scan.
        reach_m: How far an object is moved up or down until it touches.
        n_workers: Processes that simulate; results do not depend on it.
        settings: Sections of the configuration that trials look at.
    """
    bench = bench_of(seed, read_catalogue(catalogue), spacing_m, settings)
    table = draw_trials(seed, bench.grounds, bench.things, settings.trials)
    let_go = bench.fixed, bench.bodies, settings.settling, reach_m, n_workers
    watched = run_trials(table, *let_go)
    outcomes = list(tqdm(watched, total=len(table), unit="trial", disable=None))
    done = with_outcomes(table, outcomes)
    write_table(trials_file, done)
    log.info("%d trials, %.3f stay", len(done), done["stays"].mean())


if __name__ == "__main__":
    run(main)
