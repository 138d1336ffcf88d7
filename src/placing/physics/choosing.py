"""The best of many fresh placements of each object on each fixture, settled anew.

Chosen by what is learned from other objects, settled for the full time: whether what
stability recommends stays put in a simulation that had no part in learning.
"""

from collections.abc import Iterator, Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing.physics.bodies import Body, Piece
from placing.physics.grounds import Ground, Key
from placing.physics.running import run_trials
from placing.physics.settling import SettleConfig, settle, unrest
from placing.physics.things import Thing
from placing.physics.trials import (
    POSE,
    TrialsConfig,
    draw_placement,
    groups_of,
    lowered,
)
from placing.psi.contacts import stability_features
from placing.psi.stability import Models, log_psi_stability
from placing.rigid import Array
from placing.seeds import generator


def features_of(
    table: pd.DataFrame, grounds: Mapping[Key, Ground], things: Mapping[str, Thing]
) -> NDArray[np.float32]:
    """Return the features of every placement of a table, shape (c, f)."""
    found: list[tuple[NDArray, NDArray]] = []
    for key, name, rows in groups_of(table):
        part = table.iloc[rows]
        values = stability_features(
            grounds[key].field,
            things[name].cloud,
            part[list(POSE)].to_numpy(float),
            part["area_height_m"].to_numpy(float),
        )
        found.append((rows, values))
    order = np.concatenate([rows for rows, _ in found])
    features = np.empty((len(table), found[0][1].shape[1]), np.float32)
    features[order] = np.concatenate([values for _, values in found])
    return features


def choose(
    seed: int,
    grounds: Mapping[Key, Ground],
    things: Mapping[str, Thing],
    folds: Mapping[str, int],
    models: Mapping[str, Models],
    config: TrialsConfig,
    n_candidates: int,
) -> Iterator[dict[str, object]]:
    """Yield the likeliest of fresh placements under the models of each protocol.

    For each object and kind of fixture, of which one is drawn, clean or noisy.
    """
    kinds = list(dict.fromkeys(kind for kind, _, _ in grounds))
    # Object by object, since what is prepared of an object is kept for a while only.
    for name, thing in sorted(things.items()):
        for kind in kinds:
            rng = generator(seed, "choose", kind, name)
            mine = [key for key in grounds if key[0] == kind]
            key = mine[rng.integers(len(mine))]
            rows = [
                draw_placement(rng, grounds[key], thing, config)
                for _ in range(n_candidates)
            ]
            table = pd.DataFrame(rows).assign(
                fixture=kind, instance=key[1], is_noisy=key[2]
            )
            table = lowered(table, grounds, things)
            features = features_of(table, grounds, things)
            for protocol, known in models.items():
                scores = log_psi_stability(known[kind, folds[name]], features)
                best = int(np.argmax(scores))
                probability = float(np.exp(scores[best]))
                row = table.iloc[best].to_dict()
                yield {**row, "protocol": protocol, "probability": probability}


def settle_chosen(
    table: pd.DataFrame,
    fixed: Mapping[str, Mapping[str, tuple[Piece, ...]]],
    bodies: Mapping[str, Body],
    config: SettleConfig,
    reach_m: float,
    n_workers: int,
) -> list[bool]:
    """Return whether each placement of a table stays when it settles for long."""
    same = ["fixture", "instance", "object", *POSE]
    once = table.drop_duplicates(same)  # what two protocols choose settles once
    args = once, fixed, bodies, config, reach_m, n_workers
    known = once[same].assign(found=list(run_trials(*args, let_go=stays_settled)))
    return table[same].merge(known, on=same, how="left")["found"].tolist()


def stays_settled(
    fixed: Mapping[str, tuple[Piece, ...]],
    body: Body,
    T_world_body: Array,
    config: SettleConfig,
    reach_m: float,
) -> bool:
    """Return whether an object that is put down on a fixture settles where it is."""
    placed = {"body": (body, T_world_body)}
    settled = settle(fixed, placed, config, reach_m)["body"]
    return not unrest(settled, config)
