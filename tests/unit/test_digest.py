"""A stage runs again when a module changes that it imports: all of them are found."""

import ast
import functools
import hashlib
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MODULES = sorted((ROOT / "src").rglob("*.py"))
SCRIPTS = sorted((ROOT / "workflow" / "scripts").glob("*.py"))


@pytest.fixture
def rules(monkeypatch):
    """What common.smk says of digests, which is plain Python."""
    monkeypatch.chdir(ROOT)
    text = Path("workflow/rules/common.smk").read_text()
    names = {"functools": functools, "hashlib": hashlib, "re": re, "Path": Path}
    exec(text[text.index("@functools.cache\ndef digest") :], names)
    return names


def imported(path):
    """Return the modules of this project in the syntax tree of a file."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
    found = set()
    for part in (name.split(".") for name in names):
        for n in range(1, len(part) + 1):
            for folder in ("src", "workflow/scripts"):
                stem = Path(folder, *part[:n])
                found |= {stem.with_suffix(".py"), stem / "__init__.py"}
    return {str(file) for file in found if (ROOT / file).exists()}


def test_lines_tell_the_imports_of_the_syntax_tree(rules):
    for path in [*MODULES, *SCRIPTS]:
        found = rules["imports"](str(path.relative_to(ROOT)))
        assert set(found) == imported(path), path


def test_a_changed_digest_needs_a_changed_module(rules):
    digests = {path.stem: rules["digest"](path.stem) for path in SCRIPTS}
    assert digests["plan_placing"] == rules["digest"].__wrapped__("plan_placing")
    assert len(set(digests.values())) == len(SCRIPTS)
