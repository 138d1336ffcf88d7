"""Where a robot may put an object: places offered, each with its likely headings."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import pandas as pd

from placing import rigid
from placing.scene import Placement, SceneObject


@dataclass(frozen=True, eq=False)
class Candidate:
    """One way to put one object down: upright, on an area, facing somewhere.

    Equal only to itself, so that a search that keeps thousands looks them up fast.
    """

    object_id: str
    option: int
    """Number of the place, best first."""
    heading: int
    """Number of the heading at this place, likeliest first."""
    is_mode: bool
    """Whether the place is one of the highest modes of the density."""
    area: str
    resting_point: tuple[float, float, float]
    """On the area, below the centre of the object [m]."""
    yaw_rad: float
    log_score: float
    """Log density of place and heading."""

    def placement(self, item: SceneObject) -> Placement:
        """Return the placement of the object."""
        x, y, z = self.resting_point
        location = np.array([x, y, z + item.size_m[2] / 2])
        turned = rigid.yaw_quaternion(self.yaw_rad)
        return Placement(self.object_id, self.area, location, turned)


def candidates_of(options: pd.DataFrame) -> dict[str, list[Candidate]]:
    """Return the candidates of every object of one question, best place first.

    `options` has the columns of `placing.plans.offering`.
    """
    found: dict[str, list[Candidate]] = {}
    headings = options.groupby(["object", "option"]).cumcount()
    columns = [options[name].tolist() for name in ("object", "option")]
    columns += [headings.tolist(), options["is_mode"].tolist()]
    columns += [options["area"].tolist()]
    columns += [list(map(tuple, options[["x_m", "y_m", "z_m"]].to_numpy().tolist()))]
    columns += [options["yaw_rad"].tolist()]
    columns += [(options["log_density"] + options["log_heading"]).tolist()]
    for row in zip(*columns, strict=True):
        candidate = Candidate(*row)
        found.setdefault(candidate.object_id, []).append(candidate)
    return found


def arranged(candidates: Iterable[Candidate], n: int) -> list[Candidate]:
    """Return the `n` highest modes, each with its likeliest heading, best first."""
    found = [c for c in candidates if c.is_mode and c.heading == 0]
    return sorted(found, key=lambda c: c.option)[:n]


def in_falling_score(candidates: Iterable[Candidate]) -> list[Candidate]:
    """Return every place with every heading, best first."""
    return sorted(candidates, key=lambda c: (-c.log_score, c.option, c.heading))
