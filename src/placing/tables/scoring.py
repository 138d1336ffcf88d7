"""Scores of one scene's answers against its labelled arrangements.

An answer to a question with given objects is compared with the arrangement these come
from; an answer for the empty room is compared with every arrangement. The method
`labels` is one labelled arrangement compared with another: the spread between people,
which no method can be expected to beat.

Shapes: a arrangements, n objects of the scene, p places, r rows of a table.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing import rigid
from placing.methods.answer_tables import LOCATION, NO_PLACE, ORIENTATION, PLACED
from placing.methods.names import LABELS
from placing.scene import Scene
from placing.tables.metrics import ERRORS, distances, match_locations

Array = NDArray[np.float64]
ANSWER_COLUMNS = (
    *("scene", "method", "question", "labels", "object", "category", "status"),
    *(*LOCATION, *ORIENTATION),
)
"""What is read of the table of answers."""
Pair = tuple[int, int, int, bool]
"""Arrangement, object, row of the pose compared with that label, is it placed."""
Members = tuple[list[int], list[int], list[bool]]
"""Objects of an answer, the rows of their poses, and whether they are placed."""


@dataclass(frozen=True)
class Labelled:
    """The labelled arrangements of a scene, objects sorted by their name."""

    arrangements: tuple[str, ...]
    objects: tuple[str, ...]
    categories: tuple[str, ...]
    """(n,) of the objects."""
    has_front: NDArray[np.bool_]
    """(n,)"""
    poses: Array
    """(a, n, 7) location, then orientation."""


def score_scene(
    scene: Scene,
    answers: pd.DataFrame,
    likelihoods: pd.DataFrame,
) -> pd.DataFrame:
    """Return one row per method, labelled arrangement and object.

    `likelihoods` holds the nll and rank of every labelled place. An object without a
    placement has errors NaN, one without a front has no orientation error, and
    `labels` have no likelihood.
    """
    labelled = _labelled(scene)
    poses = labelled.poses.reshape(-1, 7)
    given = answers[[*LOCATION, *ORIENTATION]].to_numpy(float)
    poses = np.concatenate([poses, given])  # (r, 7)
    pairs = _spread(labelled, poses)
    methods = [LABELS] * len(pairs)
    for group, members in _groups(answers, labelled).items():
        method, _, _, labels = group
        found = [
            pair
            for a, name in enumerate(labelled.arrangements)
            if labels in ("", name)
            for pair in _compare(labelled, poses, a, *members)
        ]
        pairs += found
        methods += [method] * len(found)
    table = _table(labelled, poses, pairs).assign(method=methods, scene=scene.scene)
    # Of a method, only one question is about an object under one arrangement.
    keys = ["method", "labels", "object"]
    fit = likelihoods[[*keys, "nll", "rank"]]
    return table.merge(fit, on=keys, how="left", validate="many_to_one")


def _labelled(scene: Scene) -> Labelled:
    """Return the labelled arrangements of a scene as arrays."""
    items = sorted(scene.objects, key=lambda item: item.object_id)
    poses = []
    for arrangement in scene.arrangements:
        by_object = {p.object_id: p for p in arrangement.placements}
        placements = [by_object[item.object_id] for item in items]
        poses += [np.append(p.location, p.orientation) for p in placements]
    shape = (len(scene.arrangements), len(items))
    return Labelled(
        tuple(arrangement.name for arrangement in scene.arrangements),
        tuple(item.object_id for item in items),
        tuple(item.category for item in items),
        np.array([item.has_front for item in items], np.bool_),
        np.array(poses, float).reshape(*shape, 7),
    )


def _groups(
    answers: pd.DataFrame, labelled: Labelled
) -> dict[tuple[str, str, str, str], Members]:
    """Return the members by method, question, category and labels, sorted."""
    number = {name: n for n, name in enumerate(labelled.objects)}
    first = labelled.poses.shape[0] * labelled.poses.shape[1]
    names = ("method", "question", "category", "labels", "object", "status")
    groups: dict[tuple[str, str, str, str], Members] = {}
    columns = [answers[name].tolist() for name in names]
    for row, (*key, name, status) in enumerate(zip(*columns, strict=True), first):
        objects, rows, is_placed = groups.setdefault(tuple(key), ([], [], []))
        objects.append(number[name])
        rows.append(row)
        is_placed.append(status == PLACED)
    return dict(sorted(groups.items()))


def _compare(
    labelled: Labelled,
    poses: Array,
    a: int,
    objects: Sequence[int],
    rows: Sequence[int],
    is_placed: Sequence[bool],
) -> list[Pair]:
    """Return the objects of one category with the poses matched to their labels."""
    placed = np.flatnonzero(is_placed)
    to, at = np.array(objects)[placed], np.array(rows)[placed]
    matched = match_locations(poses[at, :3], labelled.poses[a, to, :3])
    pose_of = dict(zip(to.tolist(), at[matched].tolist(), strict=True))
    return [(a, n, pose_of.get(n, 0), n in pose_of) for n in sorted(objects)]


def _spread(labelled: Labelled, poses: Array) -> list[Pair]:
    """Return each labelled arrangement compared with each other one."""
    n_objects = len(labelled.objects)
    by_category: dict[str, list[int]] = {}
    for n, category in enumerate(labelled.categories):
        by_category.setdefault(category, []).append(n)
    pairs: list[Pair] = []
    for one, other in permutations(range(len(labelled.arrangements)), 2):
        for objects in by_category.values():
            rows = [other * n_objects + n for n in objects]
            every = [True] * len(objects)
            pairs += _compare(labelled, poses, one, objects, rows, every)
    return pairs


def _table(labelled: Labelled, poses: Array, pairs: list[Pair]) -> pd.DataFrame:
    """Return what is compared and its errors, one row per pair."""
    a, n, row = np.array([pair[:3] for pair in pairs], np.intp).reshape(-1, 3).T
    is_placed = np.array([pair[3] for pair in pairs], np.bool_)
    label, pose = labelled.poses[a, n], poses[row]
    found = np.where(is_placed[:, None], distances(pose[:, :3] - label[:, :3]), np.nan)
    turn = rigid.wrap(rigid.yaw_of(pose[:, 3:]) - rigid.yaw_of(label[:, 3:]))
    is_turned = is_placed & labelled.has_front[n]
    columns = {
        "labels": np.array(labelled.arrangements, object)[a],
        "object": np.array(labelled.objects, object)[n],
        "category": np.array(labelled.categories, object)[n],
        "status": np.where(is_placed, PLACED, NO_PLACE).astype(object),
        **dict(zip(ERRORS, found.T, strict=True)),
        "orientation_error_deg": np.where(is_turned, np.degrees(np.abs(turn)), np.nan),
    }
    return pd.DataFrame(columns)
