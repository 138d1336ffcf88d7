"""The exact check with all that is near found by the simulator, to compare with."""

import numpy as np
import pybullet
from numpy.typing import NDArray

from placing.physics.simulator import near_pairs
from placing.robot.nearby import Held
from placing.robot.truth import Truth

Array = NDArray[np.float64]


class Simulated(Truth):
    """The exact check without a look at spheres and boxes before."""

    def __enter__(self) -> "Simulated":
        """Make the world, and let links overlap that may."""
        super().__enter__()
        self._allow()
        return self

    def _allow(self) -> None:
        """Let links overlap that do so by design or never move against each other."""
        number = {name: i for i, name in self._links.items()}
        names = self._model.links
        checked = {tuple(pair) for pair in self._model.self_pairs.tolist()}
        solid = sorted({hull.link for hull in self._model.hulls}, key=names.index)
        for i, one in enumerate(solid):
            for other in solid[i + 1 :]:
                if (names.index(one), names.index(other)) not in checked:
                    pybullet.setCollisionFilterPair(
                        self._robot,
                        self._robot,
                        number[one],
                        number[other],
                        0,
                        self._client,
                    )

    def _hits(
        self,
        q: Array,
        held: Held,
        held_id: str | None,
        T_tool_object: Array | None,
        touching: bool,
    ) -> tuple[str, ...]:
        """Return what the simulator says is hit, the robot moved in any case."""
        self._set(q)
        self._carry(q, held_id, T_tool_object)
        pybullet.performCollisionDetection(self._client)
        found = self._robot_hits(held_id)
        if held_id is not None and T_tool_object is not None:
            depth_m = self._config.touch_depth_m if touching else 0.0
            found |= self._held_hits(held_id, depth_m)
        return tuple(sorted(found))

    def _near_pairs(self) -> list[tuple[int, int, int]]:
        """Return which link may overlap with which body, and with which link of it."""
        return near_pairs(self._world, self._robot)

    def _held_hits(self, held_id: str, depth_m: float) -> set[str]:
        """Return what a held object overlaps with by at least `depth_m`."""
        i = self._standing[held_id][0]
        return {
            f"{held_id}/{self._world.names[pair[1]]}"
            for pair in near_pairs(self._world, i)
            if pair[1] != self._robot and self._is_overlap(i, pair, depth_m)
        }
