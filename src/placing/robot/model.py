"""The robot as arrays: frames that move, links fixed in them, spheres around links."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from placing import rigid
from placing.errors import BadInput
from placing.robot.kernels import Spheres, Tree, forward
from placing.robot.meshes import Hull
from placing.robot.pr2_arm import Pr2Arm, pr2_arm
from placing.robot.self_pairs import apart, self_pairs_of
from placing.robot.settings import RobotSettings
from placing.robot.solids import hulls_of, spheres_of
from placing.robot.tree import check_names, fixed_values, moving_joints, tree_of
from placing.robot.urdf import Description, Joint, read_urdf

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RobotModel:
    """A robot ready to be placed, checked and moved; equal only to itself."""

    settings: RobotSettings
    description: Description
    links: tuple[str, ...]
    """Every link of the description, the base first."""
    tree: Tree
    spheres: Spheres
    hulls: tuple[Hull, ...]
    """What the spheres contain; fingers as the space they sweep, in frames of links."""
    lower: Array
    upper: Array
    """Soft limits of a configuration, infinite where there is none, (4 + a,)."""
    self_pairs: NDArray[np.int64]
    """Pairs of links that must not touch each other, sorted, (p, 2)."""
    arm: Pr2Arm | None
    """Dimensions for the closed-form inverse, nothing for the numerical one."""

    @cached_property
    def T_tool_frame(self) -> Array:
        """The last frame of the arm seen from the tool, (4, 4)."""
        tool = np.eye(4)
        tool[:3] = self.tree.T_frame_tool
        return np.asarray(np.linalg.inv(tool), float)

    @property
    def n_arm(self) -> int:
        """Return how many joints the arm has."""
        return len(self.settings.chain)


def load_robot(settings: RobotSettings) -> RobotModel:
    """Return the model of a robot whose gripper may open fully."""
    description = read_urdf(settings.urdf, _folder_of(settings))
    check_names(settings, description)
    chain = moving_joints(settings, description)
    lower, upper = _limits(settings, chain)
    widest = settings.max_opening_m
    values = fixed_values(settings, description, widest)
    links, tree = tree_of(settings, description, chain, values)
    hulls = hulls_of(settings, description, links, widest)
    spheres = spheres_of(settings, links, tree, hulls)
    pairs = self_pairs_of(settings, description, links, tree)
    if settings.srdf is None:
        # ASSUME: links whose spheres overlap while the arm is stowed are next to each
        # other by construction.
        pairs = apart(pairs, spheres, link_poses(tree, _stowed(settings)))
    return RobotModel(
        settings=settings,
        description=description,
        links=links,
        tree=tree,
        spheres=spheres,
        hulls=hulls,
        lower=lower,
        upper=upper,
        self_pairs=pairs,
        arm=_closed_form(settings, tree, lower, upper),
    )


def _limits(settings: RobotSettings, chain: list[Joint]) -> tuple[Array, Array]:
    """Return limits of a configuration that the fixed poses keep, (4 + a,) each."""
    limits = np.array([(joint.lower, joint.upper) for joint in chain])
    low, high = settings.torso_range_m
    if low < limits[0, 0] or high > limits[0, 1]:
        raise BadInput(
            f"{settings.file}: torso_range_m: value [{low}, {high}]; expected at least "
            f"{limits[0, 0]} and at most {limits[0, 1]}, the limits of {settings.torso}"
        )
    limits[0] = settings.torso_range_m
    for field in ("stow", "carry"):
        for name, value, (low, high) in zip(
            settings.chain, getattr(settings, field), limits[1:], strict=True
        ):
            if not low <= value <= high:
                raise BadInput(
                    f"{settings.file}: {field}: value {value} of {name}; expected at "
                    f"least {low} and at most {high}"
                )
    endless = np.full(3, np.inf)
    return (
        np.concatenate([-endless, limits[:, 0]]),
        np.concatenate([endless, limits[:, 1]]),
    )


def _stowed(settings: RobotSettings) -> Array:
    """Return the configuration at the origin with the arm stowed, (4 + a,)."""
    return np.array([0.0, 0.0, 0.0, settings.torso_range_m[0], *settings.stow])


def link_poses(tree: Tree, q: Array) -> Array:
    """Return the frame of every link in the world, (l, 4, 4)."""
    frames = np.empty((len(tree.axis), 3, 4))
    forward(tree, q, frames)
    square = np.tile(np.eye(4), (len(frames), 1, 1))
    square[:, :3] = frames
    fixed = np.tile(np.eye(4), (len(tree.link_frame), 1, 1))
    fixed[:, :3] = tree.T_frame_link
    return square[tree.link_frame] @ fixed


def tool_pose(model: RobotModel, q: Array) -> Array:
    """Return `T_world_tool`, (7,)."""
    frames = np.empty((len(model.tree.axis), 3, 4))
    forward(model.tree, np.asarray(q, float), frames)
    T, fixed = np.eye(4), np.eye(4)
    T[:3], fixed[:3] = frames[-1], model.tree.T_frame_tool
    return rigid.from_homogeneous(T @ fixed)


def _closed_form(
    settings: RobotSettings, tree: Tree, lower: Array, upper: Array
) -> Pr2Arm | None:
    """Return the dimensions of the arm if the file asks for the closed form."""
    if settings.inverse != "pr2":
        return None
    arm = pr2_arm(tree, lower, upper)
    if arm is None:
        raise BadInput(
            f"{settings.file}: inverse: value 'pr2'; expected 'numerical', as the arm "
            "is no chain of pan, lift, roll, elbow, roll, flex and roll on aligned axes"
        )
    return arm


def _folder_of(settings: RobotSettings) -> Path:
    """Return the folder that holds all of one robot."""
    return settings.folder / settings.urdf.relative_to(settings.folder).parts[0]
