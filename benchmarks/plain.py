"""The sampler in plain numpy, written as the equations read, to compare with.

Two versions: with the placements of unplaced objects summed out, as the library does,
over the same rows in logs; and with placements as part of the state, which is how the
paper reads: each sweep evaluates the potential of every object with every pose, and of
an unplaced object with every placement.

Shapes: n objects, q poses, p placements.
"""

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from questions import Question
from scipy.special import i0e

from placing.people.potential import MIN_DISTANCE_M, Theta

Array = NDArray[np.float64]


def log_psi(theta: Theta, place: Array, pose: Array) -> Array:
    """Return log Psi_human of placements (..., 4) with poses (..., 5)."""
    dx, dy = place[..., 0] - pose[..., 0], place[..., 1] - pose[..., 1]
    log_d = np.log(np.maximum(np.hypot(dx, dy), MIN_DISTANCE_M))
    yaw = np.arctan2(pose[..., 4], pose[..., 3])
    bearing = np.arctan2(dy, dx) - yaw - theta.bearing_mean_rad
    turn = place[..., 3] - yaw - theta.orientation_mean_rad
    u = (log_d - theta.log_distance_mean) / theta.log_distance_sigma
    v = (place[..., 2] - pose[..., 2] - theta.height_mean_m) / theta.height_sigma_m
    total = -0.5 * (u * u + v * v) - 2 * log_d
    total -= np.log(theta.log_distance_sigma * theta.height_sigma_m * 2 * np.pi)
    for kappa, angle in (
        (theta.bearing_kappa, bearing),
        (theta.orientation_kappa, turn),
    ):
        total += kappa * (np.cos(angle) - 1) - np.log(2 * np.pi * i0e(kappa))
    return total


def draw(rng: Generator, log_weight: Array) -> int:
    """Return an index drawn in proportion to the exponentials of its argument."""
    below = np.cumsum(np.exp(log_weight - log_weight.max()))
    return int(np.searchsorted(below, rng.random() * below[-1], side="right"))


class Summed:
    """Potentials from rows (n, q): placements are summed out."""

    def __init__(self, question: Question) -> None:
        """Keep the logs of the rows and the weight of a birth per object."""
        self.logs = np.log(question.rows.astype(float))
        self.log_prior = np.log(question.prior)
        self.prior_below = np.cumsum(question.prior)
        self.log_birth = np.log(question.rows @ question.prior)

    def of_pose(self, i: int, pose: int) -> float:
        """Return the log potential of an object with a pose."""
        return float(self.logs[i, pose])

    def of_poses(self, i: int) -> Array:
        """Return the log potential of an object with every pose, shape (q,)."""
        return self.logs[i]

    def draw_prior(self, rng: Generator) -> int:
        """Return a pose drawn from P0."""
        u = rng.random() * self.prior_below[-1]
        return int(np.searchsorted(self.prior_below, u, side="right"))

    def move(self, rng: Generator, pose: int) -> None:
        """Do nothing: no object has a placement to redraw."""


class Placed(Summed):
    """Potentials from the placements of all objects; the last one is redrawn."""

    def __init__(self, question: Question) -> None:
        """Keep where every object is."""
        super().__init__(question)
        self.question, self.objects = question, question.objects.copy()

    def of_pose(self, i: int, pose: int) -> float:
        """Return the log potential of an object with a pose."""
        question = self.question
        place, at = self.objects[i], question.poses[pose]
        return float(log_psi(question.thetas[i], place, at))

    def of_poses(self, i: int) -> Array:
        """Return the log potential of an object with every pose, shape (q,)."""
        return log_psi(self.question.thetas[i], self.objects[i], self.question.poses)

    def move(self, rng: Generator, pose: int) -> None:
        """Redraw the placement of the last object, whose person is at a pose."""
        question = self.question
        at = question.poses[pose]
        weight = log_psi(question.thetas[-1], question.placements, at)
        self.objects[-1] = question.placements[draw(rng, weight)]


def sample(
    rng: Generator, potentials: Summed, concentration: float, m: int, n_sweeps: int
) -> Array:
    """Return the number of poses in use after each sweep, shape (n_sweeps,).

    `m` auxiliary poses of algorithm 8, or the exact weight of a new pose for 0.
    """
    n = len(potentials.logs)
    choice, pose_of = np.zeros(n, int), {0: potentials.draw_prior(rng)}
    trace = np.empty(n_sweeps)
    for s in range(n_sweeps):
        for i in range(n):
            choose(rng, potentials, choice, pose_of, i, np.log(concentration), m)
        for k in pose_of:
            members = np.flatnonzero(choice == k)
            weight = potentials.log_prior + sum(
                potentials.of_poses(int(i)) for i in members
            )
            pose_of[k] = draw(rng, weight)
        potentials.move(rng, pose_of[choice[-1]])
        trace[s] = len(pose_of)
    return trace


def choose(
    rng: Generator,
    potentials: Summed,
    choice: NDArray[np.int64],
    pose_of: dict[int, int],
    i: int,
    log_alpha: float,
    m: int,
) -> None:
    """Redraw the pose that an object picks; a pose that nobody uses is dropped."""
    old, choice[i] = choice[i], -1
    left = pose_of.pop(old) if (choice != old).all() else None
    used = list(pose_of)
    weight = [
        np.log((choice == k).sum()) + potentials.of_pose(i, pose_of[k]) for k in used
    ]
    new = [potentials.draw_prior(rng) for _ in range(m)]
    if m and left is not None:
        new[0] = left
    weight += [log_alpha - np.log(m or 1) + potentials.of_pose(i, pose) for pose in new]
    if not m:
        weight.append(log_alpha + potentials.log_birth[i])
    picked = draw(rng, np.array(weight))
    if picked < len(used):
        choice[i] = used[picked]
        return
    choice[i] = min(set(range(len(choice))) - set(used))
    if m:
        pose_of[choice[i]] = new[picked - len(used)]
    else:
        weight = potentials.log_prior + potentials.of_poses(i)
        pose_of[choice[i]] = draw(rng, weight)
