"""The chain of frames that move, and the links that each of them carries.

A robot's description is a tree of links; only torso and arm move relative to the base,
so that every other joint is fixed at its value and its links hang rigidly in a frame.
"""

from collections.abc import Collection, Iterable, Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from placing.errors import BadInput
from placing.robot.kernels import Tree
from placing.robot.settings import RobotSettings
from placing.robot.urdf import Description, Joint

Array = NDArray[np.float64]


def gripper_values(settings: RobotSettings, opening_m: float) -> dict[str, float]:
    """Return the joints of the gripper when the fingers are `opening_m` apart."""
    # ASSUME: the opening is linear in the joints; over the range of the fingers of
    # both robots the arc of a finger differs from its chord by less than 2 mm.
    share = float(np.clip(opening_m / settings.max_opening_m, 0, 1))
    shut, wide = settings.gripper_closed, settings.gripper_open
    return {name: shut[name] + share * (wide[name] - shut[name]) for name in wide}


def fixed_values(
    settings: RobotSettings, description: Description, opening_m: float
) -> dict[str, float]:
    """Return the value of every joint that no configuration moves."""
    values = {}
    for joint in description.joints.values():
        if joint.kind != "fixed":
            values[joint.name] = float(np.clip(0.0, joint.lower, joint.upper))
    given = {**settings.other_joints, **gripper_values(settings, opening_m)}
    moving = (settings.torso, *settings.chain)
    return {k: v for k, v in {**values, **given}.items() if k not in moving}


def check_names(settings: RobotSettings, description: Description) -> None:
    """Raise `BadInput` for a link or joint that the description does not have."""
    joints = {
        "chain": settings.chain,
        "torso": (settings.torso,),
        "gripper_open": settings.gripper_open,
        "other_joints": settings.other_joints,
    }
    links = {
        "tool_frame": (settings.tool_frame,),
        "gripper_links": settings.gripper_links,
    }
    moving = [j.name for j in description.joints.values() if j.kind != "fixed"]
    for field, names in joints.items():
        _check_known(settings, field, "joint", names, moving)
    for field, names in links.items():
        _check_known(settings, field, "link", names, description.links)


def _check_known(
    settings: RobotSettings,
    field: str,
    what: str,
    names: Iterable[str],
    known: Collection[str],
) -> None:
    """Raise `BadInput` for the first unknown name of a field."""
    for name in names:
        if name not in known:
            raise BadInput(
                f"{settings.file}: {field}: unknown {what} {name!r}; known are "
                f"{', '.join(sorted(known))}"
            )


def moving_joints(settings: RobotSettings, description: Description) -> list[Joint]:
    """Return the joints that move, from the torso to the wrist."""
    above = {joint.child: joint for joint in description.joints.values()}
    path, link = [], settings.tool_frame
    while link in above and len(path) <= len(above):
        path.insert(0, above[link])
        link = above[link].parent
    names = (settings.torso, *settings.chain)
    found = tuple(joint.name for joint in path if joint.name in names)
    if found != names:
        raise BadInput(
            f"{settings.file}: chain: from the base to {settings.tool_frame!r} the "
            f"joints come as {', '.join(found)}; expected {', '.join(names)}"
        )
    return [description.joints[name] for name in names]


def tree_of(
    settings: RobotSettings,
    description: Description,
    chain: list[Joint],
    values: Mapping[str, float],
) -> tuple[tuple[str, ...], Tree]:
    """Return the names of the links, the base first, and the frames that carry them."""
    number = {joint.name: i + 1 for i, joint in enumerate(chain)}
    frame_of, T_frame = carried(description, number, values)
    links = tuple(frame_of)
    hung = [np.eye(4)]
    hung += [T_frame[joint.parent] @ joint.T_parent_joint for joint in chain]
    tool = np.eye(4)
    turn = Rotation.from_euler("xyz", settings.tool_rpy_deg, degrees=True)
    tool[:3, :3], tool[:3, 3] = turn.as_matrix(), settings.tool_offset_m
    axes = np.array([[0.0, 0, 1], *(joint.axis for joint in chain)])
    tree = Tree(
        T_parent_joint=np.array(hung)[:, :3].copy(),
        axis=axes,
        is_turning=np.array([True] + [j.kind != "prismatic" for j in chain]),
        along=np.array([_along(*both) for both in zip(hung, axes, strict=True)]),
        link_frame=np.array([frame_of[link] for link in links]),
        T_frame_link=np.array([T_frame[link] for link in links])[:, :3].copy(),
        T_frame_tool=(T_frame[settings.tool_frame] @ tool)[:3].copy(),
    )
    return links, tree


def _along(T_parent_joint: Array, axis: Array) -> int:
    """Return the axis of the parent that a joint is along, -1 if it is turned."""
    is_turned = np.any(T_parent_joint[:3, :3] != np.eye(3))
    along = int(np.argmax(axis))
    return -1 if is_turned or np.any(axis != np.eye(3)[along]) else along


def carried(
    description: Description, number: Mapping[str, int], values: Mapping[str, float]
) -> tuple[dict[str, int], dict[str, Array]]:
    """Return which moving frame carries each link, and where in it, (4, 4)."""
    children = {joint.child for joint in description.joints.values()}
    roots = [link for link in description.links if link not in children]
    if len(roots) != 1:
        raise BadInput(
            f"{description.file}: links without a parent are {', '.join(roots)}; "
            "expected one base"
        )
    frame_of, T_frame, open_links = {roots[0]: 0}, {roots[0]: np.eye(4)}, [roots[0]]
    for link in open_links:
        for joint in description.joints.values():
            if joint.parent != link or joint.child in frame_of:
                continue
            if joint.name in number:
                frame_of[joint.child] = number[joint.name]
                T_frame[joint.child] = np.eye(4)
            else:
                frame_of[joint.child] = frame_of[link]
                T_joint = joint_pose(joint, values.get(joint.name, 0.0))
                T_frame[joint.child] = T_frame[link] @ T_joint
            open_links.append(joint.child)
    return frame_of, T_frame


def joint_pose(joint: Joint, value: float) -> Array:
    """Return the child of a joint in the frame of its parent, (4, 4)."""
    T = np.eye(4)
    if joint.kind == "prismatic":
        T[:3, 3] = value * joint.axis
    elif joint.kind != "fixed":
        T[:3, :3] = Rotation.from_rotvec(value * joint.axis).as_matrix()
    return joint.T_parent_joint @ T
