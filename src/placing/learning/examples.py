"""What the learners see of a training scene: labelled objects, poses and places."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from placing import rigid
from placing.candidates import Candidates
from placing.learning.likelihoods import Nearest
from placing.learning.theta import Example
from placing.methods.baselines import place_features
from placing.people.human import HumanPoses
from placing.people.offsets import find_spots
from placing.scene import Scene

Array = NDArray[np.float64]


def examples_of(scene: Scene, poses: HumanPoses) -> list[Example]:
    """Return one example per labelled arrangement of a scene."""
    items = {item.object_id: item for item in scene.objects}
    spots = find_spots(poses.references())
    examples = []
    for arrangement in scene.arrangements:
        placed = [items[p.object_id] for p in arrangement.placements]
        locations = np.array([p.location for p in arrangement.placements])
        yaw = rigid.yaw_of(np.array([p.orientation for p in arrangement.placements]))
        examples.append(
            Example(
                scene=scene.scene,
                categories=tuple(item.category for item in placed),
                objects=np.column_stack([locations, yaw]),
                has_front=np.array([item.has_front for item in placed]),
                spots=spots,
                prior=poses.prior,
            )
        )
    return examples


def baseline_values(
    training: Sequence[tuple[Scene, Candidates, Nearest]], method: str
) -> dict[str, Array]:
    """Return the features of a baseline where labelled objects rest, by category.

    Each training scene comes with its places and `nearest_places`; the features are
    those of the place nearest to the object, (n, f) per category.
    """
    values: dict[str, list[Array]] = {}
    for scene, candidates, nearest in training:
        category = {item.object_id: item.category for item in scene.objects}
        table = place_features(candidates, method)
        for places in nearest.values():
            for name, place in places.items():
                values.setdefault(category[name], []).append(table[place])
    return {name: np.array(values[name]) for name in sorted(values)}
