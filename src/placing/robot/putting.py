"""Put an object somewhere, or pick it up there, among what stands (Section 3.3).

What was planned among the points of a scan is checked among the true furniture before
it is carried out. Motions are remembered: what is free where nothing else stands often
is where something does.
"""

import numpy as np

from placing.rigid import Array
from placing.robot.errands import Errand
from placing.robot.exact import LINES, Exact
from placing.robot.planning import FALLS, REJECTED, Motion, Refusal
from placing.robot.seeking import Seeker


class Placer:
    """Answers for one robot in one scene, and remembers what it found."""

    def __init__(self, seeker: Seeker, exact: Exact) -> None:
        """Take who seeks motions; `exact` knows the true furniture."""
        self.seeker, self.exact = seeker, exact
        self._motions: dict[tuple, list[Motion]] = {}
        self._refused: dict[tuple, Refusal] = {}
        self._carried_out: dict[tuple, Motion | Refusal] = {}
        self._clear: dict[tuple[int, bytes], bool] = {}

    def planned(self, errand: Errand) -> Motion | Refusal:
        """Return a motion that is free among the points of the scan, or why none is.

        What is refused where nothing else stands is refused everywhere.
        """
        key = errand.key
        if key not in self._motions:
            self._motions[key] = []
            self._sought(errand.alone)
        if (key, ()) in self._refused:
            return self._refused[key, ()]
        known = (m for m in self._motions[key] if self._holds(m, errand))
        return next(known, None) or self._sought(errand)

    def carried_out(self, errand: Errand) -> Motion | Refusal:
        """Return a motion that the exact check accepts, or why there is none."""
        asked = errand.key, errand.standing
        if asked not in self._carried_out:
            self._carried_out[asked] = self._accepted(errand)
        return self._carried_out[asked]

    def _sought(self, errand: Errand) -> Motion | Refusal:
        """Return a new motion among the points of the scan, or why there is none."""
        asked = errand.key, errand.standing
        if asked in self._refused:
            return self._refused[asked]
        found = self.seeker.sought(errand)
        if isinstance(found, Motion):
            self._motions[errand.key].append(found)
        else:
            self._refused[asked] = found
        return found

    def _accepted(self, errand: Errand) -> Motion | Refusal:
        """Return the first known motion that is accepted, else a new one, else why."""
        planned = self.planned(errand)
        if isinstance(planned, Refusal):
            return planned
        known = self._motions[errand.key]
        for motion in known:
            if self._holds(motion, errand) and not self._complaint(errand, motion):
                return motion
        found = self.seeker.sought(errand, lambda m: self._complaint(errand, m))
        if isinstance(found, Motion):
            known.append(found)
        return found

    def _holds(self, motion: Motion, errand: Errand) -> bool:
        """Return whether a motion of the same errand is free of all that stands now.

        What is put down has to touch where it did.
        """
        if errand.is_putting:
            args = errand.item, errand.T_world_object, errand.boxes
            if not np.array_equal(self.exact.contact(*args), motion.T_world_object):
                return False
        return all(self._is_clear(motion, errand, box) for box in errand.boxes.values())

    def _is_clear(self, motion: Motion, errand: Errand, box: Array) -> bool:
        """Return whether a motion, which is kept, is free of one more box (7,)."""
        key = id(motion), box.tobytes()
        if key not in self._clear:
            _, held = self.seeker.grasps(errand.item)[motion.grasp]
            checker = self.seeker.checker.with_boxes(box[None])
            self._clear[key] = all(
                checker.is_path_clear(
                    segment.path,
                    held if segment.is_holding else None,
                    touching=segment.name in LINES,
                )
                for segment in motion.segments
            )
        return self._clear[key]

    def _complaint(self, errand: Errand, motion: Motion) -> str:
        """Return why the exact check does not accept a motion; empty if it does."""
        self.exact.stand(errand.boxes)
        if self.exact.complaint(motion, errand.item):
            return REJECTED
        if not errand.is_putting:
            return ""
        grasp, _ = self.seeker.grasps(errand.item)[motion.grasp]
        args = errand.item, motion.T_world_object, grasp.release_m
        return FALLS if self.exact.falls(*args) else ""
