"""Choose K and omega on training scenes, and calibrate regions on the same answers.

Each training scene is answered by what was learned without it and without the scenes
that are held out. Of every number tried, the one of lowest negative log density wins;
the ranks of the labelled places calibrate the regions (see `regions`).

Shapes: p places.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.random import Generator
from numpy.typing import NDArray

from placing.learning.learned import Choices
from placing.learning.likelihoods import ScoringConfig, likelihood_rows, with_uniform
from placing.methods.answering import Asked
from placing.methods.names import METHODS
from placing.methods.scene_model import SceneModel
from placing.tasks import Question, questions

Array = NDArray[np.float64]

COLUMNS = ["scene", "task", "method", "variant", "category", "object", "nll", "rank"]


@dataclass(frozen=True)
class TuningConfig:
    """What is tried, and on how much; the values live in `config/config.yaml`."""

    n_components: tuple[int, ...]
    """Poses K of the finite mixture `fmm`."""
    object_weights: tuple[float, ...]
    """Shares omega of the human context in `dp_object`."""
    max_scenes: int
    """Training scenes that are looked at."""
    n_chains: int
    n_burn_in: int
    n_samples: int
    """Chains and sweeps per question."""


def asked_of(model: SceneModel, task: str, turn: int) -> list[Question]:
    """Return the questions of a scene filled by one labelled arrangement, in turn."""
    labels = [a.name for a in model.scene.arrangements]
    chosen = ("", labels[turn % len(labels)]) if labels else ("",)
    return [q for q in questions(model.scene, task) if q.labels in chosen]


def try_variants(
    stream: Callable[[str], Generator],
    model: SceneModel,
    task: str,
    question: Question,
    config: TuningConfig,
    scoring: ScoringConfig,
) -> Iterator[tuple[object, ...]]:
    """Yield the nll and rank of each labelled object under everything tried."""
    spacing_m = model.settings.candidates.spacing_m
    for method, variant, densities in _densities(stream, model, question, config):
        mixed = {c: with_uniform(d, scoring) for c, d in densities.items()}
        args = model.nearest, question, mixed, spacing_m
        for _, name, category, nll, rank in likelihood_rows(*args):
            row = (model.scene.scene, task, method, variant, category, name)
            yield (*row, nll, rank)


def choose(tried: pd.DataFrame) -> dict[str, dict[str, object]]:
    """Return what the training scenes chose and how, ready to be written as JSON.

    `choices` per task; `nll` per task and variant; `calibration`, the sorted ranks of
    the labelled places per task and method, under the chosen variant.
    """
    document: dict[str, dict[str, object]] = {"choices": {}, "nll": {}}
    document["calibration"] = {}
    for task, of_task in tried.groupby("task"):
        keys = ["method", "variant", "category", "scene"]
        by_scene = of_task.groupby(keys)["nll"].mean()
        by_category = by_scene.groupby(level=["method", "variant", "category"]).mean()
        nll = by_category.groupby(level=["method", "variant"]).mean()
        best = {m: str(nll[m].idxmin()) for m in nll.index.unique("method")}
        is_best = of_task["variant"] == of_task["method"].map(best)
        chosen = of_task[is_best].groupby("method")["rank"]
        document["choices"][str(task)] = {
            "n_components": int(best["fmm"]),
            "object_weight": float(best["dp_object"]),
        }
        document["nll"][str(task)] = {
            method: {str(v): float(x) for v, x in nll[method].items()}
            for method in best
        }
        ranks = {str(m): sorted(r.round(6).tolist()) for m, r in chosen}
        document["calibration"][str(task)] = ranks
    return document


def _densities(
    stream: Callable[[str], Generator],
    model: SceneModel,
    question: Question,
    config: TuningConfig,
) -> Iterator[tuple[str, str, Mapping[str, Array]]]:
    """Yield the densities of every method and variant per category, each (p,)."""
    k = config.n_components[0]
    asked = Asked(stream, model, question, Choices(k, 1.0))
    whole = {}
    for method in METHODS:
        if method not in ("fmm", "dp_object"):
            whole[method] = _whole(asked, stream, method)
            yield method, "", _fitting(asked, whole[method])
    for k in config.n_components:
        of_k = Asked(stream, model, question, Choices(k, 1.0))
        yield "fmm", str(k), _fitting(of_k, _whole(of_k, stream, "fmm"))
    for w in config.object_weights:
        mixed = {
            name: w * density + (1 - w) * whole["object"][name]
            for name, density in whole["dp"].items()
        }
        yield "dp_object", str(w), _fitting(asked, mixed)


def _whole(
    asked: Asked, stream: Callable[[str], Generator], method: str
) -> dict[str, Array]:
    """Return the density of a method over all places per category."""
    names = asked.question.categories
    return {name: asked.density(stream(method), method, name)[0] for name in names}


def _fitting(asked: Asked, whole: Mapping[str, Array]) -> dict[str, Array]:
    """Return densities without the places that fit no object of the category."""
    return {name: asked.fitting(name, density) for name, density in whole.items()}
