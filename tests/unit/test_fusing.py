"""How points of many images become one cloud, compared with plain loops."""

import numpy as np

from placing.clouds.fusing import Seen, cloud_of, fuse, fuse_to, joined, keep_surest


def seen(n: int, seed: int = 1) -> Seen:
    rng = np.random.default_rng(seed)
    weight = rng.uniform(1, 9, n)
    points = rng.uniform(-0.3, 0.3, (n, 3))
    colors = rng.uniform(0, 255, (n, 3))
    return Seen(points, rng.normal(size=(n, 3)), colors, rng.random(n), weight, weight)


def test_fusing_is_the_weighted_mean_over_the_cells_of_a_dictionary() -> None:
    every, cells = seen(800), {}
    for k, point in enumerate(every.points):
        cells.setdefault(tuple(np.floor(point / 0.1).astype(int)), []).append(k)
    fused = fuse(every, 0.1)
    expected = [
        (
            *np.average(every.points[rows], axis=0, weights=every.weight[rows]),
            np.average(every.softness[rows], weights=every.weight[rows]),
            every.weight[rows].sum(),
            every.weight[rows].max(),
        )
        for rows in cells.values()
    ]
    found = np.column_stack([fused.points, fused.softness, fused.weight, fused.surest])
    assert np.allclose(
        found[np.lexsort(found.T)],
        np.array(sorted(expected, key=lambda row: row[::-1])),
    )


def test_fusing_in_turns_is_fusing_at_once() -> None:
    first, second = seen(500), seen(400, seed=2)
    at_once = fuse(joined([first, second]), 0.1)
    in_turns = fuse(joined([fuse(first, 0.1), fuse(second, 0.1)]), 0.1)
    for a, b in zip(at_once, in_turns, strict=True):
        assert np.allclose(a, b)


def test_voxels_grow_until_there_are_few_enough() -> None:
    assert 100 < len(fuse_to(seen(3000), 0.02, 300).points) <= 300


def test_what_is_less_sure_is_dropped_before_and_behind_but_not_beside() -> None:
    rows = {"wall": 0.0, "before": -0.05, "behind": 0.05, "beside": 0.0, "far": 0.3}
    points = np.array([[x, 0.0, 0.0] for x in rows.values()])
    points[3, 1] = 0.05
    weight = np.array([9.0, 1.0, 1.0, 1.0, 1.0])
    back = np.tile([-2.0, 0.0, 0.0], (5, 1))
    every = Seen(points, back, points, weight, weight, weight)
    kept = keep_surest(every, 0.025, 0.075, 0.25)
    assert np.array_equal(kept.points, points[[0, 3, 4]])
    assert len(keep_surest(every, 0.025, 0.075, 0.1).points) == 5


def test_normals_face_the_camera() -> None:
    rng = np.random.default_rng(3)
    flat = np.column_stack([rng.uniform(0, 1, (500, 2)), np.zeros(500)])
    back = np.tile([0.3, 0.0, -1.0], (500, 1))
    cloud = cloud_of(seen(500)._replace(points=flat, back=back), 12)
    assert np.allclose(cloud.normals, [0, 0, -1], atol=1e-5)
