"""Take a picture of a recording as it opens, without a screen."""

import os
import socket
import time
from importlib.resources import files
from pathlib import Path

from rerun.experimental import ViewerClient

from command import run
from placing.errors import BadArtifact, PlacingError

SECONDS_TO_OPEN = 60
SECONDS_TO_SETTLE = 5
"""The viewer greets for some seconds with notes that cover a corner."""


def main(recording: Path, picture: Path) -> None:
    """Open a recording in a headless viewer and save what it shows.

    Args:
        recording: Recording to open.
        picture: PNG to write.
    """
    if not recording.is_file():
        raise BadArtifact(f"{recording}: there is no such recording")
    os.environ.setdefault("RUST_LOG", "error")  # the viewer is talkative
    # The program itself, since the command around it does not end with its parent.
    program = files("rerun_cli") / "rerun"
    try:
        with ViewerClient.spawn(
            headless=True, port=free_port(), executable_path=str(program)
        ) as viewer:
            faults = show(viewer, recording, picture)
    except (ConnectionError, RuntimeError) as error:
        raise PlacingError(
            f"{recording}: the viewer ended ({error}); it draws with Vulkan, which the "
            "packages mesa-vulkan-drivers and libvulkan1 give to computers without it"
        ) from error
    if faults:
        raise BadArtifact(f"{recording}: the viewer reports {faults}")


def show(viewer: ViewerClient, recording: Path, picture: Path) -> list[str]:
    """Show a recording, save the picture and return what the views report."""
    viewer.open(str(recording.resolve()))
    wait_until_loaded(viewer)
    viewer.take_screenshot()  # nothing is drawn, nor a note gone, before a picture
    time.sleep(SECONDS_TO_SETTLE)
    picture.parent.mkdir(parents=True, exist_ok=True)
    viewer.save_screenshot(str(picture))
    return [str(report) for view in viewer.get_state().views for report in view.reports]


def free_port() -> int:
    """Return a port that nothing listens on."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


def wait_until_loaded(viewer: ViewerClient) -> None:
    """Wait until the viewer has loaded what it opened."""
    start = time.monotonic()
    while time.monotonic() - start < SECONDS_TO_OPEN:
        state = viewer.get_state()
        if state.recordings and not state.loading:
            return
        time.sleep(0.2)
    raise PlacingError(f"the viewer has opened nothing in {SECONDS_TO_OPEN} s")


if __name__ == "__main__":
    run(main)
