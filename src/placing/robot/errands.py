"""What the robot is asked to do with one object."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from placing.rigid import Array
from placing.robot.planning import Motion, Refusal
from placing.scene import SceneObject

Boxes = Mapping[str, Array]
"""Objects that stand there: centre, size and yaw (7,) by object id."""


@dataclass(frozen=True)
class Errand:
    """An object to put at a pose, or to pick up there."""

    is_putting: bool
    item: SceneObject
    T_world_object: Array
    """(7,)."""
    boxes: Boxes
    """What else stands there."""
    grasp: str = ""
    """The only one that is tried, by name; empty: any."""
    start: Array | None = None
    """(4 + a,) whose base pose is the start; None: where the floor is most open."""

    @property
    def alone(self) -> "Errand":
        """The same where nothing else stands."""
        return replace(self, boxes={})

    @property
    def standing(self) -> tuple[tuple[str, bytes], ...]:
        """What stands there, to be compared."""
        return tuple((name, box.tobytes()) for name, box in sorted(self.boxes.items()))

    @property
    def key(self) -> tuple[object, ...]:
        """All but what stands there."""
        start = b"" if self.start is None else self.start.tobytes()
        T = self.T_world_object.tobytes()
        return self.is_putting, self.item.object_id, T, self.grasp, start


Answer = Callable[[Errand], Motion | Refusal]
"""Says how an errand is done, or why it cannot be."""
