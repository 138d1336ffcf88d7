"""The page for raters: one file that needs no network, with every picture inside.

It names neither methods nor scenes: an arrangement is what its pictures show.
"""

import json
from base64 import b64encode
from collections.abc import Iterable, Iterator, Mapping
from hashlib import blake2b
from typing import Any

from placing.dressing import meshes_of, object_meshes
from placing.rating.blinding import Blinded
from placing.rating.close_ups import close_ups
from placing.rating.views import jpeg_of, views_of
from placing.scene import Arrangement, Layout

KINDS = {"livingroom": "living room"}
"""Kinds of rooms whose word is not their name."""
DATA = "{{data}}"
"""Where the template has the data."""


def page_of(template: str, entries: Iterable[Mapping[str, Any]]) -> str:
    """Return the page with the entries of `entries_of` in their order."""
    arrangements = list(entries)
    names = " ".join(entry["name"] for entry in arrangements)
    # What is kept in a browser is for these very arrangements.
    edition = blake2b(names.encode(), digest_size=6).hexdigest()
    data = json.dumps({"edition": edition, "arrangements": arrangements})
    before, after = template.split(DATA)
    # No text of the data may end the script that holds it.
    return before + data.replace("<", "\\u003c") + after


def entries_of(
    arrangements: Iterable[Blinded], layouts: Mapping[str, Layout]
) -> Iterator[dict[str, Any]]:
    """Yield what the page has to know of each arrangement, with its pictures."""
    for one in arrangements:
        layout = layouts[one.scene]
        views = list(views_of(layout, one.placements))
        placed = object_meshes(layout, Arrangement("", "", one.placements))
        near = close_ups(meshes_of(layout), placed)
        objects: list[dict[str, Any]] = [
            {
                "object": name,
                "label": label_of(name),
                "is_placed": True,
                "number": str(number),
                "points": [view.points[name] for view in views],
                "close_up": _source(jpeg_of(near[name])),
            }
            for number, name in enumerate(placed, 1)
        ]
        objects += [
            {"object": name, "label": label_of(name), "is_placed": False}
            for name in one.unplaced
        ]
        yield {
            "name": one.name,
            "kind": KINDS.get(layout.kind, layout.kind),
            "objects": objects,
            "views": [{"title": v.title, "source": _source(v.jpeg)} for v in views],
        }


def label_of(object_id: str) -> str:
    """Return the id of an object as words: `shoe_pair1` is `shoe pair`."""
    return object_id.rstrip("0123456789").replace("_", " ")


def _source(jpeg: bytes) -> str:
    """Return a picture as the source of an image on a page."""
    return f"data:image/jpeg;base64,{b64encode(jpeg).decode()}"
