"""What the reader of point clouds accepts, and how it refuses the rest."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from placing.clouds.ply import Cloud, read_ply, write_ply
from placing.errors import BadInput

XYZ = "property float x\nproperty float y\nproperty float z\n"


def cloud_of(n: int) -> Cloud:
    rng = np.random.default_rng(1)
    normals = rng.normal(size=(n, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    colors = rng.integers(0, 256, (n, 3), dtype=np.uint8)
    points = rng.normal(size=(n, 3)).astype(np.float32)
    return Cloud(points, normals.astype(np.float32), colors)


def write(path: Path, head: str, body: bytes) -> Path:
    path.write_bytes(f"ply\n{head}end_header\n".encode() + body)
    return path


def binary(n: int, order: str = "little", extra: str = "") -> str:
    return f"format binary_{order}_endian 1.0\nelement vertex {n}\n{XYZ}{extra}"


def test_what_was_written_is_read_back_exactly(tmp_path: Path) -> None:
    cloud = cloud_of(1000)
    write_ply(tmp_path / "a.ply", cloud)
    read = read_ply(tmp_path / "a.ply")
    assert np.array_equal(read.points, cloud.points)
    assert np.array_equal(read.normals, cloud.normals)
    assert np.array_equal(read.colors, cloud.colors)
    assert [p.name for p in tmp_path.iterdir()] == ["a.ply"]


def test_softness_is_read_back_exactly_and_unknown_where_nothing_is_said(
    tmp_path: Path,
) -> None:
    softness = np.array([0, 1, 0.3, np.nan] * 25, np.float32)
    write_ply(tmp_path / "a.ply", replace(cloud_of(100), softness=softness))
    write_ply(tmp_path / "b.ply", cloud_of(100))
    read = read_ply(tmp_path / "a.ply")
    assert read.softness is not None
    assert np.array_equal(read.softness, softness, equal_nan=True)
    assert np.array_equal(read.points, cloud_of(100).points)
    taken = read.take(np.array([2, 3])).softness
    assert taken is not None
    assert np.array_equal(taken, softness[2:4], equal_nan=True)
    assert read_ply(tmp_path / "b.ply").softness is None
    assert b"softness" not in (tmp_path / "b.ply").read_bytes()


@pytest.mark.parametrize("value", ["1.5", "-0.1", "inf"])
def test_softness_beyond_its_range_is_named_in_one_line(
    tmp_path: Path, value: str
) -> None:
    head = f"format ascii 1.0\nelement vertex 2\n{XYZ}property float softness\n"
    body = f"1 2 3 nan\n4 5 6 {value}\n".encode()
    with pytest.raises(BadInput, match=r"softness of vertex 1 is .*expected a number"):
        read_ply(write(tmp_path / "a.ply", head, body))


def test_open3d_reads_what_was_written(tmp_path: Path) -> None:
    open3d = pytest.importorskip("open3d")
    cloud = cloud_of(50)
    write_ply(tmp_path / "a.ply", cloud)
    read = open3d.io.read_point_cloud(str(tmp_path / "a.ply"))
    assert np.allclose(read.points, cloud.points)
    assert np.allclose(read.normals, cloud.normals)
    assert np.allclose(np.asarray(read.colors) * 255, cloud.colors)


@pytest.mark.parametrize(("order", "sign"), [("little", "<"), ("big", ">")])
def test_byte_order_further_properties_and_faces_do_not_matter(
    tmp_path: Path, order: str, sign: str
) -> None:
    kind = [
        ("x", sign + "f4"),
        ("y", sign + "f4"),
        ("z", sign + "f4"),
        ("q", sign + "f8"),
    ]
    rows = np.array([(1, 2, 3, 9), (4, 5, 6, 9)], kind)
    face = b"\x03" + np.arange(3).astype(sign + "i4").tobytes()
    faces = "element face 2\nproperty list uchar int vertex_indices\n"
    head = binary(2, order, "property double quality\n" + faces)
    cloud = read_ply(write(tmp_path / "a.ply", head, rows.tobytes() + 2 * face))
    assert cloud.points.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert not cloud.normals.any()
    assert (cloud.colors == 128).all()


def test_ascii_is_read(tmp_path: Path) -> None:
    head = f"format ascii 1.0\ncomment by hand\nelement vertex 2\n{XYZ}"
    cloud = read_ply(write(tmp_path / "a.ply", head, b"1 2 3\n4 5 -6.5\n"))
    assert cloud.points.tolist() == [[1, 2, 3], [4, 5, -6.5]]


POINT = np.array([1, 2, 3], "<f4").tobytes()
NAN = np.array([1, np.nan, 3], "<f4").tobytes()
FAR = np.array([1, 2, 3000000], "<f4").tobytes()
FACES = "element face 1\nproperty list uchar int vertex_indices\n"
ASCII = f"format ascii 1.0\nelement vertex 2\n{XYZ}"
BROKEN = {
    "promises more than it holds": (binary(5), 3 * POINT, "vertex promises 5 rows"),
    "holds more than it promises": (binary(2), 3 * POINT, "size is"),
    "absurd count": (binary(10**12), POINT, "expected 1 to 50000000"),
    "no points": (binary(0), b"", "vertex is 0, expected 1"),
    "negative count": (binary(-1), b"", "'element vertex -1' is not understood"),
    "nan": (binary(2), POINT + NAN, "y of vertex 1 is nan, expected a number"),
    "millimetres": (binary(1), FAR, "z of vertex 0 is 3000000"),
    "no z": (binary(1).replace("float z", "float w"), POINT, "z is missing"),
    "twice x": (binary(1).replace("float z", "float x"), POINT, "'x' stands"),
    "no format": (f"element vertex 1\n{XYZ}", POINT, "format is missing"),
    "no vertex": ("format ascii 1.0\n", b"", "expected one named vertex"),
    "long comment": (f"comment {'a' * 70000}\n{binary(1)}", POINT, "no end_header"),
    "cut face": (binary(1, extra=FACES), POINT + b"\x03\0\0", "face row 0 reaches"),
    "huge face": (binary(1, extra=FACES), POINT + b"\xff", "face row 0 reaches"),
    "word": (ASCII, b"1 2 3\n4 five 6\n", "expected 3 numbers a line"),
    "short line": (ASCII, b"1 2 3\n4 5\n", "expected 3 numbers a line"),
    "missing line": (ASCII, b"1 2 3\n", "lines is 1, expected 2"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_damage_is_named_in_one_line(tmp_path: Path, name: str) -> None:
    head, body, message = BROKEN[name]
    path = write(tmp_path / "bad.ply", head, body)
    with pytest.raises(BadInput) as error:
        read_ply(path)
    text = str(error.value)
    assert message in text
    assert text.startswith(f"{path}: ")
    assert "expected" in text
    assert "\n" not in text


def test_other_files_are_refused(tmp_path: Path) -> None:
    (tmp_path / "a.ply").write_bytes(b"PK\x03\x04")
    with pytest.raises(BadInput, match="magic"):
        read_ply(tmp_path / "a.ply")
    with pytest.raises(BadInput, match="missing"):
        read_ply(tmp_path / "none.ply")


@pytest.mark.parametrize("n_kept", [0, 3, 40, 150, 200, 700])
def test_no_truncation_goes_unnoticed(tmp_path: Path, n_kept: int) -> None:
    write_ply(tmp_path / "a.ply", cloud_of(20))
    whole = (tmp_path / "a.ply").read_bytes()
    assert n_kept < len(whole)
    (tmp_path / "a.ply").write_bytes(whole[:n_kept])
    with pytest.raises(BadInput):
        read_ply(tmp_path / "a.ply")
