"""What every rules file needs: environment, sheet of scenes, flags, source files."""

import functools
import hashlib
import json
import os
import re
import sys
from pathlib import Path

import yaml

from placing import schema, sheets
from placing.errors import BadInput, PlacingError, unknown

# Jobs find the Python that runs Snakemake, and get the same numbers on every machine;
# `run` sets the same for commands that are typed.
os.environ.update(
    PATH=f"{Path(sys.executable).parent}{os.pathsep}{os.environ.get('PATH', '')}"
)
os.environ.setdefault("NUMBA_CPU_NAME", "generic")
os.environ.setdefault("NPY_DISABLE_CPU_FEATURES", "X86_V4 AVX512_ICL AVX512_SPR")
os.environ.setdefault("NUMBA_CACHE_DIR", str(Path(".cache/numba").absolute()))
os.environ.setdefault("PYTHONHASHSEED", "0")
os.environ.setdefault("MPLBACKEND", "Agg")
os.environ.setdefault("ARROW_DEFAULT_MEMORY_POOL", "system")
os.environ.setdefault("MALLOC_MMAP_THRESHOLD_", "4194304")
os.environ.setdefault("MALLOC_TRIM_THRESHOLD_", "33554432")

SCANS = "scans"
"""The data set that is arranged with what all folds of `rooms` teach."""
TASKS = ["filled", "empty"]
ANSWERING = ["candidates", "sampling", "diagnostics", "arranging"]
ANSWERING += ["decision", "baselines"]


def schema_of(name):
    """Return the JSON Schema called `name`."""
    return yaml.safe_load(Path(f"workflow/schemas/{name}.schema.yaml").read_text())


def check_config():
    """Raise `BadInput` for a value of the configuration that no stage can use."""
    files = " + ".join(os.path.relpath(file) for file in reversed(workflow.configfiles))
    schema.check(config, schema_of("config"), files)


def checked_scenes():
    """Return the rows of the sheet of scenes."""
    sheet = Path("config/scenes.csv")
    rows = sheets.read_sheet(sheet, schema_of("scenes"), key=("dataset", "scene"))
    known, scanned = (
        sorted(path.stem for path in Path(f"resources/{folder}").glob("*.yaml"))
        for folder in ("rooms", SCANS)
    )
    for row in rows:
        folds = {other["fold"] for other in rows if other["dataset"] == row["dataset"]}
        if len(folds) < 2 and row["dataset"] != SCANS:
            raise BadInput(
                f"{sheet}: fold: value {row['fold']} in every row of data set"
                f" {row['dataset']!r}; expected at least two folds"
            )
        if row["dataset"] == "rooms" and row["scene"] not in known:
            raise unknown(f"scene in {sheet}:", row["scene"], known)
        if row["dataset"] == SCANS and row["scene"] not in scanned:
            raise unknown(f"scene in {sheet}:", row["scene"], scanned)
        if row["dataset"] == SCANS and "rooms" not in {r["dataset"] for r in rows}:
            raise BadInput(
                f"{sheet}: dataset: value 'scans'; expected rooms too, to learn from"
            )
    return rows


try:
    check_config()
    SCENES = checked_scenes()
except PlacingError as error:
    sys.exit(f"Error: {error}")

DATASETS = sorted({row["dataset"] for row in SCENES})
SCENARIOS = "scenarios"
"""The data set of Section 4.3: in no fold, and in no table but its own."""
STUDIED = [dataset for dataset in DATASETS if dataset != SCANS]
"""The data sets of figure 6, which learn from their own other folds."""
FOLDS = {
    dataset: sorted({row["fold"] for row in SCENES if row["dataset"] == dataset})
    for dataset in DATASETS
}
FOLDS[SCENARIOS] = [0]
ROOM_SCENES = [row["scene"] for row in SCENES if row["dataset"] == "rooms"]
SCAN_SCENES = [row["scene"] for row in SCENES if row["dataset"] == SCANS]
SCAN_FILES = [f"resources/scans/{scene}.yaml" for scene in SCAN_SCENES]
ROOMS = sorted(path.stem for path in Path("resources/rooms").glob("*.yaml"))
SCENARIO_SCENES = [
    path.stem
    for path in sorted(Path(f"resources/{SCENARIOS}").glob("*.yaml"))
    if sorted(ROOM_SCENES) == ROOMS
]
"""Scenarios, which are arranged with what all rooms teach and not with what some do."""
DESK = {"scene": "office2", "furniture": "desk1"}
"""The desk of figure 7 of the paper: the large one among the scans."""
OFFICE = next(
    (r for r in SCENES if (r["dataset"], r["kind"]) == ("rooms", "office")),
    {"scene": "none", "fold": 0},
)
"""The room of the figures 4 and 5 of the paper: the first office of the sheet."""


wildcard_constraints:
    dataset="|".join([*DATASETS, SCENARIOS]),
    fold="|".join(sorted({str(row["fold"]) for row in SCENES})),
    task="|".join(TASKS),
    held_out=r"all|fold\d+(_fold\d+)?",


def scenes_of(wildcards):
    """Return the scenes of a data set, of one fold where the job has a fold."""
    if wildcards.dataset == SCENARIOS:
        return SCENARIO_SCENES
    fold = getattr(wildcards, "fold", None)
    return [
        row["scene"]
        for row in SCENES
        if row["dataset"] == wildcards.dataset and fold in (None, str(row["fold"]))
    ]


def robot_scenes(wildcards):
    """Return the scenes in which the robot works, of one fold where the job has one.

    Of every kind of scene and fold the first by name, then the second, until there
    are enough.
    """
    turns = {}
    rows = [row for row in SCENES if row["dataset"] == wildcards.dataset]
    for row in sorted(rows, key=lambda row: row["scene"]):
        turns.setdefault((row["kind"], row["fold"]), []).append(row)
    queue = [
        (turn, *key, row["scene"], row["fold"])
        for key, of_key in turns.items()
        for turn, row in enumerate(of_key)
    ]
    first = sorted(queue)[: config["robot_scenes"]["n_most"]]
    asked = getattr(wildcards, "fold", None)
    return sorted(name for *_, name, fold in first if asked in (None, str(fold)))


def room_files(wildcards):
    """Return the room files that a job reads; designers' rooms have none."""
    if wildcards.dataset == "thor":
        return []
    folder = f"resources/{wildcards.dataset}"
    return [f"{folder}/{scene}.yaml" for scene in scenes_of(wildcards)]


def every(path, dataset):
    """Return `path` for every task and fold of a data set."""
    return sorted(
        set(expand(path, dataset=dataset, fold=FOLDS.get(dataset, []), task=TASKS))
    )


def checks_of(wildcards):
    """Return the tables of checks of a data set."""
    names = {"rooms": ["areas", "arrangements"], "thor": ["areas", "support"]}
    names = {dataset: [*some, "certificates"] for dataset, some in names.items()}
    folder = f"results/{wildcards.dataset}/checks"
    return [f"{folder}/{name}.csv" for name in names[wildcards.dataset]]


def leaves():
    """Return what the study is for: all that no other stage needs."""
    paths = [
        "fold{fold}.csv",
        "tables/figure6.md",
        "tables/claims.md",
        "tables/diagnostics.md",
        "tables/coverage.md",
        "tables/table1.md",
        "figures/figure6_{task}.png",
        "figures/coverage.png",
        "recordings/fold{fold}/{task}/dp",
        "recordings/fold{fold}/plans",
        "checks/passed.txt",
    ]
    found = [
        file
        for dataset in STUDIED
        for path in paths
        for file in every(f"results/{{dataset}}/{path}", dataset)
    ]
    if ROOM_SCENES:
        names = ["objects", "rooms", "arrangements"]
        found += [f"results/rooms/pictures/{name}.png" for name in names]
        found.append("results/rooms/tables/sensitivity.md")
        found.append("results/rooms/tables/semantics.csv")
    if OFFICE["scene"] in ROOM_SCENES:
        found += [f"results/rooms/figures/figure{n}.png" for n in (4, 5)]
    if SCENARIO_SCENES:
        found += [f"results/{SCENARIOS}/{name}" for name in LEAVES_OF_SCENARIOS]
    return found + leaves_of_scans() if SCAN_SCENES else found


LEAVES_OF_SCENARIOS = ["tables/execution.csv", "checks/certificates.csv"]
LEAVES_OF_SCENARIOS += ["pictures/rooms.png", "recordings"]
LEAVES_OF_SCENARIOS += [f"pictures/{scene}.png" for scene in SCENARIO_SCENES]


def leaves_of_scans():
    """Return what the point-cloud scenes are for."""
    names = ["tables/table2.md", "checks/joint.csv", "checks/areas.csv"]
    names += ["checks/arrangements.csv", "recordings/fold0"]
    names += [f"pictures/{name}.png" for name in ("rooms", "arrangements")]
    names += ["figures/figure7.png"] if DESK["scene"] in SCAN_SCENES else []
    return [f"results/scans/{name}" for name in names]


def of_every_fold(path):
    """Return the input function that gives `path` in every fold and task."""
    return lambda wildcards: every(path, wildcards.dataset)


def of_tasks(path):
    """Return `path` for every task, other wildcards kept."""
    return expand(path, task=TASKS, allow_missing=True)


def of_office(path):
    """Return `path` in the fold of the office of the figures."""
    return path.format(fold=OFFICE["fold"])


def of_other_folds(path):
    """Return the input function that gives `path` in the folds one learns from."""
    return lambda wildcards: [
        path.format(dataset=wildcards.dataset, fold=fold)
        for fold in FOLDS[wildcards.dataset]
        if str(fold) != wildcards.fold
    ]


def of_folds_left(path):
    """Return the input function that gives `path` in the folds not held out.

    `all` holds out none.
    """
    return lambda wildcards: [
        path.format(dataset=wildcards.dataset, fold=fold)
        for fold in FOLDS[wildcards.dataset]
        if f"fold{fold}" not in wildcards.held_out.split("_")
    ]


def of_pairs(path):
    """Return the input function that gives `path` without a fold and one more each."""
    return lambda wildcards: [
        path.format(dataset=wildcards.dataset, held_out=pair_of(wildcards, fold))
        for fold in FOLDS[wildcards.dataset]
        if str(fold) != wildcards.fold
    ]


def folder_of_scenarios(wildcards):
    """Return the folder of the room files of the scenarios."""
    return f"resources/{SCENARIOS}"


def films_of_scenarios(wildcards):
    """Return the folder of what was seen when the scenarios were carried out."""
    return f"results/{SCENARIOS}/executions"


def folder_of(wildcards):
    """Return the folder of the room files of a data set."""
    own = wildcards.dataset in (SCANS, SCENARIOS)
    return f"resources/{wildcards.dataset if own else 'rooms'}"


def catalogue_of(wildcards):
    """Return the table of objects of a data set."""
    name = "scenario_objects" if wildcards.dataset == SCENARIOS else "objects"
    return f"config/{name}.csv"


def taught(path):
    """Return the input function that gives what teaches the scenes of a job."""
    return lambda wildcards: path.format(
        held_out="all" if wildcards.dataset == SCANS else f"fold{wildcards.fold}"
    )


def tuned(wildcards):
    """Return what training scenes chose, by fold that they were chosen without."""
    own = [wildcards.fold] if wildcards.dataset != SCANS else FOLDS["rooms"]
    return [f"results/rooms/tuning/fold{fold}.json" for fold in own]


def pair_of(wildcards, other):
    """Return the name of two held-out folds.

    Of two folds nothing is left to learn from without both: what chooses K and omega
    is then what was learned from.
    """
    if len(FOLDS[wildcards.dataset]) < 3:
        return f"fold{wildcards.fold}"
    return "_".join(f"fold{f}" for f in sorted({int(wildcards.fold), int(other)}))


def flags(*sections, within=""):
    """Return config sections as the `--section.key value` words of a script."""
    return [
        word
        for section in sections
        for word in words_of(f"{within}{section}", config[section])
    ]


def words_of(name, value):
    """Yield the words that give `value` to the flag called `name`."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from words_of(f"{name}.{key.replace('_', '-')}", item)
    elif isinstance(value, bool):
        parent, _, key = name.rpartition(".")
        yield f"--{name}" if value else f"--{parent}.no-{key}"
    else:
        yield f"--{name}"
        yield from flat(value)


def flat(value):
    """Yield the numbers and words of a value that may be a list of lists."""
    for item in value if isinstance(value, list) else [value]:
        if isinstance(item, list):
            yield from flat(item)
        else:
            yield item


@functools.cache
def digest(script):
    """Return a digest of a script and of every module of this project it imports.

    As a parameter of a rule it makes the jobs of that rule run again when the content
    of their code has changed, and only then.
    """
    found, todo = set(), [f"workflow/scripts/{script}.py"]
    while todo:
        path = todo.pop()
        if path not in found:
            found.add(path)
            todo += imports(path)
    contents = hashlib.sha256()
    for path in sorted(found):
        contents.update(Path(path).read_bytes())
    return contents.hexdigest()[:16]


@functools.cache
def modules_here():
    """Return the files of this project by the names of their modules."""
    files = {}
    for folder in ("src", "workflow/scripts"):
        for path in Path(folder).rglob("*.py"):
            parts = path.relative_to(folder).with_suffix("").parts
            name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
            files.setdefault(name, []).append(str(path))
    return files


IMPORT = re.compile(
    r"^[ \t]*(?:from[ \t]+([\w.]+)[ \t]+import[ \t]+(\([^)]*\)|[^\n]+)"
    r"|import[ \t]+([^\n]+))",
    re.MULTILINE,
)
"""Lines that import; to parse all modules takes as long as all else that is done."""


@functools.cache
def imports(path):
    """Return the modules of this project that a file imports, also inside functions."""
    names = set()
    for module, some, plain in IMPORT.findall(Path(path).read_text()):
        words = [word.split()[:1] for word in (some or plain).strip("()").split(",")]
        start = f"{module}." if module else ""
        names |= {f"{start}{first[0]}" for first in words if first}
    # Importing `a.b.c` runs `a` and `a.b` first; a name may be a module or in one.
    parts = [name.split(".") for name in names]
    modules = {".".join(part[:n]) for part in parts for n in range(1, len(part) + 1)}
    return [file for name in modules for file in modules_here().get(name, [])]
