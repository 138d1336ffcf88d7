"""A scene with its features and all that was learned without it, read from files."""

from pathlib import Path

from placing.artifacts.features import read_features
from placing.artifacts.scenes import read_scene
from placing.learning.learned import Learned
from placing.methods.scene_model import SceneModel, Settings


def read_model(
    path: Path, features: Path, learned: Learned, settings: Settings
) -> SceneModel:
    """Read the scene of a file, with its features from a directory of them."""
    scene = read_scene(path)
    candidates, valid = read_features(features / f"{scene.scene}.npz")
    return SceneModel(scene, candidates, valid, learned, settings)
