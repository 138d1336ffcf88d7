"""Sheets that people write: CSV files whose every row is checked against a schema."""

import csv
from pathlib import Path
from typing import Any

from placing import schema
from placing.errors import BadInput

Row = dict[str, Any]


def read_sheet(
    path: Path, row_schema: dict[str, Any], key: tuple[str, ...]
) -> list[Row]:
    """Return the rows of a sheet, whose `key` columns together differ in every row.

    The columns and their types are those of `row_schema`, a JSON Schema of one row.
    """
    properties = row_schema["properties"]
    rows, seen = [], {}
    for line, cells in read_lines(path, list(properties)):
        where = f"{path}: line {line}"
        row = {name: _value(cells[name], properties[name]) for name in properties}
        schema.check(row, row_schema, where)
        name = " ".join(str(row[column]) for column in key)
        if name in seen:
            raise BadInput(
                f"{where}: {' '.join(key)}: value {name!r} is that of line {seen[name]}"
                " too; expected each once"
            )
        seen[name] = line
        rows.append(row)
    if not rows:
        raise BadInput(f"{path}: no rows; expected at least one")
    return rows


def read_lines(path: Path, columns: list[str]) -> list[tuple[int, dict[str, str]]]:
    """Return the rows below the header with the number of their line in the file."""
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            reader = csv.reader(file)
            lines = [(reader.line_num, cells) for cells in reader if cells]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise BadInput(f"{path}: {error}; expected a CSV file in UTF-8") from error
    header = lines[0][1] if lines else []
    if header != columns:
        raise BadInput(
            f"{path}: line 1: header {','.join(header)[:200]!r};"
            f" expected {','.join(columns)}"
        )
    for line, cells in lines[1:]:
        if len(cells) != len(columns):
            raise BadInput(
                f"{path}: line {line}: {len(cells)} cells; expected {len(columns)}"
            )
    return [(line, dict(zip(columns, cells, strict=True))) for line, cells in lines[1:]]


def _value(text: str, column_schema: dict[str, Any]) -> object:
    """Return a cell in the type of its column, or as it is where that fails."""
    convert = {"integer": int, "number": float}.get(column_schema.get("type", ""))
    try:
        return convert(text) if convert else text
    except ValueError:
        return text
