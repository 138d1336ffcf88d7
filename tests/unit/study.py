"""A small study for tests: one furnished scene, made by hand, with two labellers."""

import numpy as np

from placing import rigid
from placing.candidates import Candidates, CandidatesConfig
from placing.clouds.ply import Cloud
from placing.learning.examples import baseline_values, examples_of
from placing.learning.fitting import FittingConfig
from placing.learning.learned import Learned
from placing.learning.likelihoods import nearest_places
from placing.learning.theta import LearningConfig, learn_theta
from placing.methods.baselines import FEATURES_OF, BaselinesConfig, learn_histograms
from placing.methods.decision import DecisionConfig
from placing.methods.object_context import ObjectContextConfig, learn_relations
from placing.methods.scene_model import SceneModel, Settings
from placing.people.diagnostics import DiagnosticsConfig
from placing.people.dpmm import DpmmConfig
from placing.people.human import HumanPoses
from placing.people.lattice import ArrangingConfig
from placing.people.valid_poses import PosesConfig, valid_poses
from placing.places import find_candidates
from placing.scene import Arrangement, Placement, PlacingArea, Scene, SceneObject
from placing.seeds import generator

SETTINGS = Settings(
    CandidatesConfig(0.05, 8, 0.7, 0.05),
    DpmmConfig("exact_birth", 1.0, 8, 2, 20, 40),
    DiagnosticsConfig(1.5, 0.5, 1),
    ArrangingConfig(4.0, 0.1),
    DecisionConfig(0.2, 0.25),
    BaselinesConfig(0.05, 0.05, 0.1, 0.2, 3.0, 1.0, 1.0, 0.7, 12.0, 0.1, 0.1, 1.0),
)
OBJECTS = (
    SceneObject("laptop1", "laptop", "laptop", (0.25, 0.35, 0.25), 2.0, True, False),
    SceneObject("mouse1", "mouse", "mouse", (0.1, 0.06, 0.04), 0.1, True, True),
    SceneObject("mouse2", "mouse", "mouse", (0.1, 0.06, 0.04), 0.1, True, True),
    SceneObject("shoes", "shoe", "shoes", (0.28, 0.2, 0.1), 0.8, False, True),
)


def plane(x, y, z):
    """Return points that cover a horizontal rectangle every 2 cm."""
    axes = [np.arange(a, b + 1e-9, 0.02) for a, b in (x, y)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 2)
    return np.column_stack([grid, np.full(len(grid), z)])


def area(name, x, y, height, is_floor=False):
    """Return a rectangular placing area."""
    corners = [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])]
    return PlacingArea(name, np.array(corners, float), height, np.inf, is_floor, None)


def placement(name, x, y, z, yaw):
    """Return a placement, upright."""
    location = np.array([x, y, z])
    return Placement(name, "area2", location, rigid.yaw_quaternion(yaw))


def study_scene() -> tuple[Scene, Cloud]:
    """Return a room of 3 x 3 m with a desk at the wall, a seat and two arrangements."""
    parts = [plane((0, 3), (0, 3), 0), plane((0.8, 2.2), (2.2, 3), 0.74)]
    parts.append(plane((1.3, 1.7), (1.5, 1.9), 0.45))
    points = np.concatenate(parts).astype(np.float32)
    normals = np.tile(np.float32([0, 0, 1]), (len(points), 1))
    cloud = Cloud(points, normals, np.full(points.shape, 128, np.uint8))
    areas = (
        area("floor", (0, 3), (0, 3), 0.0, is_floor=True),
        area("area1", (1.3, 1.7), (1.5, 1.9), 0.45),
        area("area2", (0.8, 2.2), (2.2, 3), 0.74),
    )
    one = (
        placement("laptop1", 1.5, 2.5, 0.865, -np.pi / 2),
        placement("mouse1", 1.8, 2.4, 0.76, np.pi / 2),
        placement("mouse2", 1.0, 2.4, 0.76, np.pi / 2),
        placement("shoes", 0.3, 0.3, 0.05, 0),
    )
    other = (*one[:3], placement("shoes", 2.7, 0.3, 0.05, 0))
    labelled = (
        Arrangement("labeller1", "tidy", one),
        Arrangement("labeller2", "tall", other),
    )
    return Scene("office1", "office", areas, OBJECTS, labelled), cloud


def study() -> tuple[Scene, Candidates, HumanPoses]:
    """Return the scene with its places and valid poses."""
    scene, cloud = study_scene()
    poses = PosesConfig(0.2, 0.1, 8, 0.05, 0.3, 0.8)
    valid = valid_poses(cloud.points, scene.areas, poses)
    return scene, find_candidates(cloud, scene.areas, SETTINGS.candidates), valid


def study_model() -> SceneModel:
    """Return the scene with what is learned from that very scene."""
    scene, candidates, poses = study()
    rng = generator(0, "test")
    config = LearningConfig(5, 10, 10, 100, 1)
    fitting = FittingConfig(0.2, 50.0, 0.1, 0.05)
    examples = [examples_of(scene, poses)]
    thetas, _ = learn_theta(rng, examples, SETTINGS.sampling, config, fitting)
    placed = [(scene, candidates, nearest_places(scene, candidates.location))]
    histograms = {
        method: learn_histograms(
            baseline_values(placed, method), method, SETTINGS.baselines
        )
        for method in FEATURES_OF
    }
    labelled = [(scene, a) for a in scene.arrangements]
    context = ObjectContextConfig(0.1, 50.0, 0.1, 0.05, 1.0)
    relations = learn_relations(labelled, context)
    mixtures = {"dp": thetas, "fmm2": thetas, "fmm3": thetas}
    learned = Learned(mixtures, histograms, relations)
    return SceneModel(scene, candidates, poses, learned, SETTINGS)
