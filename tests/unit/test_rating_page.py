"""The page for raters is blind, needs no network, and saves what is read back."""

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from placing.methods.names import JOINT_NAMES
from placing.rating import close_ups, views
from placing.rating.answers import read_ratings
from placing.rating.blinding import Blinded
from placing.rating.page import entries_of, label_of, page_of
from placing.rooms.file import read_yaml
from placing.rooms.reader import layout_reader
from placing.scene import Placement

ROOT = Path(__file__).parents[2]
SCHEMAS = ROOT / "workflow" / "schemas"
TEMPLATE = (ROOT / "src" / "placing" / "rating" / "page.html").read_text()
BROWSER = shutil.which("chromium") or shutil.which("chromium-browser")
DOT = "data:image/gif;base64,R0lGODlhAQABAAAAACH5BAEKAAEALAAAAAABAAEAAAICTAEAOw=="
NOBODY = np.zeros(3), np.array([1.0, 0, 0, 0])
FIRST = Blinded(
    "0123abcd", "apt1", "dp", (Placement("mug1", "", *NOBODY),), ("shoe_pair1",)
)
SECOND = Blinded("ffffffff", "apt1", "fmm", (Placement("cup", "", *NOBODY),), ())

ANSWER = """
const saved = [];
URL.createObjectURL = (blob) => { saved.push(blob.text()); return "#"; };
const press = (key) =>
  document.dispatchEvent(new KeyboardEvent("keydown", { key, cancelable: true }));
const start = (name) => {
  get("rater").value = name;
  document.querySelector("#start form").requestSubmit();
};
start("../ann");
const refused = get("problem").textContent !== "" && get("rating").hidden;
start("ann.b-1");
"""
REPORT = """
Promise.all(saved).then((texts) => {
  const said = { refused, texts, progress: get("said").textContent,
    rater: state.rater, answers: state.answers };
  const node = make("pre", { id: "report" }, JSON.stringify(said));
  document.body.replaceChildren(node);
});
"""


def entry(one):
    """Return what the page has to know of an arrangement, with empty pictures."""
    placed = [
        {"object": p.object_id, "label": label_of(p.object_id), "is_placed": True}
        | {"number": str(n), "points": [[0.5, 0.5]] * 3, "close_up": DOT}
        for n, p in enumerate(one.placements, 1)
    ]
    lost = [
        {"object": name, "label": label_of(name), "is_placed": False}
        for name in one.unplaced
    ]
    seen = [{"title": title, "source": DOT} for title in views.TITLES]
    kind = "apartment"
    return {"name": one.name, "kind": kind, "objects": placed + lost, "views": seen}


@pytest.fixture
def browse(tmp_path):
    """Return the function that opens the page, runs a script in it and reports."""
    if BROWSER is None:
        pytest.skip("there is no chromium")
    page = tmp_path / "rate.html"

    def run(script):
        text = page_of(TEMPLATE, [entry(FIRST), entry(SECOND)])
        script = f"<script>{ANSWER}{script}{REPORT}</script></body>"
        page.write_text(text.replace("</body>", script))
        done = subprocess.run(
            [
                *(BROWSER, "--headless", "--no-sandbox", "--disable-gpu"),
                *(f"--user-data-dir={tmp_path / 'profile'}", "--dump-dom"),
                *("--virtual-time-budget=5000", page.as_uri()),
            ],
            check=False,
            capture_output=True,
            text=True,
            timeout=120,
            env={**os.environ, "HOME": str(tmp_path)},
        )
        found = re.search(r'<pre id="report">(.*)</pre>', done.stdout, re.DOTALL)
        assert found, done.stdout[-2000:] + done.stderr[-2000:]
        return json.loads(found.group(1))

    return run


def test_what_a_browser_saves_is_read_back(browse, tmp_path):
    said = browse("""
for (const key of ["y", "3", "."]) press(key);
press("ArrowRight");
document.querySelector('[aria-label="cup: no"]').click();
document.querySelector('[aria-label="Score 0.5"]').click();
get("save").click();
""")
    assert said["refused"]
    assert said["rater"] == "ann.b-1"
    file = tmp_path / "saved.csv"
    file.write_text(said["texts"][0])
    schema = read_yaml(SCHEMAS / "ratings.schema.yaml")
    rows = read_ratings([file], schema, (FIRST, SECOND))
    columns = ["rater", "scene", "method", "object", "answer", "is_asked"]
    assert rows[columns].to_numpy().tolist() == [
        ["ann.b-1", "apt1", "dp", "mug1", 1.0, True],
        ["ann.b-1", "apt1", "dp", "whole", 3.5, True],
        ["ann.b-1", "apt1", "dp", "shoe_pair1", 0.0, False],
        ["ann.b-1", "apt1", "fmm", "cup", 0.0, True],
        ["ann.b-1", "apt1", "fmm", "whole", 0.5, True],
    ]


def test_only_complete_arrangements_are_saved(browse):
    said = browse('press("y"); press("3"); press("ArrowRight"); press("y"); save();')
    assert "ffffffff" not in said["texts"][0]
    assert said["texts"][0].count("\n") == 3
    assert "the 1 complete of 2" in said["progress"]


def test_nothing_is_saved_of_no_answers(browse):
    assert browse("save();")["texts"] == []


def test_answers_survive_closing_the_page(browse):
    first = browse('press("n"); press("4"); press("."); press("."); press(".");')
    assert first["answers"] == {"0123abcd": {"mug1": "no", "whole": "5"}}
    assert browse("")["answers"] == first["answers"]


@pytest.fixture
def small_pictures(monkeypatch):
    monkeypatch.setattr(views, "SIZE", (64, 48))
    monkeypatch.setattr(close_ups, "SIZE", (64, 48))


@pytest.fixture
def drawn(small_pictures):
    """Return the layout of an office, an arrangement of it and its entry."""
    schema, catalogue = SCHEMAS / "room.schema.yaml", ROOT / "config" / "objects.csv"
    layout = layout_reader(ROOT / "resources" / "rooms", schema, catalogue)("office1")
    placed = layout.arrangements[0].placements[:2]
    one = Blinded("89abcdef", "office1", "dp_object_context", placed, ("mug1",))
    return one, next(iter(entries_of([one], {"office1": layout})))


def test_the_page_names_no_method_and_loads_nothing(drawn):
    page = page_of(TEMPLATE, [drawn[1]])
    words = re.sub(r"data:image/jpeg;base64,[A-Za-z0-9+/=]+", "", page).lower()
    names = [
        *JOINT_NAMES,
        *map(str.lower, JOINT_NAMES.values()),
        "fmm",
        "dp",
        "context",
    ]
    for name in names:
        assert not re.search(rf"\b{re.escape(name)}\b", words), name
    assert "office1" not in words
    for reference in ("https?:", "src=", "@import", r"\burl\(", "fetch", "<link"):
        assert not re.search(reference, words), reference
    assert "default-src 'none'" in words


def test_an_entry_has_three_views_a_close_up_and_what_was_not_placed(drawn):
    one, found = drawn
    assert [view["title"] for view in found["views"]] == list(views.TITLES)
    assert [item["object"] for item in found["objects"]] == [
        *(p.object_id for p in one.placements),
        "mug1",
    ]
    for item in found["objects"][:2]:
        assert item["close_up"].startswith("data:image/jpeg;base64,")
        assert all(0 < share < 1 for point in item["points"] for share in point)
    assert not found["objects"][2]["is_placed"]


def test_no_text_can_end_the_script_that_holds_the_data():
    hostile = entry(FIRST) | {"kind": "</script><script>alert(1)"}
    assert page_of(TEMPLATE, [hostile]).count("</script>") == TEMPLATE.count(
        "</script>"
    )
