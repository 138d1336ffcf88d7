"""A sheet is read row by row, and a mistake in it is found with its line."""

import pytest

from placing.errors import BadInput
from placing.sheets import read_sheet

SCHEMA = {
    "type": "object",
    "required": ["scene", "fold"],
    "properties": {
        "scene": {"type": "string", "pattern": "^[a-z0-9]+$"},
        "fold": {"type": "integer", "minimum": 0},
        "width_m": {"type": "number"},
    },
}
HEADER = "scene,fold,width_m\n"


@pytest.fixture
def sheet(tmp_path):
    """Return the function that writes a sheet and reads it."""
    path = tmp_path / "scenes.csv"

    def read(text):
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return read_sheet(path, SCHEMA, ("scene",))

    return read


def test_cells_have_the_type_of_their_column(sheet):
    rows = sheet(HEADER + "office1,0,2.5\n\noffice2,3,1\n")
    assert rows == [
        {"scene": "office1", "fold": 0, "width_m": 2.5},
        {"scene": "office2", "fold": 3, "width_m": 1.0},
    ]


def test_what_spreadsheets_write_is_read(sheet):
    rows = sheet(b"\xef\xbb\xbf" + (HEADER + "office1,0,2.5\n").encode())
    assert rows[0]["scene"] == "office1"
    assert sheet((HEADER + "office1,0,2.5\n").replace("\n", "\r\n")) == rows


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "line 1: header ''; expected scene,fold,width_m"),
        ("scene,flod,width_m\n", "line 1: header 'scene,flod,width_m'; expected"),
        (HEADER, "no rows; expected at least one"),
        (HEADER + "a,0,1\nb,one,1\n", "line 3: fold: value 'one'; expected integer"),
        (HEADER + "a,1.5,1\n", "line 2: fold: value '1.5'; expected integer"),
        (HEADER + "../a,1,1\n", "line 2: scene: value '../a'; expected string that"),
        (HEADER + "a,1,nan\n", "line 2: width_m: value nan; expected a finite number"),
        (HEADER + "a,1\n", "line 2: 2 cells; expected 3"),
        (
            HEADER + "a,1,1\nb,1,1\na,2,1\n",
            "line 4: scene: value 'a' is that of line 2",
        ),
        (b"\xff\xfe\x00", "expected a CSV file in UTF-8"),
    ],
)
def test_a_mistake_is_named_with_its_line(sheet, text, said):
    with pytest.raises(BadInput) as caught:
        sheet(text)
    assert said in str(caught.value)
    assert "scenes.csv: " in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_missing_sheet_is_named(tmp_path):
    with pytest.raises(BadInput, match=r"none\.csv"):
        read_sheet(tmp_path / "none.csv", SCHEMA, ("scene",))
