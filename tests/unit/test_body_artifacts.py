"""What is cut for the simulator comes back; what is out of place is named."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from test_bodies import block, shelf

from placing.artifacts.bodies import NAMES, PIECES, read_solids, write_solids
from placing.artifacts.formats import read_arrays, write_arrays
from placing.errors import BadArtifact
from placing.physics.bodies import Solids
from placing.physics.cutting import body_of, fixed_pieces

SCRIPTS = Path(__file__).parents[2] / "workflow" / "scripts"


@pytest.fixture
def solids():
    """A shelf and a table, a box and what has two parts."""
    two = shelf() + block((0.1, 0.1, 0.1), (0, 0, 1))
    fixed = {"shelf": shelf(), "table": block((1, 1, 0.03), (0, 0, 1))}
    bodies = {"box": body_of(block((0.2, 0.1, 0.3)), 2.0, 0.001)}
    bodies["two"] = body_of(two, 1.0, 0.001)
    return Solids({k: fixed_pieces(mesh, 0.001) for k, mesh in fixed.items()}, bodies)


def listed(pieces):
    return [
        (piece.vertices_m.tolist(), piece.faces.tolist(), piece.is_convex)
        for piece in pieces
    ]


def test_solids_come_back_to_the_last_digit(tmp_path, solids):
    write_solids(tmp_path / "room.npz", solids)
    found = read_solids(tmp_path / "room.npz")
    assert list(found.fixed) == ["shelf", "table"]
    assert list(found.bodies) == ["box", "two"]
    for name, pieces in solids.fixed.items():
        assert listed(found.fixed[name]) == listed(pieces)
    for name, body in solids.bodies.items():
        other = found.bodies[name]
        assert listed(other.pieces) == listed(body.pieces)
        assert other.mass_kg == body.mass_kg
        assert np.array_equal(other.mass_centre_m, body.mass_centre_m)
        assert np.array_equal(other.inertia_kg_m2, body.inertia_kg_m2)


def test_a_room_without_objects_comes_back(tmp_path, solids):
    write_solids(tmp_path / "room.npz", Solids(solids.fixed, {}))
    assert read_solids(tmp_path / "room.npz").bodies == {}


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("faces", lambda faces: faces + 1000),
        ("faces", lambda faces: faces[:-1]),
        ("vertices_m", lambda vertices: vertices * np.nan),
        ("mass_kg", lambda mass: -mass),
        ("thing", lambda thing: thing + 1),
        ("n_faces", lambda n: n[:-1]),
        ("objects", lambda objects: objects[:-1]),
    ],
)
def test_what_does_not_belong_together_is_named(tmp_path, solids, name, change):
    path = tmp_path / "room.npz"
    write_solids(path, solids)
    arrays = read_arrays(path, NAMES + PIECES)
    write_arrays(path, arrays | {name: change(arrays[name])})
    with pytest.raises(BadArtifact, match=r"room\.npz: \w+: ") as caught:
        read_solids(path)
    assert "\n" not in str(caught.value)


def test_planning_does_without_meshes():
    """They would be a tenth of its memory."""
    code = "import sys, plan_placing; print('trimesh' in sys.modules)"
    command = [sys.executable, "-c", code]
    found = subprocess.run(command, cwd=SCRIPTS, capture_output=True, check=True)
    assert found.stdout.decode().split()[-1] == "False"
