"""What the planner calls free is free; the fast check agrees with a slow one."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from robot_room import (
    CONFIG,
    SETTLING,
    anywhere,
    checker,
    pieces,
    points,
    pr2,
    reaching,
    stowed,
)
from scipy.ndimage import map_coordinates
from scipy.spatial.distance import cdist
from test_nearby import all_near

from placing import rigid
from placing.robot import trunk as trunk_module
from placing.robot import truth as truth_module
from placing.robot.checker import SceneChecker, held, levers, make_body, outermost
from placing.robot.distance_field import distance_field, open_field
from placing.robot.kernels import forward, n_steps
from placing.robot.model import tool_pose
from placing.robot.truth import Truth, steps

BESIDE = rigid.from_yaw(0.3, (0.06, 0.0, 0.02))


def centres_of(q):
    """Return the centres of all spheres of the robot, (s, 3)."""
    return placed_at(pr2().spheres, q)


def placed_at(spheres, q):
    """Return centres of spheres in the world, (s, 3)."""
    tree = pr2().tree
    frames = np.empty((len(tree.axis), 3, 4))
    forward(tree, np.asarray(q, float), frames)
    T = frames[spheres.frame]
    return np.einsum("sij,sj->si", T[:, :, :3], spheres.at_m) + T[:, :, 3]


def slow_scene(q):
    """Return whether a sphere is too near to the field or the ground, by scipy."""
    field, model = checker().field, pr2()
    centre, radius = centres_of(q), model.spheres.radius_m
    u = ((centre - field.origin_m) / field.cell_m).T
    inside = np.all(
        (u[:2].T >= 0) & (np.array(field.distance_m.shape[:2]) - 1 > u[:2].T), 1
    )
    if not inside.all():
        return True
    distance = map_coordinates(field.distance_m, u, order=1, mode="nearest")
    ground = field.ground_m[tuple(np.round(u[:2]).astype(int))]
    is_arm = model.spheres.frame > 0
    low = is_arm & (centre[:, 2] - radius - CONFIG.margin_m < ground)
    reach = np.hypot(radius + CONFIG.margin_m, CONFIG.spacing_m)
    return bool(np.any(distance < reach - 1e-6) or low.any())


def slow_self(q):
    """Return whether spheres of two links that may hit overlap, pair by pair."""
    model, centre = pr2(), centres_of(q)
    radius, link = model.spheres.radius_m, model.spheres.link
    for i, j in model.self_pairs:
        a, b = link == i, link == j
        away = np.linalg.norm(centre[a][:, None] - centre[b], axis=2)
        if np.any(away < radius[a][:, None] + radius[b] + CONFIG.self_margin_m):
            return True
    return False


def test_it_agrees_with_a_slow_check():
    configurations = anywhere(1, 100)
    free = checker().are_free(configurations)
    for q, is_free in zip(configurations, free, strict=True):
        hits = checker().hits(q)
        assert (hits.scene, hits.self) == (slow_scene(q), slow_self(q))
        assert is_free == (not hits.scene and not hits.self) == checker().is_free(q)
    assert 5 < free.sum() < 95


def test_rows_that_share_base_and_torso_are_checked_as_if_alone():
    arm = anywhere(2, 300)
    arm[:, :4] = np.repeat([stowed(1.5, 1.5)[:4], stowed(0.2, 0.2)[:4]], 150, axis=0)
    alone = [checker().is_free(q) for q in arm]
    assert checker().are_free(arm).tolist() == alone
    assert 20 < sum(alone) < 280


def test_nothing_is_free_that_collides(monkeypatch):
    # The exact check has to look at all true meshes: its spheres are the planner's.
    monkeypatch.setattr(truth_module, "near", all_near)
    configurations = anywhere(3, 2000)
    free = checker().are_free(configurations)
    with Truth(pr2(), pieces(), CONFIG, SETTLING) as truth:
        assert not [truth.hits(q) for q in configurations[free] if truth.hits(q)]
        true = sum(not truth.hits(q) for q in configurations[:500])
    assert free.sum() > 100
    assert free[:500].sum() > 0.5 * true


def test_an_edge_is_free_if_all_its_steps_are():
    lever_m = levers(pr2())
    rows = anywhere(4, 4000)
    rows[:, :4] = stowed(2.2, 1.5)[:4]
    rows = rows[checker().are_free(rows)][:60]
    answers = []
    for q0, q1 in pairwise(rows):
        path = np.array([q0, q1])
        between = np.array(
            [
                q
                for _, q in steps(
                    path, pr2().tree, pr2().spheres, lever_m, CONFIG.step_m
                )
            ]
        )
        answers.append(checker().is_edge_free(q0, q1))
        assert answers[-1] == checker().are_free(between).all()
    assert 5 < sum(answers) < 55
    assert checker().is_path_free(rows[:1])
    assert not checker().is_path_free(rows)


def test_nothing_moves_farther_than_a_step():
    rows = anywhere(5, 40)
    for q0, q1 in pairwise(rows):
        path = np.array([q0, q0 + 0.2 * (q1 - q0)])
        spheres = [
            centres_of(q)
            for _, q in steps(
                path, pr2().tree, pr2().spheres, levers(pr2()), CONFIG.step_m
            )
        ]
        moved = np.linalg.norm(np.diff(spheres, axis=0), axis=2)
        assert moved.max() <= CONFIG.step_m + 1e-9


def test_levers_are_reached_by_a_stretched_arm_and_never_passed():
    stretched = np.array([0, 0, 0, 0.3, 0, 0, 0, -0.15, 0, -0.1, 0])
    rows, lever_m = [stretched, *anywhere(11, 30)], levers(pr2())
    for k in range(6):  # the rolls turn nothing far from their axes
        moved = []
        for q in rows:
            other = q.copy()
            other[k] += 1e-4
            away = np.linalg.norm(centres_of(other) - centres_of(q), axis=1)
            moved.append(away.max() / 1e-4)
        assert 0.6 * lever_m[k] < max(moved) <= lever_m[k] * (1 + 1e-3)


def test_boxes_are_hit_as_a_slow_distance_says():
    rng = np.random.default_rng(6)
    model = pr2()
    centre, size = (
        rng.uniform([1, 1, 0.1], [2, 2, 1.2], (12, 3)),
        rng.uniform(0.05, 0.4, (12, 3)),
    )
    boxes = np.column_stack([centre, size, rng.uniform(-3, 3, 12)])
    among = checker().with_boxes(boxes)
    for q in anywhere(7, 100) * [0, 0, *[1] * 9] + [1.5, 1.5, *[0] * 9]:
        hit = []
        for b, box in enumerate(boxes):
            T = rigid.inverse(rigid.from_yaw(box[6], box[:3]))
            beyond = np.maximum(np.abs(rigid.apply(T, centres_of(q))) - box[3:6] / 2, 0)
            away = np.linalg.norm(beyond, axis=1)
            if np.any(away < model.spheres.radius_m + CONFIG.box_margin_m):
                hit.append(b)
        assert among.hits(q).boxes == tuple(hit)
    assert checker().boxes == ()


def test_the_spheres_of_a_held_object_cover_its_box():
    item = held("pan", (0.32, 0.05, 0.011), BESIDE)
    inside = np.random.default_rng(8).uniform(-0.5, 0.5, (5000, 3)) * item.size_m
    away = rigid.apply(BESIDE, inside)[:, None] - item.centre_m
    assert np.all(np.any(np.linalg.norm(away, axis=2) <= item.radius_m, axis=1))
    assert np.ptp(item.centre_m, axis=0).max() < 0.32


def standing_on_a_patch(lift_m):
    """Return a checker with a patch of table below what the tool holds, and both."""
    q = reaching()
    tool = tool_pose(pr2(), q)
    upright = rigid.compose(rigid.inverse(tool), rigid.from_yaw(0.0, tool[4:]))
    item = held("mug", (0.06, 0.06, 0.14), upright)
    x, y = np.meshgrid(np.arange(-0.1, 0.1, 0.02), np.arange(-0.1, 0.1, 0.02))
    patch = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)]) + tool[4:]
    patch[:, 2] -= 0.07 + lift_m
    floor = points()[points()[:, 2] < 0.001]
    field = distance_field(np.concatenate([floor, patch]), CONFIG)
    return SceneChecker(pr2(), field, CONFIG), q, item


def test_what_is_held_may_touch_only_while_it_is_put_down():
    low, q, item = standing_on_a_patch(0.0)
    assert low.is_free(q)
    assert not low.is_free(q, item)
    assert low.is_free(q, item, touching=True)
    high, q, item = standing_on_a_patch(0.15)
    assert high.is_free(q, item)


def test_while_touching_the_gripper_still_must_not_hit():
    deep, q, item = standing_on_a_patch(-0.07)
    assert not deep.is_free(q, item, touching=True)


def test_what_is_held_must_not_hit_the_robot():
    q = stowed(1.5, 1.5)
    T = rigid.inverse(tool_pose(pr2(), q))
    inside = rigid.compose(T, rigid.from_yaw(0.0, (1.5, 1.5, 0.5)))
    assert checker().hits(q).self is False
    assert checker().hits(q, held("box", (0.1, 0.1, 0.1), inside)).self is True


def test_robot_and_what_it_holds_hit_where_all_their_spheres_say():
    model, long = pr2(), held("broom", (0.1, 0.1, 1.2), BESIDE)
    last = len(model.tree.axis) - 1
    gripper = {model.links.index(name) for name in model.settings.gripper_links}
    others = [n not in gripper for n in model.spheres.link.tolist()]
    T, found = model.tree.T_frame_tool, []
    spheres = model.spheres._replace(
        frame=np.full(len(long.radius_m), last),
        at_m=long.centre_m @ T[:, :3].T + T[:, 3],
    )
    for q in anywhere(13, 150):
        away = np.linalg.norm(
            placed_at(spheres, q)[:, None] - centres_of(q)[others], axis=2
        )
        reach = long.radius_m[:, None] + model.spheres.radius_m[others]
        found.append(bool(np.any(away < reach + CONFIG.self_margin_m)) or slow_self(q))
        assert checker().hits(q, long).self == found[-1]
    assert 20 < sum(found) < 130


@pytest.mark.parametrize("bin_rad", [trunk_module.BIN_RAD, 0.2])
def test_what_the_first_joint_of_the_arm_keeps_apart_is_apart(monkeypatch, bin_rad):
    monkeypatch.setattr(trunk_module, "BIN_RAD", bin_rad)
    model, trunk = pr2(), make_body.__wrapped__(pr2(), CONFIG).trunk
    frame, spheres = model.tree.link_frame.tolist(), model.spheres
    q, pairs = anywhere(16, 1)[0], model.self_pairs.tolist()
    pairs = [(i, j) for i, j in pairs if {frame[i], frame[j]} == {1, 2}]
    places = np.arange(len(trunk.is_apart))[:, None] + np.linspace(0, 1, 5)
    angles = trunk.start_rad + trunk.bin_rad * places
    least_m = np.full(angles.shape, np.inf)
    for n, q[4] in np.ndenumerate(angles):
        centre = centres_of(q)
        for i, j in pairs:
            a, b = spheres.link == i, spheres.link == j
            reach = spheres.radius_m[a][:, None] + spheres.radius_m[b]
            away = np.min(cdist(centre[a], centre[b]) - reach)
            least_m[n] = min(least_m[n], away)
    assert np.all(least_m[trunk.is_apart] > CONFIG.self_margin_m)
    assert least_m.min() < 0.0 < trunk.is_apart.mean()


def test_no_point_moves_farther_than_the_outermost():
    spheres, tree = pr2().spheres, pr2().tree
    frame, at_m = outermost(spheres.frame, spheres.at_m)
    some = spheres._replace(frame=frame, at_m=at_m)
    assert len(at_m) < 0.8 * len(spheres.at_m)
    for q0, q1 in pairwise(anywhere(14, 60)):
        away = np.linalg.norm(placed_at(spheres, q1) - placed_at(spheres, q0), axis=1)
        fewer = np.linalg.norm(placed_at(some, q1) - placed_at(some, q0), axis=1)
        assert np.isclose(away.max(), fewer.max(), atol=1e-12)
        lever_m = levers(pr2())
        args = tree, spheres.frame, spheres.at_m, lever_m, q0, q1, 0.04
        assert n_steps(*args) == n_steps(tree, frame, at_m, lever_m, q0, q1, 0.04)


def test_checks_are_counted_together():
    first = SceneChecker(pr2(), checker().field, CONFIG)
    second = first.with_boxes(np.zeros((0, 7)))
    first.are_free(anywhere(9, 7))
    second.is_free(stowed(1.5, 1.5))
    assert first.n_checks == second.n_checks == 8


@pytest.mark.parametrize("x", [-0.5, 4.5])
def test_outside_of_the_scan_nothing_is_free(x):
    assert checker().is_free(stowed(1.5, 1.5))
    assert not checker().is_free(stowed(x, 1.5))


def test_a_wider_margin_frees_nothing():
    wide = SceneChecker(pr2(), checker().field, replace(CONFIG, margin_m=0.05))
    rows = anywhere(10, 2000)
    assert not np.any(wide.are_free(rows) & ~checker().are_free(rows))


def test_many_rows_get_the_answers_that_each_gets_alone():
    rows = np.repeat(anywhere(5, 60), 5, axis=0)
    rng = np.random.default_rng(5)
    for first, last in ((0, 3), (3, 4), (4, 5), (8, 11), (0, 11)):
        some = np.arange(len(rows)) % 5 == (first + last) % 5
        rows[some, first:last] += rng.normal(0, 0.2, (int(some.sum()), last - first))
    alone = [checker().is_free(q) for q in rows]
    assert checker().are_free(rows).tolist() == alone
    assert 20 < sum(alone) < 280


def test_an_edge_is_free_where_all_its_steps_are():
    n_free = 0
    for q0, q1 in pairwise(anywhere(6, 300)):
        q1 = np.where(np.arange(len(q1)) < 3 + n_free % 5, q1, q0)
        way = np.abs(q1 - q0) @ levers(pr2())
        n = max(1, int(np.ceil(way / CONFIG.step_m)))
        steps_m = q0 + np.arange(n + 1)[:, None] / n * (q1 - q0)
        expected = all(checker().is_free(q) for q in steps_m)
        assert checker().is_edge_free(q0, q1) == expected
        n_free += expected
    assert n_free > 5


def test_steps_of_an_edge_are_as_short_as_they_say_also_for_what_is_held():
    model = pr2()
    broom = np.array([[0.0, 0.0, 0.8], [0.05, 0.1, -0.6], [0.2, 0.0, 0.0]])
    T, last = model.tree.T_frame_tool, len(model.tree.axis) - 1
    at = np.vstack([model.spheres.at_m, broom @ T[:, :3].T + T[:, 3]])
    frame = np.append(model.spheres.frame, np.full(3, last))
    lever_m, longest = levers(model, broom), 0.0
    spheres = model.spheres._replace(frame=frame, at_m=at)
    for q0, q1 in pairwise(anywhere(8, 60)):
        q1[10:] += 1.5  # the wrist rolls
        n = n_steps(model.tree, frame, at, lever_m, q0, q1, CONFIG.step_m)
        rows = q0 + np.arange(n + 1)[:, None] / n * (q1 - q0)
        centres = np.array([placed_at(spheres, q) for q in rows])
        away = np.linalg.norm(np.diff(centres, axis=0), axis=2).max()
        longest = max(longest, away / CONFIG.step_m)
    assert 0.7 < longest <= 1.02


def test_rows_free_without_boxes_are_free_among_them_where_they_are_clear():
    alone, rng = checker().with_boxes(np.zeros((0, 7))), np.random.default_rng(12)
    rows = anywhere(15, 2000)
    rows = rows[alone.are_free(rows, touching=True)]
    sizes = np.tile([0.3, 0.3, 0.4, 0.2], (8, 1))
    boxes = np.hstack([rng.uniform((0, 0, 0.2), (4, 3, 1.2), (8, 3)), sizes])
    among = checker().with_boxes(boxes)
    for what in (None, held("mug", (0.1, 0.1, 0.1), BESIDE)):
        some = rows[alone.are_free(rows, what, touching=True)]
        clear = among.are_clear(some, what, touching=True)
        assert np.array_equal(clear, among.are_free(some, what, touching=True))
        assert 0.05 < clear.mean() < 0.95


def test_a_path_is_clear_of_boxes_where_each_of_its_configurations_is():
    boxless, tree = SceneChecker(pr2(), open_field(), CONFIG), pr2().tree
    rng, found = np.random.default_rng(11), []
    for seed in range(60):
        box = np.array([*rng.uniform((0, 0, 0.3), (4, 3, 1.2)), 0.2, 0.3, 0.25, 0.4])
        path = anywhere(seed, 3)
        path[1:, 3:] = path[0, 3:] + rng.uniform(-0.5, 0.5, (2, 8)) * [0, *[1] * 7]
        among = boxless.with_boxes(box[None])
        rows = steps(path, tree, pr2().spheres, levers(pr2()), CONFIG.step_m)
        is_hit = any(among.hits(q).boxes for _, q in rows)
        found.append(among.is_path_clear(path))
        assert found[-1] is not is_hit
    assert 10 < sum(found) < 50


def test_the_ends_of_an_edge_are_looked_at_with_their_own_angles():
    model, trunk = pr2(), make_body(pr2(), CONFIG).trunk
    alone = SceneChecker(model, open_field(), CONFIG)
    places = np.arange(len(trunk.is_apart)) + 0.5
    free, hit = [], []
    for angle in trunk.start_rad + trunk.bin_rad * places:
        q = anywhere(16, 1)[0]
        q[4] = angle
        (hit if slow_self(q) else free).append(q)
    assert len(hit) > 5
    turned = free[len(free) // 2].copy()
    turned[-1] += 0.5
    for q in hit:
        # What is free leaves its numbers in memory.
        assert alone.is_edge_free(free[len(free) // 2], turned)
        assert not alone.is_edge_free(q, q)
