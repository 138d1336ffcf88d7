"""Let go of many objects, each in its own world, in as many processes as wanted."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from typing import Any

import pandas as pd

from placing.freed_memory import keep_freed_memory
from placing.physics.bodies import Body, Piece
from placing.physics.settling import SettleConfig
from placing.physics.trials import POSE, TRIAL_COLUMNS
from placing.physics.watching import Watched, watch
from placing.rigid import Array


def run_trials(
    table: pd.DataFrame,
    fixed: Mapping[str, Mapping[str, tuple[Piece, ...]]],
    bodies: Mapping[str, Body],
    config: SettleConfig,
    reach_m: float,
    n_workers: int,
    let_go: Callable[..., Any] = watch,
) -> Iterator[Any]:
    """Yield in order what `let_go` tells of each placement of a table.

    It gets fixture, body, pose, settings and reach, as `watch` does, which tells what
    an object does and whether it stays.
    """
    names = [f"{row.fixture}{row.instance}" for row in table.itertuples()]
    poses = table[list(POSE)].to_numpy(float)
    jobs = list(zip(names, table["object"], poses, strict=True))
    if n_workers == 1:
        _prepare(fixed, bodies, config, reach_m, let_go)
        yield from map(_try, jobs)
        return
    shared = fixed, bodies, config, reach_m, let_go
    with ProcessPoolExecutor(n_workers, None, _prepare, shared) as pool:
        yield from pool.map(_try, jobs, chunksize=25)


_shared: dict[str, tuple] = {}
"""What every trial of a process needs; set once for each worker."""


def _prepare(
    fixed: Mapping[str, Mapping[str, tuple[Piece, ...]]],
    bodies: Mapping[str, Body],
    config: SettleConfig,
    reach_m: float,
    let_go: Callable[..., Any],
) -> None:
    """Keep what every trial needs in a worker."""
    keep_freed_memory()
    _shared["all"] = (fixed, bodies, config, reach_m, let_go)


def _try(job: tuple[str, str, Array]) -> Any:  # noqa: ANN401 (what `let_go` tells)
    """Return what an object does that is let go at a pose on a fixture."""
    fixture, name, pose = job
    fixed, bodies, config, reach_m, let_go = _shared["all"]
    return let_go(fixed[fixture], bodies[name], pose, config, reach_m)


def with_outcomes(table: pd.DataFrame, outcomes: Sequence[Watched]) -> pd.DataFrame:
    """Return the table of trials with what was measured."""
    measured = pd.DataFrame([asdict(outcome) for outcome in outcomes])
    return pd.concat([table, measured], axis=1)[list(TRIAL_COLUMNS)]
