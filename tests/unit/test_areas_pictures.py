"""A user's own cloud: its areas as lines and as a picture, and how the rest is refused.

Each malformed cloud is refused in one line, and nothing is written.
"""

import os
import subprocess
import sys
import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from matplotlib.backends.backend_agg import FigureCanvasAgg
from PIL import Image

from placing.areas.finder import AreaConfig
from placing.areas.outlines import heal
from placing.areas.scans import ScanAreas, find_in_scan
from placing.clouds.cloud import CloudConfig, sample_cloud
from placing.clouds.ply import Cloud, write_ply
from placing.errors import BadInput
from placing.pictures.areas import draw_areas, seen_from, splat, without_outside
from placing.pictures.cameras import Camera
from placing.rooms.file import read_yaml

ROOT = Path(__file__).parents[2]
SCRIPT = ROOT / "workflow" / "scripts" / "picture_areas.py"
DOCUMENT = read_yaml(ROOT / "config" / "config.yaml")
CLOUD, AREAS = CloudConfig(**DOCUMENT["cloud"]), AreaConfig(**DOCUMENT["areas"])
Main = Callable[[Path, Path], None]
XYZ = "property float x\nproperty float y\nproperty float z\n"
PLANE = np.random.default_rng(0).uniform(0, 3, (15000, 3)) * [1, 1, 0]
WALL = PLANE[:, [2, 0, 1]]
LINE = PLANE * [1, 0, 0]


def block(low: tuple, high: tuple) -> trimesh.Trimesh:
    mesh = trimesh.creation.box(bounds=[low, high])
    return trimesh.Trimesh(
        mesh.vertices, mesh.faces, face_colors=[180, 120, 60, 255], process=False
    )


def room() -> Cloud:
    """Return a floor of 3 m x 2 m, a table of 0.7 m and a solid wall at x = 0."""
    floor = block((0, 0, -0.1), (3, 2, 0))
    table = block((1, 0.5, 0.66), (2, 1.5, 0.7))
    wall = block((-0.1, 0, 0), (0, 2, 2.5))
    return sample_cloud(np.random.default_rng(1), [floor, table, wall], 0.02)


def found() -> ScanAreas:
    return find_in_scan(room(), CLOUD, AREAS)


def script(*words: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(SCRIPT), *map(str, words)]
    env = dict(os.environ, MPLBACKEND="Agg")
    return subprocess.run(command, capture_output=True, text=True, env=env, check=False)


def test_the_script_draws_a_cloud_and_prints_a_line_for_each_area(
    tmp_path: Path,
) -> None:
    write_ply(tmp_path / "my.ply", room())
    done = script("--cloud", tmp_path / "my.ply", "--picture", tmp_path / "a.png")
    assert done.returncode == 0, done.stderr
    head, *lines = done.stdout.splitlines()
    assert "spacing 0.0" in head
    assert lines[0].startswith("floor: height 0.000 m")
    (top,) = [line for line in lines if "height 0.70" in line or "0.69" in line]
    size = float(top.split(", ")[1].split()[0])
    assert size == pytest.approx(1.0, rel=0.06)
    assert "around (1.5" in top
    picture = Image.open(tmp_path / "a.png")
    assert picture.width > 1500
    assert len(np.unique(np.asarray(picture).reshape(-1, 4), axis=0)) > 200


def test_without_normals_areas_are_found_but_for_their_margin() -> None:
    """Planes through neighbours bend at an edge, as far as neighbours are: 7 cm."""
    bare = room().take(room().normals[:, 2] > -0.5)  # No scanner looks from below.
    few = bare.normals * (np.arange(len(bare)) % 50 == 0)[:, None]
    for normals in (np.zeros_like(bare.normals), few):
        areas = find_in_scan(replace(bare, normals=normals), CLOUD, AREAS).areas
        (top,) = [a for a in areas if abs(a.height_m - 0.7) < 0.01]
        assert 0.85**2 - 0.05 < heal(top.polygon_m).area <= 1.01
        assert areas[0].is_floor


def test_the_same_cloud_gives_the_same_picture() -> None:
    first, again = (draw_areas(found(), "a") for _ in range(2))
    pixels = []
    for figure in (first, again):
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        pixels.append(np.asarray(canvas.buffer_rgba()))
    assert np.array_equal(*pixels)
    table = first.axes[2].texts[0].get_text()
    assert "floor" in table
    assert table.count("\n") == len(found().areas) + 1


def test_a_nearer_point_covers_a_farther_one() -> None:
    camera = Camera((0.0, -5.0, 0.0), (0.0, 0.0, 0.0))
    points = np.array([[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.4, 0.0, 0.0]])
    colors = np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255]], np.uint8)
    picture = splat(points, colors, camera, (100, 80), 0.01)
    assert picture[40, 50].tolist() == [0, 255, 0]
    u, v = camera.project(points[2:], (100, 80))[0].astype(int)
    assert picture[v, u].tolist() == [0, 0, 255]
    assert picture[5, 5].tolist() == [255, 255, 255]
    assert not (picture == [255, 0, 0]).all(axis=2).any()


def test_walls_between_camera_and_room_are_left_out() -> None:
    scan = found()
    cloud = without_outside(scan.cloud, scan.areas)
    shown = cloud.take(seen_from(cloud, np.array([-4.0, 1.0, 3.0])))
    is_wall = (shown.points[:, 0] < 0.05) & (shown.points[:, 2] > 0.1)
    assert is_wall.sum() < 0.02 * (scan.cloud.points[:, 2] > 0.1).sum()
    shown = cloud.take(seen_from(cloud, np.array([6.0, 1.0, 3.0])))
    is_wall = (np.abs(shown.points[:, 0]) < 0.01) & (shown.points[:, 2] > 0.1)
    assert is_wall.sum() > 0.8 * 2.4 * 2 / 0.025**2
    assert np.sum(np.abs(shown.points[:, 2] - 0.7) < 0.01) > 1000


def binary(n: int, extra: str = "") -> str:
    return f"format binary_little_endian 1.0\nelement vertex {n}\n{XYZ}{extra}"


def bytes_of(points: np.ndarray) -> bytes:
    return points.astype("<f4").tobytes()


def with_value(value: float) -> bytes:
    points = PLANE.copy()
    points[7, 1] = value
    return bytes_of(points)


LIST = "element face {}\nproperty list {} int vertex_indices\n"
TEN = bytes_of(PLANE[:10])
FAR = np.concatenate([PLANE, 0.3 * PLANE + [9000, 9000, 0]])
BAD = {
    "promises more, ascii": (f"format ascii 1.0\nelement vertex 5\n{XYZ}", b"1 2 3\n"),
    "promises more, binary": (binary(5), TEN[:36]),
    "ten million, holds ten": (binary(10**7), TEN),
    "ten million, ascii": (f"format ascii 1.0\nelement vertex {10**7}\n{XYZ}", b"1 2 "),
    "nan": (binary(15000), with_value(np.nan)),
    "inf": (binary(15000), with_value(np.inf)),
    "long comment": (f"comment {'a' * 200_000}\n{binary(10)}", TEN),
    "header only": (binary(10), b""),
    "negative count": (binary(-10), TEN),
    "huge lists": (binary(10, LIST.format(4 * 10**9, "uint")), TEN + b"\xff" * 64),
    "negative list": (binary(10, LIST.format(2, "int")), TEN + b"\xff" * 16),
    "list of nan": (binary(10, LIST.format(1, "float")), TEN + b"\xff" * 4),
    "millimetres": (binary(15000), bytes_of(PLANE * 1e4)),
    "few centimetres": (binary(15000), bytes_of(PLANE * 100)),
    "one cluster far away": (binary(30000), bytes_of(FAR)),
    "too few points": (binary(10), TEN),
    "one point": (binary(15000), bytes_of(PLANE * 0)),
    "one line": (binary(15000), bytes_of(LINE)),
    "an upright line": (binary(15000), bytes_of(LINE[:, [1, 2, 0]])),
    "only a wall": (binary(15000), bytes_of(WALL)),
    "a narrow floor": (binary(15000), bytes_of(PLANE * [1, 0.015, 1])),
}


@pytest.fixture
def main(monkeypatch: pytest.MonkeyPatch) -> Main:
    """Return the typed main of the script; its folder is only on the path for it."""
    monkeypatch.syspath_prepend(str(SCRIPT.parent))
    return __import__("picture_areas").main


def complaint(main: Main, path: Path) -> str:
    before = sorted(path.parent.iterdir())
    with pytest.raises(BadInput) as error:
        main(path, path.parent / "out.png")
    assert sorted(path.parent.iterdir()) == before
    text = str(error.value)
    assert "\n" not in text
    assert text.startswith(f"{path}: ")
    assert "expected" in text
    return text


@pytest.mark.parametrize("name", BAD)
def test_malformed_clouds_are_refused_in_one_line(
    main: Main,
    tmp_path: Path,
    name: str,
) -> None:
    head, body = BAD[name]
    path = tmp_path / "bad.ply"
    path.write_bytes(f"ply\n{head}end_header\n".encode() + body)
    complaint(main, path)


def test_what_is_no_cloud_is_refused_in_one_line(main: Main, tmp_path: Path) -> None:
    (tmp_path / "empty.ply").write_bytes(b"")
    (tmp_path / "garbage.ply").write_bytes(os.urandom(4096))
    (tmp_path / "folder.ply").mkdir()
    (tmp_path / "loop.ply").symlink_to(tmp_path / "loop.ply")
    (tmp_path / "zero.ply").symlink_to("/dev/zero")
    os.mkfifo(tmp_path / "pipe.ply")  # Whoever opens it waits forever.
    for path in [*sorted(tmp_path.iterdir()), tmp_path / "none.ply"]:
        complaint(main, path)


def test_a_file_that_may_not_be_read_is_refused_in_one_line(
    main: Main,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    path = tmp_path / "a.ply"
    write_ply(path, room())
    whole = Path.open

    def refuse(self: Path, *args, **kwargs):
        if self == path:
            raise PermissionError(13, "Permission denied", str(self))
        return whole(self, *args, **kwargs)

    monkeypatch.setattr(Path, "open", refuse)
    assert "Permission denied" in complaint(main, path)


def test_a_header_that_promises_too_much_takes_no_memory(
    main: Main,
    tmp_path: Path,
) -> None:
    for name in ("ten million, holds ten", "ten million, ascii", "huge lists"):
        head, body = BAD[name]
        path = tmp_path / "bad.ply"
        path.write_bytes(f"ply\n{head}end_header\n".encode() + body)
        tracemalloc.start()
        complaint(main, path)
        assert tracemalloc.get_traced_memory()[1] < 5e6
        tracemalloc.stop()


def test_the_exit_code_tells_of_bad_input(tmp_path: Path) -> None:
    write_ply(tmp_path / "a.ply", room().take(np.arange(50)))
    for words in (
        ["--cloud", tmp_path / "a.ply", "--picture", tmp_path / "a.png"],
        ["--cloud", tmp_path / "a.ply", "--picture", tmp_path / "a.txt"],
    ):
        done = script(*words)
        assert done.returncode == 1
        assert done.stderr.count("\n") == 1
        assert [p.name for p in tmp_path.iterdir()] == ["a.ply"]
