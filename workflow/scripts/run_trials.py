"""Try placements of every object on pieces of furniture and watch whether they stay."""

import logging
from pathlib import Path

from tqdm import tqdm

from command import run
from placing.artifacts.formats import write_table
from placing.clouds.cloud import CloudConfig
from placing.object_clouds import LookingConfig
from placing.orientations import OrientationsConfig
from placing.physics.arrangements import bodies_of
from placing.physics.grounds import grounds_of, pieces_of_fixtures
from placing.physics.running import run_trials, with_outcomes
from placing.physics.settling import SettleConfig
from placing.physics.things import things_of
from placing.physics.trials import TrialsConfig, draw_trials
from placing.rooms.catalogue import read_catalogue

log = logging.getLogger(__name__)


def main(
    catalogue: Path,
    trials_file: Path,
    seed: int,
    spacing_m: float,
    reach_m: float,
    n_workers: int,
    cloud: CloudConfig,
    orientations: OrientationsConfig,
    looking: LookingConfig,
    trials: TrialsConfig,
    settling: SettleConfig,
) -> None:
    """Try placements of every object on pieces of furniture and watch them.

    Args:
        catalogue: Table of objects.
        trials_file: Table to write, one line for each trial.
        seed: Root of all random streams.
        spacing_m: Mean distance of the points of a scan.
        reach_m: How far an object is moved up or down until it touches.
        n_workers: Processes that simulate; results do not depend on it.
        cloud: Preprocessing of the scans.
        orientations: How objects are turned.
        looking: How closely objects and scenes are looked at.
        trials: What is tried.
        settling: What counts as staying put.
    """
    things = things_of(
        read_catalogue(catalogue), looking.object_spacing_m, orientations
    )
    grounds = grounds_of(seed, trials.noise_m, looking.cell_m, cloud, spacing_m)
    table = draw_trials(seed, grounds, things, trials)
    bodies = bodies_of([t.item for t in things.values()], settling.margin_m)
    fixed = pieces_of_fixtures(grounds, settling.margin_m)
    watched = run_trials(table, fixed, bodies, settling, reach_m, n_workers)
    outcomes = list(tqdm(watched, total=len(table), unit="trial", disable=None))
    done = with_outcomes(table, outcomes)
    write_table(trials_file, done)
    log.info("%d trials, %.3f stay", len(done), done["stays"].mean())


if __name__ == "__main__":
    run(main)
