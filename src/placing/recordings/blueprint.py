"""What is seen when a recording is opened: views, eye, and which walls are cut away."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import rerun.blueprint as rrb
from numpy.typing import NDArray

from placing.recordings.content import SceneRecording
from placing.recordings.tables import TRACED

Array = NDArray[np.float64]

ELEVATION_DEG = 38.0
AZIMUTH_DEG = 30.0
"""Of the eye, from the normal of the longer walls."""
VERTICAL_VIEW_DEG = 55.0
"""The angle rerun's eye sees from the lowest to the highest pixel."""
ASPECT = 1.25
"""Width over height of the view when the window is as large as common screens."""
SEEN_HEIGHT_M = 1.6
"""The room is framed up to this height; walls may be cut above."""
FRONT_DEPTH_M, FRONT_BIN_M, FRONT_LIP_M = 0.2, 0.1, 0.1
"""How deep a wall towards the eye is cut away, in strips so wide, down to a lip."""
BACKGROUND = (38, 41, 47)
N_USES = 3
"""Of so many objects, the largest, the user is seen from the start."""


@dataclass(frozen=True)
class Eye:
    """Where the eye of the three-dimensional view is, and what it looks at."""

    position: Array
    """(3,) [m]."""
    target: Array
    """(3,) [m]."""


def eye_of_room(points: NDArray[np.floating], objects: Array) -> Eye:
    """Return an eye above a corner of the room that faces most of the objects."""
    low, high = (np.array([f(c) for c in points.T], float) for f in (np.min, np.max))
    high[2] = low[2] + SEEN_HEIGHT_M
    target = (low + high) / 2
    seen = objects.mean(axis=0) if len(objects) else target
    side = np.where(seen[:2] > target[:2], -1.0, 1.0)
    elevation, azimuth = np.deg2rad([ELEVATION_DEG, AZIMUTH_DEG])
    flat = np.array([np.sin(azimuth), np.cos(azimuth)])
    flat = flat if high[0] - low[0] > high[1] - low[1] else flat[::-1]
    back = np.array([*side * flat * np.cos(elevation), np.sin(elevation)])
    right = np.cross([0, 0, 1], back) / np.cos(elevation)
    up = np.cross(back, right)
    half = (high - low) / 2
    signs = np.stack(np.meshgrid(*[[-1, 1]] * 3), axis=-1).reshape(-1, 3)
    corners = signs * half  # (8, 3) about the target
    slope = np.tan(np.deg2rad(VERTICAL_VIEW_DEG) / 2)
    needed = np.maximum(
        np.abs(corners @ right) / (slope * ASPECT), np.abs(corners @ up) / slope
    )
    distance = (needed + corners @ back).max()
    return Eye(target + distance * back, target)


def is_in_front(points: Array, eye: Eye) -> NDArray[np.bool_]:
    """Return which points are on the walls between the eye and the room, shape (n,).

    In each strip across the room, along x and along y, that is what lies nearest to the
    eye's side: the wall there, whatever the outline of the room.
    """
    is_high = points[:, 2] > points[:, 2].min() + FRONT_LIP_M
    is_cut = np.zeros(len(points), bool)
    for across, along in ((0, 1), (1, 0)):
        nearness = points[:, along] * np.sign(eye.position - eye.target)[along]
        strip = np.floor(points[:, across] / FRONT_BIN_M).astype(int)
        strip -= strip.min()
        nearest = np.full(strip.max() + 1, -np.inf)
        np.maximum.at(nearest, strip[is_high], nearness[is_high])
        is_cut |= nearness > nearest[strip] - FRONT_DEPTH_M
    return is_cut & is_high


def layout(content: SceneRecording, eye: Eye) -> rrb.Blueprint:
    """Return the views: the room beside the words and the traces of the chains."""
    words = rrb.Tabs(
        rrb.TextDocumentView(origin="summary", name="Summary"),
        rrb.TextDocumentView(origin="reasons", name="Why here"),
        active_tab=0,
    )
    traces = [
        rrb.TimeSeriesView(
            origin=f"diagnostics/{name}",
            name=label.capitalize(),
            plot_legend=rrb.PlotLegend(visible=False),  # chains are alike
        )
        for name, label in TRACED.items()
    ]
    side = rrb.Vertical(words, *traces, row_shares=[6, *[1] * len(traces)])
    return views(
        rrb.Horizontal(room(eye, hidden(content)), side, column_shares=[3, 1.3])
    )


def hidden(content: SceneRecording) -> list[str]:
    """Return the entities that are switched off at first: a view of all is too full."""
    volume = content.predicted.sizes.prod(axis=1)
    by_size = np.array(content.predicted.names)[np.argsort(-volume, kind="stable")]
    return [
        "world/cloud/front",
        *(f"world/density/{name}" for name in list(content.densities)[1:]),
        *(f"world/uses/{name}" for name in by_size[N_USES:]),
    ]


def room(
    eye: Eye,
    off: Sequence[str],
    name: str = "Room",
    contents: Sequence[str] = ("$origin/**",),
) -> rrb.Spatial3DView:
    """Return a view of the room with some entities switched off."""
    behaviour = rrb.EntityBehavior(visible=False)
    return rrb.Spatial3DView(
        origin="world",
        name=name,
        contents=list(contents),
        overrides=dict.fromkeys(off, behaviour),
        eye_controls=rrb.EyeControls3D(
            kind=rrb.Eye3DKind.Orbital,
            position=eye.position,
            look_target=eye.target,
            eye_up=(0, 0, 1),
        ),
        background=BACKGROUND,
        line_grid=False,
    )


def views(container: rrb.Container) -> rrb.Blueprint:
    """Return a blueprint of these views alone, without the panels around them."""
    return rrb.Blueprint(
        container,
        rrb.TimePanel(state="collapsed", timeline="sweep", play_state="following"),
        rrb.SelectionPanel(state="hidden"),
        rrb.BlueprintPanel(state="hidden"),
        auto_views=False,
        auto_layout=False,
    )
