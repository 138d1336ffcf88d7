"""Definitions of the ROS 2 messages of a joint log, as `.msg` text.

# SOURCE: the packages common_interfaces and geometry2 of ROS 2, without comments.
"""

_RULE = "=" * 80

_PARTS = {
    "builtin_interfaces/Time": "int32 sec\nuint32 nanosec",
    "builtin_interfaces/Duration": "int32 sec\nuint32 nanosec",
    "std_msgs/Header": "builtin_interfaces/Time stamp\nstring frame_id",
    "std_msgs/String": "string data",
    "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z",
    "geometry_msgs/Point": "float64 x\nfloat64 y\nfloat64 z",
    "geometry_msgs/Quaternion": ("float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1"),
    "geometry_msgs/Pose": (
        "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation"
    ),
    "geometry_msgs/PoseStamped": ("std_msgs/Header header\ngeometry_msgs/Pose pose"),
    "geometry_msgs/Transform": (
        "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation"
    ),
    "geometry_msgs/TransformStamped": (
        "std_msgs/Header header\nstring child_frame_id\n"
        "geometry_msgs/Transform transform"
    ),
    "tf2_msgs/TFMessage": "geometry_msgs/TransformStamped[] transforms",
    "sensor_msgs/JointState": (
        "std_msgs/Header header\nstring[] name\nfloat64[] position\n"
        "float64[] velocity\nfloat64[] effort"
    ),
    "trajectory_msgs/JointTrajectoryPoint": (
        "float64[] positions\nfloat64[] velocities\nfloat64[] accelerations\n"
        "float64[] effort\nbuiltin_interfaces/Duration time_from_start"
    ),
    "trajectory_msgs/JointTrajectory": (
        "std_msgs/Header header\nstring[] joint_names\n"
        "trajectory_msgs/JointTrajectoryPoint[] points"
    ),
    "placing_msgs/PlanningResult": (
        "std_msgs/Header header\nstring dataset\nstring scene\nstring task\n"
        "string constraints\nstring[] order\nstring[] refused\nstring[] reasons"
    ),
}
"""Fields of each type, those it is made of by their full names."""

LOGGED = (
    "std_msgs/String",
    "tf2_msgs/TFMessage",
    "sensor_msgs/JointState",
    "geometry_msgs/PoseStamped",
    "trajectory_msgs/JointTrajectory",
    "placing_msgs/PlanningResult",
)


def _needed(name: str) -> list[str]:
    """Return the types that a type is made of, itself first, each once."""
    found = [name]
    for one in found:  # grows while it is walked
        for line in _PARTS[one].splitlines():
            kind = line.split()[0].removesuffix("[]")
            if kind in _PARTS and kind not in found:
                found.append(kind)
    return found


def _definition(name: str) -> str:
    """Return the fields of a type followed by those of the types it is made of."""
    first, *others = _needed(name)
    rest = [f"{_RULE}\nMSG: {other}\n{_PARTS[other]}" for other in others]
    return "\n".join([_PARTS[first], *rest]) + "\n"


DEFINITIONS = {"/msg/".join(name.split("/")): _definition(name) for name in LOGGED}
"""By full name, such as `std_msgs/msg/String`."""
