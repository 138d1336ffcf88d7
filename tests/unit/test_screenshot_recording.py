"""The picture of a recording is what a person sees who opens it."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
import rerun as rr

ROOT = Path(__file__).parents[2]
SCRIPT = ROOT / "workflow" / "scripts" / "screenshot_recording.py"
DRIVERS = [
    driver
    for folder in ("/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d")
    for driver in sorted(Path(folder).glob("*.json"))
]


def take(tmp_path: Path, **environment: str) -> subprocess.CompletedProcess:
    """Take a picture of a recording of one point."""
    recording = tmp_path / "point.rrd"
    stream = rr.RecordingStream("placing", recording_id="point", send_properties=False)
    stream.save(recording)
    stream.log("point", rr.Points3D([[0, 0, 0]]), static=True)
    stream.flush()
    stream.disconnect()
    arguments = ["--recording", recording, "--picture", tmp_path / "point.png"]
    return subprocess.run(
        [sys.executable, SCRIPT, *arguments],
        env={**os.environ, **environment},
        check=False,
        capture_output=True,
        text=True,
        timeout=120,
    )


@pytest.mark.skipif(not DRIVERS, reason="there is no Vulkan driver")
def test_a_recording_gives_a_picture_and_no_view_reports_a_fault(tmp_path):
    done = take(tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "point.png").read_bytes().startswith(b"\x89PNG")


def test_without_vulkan_one_line_says_what_is_missing(tmp_path):
    nowhere = str(tmp_path / "no_driver.json")
    done = take(tmp_path, VK_DRIVER_FILES=nowhere, VK_ICD_FILENAMES=nowhere)
    assert done.returncode == 1
    assert not (tmp_path / "point.png").exists()
    last = done.stderr.splitlines()[-1]
    assert "Vulkan" in last
    assert "mesa-vulkan-drivers" in last
