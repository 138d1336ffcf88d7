"""The entities of a joint arrangement that change with the step, one per object.

The density of the object, its box, its area, the names and the words, all on the
timeline `object`. The numbers here only steer how things look.
"""

import matplotlib as mpl
import numpy as np
import rerun as rr
from rerun.components import FillMode

from placing.recordings.blueprint import Eye
from placing.recordings.joint import Chosen, JointRecording
from placing.recordings.joint_entities import (
    LIFT_M,
    Color,
    area_title,
    category_color,
    outline,
)
from placing.recordings.joint_words import about_step, score_label, stack_label, steps
from placing.recordings.strips import strips

TIMELINE = "object"
HEAT_HEIGHT_M, HEAT_FILL = 0.004, 0.96
"""Squares of the density are so thick, and of such a share of the spacing of places."""
COLDEST_COLOR = 0.12
"""Of the colour map, whose darkest colours would look like shadows."""
LABEL_M = 0.1
"""Labels are so far above their objects, so that they do not hide small ones."""
BRIGHT, AREA_NAME = (255, 255, 255), (176, 206, 236)
ALL_M, NEAR_M = (0.25, np.inf), (0.1, 0.8)
"""What is nearer to the object of the step or farther has no name at that step, in the
view of all and in that from near: names would hide each other."""
PALE = 0.55
"""Share of white in the colour of a name: names are written on dark grey."""


def log_steps(stream: rr.RecordingStream, content: JointRecording, eye: Eye) -> None:
    """Log one step per object: its density, its box, its area and its words."""
    n = len(content.objects)
    for step, chosen in steps(content):
        stream.set_time(TIMELINE, sequence=step)
        path = f"world/heat/{chosen.item.object_id}"
        stream.log(path, heat_squares(chosen, content.spacing_m))
        _log_chosen(stream, chosen, eye)
        stream.log("world/names/all", names(content, chosen, ALL_M))
        stream.log("world/names/near", names(content, chosen, NEAR_M))
        text = about_step(content, step)
        stream.log("now", rr.TextDocument(text, media_type=rr.MediaType.MARKDOWN))
        if step < n:
            stream.set_time(TIMELINE, sequence=step + 1)
            stream.log(path, rr.Clear(recursive=False))
    stream.reset_time()


def heat_squares(chosen: Chosen, spacing_m: float) -> rr.Boxes3D:
    """Return the density of an object as flat squares on its places."""
    heat = chosen.heat
    half = [HEAT_FILL * spacing_m / 2] * 2 + [HEAT_HEIGHT_M / 2]
    at = COLDEST_COLOR + (1 - COLDEST_COLOR) * heat.warmth
    return rr.Boxes3D(
        centers=heat.places + np.array([0, 0, LIFT_M]),
        half_sizes=np.tile(half, (len(at), 1)),
        colors=mpl.colormaps["turbo"](at, bytes=True)[:, :3],
        fill_mode=FillMode.Solid,
    )


def names(
    content: JointRecording, now: Chosen, within_m: tuple[float, float]
) -> rr.Points3D:
    """Return the names over the objects about that of the step, its own with its score.

    What carries another object is named with what stands on it, on top of the stack.
    """
    below = {c.item.object_id: c.on for c in content.placed}
    tops = [c for c in content.placed if c.item.object_id not in below.values()]
    if now.is_placed:
        middle, (low, high) = now.T_world_object[4:], within_m
        away = [np.linalg.norm(c.T_world_object[4:] - middle) for c in tops]
        tops = [c for c, d in zip(tops, away, strict=True) if low < d < high]
        tops.append(now)
    at = np.array([c.T_world_object[4:] for c in tops]).reshape(-1, 3)
    at[:, 2] += [c.half_extents[2] + LABEL_M for c in tops]
    return rr.Points3D(
        at,
        labels=[
            score_label(c) if c is now else stack_label(c.item.object_id, below)
            for c in tops
        ],
        colors=[BRIGHT if c is now else _pale(c.item.category) for c in tops],
        radii=0.001,
        show_labels=True,
    )


def _pale(category: str) -> Color:
    """Return the colour of a category, pale enough to read."""
    r, g, b = (
        round((1 - PALE) * part + PALE * 255) for part in category_color(category)
    )
    return r, g, b


def _log_chosen(stream: rr.RecordingStream, chosen: Chosen, eye: Eye) -> None:
    """Log the box of an object and the outline of its area, or clear them."""
    if chosen.area is None:
        stream.log("world/chosen", rr.Clear(recursive=True))
        return
    T = chosen.T_world_object
    box = rr.Boxes3D(
        centers=T[None, 4:],
        half_sizes=np.array([chosen.item.size_m]) / 2 + 0.01,
        quaternions=T[None, [1, 2, 3, 0]],  # rerun wants xyzw
        colors=BRIGHT,
        radii=0.003,
        fill_mode=FillMode.MajorWireframe,
    )
    stream.log("world/chosen/box", box)
    line = outline(chosen.area)
    drawn = rr.LineStrips3D(strips([line]), colors=BRIGHT, radii=0.005)
    stream.log("world/chosen/area", drawn)
    nearest = line[np.argmax(line @ (eye.position - eye.target))]
    title = rr.Points3D(
        nearest[None],
        labels=[area_title(chosen.area)],
        colors=AREA_NAME,
        radii=0.001,
        show_labels=True,
    )
    stream.log("world/chosen/area_name", title)
