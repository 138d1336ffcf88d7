"""Configuration, its schema, its README and the settings of the stages agree."""

import dataclasses
import importlib.util
import inspect
import sys
import typing
from pathlib import Path

import pytest
import yaml

from placing.schema import check

ROOT = Path(__file__).parents[2]
SCRIPTS = ROOT / "workflow" / "scripts"
CONFIG = yaml.safe_load((ROOT / "config" / "config.yaml").read_text())
SCHEMA = yaml.safe_load((ROOT / "workflow/schemas/config.schema.yaml").read_text())


def settings_of_scripts():
    """Yield script, section and dataclass of every setting of a stage."""
    sys.path.insert(0, str(SCRIPTS))
    for path in sorted(SCRIPTS.glob("*.py")):
        if path.stem == "command":
            continue
        spec = importlib.util.spec_from_file_location(path.stem, path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        hints = typing.get_type_hints(module.main)
        parameters = inspect.signature(module.main).parameters
        # A setting with a default is no number of the study and is not configured.
        needed = {n for n, p in parameters.items() if p.default is p.empty}
        yield from sections_of(path.stem, {n: hints[n] for n in needed})


def sections_of(script, hints):
    """Yield the dataclasses among `hints`, and those they only bundle."""
    for name, hint in sorted(hints.items()):
        if not dataclasses.is_dataclass(hint):
            continue
        fields = typing.get_type_hints(hint)
        if all(dataclasses.is_dataclass(field) for field in fields.values()):
            yield from sections_of(script, fields)
        else:
            yield script, name, set(fields)


def test_the_configuration_matches_its_schema():
    check(CONFIG, SCHEMA, "config.yaml")


def test_every_section_is_closed_and_complete():
    for name, section in SCHEMA["properties"].items():
        if section["type"] == "object":
            assert section["additionalProperties"] is False, name
            assert sorted(section["required"]) == sorted(section["properties"]), name
    assert sorted(SCHEMA["required"]) == sorted(SCHEMA["properties"])


def test_sections_are_the_settings_of_the_stages():
    found = list(settings_of_scripts())
    assert len(found) > 5
    for script, section, fields in found:
        assert fields == set(CONFIG[section]), f"{section} of {script}"
        assert fields == set(SCHEMA["properties"][section]["properties"]), section


@pytest.mark.parametrize(
    "section", [k for k, v in CONFIG.items() if isinstance(v, dict)]
)
def test_the_readme_explains_every_key(section):
    text = (ROOT / "config" / "README.md").read_text()
    assert f"`{section}`" in text
    for key in CONFIG[section]:
        assert f"`{key}`" in text, f"{section}.{key}"
