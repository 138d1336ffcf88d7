"""Compare the pose sampler with plain numpy, with peers and with the machine's limit.

Run it with `./run python benchmarks/sampling.py`. All figures of a table come from one
run on one machine; ratios within a table are what carries over.
"""

import json
import os
import platform
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gaussian
import numpy as np
import pandas as pd
import peers
import plain
import tyro
from clock import gather_rate, seconds_of, triad_rate
from numpy.typing import NDArray
from questions import Question, ask, full_scene
from tqdm import tqdm

from placing.artifacts.features import read_features
from placing.people import dpmm, gibbs
from placing.people.diagnostics import rhat_and_ess
from placing.people.potential import log_psi_human

Array = NDArray[np.float64]
Table = list[dict[str, Any]]

N_CHAINS, N_BURN_IN, N_SAMPLES = 2, 100, 1500
N_AUXILIARY = 8
N_PLAIN = {"summed": 150, "placed": 6}
"""Sweeps of the plain numpy versions, with placements summed out or in the state."""


def main(
    output: Path = Path("results/benchmarks_sampling.json"),
    features: Path | None = None,
    n_objects: int = 17,
    n_poses: int = 80_000,
    with_peers: bool = True,
    nuts_steps: int = 20,
) -> None:
    """Measure the sampler; print tables and write them as JSON.

    Args:
        output: File to write.
        features: A features file of a real scene (results/.../features/.../x.npz).
        n_objects: Objects of the question, the last one to be placed.
        n_poses: Human poses of the made-up full scene, about.
        with_peers: Compare a Gaussian mixture with other libraries as well.
        nuts_steps: Steps of NumPyro: 20 show its speed, hundreds make it converge.
    """
    question = full_scene(n_objects, n_poses)
    stages: dict[str, Callable[[], Table]] = {
        "sweeps, full scene": lambda: sweeps(question),
        "potentials": lambda: potentials(question),
        "memory": lambda: memory(question),
        "growth": growth,
    }
    if features:
        real = real_question(features, n_objects)
        stages[f"sweeps, {features.stem}"] = lambda: sweeps(real)
    if with_peers:
        stages["Gaussian mixture"] = lambda: mixtures(nuts_steps)
    tables: dict[str, Table] = {}
    start = time.process_time()
    with tqdm(stages, unit="table") as bar:
        for name in bar:
            bar.set_postfix_str(name)
            table = tables[name] = stages[name]()
            shown = pd.DataFrame(table).to_string(
                index=False, na_rep="-", float_format="{:.4g}".format
            )
            tqdm.write(f"\n{name}\n{shown}\n")
    taken = time.process_time() - start
    output.parent.mkdir(parents=True, exist_ok=True)
    document = {"machine": machine(), "seconds": taken, "tables": tables}
    output.write_text(json.dumps(document, indent=1) + "\n")
    print(f"\n{taken:.0f} s of processor time in all; written to {output}")


def shown(table: Table) -> str:
    """Return a table as text."""
    form = "{:.4g}".format
    return pd.DataFrame(table).to_string(index=False, na_rep="-", float_format=form)


def machine() -> dict[str, str]:
    """Return what the figures depend on."""
    names = ("NUMBA_CPU_NAME", "NPY_DISABLE_CPU_FEATURES", "OMP_NUM_THREADS")
    found = {name: os.environ.get(name, "") for name in names}
    return {"machine": platform.platform(), "numpy": np.__version__} | found


def real_question(features: Path, n_objects: int) -> Question:
    """Return a question about the places and poses of a real scene."""
    candidates, poses = read_features(features)
    rng = np.random.default_rng(0)
    places = candidates.location
    if len(places) > 5000:
        places = rng.choice(places, 5000, replace=False)
    return ask(rng, poses, places, n_objects)


def ours(question: Question, m: int, n_samples: int = N_SAMPLES) -> dpmm.Chains:
    """Return chains of the library's sampler, exact birth for no auxiliary poses."""
    sampler = "algorithm8" if m else "exact_birth"
    config = dpmm.DpmmConfig(sampler, 1.0, m, N_CHAINS, N_BURN_IN, n_samples)
    slot = np.full(len(question.rows), -1)
    slot[-1] = 0
    rng = np.random.default_rng(0)
    return dpmm.sample(rng, question.rows, question.prior, config, slot)


def seconds_per_sweep(question: Question, m: int = 0, many: int = N_SAMPLES) -> float:
    """Return the time of a sweep, without what is done once for a question [s]."""
    few = 10
    short = seconds_of(lambda: ours(question, m, few))
    long = seconds_of(lambda: ours(question, m, many))
    return (long - short) / N_CHAINS / (many - few)


def ess_of(traces: Array) -> float:
    """Return the bulk effective sample size of traces (r, s)."""
    return float(rhat_and_ess(traces[None])[1][0])


def sweeps(question: Question) -> Table:
    """Compare a sweep and the effective samples per second with plain numpy."""
    table = []
    for name, m in (
        ("exact birth", 0),
        (f"algorithm 8, m = {N_AUXILIARY}", N_AUXILIARY),
    ):
        trace = ours(question, m).n_poses.astype(float)
        taken = seconds_per_sweep(question, m)
        table.append(_sweeps_row("library", name, taken, trace))
        table.append(plain_row(plain.Summed(question), name, m, "summed"))
    table.append(plain_row(plain.Placed(question), name, N_AUXILIARY, "placed"))
    for row in table:
        row["time / ours"] = row["us a sweep"] / table[0]["us a sweep"]
    return table


def plain_row(potentials: plain.Summed, name: str, m: int, kind: str) -> dict[str, Any]:
    """Return the row of a plain numpy version; two chains of one start each."""
    traces, start = [], time.process_time()
    for r in range(N_CHAINS):
        rng = np.random.default_rng(r)
        traces.append(plain.sample(rng, potentials, 1.0, m, N_PLAIN[kind]))
    taken = (time.process_time() - start) / N_CHAINS / N_PLAIN[kind]
    trace = np.array(traces)[:, N_PLAIN[kind] // 10 :]
    return _sweeps_row(f"numpy, placements {kind}", name, taken, trace)


def _sweeps_row(code: str, name: str, taken: float, trace: Array) -> dict[str, Any]:
    """Return the row of a sampler that took `taken` seconds for a sweep."""
    # The size of a sample says nothing about chains of a dozen sweeps.
    ess = ess_of(trace) / trace.size if trace.size >= 100 else np.nan
    return {
        "code": code,
        "algorithm": name,
        "us a sweep": 1e6 * taken,
        "sweeps/s": 1 / taken,
        "ESS(K) a sweep": ess,
        "ESS(K)/s": ess / taken,
        "mean K": trace.mean() if trace.size >= 100 else np.nan,
    }


def potentials(question: Question) -> Table:
    """Compare how many potentials a second the library and plain numpy evaluate."""
    n, q = question.rows.shape
    theta, objects, poses = question.thetas[0], question.objects, question.poses
    has_front = np.ones(n, np.bool_)
    compiled = seconds_of(lambda: log_psi_human(theta, objects, has_front, poses))
    numpy = seconds_of(lambda: plain.log_psi(theta, objects[:1], poses)) * n
    rows = (("library", compiled), ("numpy", numpy))
    return [
        {
            "code": code,
            "million/s": n * q / taken / 1e6,
            "time / ours": taken / compiled,
        }
        for code, taken in rows
    ]


def memory(question: Question) -> Table:
    """Compare a sweep with the least time of one that reads every row."""
    rows = question.rows
    n_bytes = float(rows.nbytes)
    rate = triad_rate(3 * n_bytes)
    tiles = seconds_of(lambda: gibbs.tile_rows(rows, question.prior))
    sweep = seconds_per_sweep(question)
    gather = gather_rate()
    facts = {
        "triad, in the caches of a core [GB/s]": triad_rate(3e5) / 1e9,
        "triad, as large as the rows [GB/s]": rate / 1e9,
        "triad, memory (300 MB) [GB/s]": triad_rate(3e8) / 1e9,
        "random f32 read of 8 MB [million/s]": gather / 1e6,
        "rows of the question [MB]": n_bytes / 1e6,
        "least time to read every row [us]": 1e6 * n_bytes / rate,
        "a sweep of ours [us]": 1e6 * sweep,
        "least time / a sweep of ours": n_bytes / rate / sweep,
        "set-up of a question, once [us]": 1e6 * tiles,
        "least time / set-up": n_bytes / rate / tiles,
    }
    return [{"figure": name, "value": value} for name, value in facts.items()]


def growth() -> Table:
    """Measure a sweep for more objects, more poses and more scenes."""
    cases = [("objects", n, [(n, 80_000, 0)]) for n in (8, 17, 40, 80)]
    sizes = (20_000, 40_000, 80_000, 160_000)
    cases += [("poses", q, [(17, q, 0)]) for q in sizes]
    cases += [("scenes", k, [(17, 20_000, i) for i in range(k)]) for k in (1, 2, 4)]
    table, first = [], 0.0
    for what, value, scenes in cases:
        questions = (full_scene(*scene) for scene in scenes)
        taken = 1e6 * sum(seconds_per_sweep(q, 0, 400) for q in questions)
        if not table or table[-1]["growing"] != what:
            first = taken
        row = {"growing": what, "value": value, "us a sweep": taken}
        table.append(row | {"times first": taken / first})
    return table


def mixtures(nuts_steps: int) -> Table:
    """Compare a Dirichlet process mixture of Gaussians with other libraries."""
    rng, prior = np.random.default_rng(5), gaussian.Prior()
    points, truth = gaussian.made_up_points(rng, 2000)
    points, held_out = points[:1000], points[1000:]
    table = [{"code": "truth", "what": "density drawn from", "held_out": truth}]
    for name, m in (("ours, exact birth", 0), ("ours, algorithm 8, m = 3", 3)):
        table.append({"code": name} | own_mixture(points, held_out, prior, m))
    found_by = {
        "scikit-learn": peers.scikit_learn(points, held_out, prior),
        "NumPyro": peers.numpyro(points, held_out, prior, nuts_steps),
    }
    for name, found in found_by.items():
        if found and (largest := found.pop("largest", None)) is not None:
            found["ESS(largest)/s"] = ess_of(largest[None]) / found["seconds"]
        if found:
            table.append({"code": name} | found)
    return table


def own_mixture(
    points: Array, held_out: Array, prior: gaussian.Prior, m: int
) -> dict[str, Any]:
    """Return the row of our algorithm on a Gaussian mixture."""
    n_samples = 3000
    trace, empty = np.empty((n_samples, 2)), np.empty((0, 2))
    args = points, prior, 1.0, m, 200
    gaussian.sample(
        np.random.default_rng(0), *args, trace[:2], held_out[:2]
    )  # compiles
    start = time.process_time()
    gaussian.sample(np.random.default_rng(0), *args, trace, empty)
    taken = time.process_time() - start
    out = gaussian.sample(np.random.default_rng(1), *args, trace[:500].copy(), held_out)
    kept = taken * n_samples / (n_samples + 200)
    return {
        "what": f"{n_samples} sweeps",
        "seconds": taken,
        "ms_per_sweep": 1000 * kept / n_samples,
        "ESS(K)/s": ess_of(trace[None, :, 0]) / kept,
        "ESS(largest)/s": ess_of(trace[None, :, 1]) / kept,
        "held_out": float(np.log(out).mean()),
    }


if __name__ == "__main__":
    tyro.cli(main)
