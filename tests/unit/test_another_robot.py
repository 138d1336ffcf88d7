"""Another robot is a file: a TIAGo puts a can on a table, and the replay agrees."""

from robot_room import DOCUMENT, ROOT, pieces, points
from test_grasps import SHEET
from test_putting import BODIES, CAN, CHECKING, CONFIG, PLACE, SETTLING, to_put

from placing import rigid
from placing.robot.certificates import World, certificate_of
from placing.robot.checker import SceneChecker
from placing.robot.distance_field import distance_field
from placing.robot.driving import Floor
from placing.robot.exact import Exact
from placing.robot.model import load_robot
from placing.robot.planning import PUTTING, Motion
from placing.robot.putting import Placer
from placing.robot.replay import judge_all
from placing.robot.replay_config import ReplayConfig
from placing.robot.seeking import Seeker
from placing.robot.settings import read_robot
from placing.robot.truth import Truth
from placing.rooms.file import read_yaml


def settings():
    rules = read_yaml(ROOT / "workflow" / "schemas" / "robot.schema.yaml")
    return read_robot(ROOT / "config" / "robots" / "tiago.yaml", rules)


def put():
    """Return how a TIAGo puts a can where the PR2 does in other tests."""
    tiago = load_robot(settings())
    checker = SceneChecker(tiago, distance_field(points(), CHECKING), CHECKING)
    with Truth(tiago, pieces(), CHECKING, SETTLING) as truth:
        exact = Exact(truth, BODIES, SETTLING.margin_m, CONFIG.contact_m)
        floor = Floor(checker, CONFIG, "room")
        seeker = Seeker(checker, floor, exact, SHEET, CONFIG, 1)
        return Placer(seeker, exact).carried_out(to_put(CAN, PLACE, {}))


def test_a_tiago_puts_a_can_on_a_table_and_the_replay_agrees():
    motion = put()
    assert isinstance(motion, Motion), motion
    assert tuple(s.name for s in motion.segments) == PUTTING
    away_m, _ = rigid.difference(motion.T_world_object, PLACE)
    assert away_m <= CONFIG.contact_m
    made = certificate_of(World("test", "room", "empty", "all", "with"), [motion], {})
    config = ReplayConfig(**DOCUMENT["replay"])
    args = settings(), pieces(), BODIES, config, SETTLING, CONFIG.contact_m
    (found,) = judge_all([made], *args)
    assert found.reason == ""
    assert found.end_error_m < 0.01
