"""The workflow as a newcomer meets it: a small study on a copy of the project."""

import hashlib
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
HERE = Path(__file__).parent
ACCEPTED = "Specify a conda environment or container for each rule."
PART = "results/rooms/tables/figure6.csv"
"""A target that takes the road from rooms to scores, in half the time of all."""
NOTHING = "Nothing to be done (all requested files are present and up to date)."
# Recordings hold random identifiers, pictures of text depend on nothing checked here,
# and times differ in every run.
NOT_COMPARED = {"recordings", "logs", "benchmarks", "run.json"}
SHARED = {
    "PYTHONPATH": str(ROOT / "src"),
    "NUMBA_CACHE_DIR": str(ROOT / ".cache" / "numba"),
}
"""A copy of the library would be compiled anew, which takes minutes."""
STUDY_S = 1500
"""A study that hangs is given up; on two busy cores it takes ten minutes."""


def copy_project(folder):
    """Copy what a newcomer clones, with the small study in place of the large one."""
    for name in ("workflow", "config", "src", "resources"):
        shutil.copytree(
            ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__")
        )
    for name in ("Snakefile", "pyproject.toml"):
        shutil.copy(ROOT / name, folder / name)
    shutil.copy(HERE / "scenes.csv", folder / "config" / "scenes.csv")
    shutil.copy(HERE / "config.yaml", folder / "small.yaml")
    return folder


def start(folder, *words, configs=("small.yaml",), **kwargs):
    """Start Snakemake in a project, whose library is compiled once for all tests."""
    command = [sys.executable, "-m", "snakemake", *words, "--configfile", *configs]
    return subprocess.Popen(
        command,
        cwd=folder,
        env=os.environ | SHARED,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        **kwargs,
    )


def snakemake(folder, *words, code=0, **kwargs):
    """Return what Snakemake says, after checking how it ended."""
    process = start(folder, *words, **kwargs)
    said, _ = process.communicate(timeout=STUDY_S)
    assert process.returncode == code, said[-5000:]
    return said


def artifacts(folder):
    """Return the checksum of every artifact that has to be the same in every run."""
    results = folder / "results"
    return {
        str(path.relative_to(results)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(results.rglob("*"))
        if path.is_file()
        and path.name != ".snakemake_timestamp"
        and not NOT_COMPARED & set(path.relative_to(results).parts)
    }


def planned(said):
    """Return the number of jobs of every rule in what a dry run says."""
    lines = iter(said.split("Job stats:")[1].splitlines()[3:])
    jobs = {}
    for line in lines:
        if not line.strip():
            break
        rule, count = line.split()
        jobs[rule] = int(count)
    return jobs


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A project whose study has been computed with two cores."""
    folder = copy_project(tmp_path_factory.mktemp("finished"))
    snakemake(folder, "-j2")
    return folder


@pytest.fixture
def project(tmp_path):
    """A project without any results."""
    return copy_project(tmp_path)


def test_the_linter_complains_about_containers_only(project):
    said = snakemake(project, "--lint", code=1)
    complaints = {
        line.strip() for line in said.splitlines() if line.startswith("    * ")
    }
    assert complaints == {f"* {ACCEPTED}:"}


def test_the_real_study_can_be_planned(project):
    shutil.copy(ROOT / "config" / "scenes.csv", project / "config" / "scenes.csv")
    jobs = planned(snakemake(project, "-n"))
    # Without each fold and each pair, in two data sets; with all of one for the scans.
    assert jobs["learn_theta"] == 2 * (5 + 10) + 1
    assert jobs["tune_methods"] == 10
    assert jobs["sample_arrangement"] == jobs["plan_placing"] == 10
    assert jobs["cut_bodies"] == jobs["tabulate_table1"] == 2
    assert jobs["tabulate_table2"] == jobs["record_joint"] == jobs["picture_desk"] == 1


def test_a_second_run_has_nothing_to_do(finished):
    assert NOTHING in snakemake(finished, "-j2")


def test_a_touched_module_is_not_a_changed_one(finished):
    (finished / "src" / "placing" / "rigid.py").touch()
    assert NOTHING in snakemake(finished, "-j2", "-n")


def test_an_edited_module_runs_the_stages_that_import_it(finished):
    module = finished / "src" / "placing" / "tables" / "scoring.py"
    text = module.read_text()
    module.write_text(f"{text}\nEDITED = True\n")
    try:
        jobs = planned(snakemake(finished, "-n"))
    finally:
        module.write_text(text)
    assert jobs["score_arrangement"] == 8
    assert "preprocess_cloud" not in jobs


def test_a_changed_number_runs_the_stages_of_its_section(finished):
    changed = finished / "changed.yaml"
    changed.write_text("sensitivity: {concentrations: [0.5]}\n")
    # The last of several configuration files wins.
    said = snakemake(finished, "-n", configs=("small.yaml", "changed.yaml"))
    jobs = planned(said)
    assert jobs["vary_settings"] == 2
    assert not {"preprocess_cloud", "learn_theta", "sample_arrangement"} & set(jobs)


def test_one_fold_can_run_again_alone(finished):
    target = "results/rooms/fold1.csv"
    theta = "results/rooms/theta/fold1"
    said = snakemake(finished, "-n", target, "--forcerun", theta)
    jobs = planned(said)
    assert (jobs.pop("learn_theta"), jobs.pop("total")) == (1, 6)
    assert "fold=0" not in said


@pytest.mark.slow
def test_a_run_killed_and_continued_on_one_core_gives_the_same(finished, project):
    process = start(project, "-j1", PART, start_new_session=True)
    waiting_until = time.monotonic() + 300
    while not list(project.glob("results/*/scenes/fold*/*.json")):
        assert process.poll() is None, "the run ended before it could be killed"
        assert time.monotonic() < waiting_until
        time.sleep(0.1)
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
    snakemake(project, "--unlock")
    snakemake(project, "-j1", PART, "--rerun-incomplete")
    assert artifacts(project)
    assert artifacts(project).items() <= artifacts(finished).items()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "sampling: {n_sweeps: 5}",
            "sampling: unknown key 'n_sweeps'; expected the keys",
        ),
        (
            "sampling: {n_samples: many}",
            "sampling.n_samples: value 'many'; expected int",
        ),
        (
            "sampling: {concentration: .nan}",
            "sampling.concentration: value nan; expected",
        ),
        ("seeed: 1", "unknown key 'seeed'; expected the keys"),
    ],
)
def test_a_mistake_in_the_configuration_is_one_line(project, text, said):
    (project / "small.yaml").write_text(text)
    lines = snakemake(project, "-n", code=1).strip().splitlines()
    assert f"small.yaml: {said}" in lines[-1]
    assert sum("Error" in line for line in lines) == 1


@pytest.mark.parametrize(
    ("row", "said"),
    [
        (
            "rooms,garden1,office,0",
            "unknown scene in config/scenes.csv: 'garden1'; known",
        ),
        (
            "rooms,office1,office,0",
            "scenes.csv: line 6: dataset scene: value 'rooms offi",
        ),
        (
            "moon,crater1,office,0",
            "line 6: dataset: value 'moon'; expected one of rooms",
        ),
        (
            "rooms,../office1,office,0",
            "line 6: scene: value '../office1'; expected string",
        ),
        (
            "rooms,office2,office,x",
            "line 6: fold: value 'x'; expected integer at least 0",
        ),
    ],
)
def test_a_mistake_in_the_sheet_of_scenes_is_one_line(project, row, said):
    with (project / "config" / "scenes.csv").open("a") as file:
        file.write(f"{row}\n")
    lines = snakemake(project, "-n", code=1).strip().splitlines()
    assert said in lines[-1]


def test_commands_run_outside_snakemake_give_the_same_bytes(finished):
    target = "results/rooms/scenes/fold0"
    said = snakemake(finished, "-n", "-p", target, "-R", "find_areas")
    command = said[said.index("python workflow/scripts/find_areas.py") :]
    command = command[: command.index("2>")].replace("\\\n", " ")
    folder = finished / "results" / "rooms" / "scenes" / "fold0"
    before = {path.name: path.read_bytes() for path in folder.glob("*.json")}
    again = command.replace(target, "again")
    environment = os.environ | SHARED
    environment["PATH"] = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    environment["NUMBA_CPU_NAME"] = "generic"
    subprocess.run(again, shell=True, cwd=finished, env=environment, check=True)
    after = {
        path.name: path.read_bytes() for path in (finished / "again").glob("*.json")
    }
    assert after == before != {}
