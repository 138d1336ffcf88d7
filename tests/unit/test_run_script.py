"""`./run` makes the environment once, whole or not at all, then stays out of the way.

A uv that only pretends takes the place of the real one.
"""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FAKE_UV = f"""#!/bin/sh
echo "$1 $2" >>"$LOG"
case $1 in
venv)
    for folder; do :; done
    mkdir -p "$folder/bin"
    printf '#!/bin/sh\\nexec {sys.executable} "$@"\\n' >"$folder/bin/python"
    chmod +x "$folder/bin/python"
    ;;
pip)
    touch "$LOG.started"
    sleep "${{UV_SECONDS-0}}"
    exit "${{UV_FAILS-0}}"
    ;;
esac
"""


@pytest.fixture
def project(tmp_path):
    """A folder with a space in its name that holds `run` and what it reads."""
    folder = tmp_path / "a clone"
    folder.mkdir()
    for name in ("run", "pyproject.toml", "requirements.lock"):
        shutil.copy(ROOT / name, folder / name)
    (tmp_path / "bin").mkdir()
    uv = tmp_path / "bin" / "uv"
    uv.write_text(FAKE_UV)
    uv.chmod(0o755)
    return folder


def start(project, *words, **environment):
    """Start `./run` with the pretended uv."""
    tools = project.parent / "bin"
    path = f"{tools}:{Path(sys.executable).parent}:/usr/bin:/bin"
    return subprocess.Popen(
        ["./run", *words],
        cwd=project,
        env={"PATH": path, "LOG": str(tools / "log"), **environment},
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
        # A suite that runs in the background may have been told to ignore Ctrl-C.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )


def run(project, *words, **environment):
    """Return code, stdout and stderr of `./run`."""
    process = start(project, *words, **environment)
    out, err = process.communicate(timeout=240)
    return process.returncode, out, err


def calls(project):
    """Return what uv was called with."""
    log = project.parent / "bin" / "log"
    return log.read_text().splitlines() if log.exists() else []


def installs(project):
    """Return how often uv was asked to install the packages."""
    return calls(project).count("pip sync")


def test_alone_it_explains_itself_and_installs_nothing(project):
    code, out, err = run(project)
    assert (code, err) == (0, "")
    assert "./run snakemake -j2" in out
    assert str(project / ".venv") in out
    assert calls(project) == []
    assert not (project / ".venv").exists()


def test_the_command_keeps_its_words_output_and_code(project):
    code, out, _ = run(
        project, "sh", "-c", 'printf "%s|" "$@"; exit 7', "sh", "a b", "*"
    )
    assert (code, out) == (7, "a b|*|")


def test_the_command_finds_the_environment_first_on_its_path(project):
    out = run(project, "sh", "-c", 'echo "$PATH" "$NUMBA_CPU_NAME" "$MPLBACKEND"')[1]
    assert out.startswith(f"{project}/.venv/bin:")
    assert out.endswith(" generic Agg\n")


def test_what_the_caller_has_set_is_kept(project):
    assert (
        run(project, "sh", "-c", "echo $MPLBACKEND", MPLBACKEND="TkAgg")[1] == "TkAgg\n"
    )


def test_the_second_call_starts_at_once(project):
    run(project, "true")
    seen = len(calls(project))
    begin = time.perf_counter()
    assert run(project, "true") == (0, "", "")
    assert time.perf_counter() - begin < 1  # 0.02 s where nothing else runs
    assert len(calls(project)) == seen


@pytest.mark.parametrize("change", ["requirements.lock", "move", "broken"])
def test_a_stale_environment_is_made_anew(project, change):
    run(project, "true")
    if change == "move":
        project = project.rename(project.with_name("moved"))
    elif change == "broken":
        (project / ".venv" / "bin" / "python").unlink()
    else:
        with (project / change).open("a") as file:
            file.write("# newer\n")
    assert run(project, "true")[0] == 0
    assert installs(project) == 2


def test_settings_of_checkers_do_not_make_it_stale(project):
    run(project, "true")
    with (project / "pyproject.toml").open("a") as file:
        file.write("# newer\n")
    run(project, "true")
    assert installs(project) == 1


def test_a_failed_installation_leaves_nothing_and_runs_nothing(project):
    code, out, _ = run(project, "echo", "ran", UV_FAILS="3")
    assert (code, out) == (3, "")
    assert not (project / ".venv").exists()
    assert not (project / ".cache" / "venv.new").exists()


def test_a_failed_update_keeps_the_environment_there_was(project):
    run(project, "true")
    with (project / "requirements.lock").open("a") as file:
        file.write("# newer\n")
    assert run(project, "true", UV_FAILS="1")[0] == 1
    assert (project / ".venv" / "bin" / "python").exists()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_an_interrupted_installation_is_begun_again(project, number):
    process = start(project, "true", UV_SECONDS="30")
    while not (project.parent / "bin" / "log.started").exists():
        time.sleep(0.01)
    os.killpg(process.pid, number)
    process.communicate(timeout=240)
    assert process.returncode != 0
    assert not (project / ".venv").exists()
    assert run(project, "echo", "ran")[:2] == (0, "ran\n")


def test_two_at_once_make_one_environment(project):
    both = [start(project, "echo", "ran", UV_SECONDS="0.5") for _ in range(2)]
    ended = [process.communicate(timeout=240) for process in both]
    assert [out for out, _ in ended] == ["ran\n", "ran\n"]
    assert installs(project) == 1
    assert any("waiting for another ./run" in err for _, err in ended)
