"""Replay certificates in worlds of their own; fail loudly where one does not hold."""

import logging
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from itertools import groupby
from pathlib import Path
from typing import Literal

import pandas as pd
from tqdm import tqdm

from command import run
from placing.artifacts.certificates import digest_of, read_certificates
from placing.artifacts.formats import write_csv
from placing.errors import BadArtifact
from placing.layouts import layout_reader
from placing.physics.cutting import bodies_of, fixed_of
from placing.physics.settling import SettleConfig
from placing.robot.certificates import Certificate
from placing.robot.replay import Verdict, judge_all
from placing.robot.replay_config import ReplayConfig
from placing.robot.settings import RobotSettings, read_robot
from placing.rooms.file import read_yaml
from placing.scene import Layout

log = logging.getLogger(__name__)

KEYS = ["dataset", "scene", "task", "question", "constraints", "object"]
COLUMNS = [*KEYS, "n_looks", "end_error_m", "end_error_deg", "moved_m", "tilted_deg"]


def main(
    dataset: Literal["rooms", "scenarios", "thor"],
    certificates: tuple[Path, ...],
    rooms: Path,
    schema: Path,
    catalogue: Path,
    types: Path,
    robots: Path,
    robot_schema: Path,
    table: Path,
    reach_m: float,
    replay: ReplayConfig,
    settling: SettleConfig,
) -> None:
    """Replay certificates in worlds of their own; fail where one does not hold.

    Args:
        dataset: Data set of the scenes.
        certificates: Directories of certificates.
        rooms: Directory of room files.
        schema: JSON Schema of room files.
        catalogue: Table of objects.
        types: Table of the types of designers' things.
        robots: Directory of robot files.
        robot_schema: JSON Schema of robot files.
        table: Table to write.
        reach_m: How far an object that overlaps is lifted before it is let go.
        replay: How closely certificates are looked at.
        settling: What counts as staying put.
    """
    read, rows = layout_reader(dataset, rooms, schema, catalogue, types), []
    for folder in certificates:
        found = read_certificates(folder)
        robot = read_robot(robots / f"{found.robot}.yaml", read_yaml(robot_schema))
        if digest_of(robot.urdf) != found.urdf_sha256:
            raise BadArtifact(f"{folder}: made with another {robot.urdf.name}")
        args = found.certificates, robot, read, replay, settling, reach_m
        for one, verdict in judged(*args):
            key = {**asdict(one.world), "object": one.object_id}
            rows.append(key | asdict(verdict) | {"holds": not verdict.reason})
            if verdict.reason:
                log.error("%s: %s: %s", folder, one.name, verdict.reason)
    checked = pd.DataFrame(rows, columns=[*COLUMNS, "holds", "reason"])
    write_csv(table, checked)
    n_bad = int((~checked["holds"].astype(bool)).sum())
    if n_bad:
        raise BadArtifact(f"{dataset}: {n_bad} of {len(rows)} certificates do not hold")
    log.info("%s: all %d certificates hold", dataset, len(rows))


def judged(
    certificates: Sequence[Certificate],
    robot: RobotSettings,
    read: Callable[[str], Layout],
    replay: ReplayConfig,
    settling: SettleConfig,
    reach_m: float,
) -> Iterator[tuple[Certificate, Verdict]]:
    """Yield every certificate with what is found about it, scene by scene."""
    by_scene = groupby(certificates, key=lambda c: c.world.scene)
    for scene, some in tqdm(list((k, list(v)) for k, v in by_scene), disable=None):
        layout = read(scene)
        fixed = fixed_of(layout, settling.margin_m)
        bodies = bodies_of(layout.objects, settling.margin_m)
        checks = judge_all(some, robot, fixed, bodies, replay, settling, reach_m)
        yield from zip(some, checks, strict=True)


if __name__ == "__main__":
    run(main)
