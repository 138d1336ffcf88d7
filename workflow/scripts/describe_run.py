"""Write down what was run: configuration, versions, machine, time and memory."""

import csv
import json
import os
import platform
import re
import subprocess
import tomllib
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from command import run
from placing.artifacts.formats import write_json


def main(config: str, benchmarks: Path, described: Path) -> None:
    """Write the record of a run.

    Args:
        config: Merged configuration, as JSON.
        benchmarks: Directory with a table of time and memory for each job.
        described: Record to write.
    """
    record = {
        "config": json.loads(config),
        "source": source(),
        "packages": packages(),
        "machine": machine(),
        "rules": rules(benchmarks),
    }
    write_json(described, record)


def source() -> dict[str, str | bool | None]:
    """Return the commit of this checkout and whether files differ from it."""
    commit, changes = git("rev-parse", "HEAD"), git("status", "--porcelain")
    return {"commit": commit, "is_changed": None if changes is None else changes != ""}


def git(*words: str) -> str | None:
    """Return what git says about this folder; None where there is none to ask."""
    try:
        done = subprocess.run(("git", *words), capture_output=True, text=True)
    except FileNotFoundError:
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def packages() -> dict[str, str]:
    """Return the version of Python and of every direct dependency that is installed."""
    project = tomllib.loads(Path("pyproject.toml").read_text())["project"]
    versions = {"python": platform.python_version()}
    for requirement in project["dependencies"]:
        name = re.split(r"[^A-Za-z0-9_.-]", requirement)[0]
        try:
            versions[name] = version(name)
        except PackageNotFoundError:  # it is for another kind of machine
            continue
    return versions


def machine() -> dict[str, str | int]:
    """Return processor, cores, memory [MB] and system."""
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return {
        "processor": processor(),
        "cores": len(os.sched_getaffinity(0)),
        "memory_mb": memory // 2**20,
        "system": platform.platform(),
        "libc": "".join(platform.libc_ver()),
    }


def processor() -> str:
    """Return the name of the processor."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    names = [line.partition(":")[2] for line in lines if line.startswith("model name")]
    return names[0].strip() if names else platform.machine()


def rules(benchmarks: Path) -> dict[str, dict[str, float]]:
    """Return number of jobs, their seconds and their peak memory for every rule."""
    found: dict[str, list[tuple[float, float]]] = {}
    for path in sorted(benchmarks.rglob("*.tsv")):
        rule = path.relative_to(benchmarks).parts[0].removesuffix(".tsv")
        with path.open(newline="") as file:
            row = next(csv.DictReader(file, delimiter="\t"))
        # A job too short to be looked at has no memory in its table.
        peak = 0.0 if row["max_rss"] in ("-", "NA") else float(row["max_rss"])
        found.setdefault(rule, []).append((float(row["s"]), peak))
    return {
        rule: {
            "jobs": len(jobs),
            "seconds": round(sum(seconds for seconds, _ in jobs), 1),
            "max_rss_mb": max(peak for _, peak in jobs),
        }
        for rule, jobs in found.items()
    }


if __name__ == "__main__":
    run(main)
