"""What is kept is even, bounded and always the same."""

import numpy as np

from placing.recordings.thinning import evenly, thin, voxel_means


def floor_of(n: int) -> np.ndarray:
    """Return n points on a floor of 4 x 3 m, shape (n, 3)."""
    rng = np.random.default_rng(0)
    return np.column_stack([rng.uniform(0, [4, 3], (n, 2)), np.zeros(n)])


def test_thinning_keeps_each_index_at_most_once_and_in_order():
    kept = thin(1000, 100)
    assert len(kept) == 100
    assert (np.diff(kept) > 0).all()
    assert kept.min() >= 0
    assert kept.max() < 1000
    np.testing.assert_array_equal(kept, thin(1000, 100))
    np.testing.assert_array_equal(thin(5, 100), np.arange(5))
    assert thin(0, 100).shape == (0,)


def test_voxel_means_are_few_and_leave_no_gap():
    points = floor_of(200_000)
    kept, _, spacing = voxel_means(points, points, 5000)
    assert 3500 < len(kept) <= 5000
    nearest = np.linalg.norm(points[::2000, None] - kept[None], axis=-1).min(axis=1)
    assert nearest.max() < spacing * np.sqrt(3)


def test_voxel_means_equal_a_mean_over_each_voxel():
    points, values = floor_of(300), np.arange(300.0)[:, None]
    kept, mean, spacing = voxel_means(points, values, 20)
    cells: dict[tuple, list[int]] = {}
    for i, cell in enumerate(np.floor((points - points.min(axis=0)) / spacing)):
        cells.setdefault(tuple(cell), []).append(i)
    rows = [cells[cell] for cell in sorted(cells)]
    np.testing.assert_allclose(kept, [points[row].mean(axis=0) for row in rows])
    np.testing.assert_allclose(mean, [values[row].mean(axis=0) for row in rows])


def test_a_small_cloud_is_kept_as_it_is():
    points = floor_of(50)
    kept, values, _ = voxel_means(points, points, 1000)
    order = np.lexsort(points.T)
    np.testing.assert_allclose(kept[np.lexsort(kept.T)], points[order])
    np.testing.assert_allclose(values, kept)


def test_evenly_keeps_the_first_and_the_last_value():
    kept = evenly(np.arange(10, 1010), 50)
    assert len(kept) == 50
    assert kept[0] == 10
    assert kept[-1] == 1009
    assert set(np.diff(kept)) <= {20, 21}
    np.testing.assert_array_equal(evenly(np.arange(3), 50), np.arange(3))
    assert evenly(np.arange(0), 50).shape == (0,)
