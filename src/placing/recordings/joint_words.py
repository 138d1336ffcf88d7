"""What the recording of a joint arrangement says in words."""

from collections.abc import Mapping, Sequence

import numpy as np

from placing.methods.names import JOINT_NAMES
from placing.recordings.joint import COLDEST, Chosen, JointRecording
from placing.scene import PlacingArea

ABOUT = (
    "Scenes that were written for this project and scanned in simulation. They are not "
    "the scans of the paper, whose numbers they cannot reproduce."
)
USE = (
    "Drag the slider at the bottom of the window: **each step is one object**. Its "
    "density colours the places, its box and its area are outlined in white, its name "
    "has its score, and the second view stays close to it."
)
LEGEND = (
    "Coloured squares: the density of the object over all places, before the objects "
    "are put together, so its peak may be taken by another one. Red is the highest, "
    f"blue {1 / COLDEST:.0f} times lower; what is lower still is not drawn. Objects of "
    "one category have one colour. Blue outlines: placing areas; their names are under "
    "`world/areas/names`, switched off. Brackets: what stands on what. Walls towards "
    "the eye are cut away; they are under `world/cloud/front`."
)
HEADS = ("step", "object", "log Psi", "Psi_stability", "Psi_semantics", "settled")
HEADS += ("area", "height [m]", "stands on", "orientation")


def label_of(method: str) -> str:
    """Return what a method is called in Table 2."""
    return JOINT_NAMES.get(method, method)


def summary(content: JointRecording) -> str:
    """Return what the recording shows as Markdown."""
    n, n_placed = len(content.objects), len(content.placed)
    known = [chosen for chosen in content.placed if chosen.settled]
    n_stay = sum(chosen.settled == "stays" for chosen in known)
    settled = f", {n_stay} of {len(known)} stay put when settled" if known else ""
    lines = [
        f"# {content.scene}: {label_of(content.method)}",
        f"{n_placed} of {n} objects placed together{settled}. {_program(content)}",
        *("", USE, "", f"| {' | '.join(HEADS)} |", "|-:|:-|-:|-:|-:|:-|:-|-:|:-|:-|"),
    ]
    lines += [f"| {' | '.join(_cells(k, c))} |" for k, c in steps(content)]
    missing = [c for c in content.objects if not c.is_placed]
    lines += ["", *(f"- {c.item.object_id} is not placed: {c.reason}" for c in missing)]
    about = f"Data set `{content.dataset}`, fold {content.fold}. {ABOUT}"
    return "\n".join([*lines, "", LEGEND, "", about])


def steps(content: JointRecording) -> Sequence[tuple[int, Chosen]]:
    """Return the objects with their steps, counted from 1."""
    return list(enumerate(content.objects, start=1))


def about_step(content: JointRecording, step: int) -> str:
    """Return what is shown of the object of a step as Markdown."""
    chosen = content.objects[step - 1]
    item = chosen.item
    lines = [
        f"## {step} of {len(content.objects)}: {item.object_id}",
        f"{item.category.replace('_', ' ')}, {_place(chosen)}",
    ]
    if chosen.is_placed:
        lines += ["", f"{label_of(content.method)}: log Psi {number(chosen.log_psi)}"]
        stability, semantics = chosen.log_psi_stability, chosen.log_psi_semantics
        lines += ["", f"Psi_stability {share(stability)}"]
        lines[-1] += f", Psi_semantics {share(semantics)}"
    if chosen.settled:
        lines += ["", f"When all is settled by physics: {chosen.settled}"]
    return "\n".join(lines)


def score_label(chosen: Chosen) -> str:
    """Return the name of an object with its score."""
    return f"{chosen.item.object_id}: log Psi {number(chosen.log_psi)}"


def stacks_of(placed: Sequence[Chosen]) -> list[list[str]]:
    """Return the names of the objects of each stack, upwards."""
    below = {chosen.item.object_id: chosen.on for chosen in placed}
    tops = [name for name, on in below.items() if on and name not in below.values()]
    return [_down_from(top, below)[::-1] for top in tops]


def stack_label(top: str, below: Mapping[str, str]) -> str:
    """Return the name of an object and of all that it stands on, downwards."""
    return " on ".join(_down_from(top, below))


def _down_from(top: str, below: Mapping[str, str]) -> list[str]:
    """Return the names of an object and of all that it stands on, downwards."""
    stack = [top]
    while below.get(stack[-1]):
        stack.append(below[stack[-1]])
    return stack


def height(area: PlacingArea) -> str:
    """Return the height of an area with two decimals, that of a floor without sign."""
    return f"{round(area.height_m, 2) + 0.0:.2f}"


def number(value: float) -> str:
    """Return a logarithm with two decimals, or a dash where there is none."""
    return "-" if np.isnan(value) else f"{value:.2f}"


def share(log_value: float) -> str:
    """Return a probability from its logarithm, or a dash where there is none."""
    return "-" if np.isnan(log_value) else f"{np.exp(log_value):.2g}"


def _program(content: JointRecording) -> str:
    """Return what the integer program reached."""
    return (
        f"Integer program: objective **{number(content.objective)}**, "
        f"gap to its bound {content.gap:.2g}."
    )


def _place(chosen: Chosen) -> str:
    """Return where an object stands, or why it does not."""
    if chosen.area is None:
        return f"**not placed**: {chosen.reason}."
    at = f"{chosen.area.area}, {height(chosen.area)} m above the floor"
    below = f"**{chosen.on}** (level {chosen.level}) on {at}" if chosen.on else at
    return f"{chosen.orientation}, on {below}."


def _cells(step: int, chosen: Chosen) -> list[str]:
    """Return the cells of an object in the table of the summary."""
    item, area = chosen.item, chosen.area
    if area is None:
        return [str(step), item.object_id, *3 * "-", "not placed", *4 * "-"]
    return [
        *(str(step), item.object_id, number(chosen.log_psi)),
        *(share(chosen.log_psi_stability), share(chosen.log_psi_semantics)),
        *(chosen.settled or "-", area.area, height(area)),
        *(chosen.on or "-", chosen.orientation),
    ]
