"""A mistake in what people write is one line with file, field, value, expectation."""

import math

import pytest

from placing.errors import BadInput
from placing.schema import check

SCHEMA = {
    "type": "object",
    "additionalProperties": False,
    "required": ["seed"],
    "properties": {
        "seed": {"type": "integer", "minimum": 0},
        "kind": {"enum": ["office", "kitchen"]},
        "crop_m": {
            "type": ["array", "null"],
            "items": {"type": "number"},
            "minItems": 2,
        },
        "dpmm": {
            "type": "object",
            "additionalProperties": False,
            "properties": {"alpha": {"$ref": "#/$defs/positive"}},
        },
        "people": {
            "type": "array",
            "items": {
                "type": "object",
                "properties": {"height_m": {"type": "number"}},
            },
        },
        "either": {"anyOf": [{"type": "integer"}, {"const": "auto"}]},
    },
    "$defs": {"positive": {"type": "number", "exclusiveMinimum": 0}},
}


def complaint(document):
    """Return what `check` says about a document."""
    with pytest.raises(BadInput) as caught:
        check(document, SCHEMA, "config.yaml")
    return str(caught.value)


def test_a_document_that_matches_passes():
    document = {"seed": 0, "kind": "office", "crop_m": None, "dpmm": {"alpha": 1}}
    check(document, SCHEMA, "config.yaml")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"seed": -1}, "seed: value -1; expected integer at least 0"),
        ({"seed": "7"}, "seed: value '7'; expected integer at least 0"),
        ({"seed": True}, "seed: value True; expected integer at least 0"),
        ({"seed": 5.0}, "seed: value 5.0; expected integer at least 0"),
        ({"kind": "garden"}, "kind: value 'garden'; expected one of office, kitchen"),
        ({"dpmm": {"alpha": 0}}, "dpmm.alpha: value 0; expected number more than 0"),
        (
            {"dpmm": {"alhpa": 1}},
            "dpmm: unknown key 'alhpa'; expected the keys alpha",
        ),
        ({"crop_m": [1, "x"]}, "crop_m[1]: value 'x'; expected number"),
        (
            {"crop_m": [1]},
            "crop_m: value [1]; expected array or null with at least 2 items",
        ),
        ({"either": "any"}, "either: value 'any'; expected integer or 'auto'"),
        ({"sedd": 1}, "unknown key 'sedd'; expected the keys"),
    ],
)
def test_a_mistake_is_named(changes, said):
    assert complaint({"seed": 1} | changes).startswith(f"config.yaml: {said}")


@pytest.mark.parametrize(
    ("person", "name"),
    [
        ({"id": "ada"}, "ada"),
        ({"labeller": "bob"}, "bob"),
        ({"id": 7}, "0"),
        ({"id": "a\nb"}, "0"),
        ({}, "0"),
    ],
)
def test_an_item_of_a_list_is_called_by_its_name_if_it_has_one(person, name):
    said = complaint({"seed": 1, "people": [person | {"height_m": "tall"}]})
    expected = "value 'tall'; expected number"
    assert said == f"config.yaml: people[{name}].height_m: {expected}"


def test_a_missing_key_is_named():
    assert complaint({}).startswith("config.yaml: key 'seed' is missing; expected")


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_numbers_that_are_not_finite_are_refused_wherever_they_are(value):
    said = complaint({"seed": 1, "crop_m": [0.0, value]})
    assert said == f"config.yaml: crop_m[1]: value {value}; expected a finite number"


@pytest.mark.parametrize("changes", [{"kind": "a\n" * 1000}, {"a\n" * 1000: 1}])
def test_a_complaint_is_one_line_of_bounded_length(changes):
    said = complaint({"seed": 1} | changes)
    assert "\n" not in said
    assert len(said) < 200


def test_what_is_no_mapping_is_named_too():
    assert complaint(None) == "config.yaml: value None; expected object"
