"""One robot as a file: where its description lies, which joints plan, how it holds.

Another robot is another file of `config/robots`. Names of joints and links are checked
against the description by `placing.robot.model.load_robot`.
"""

from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from typing import Any

from placing.errors import BadInput
from placing.rooms.file import read_yaml
from placing.schema import check

Pair = tuple[float, float]


@dataclass(frozen=True)
class RobotSettings:
    """What a file of `config/robots` says; lengths in metres, angles in radians."""

    file: Path
    """The file itself, for complaints."""
    robot: str
    package: str
    """Installed distribution that holds the description."""
    folder: Path
    """Folder of the distribution that holds one folder per robot."""
    urdf: Path
    srdf: Path | None
    """Description, and the pairs of links that never or always touch."""
    inverse: str
    """`pr2` (closed form) or `numerical`."""
    n_tries: int
    """Shoulder pans of the closed form, or restarts of the numerical inverse."""
    chain: tuple[str, ...]
    """The joints of the arm from shoulder to wrist."""
    torso: str
    torso_range_m: Pair
    torso_heights_m: tuple[float, ...]
    """Heights that are tried, inside the range."""
    tool_frame: str
    tool_offset_m: tuple[float, float, float]
    tool_rpy_deg: tuple[float, float, float]
    """Tool in the frame of `tool_frame`: x where fingers point, y how they close."""
    gripper_links: tuple[str, ...]
    """Links that may touch what is held."""
    gripper_open: dict[str, float]
    gripper_closed: dict[str, float]
    """Values of the joints of the gripper; values between open it partly."""
    max_opening_m: float
    """Distance between the fingers at `gripper_open`."""
    stow: tuple[float, ...]
    """Arm while the base drives with nothing held."""
    carry: tuple[float, ...]
    """Arm while the base drives with an object in the gripper."""
    other_joints: dict[str, float]
    """Joints that stand still; those not named stand at 0 or the limit next to it."""
    reach_m: Pair
    """Nearest and farthest distance on the floor from base to tool."""
    bearing_deg: Pair
    """Direction of the tool seen from the base, 0 in front, counter-clockwise."""
    max_step_rad: float
    """A joint that turns more between two steps of a straight line has jumped."""
    bulge_share: float
    """How far spheres stand out of a shape, as a share of its size."""
    body_bulge_m: Pair
    arm_bulge_m: Pair
    gripper_bulge_m: Pair
    """Least and most that they may stand out."""


def read_robot(path: Path, schema: dict[str, Any]) -> RobotSettings:
    """Return the settings of a robot file that matches `schema`."""
    content = read_yaml(path)
    check(content, schema, str(path))
    folder = _folder(path, content["package"], content["folder"])
    srdf = content["srdf"]
    files = {
        "file": path,
        "folder": folder,
        "urdf": _inside(path, "urdf", folder, content["urdf"]),
        "srdf": None if srdf == "none" else _inside(path, "srdf", folder, srdf),
    }
    lists = {k: tuple(v) for k, v in content.items() if isinstance(v, list)}
    settings = RobotSettings(**{**content, **lists, **files})
    _check_numbers(settings)
    return settings


def _folder(path: Path, package: str, folder: str) -> Path:
    """Return the folder of an installed distribution that holds the robots."""
    try:
        root = Path(str(distribution(package).locate_file("")))
    except PackageNotFoundError as error:
        raise BadInput(
            f"{path}: package: {package!r} is not installed; expected a distribution"
        ) from error
    return _inside(path, "folder", root, folder)


def _inside(path: Path, field: str, folder: Path, name: str) -> Path:
    """Return an existing file or folder inside `folder`."""
    found = (folder / name).resolve()
    if not found.is_relative_to(folder.resolve()):
        raise BadInput(f"{path}: {field}: value {name!r}; expected a path inside it")
    if not found.exists():
        raise BadInput(f"{path}: {field}: value {name!r} does not exist in {folder}")
    return found


def _check_numbers(settings: RobotSettings) -> None:
    """Raise `BadInput` for values that contradict each other."""
    for field in ("stow", "carry"):
        n, n_joints = len(getattr(settings, field)), len(settings.chain)
        if n != n_joints:
            raise BadInput(
                f"{settings.file}: {field}: {n} values; expected {n_joints}, "
                "one for each joint of chain"
            )
    for field in (
        "torso_range_m",
        "reach_m",
        "bearing_deg",
        "body_bulge_m",
        "arm_bulge_m",
        "gripper_bulge_m",
    ):
        low, high = getattr(settings, field)
        if low >= high:
            raise BadInput(
                f"{settings.file}: {field}: value [{low}, {high}]; expected the "
                "smaller number first"
            )
    low, high = settings.torso_range_m
    for height in settings.torso_heights_m:
        if not low <= height <= high:
            raise BadInput(
                f"{settings.file}: torso_heights_m: value {height}; expected at least "
                f"{low} and at most {high}"
            )
    if set(settings.gripper_open) != set(settings.gripper_closed):
        raise BadInput(
            f"{settings.file}: gripper_closed: joints "
            f"{', '.join(sorted(settings.gripper_closed))}; expected those of "
            f"gripper_open, {', '.join(sorted(settings.gripper_open))}"
        )
