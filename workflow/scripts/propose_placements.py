"""Propose placements of the objects of every empty scene of a fold."""

import logging
from functools import partial
from pathlib import Path

from tqdm import tqdm

from command import run
from placing.artifacts.models import read_model
from placing.artifacts.proposals import write_proposals
from placing.artifacts.semantics import read_semantics
from placing.artifacts.stability import read_stability
from placing.artifacts.theta import read_learned
from placing.artifacts.tuning import read_tuning
from placing.clouds.ply import read_ply
from placing.joint.joint_options import ProposalConfig
from placing.joint.joint_tuning import most_frequent
from placing.learning.learned import Choices
from placing.methods.scene_model import Settings
from placing.psi.object_clouds import LookingConfig
from placing.psi.orientations import OrientationsConfig
from placing.psi.proposing import propose_for
from placing.psi.psi_object import PsiObject, PsiObjectConfig
from placing.seeds import generator

log = logging.getLogger(__name__)


def main(
    dataset: str,
    theta: Path,
    tuning: tuple[Path, ...],
    semantics: Path,
    stability: Path,
    clouds: Path,
    scenes: Path,
    features: Path,
    proposals: Path,
    seed: int,
    settings: Settings,
    orientations: OrientationsConfig,
    looking: LookingConfig,
    psi_object: PsiObjectConfig,
    proposing: ProposalConfig,
) -> None:
    """Propose placements of the objects of every empty scene of a fold.

    Args:
        dataset: Data set of the scenes.
        theta: Directory of what was learned without the fold.
        tuning: What training scenes chose, one file per fold that was learned from.
        semantics: Psi_semantics that was learned without the fold.
        stability: Psi_stability.
        clouds: Directory of the clouds of the fold.
        scenes: Directory of its scenes.
        features: Directory of their features.
        proposals: Directory to write.
        seed: Root of all random streams.
        settings: Sections of the configuration that answering looks at.
        orientations: Which orientations are tried.
        looking: How closely objects and scenes are looked at.
        psi_object: How the object context looks at a scene.
        proposing: How many placements are proposed.
    """
    learned = read_learned(theta)
    models = read_stability(stability), read_semantics(semantics)
    chosen = [read_tuning(path, "empty")[0].n_components for path in tuning]
    choices = Choices(most_frequent(chosen), 1.0)
    config = psi_object, looking, orientations
    for path in tqdm(sorted(scenes.glob("*.json")), unit="scene", disable=None):
        model = read_model(path, features, learned, settings)
        name, cloud = path.stem, read_ply(clouds / f"{path.stem}.ply")
        psi = PsiObject(model.scene, cloud, model.candidates, models, config)
        stream = partial(generator, seed, "propose_placements", dataset, name)
        proposed = propose_for(stream, model, psi, choices, proposing)
        write_proposals(proposals / f"{name}.npz", proposed)
        log.info("%s: %d options", name, len(proposed.proposals.object))


if __name__ == "__main__":
    run(main)
