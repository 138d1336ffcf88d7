"""Checks of what people write (configuration, sheets, rooms) against a JSON Schema.

The complaint is one line for one mistake: the file, the field, its value and what was
expected there, in words rather than in the keywords of JSON Schema.
"""

import math
from collections.abc import Iterable, Iterator
from typing import Any

from jsonschema import Draft202012Validator, ValidationError
from jsonschema.exceptions import best_match
from jsonschema.validators import extend

from placing.errors import BadInput

BOUNDS = {
    "minimum": "at least {}",
    "exclusiveMinimum": "more than {}",
    "maximum": "at most {}",
    "exclusiveMaximum": "less than {}",
    "minItems": "with at least {} items",
    "maxItems": "with at most {} items",
    "minLength": "with at least {} characters",
    "maxLength": "with at most {} characters",
    "pattern": "that matches {}",
    "uniqueItems": "without repetition",
}
"""How the limits of a schema read in a sentence."""

NAMES = ("id", "labeller")
"""Keys whose value names an item of a list better than its number does."""

# JSON Schema takes 5.0 for an integer, and the commands that get the value do not.
Validator = extend(
    Draft202012Validator,
    type_checker=Draft202012Validator.TYPE_CHECKER.redefine(
        "integer", lambda _, value: type(value) is int
    ),
)


def check(document: object, schema: dict[str, Any], file: str) -> None:
    """Raise `BadInput` for the first value of `document` that breaks `schema`."""
    for field, value in _numbers(document, ""):
        if not math.isfinite(value):
            raise BadInput(f"{file}: {field}: value {value}; expected a finite number")
    error = best_match(Validator(schema).iter_errors(document))
    if error is not None:
        field = _field(document, error.absolute_path)
        raise BadInput(f"{file}: {field and f'{field}: '}{_complaint(error)}")


def _numbers(document: object, field: str) -> Iterator[tuple[str, float]]:
    """Yield every floating-point number of a document with the name of its field."""
    if isinstance(document, dict):
        for key, value in document.items():
            yield from _numbers(value, f"{field}.{key}".removeprefix("."))
    elif isinstance(document, list):
        for i, value in enumerate(document):
            yield from _numbers(value, f"{field}[{i}]")
    elif isinstance(document, float):
        yield field, document


def _field(document: Any, keys: Iterable[str | int]) -> str:  # noqa: ANN401
    """Return a field as `furniture[desk1].size_m[0]`, the document itself as ``."""
    field = ""
    for key in keys:
        document = document[key]
        field += f"[{_name(document, key)}]" if isinstance(key, int) else f".{key}"
    return field.removeprefix(".")


def _name(item: object, number: int) -> str:
    """Return what an item of a list calls itself if that can be printed."""
    values = [item.get(name) for name in NAMES] if isinstance(item, dict) else []
    names = [v for v in values if isinstance(v, str) and v.isprintable()]
    return names[0][:60] if names else str(number)


def _complaint(error: ValidationError) -> str:
    """Return value and expectation of one mistake."""
    schema = error.schema if isinstance(error.schema, dict) else {}
    keys = list(error.instance) if isinstance(error.instance, dict) else []
    if error.validator == "required":
        missing = [key for key in schema["required"] if key not in keys]
        return f"key {missing[0]!r} is missing; expected {_one_of(schema)}"
    if error.validator == "additionalProperties":
        extra = [key for key in keys if key not in schema["properties"]]
        return f"unknown key {_short(extra[0])}; expected {_one_of(schema)}"
    return f"value {_short(error.instance)}; expected {_expected(schema)}"


def _one_of(schema: dict[str, Any]) -> str:
    """Return the keys that a mapping may have."""
    keys = sorted(map(str, schema.get("properties", {})))
    return f"the keys {', '.join(keys)}" if keys else "no keys"


def _expected(schema: dict[str, Any]) -> str:
    """Return what a schema asks of a value, as part of a sentence."""
    if "const" in schema:
        return _short(schema["const"])
    if "enum" in schema:
        return f"one of {', '.join(map(str, schema['enum']))}"
    options = schema.get("anyOf", schema.get("oneOf"))
    if options:
        return " or ".join(map(_expected, options))
    types = schema.get("type", "value")
    words = [types if isinstance(types, str) else " or ".join(types)]
    words += [text.format(schema[key]) for key, text in BOUNDS.items() if key in schema]
    return " ".join(words)


def _short(value: object) -> str:
    """Return a value on one line of bounded length."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
