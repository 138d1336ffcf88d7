"""What the recording of a plan says in words: the search, and what happens now."""

from collections import Counter

from placing.recordings.plan import PlanRecording, Tried, phases

WORDS = {
    "without": "arranged without looking at the robot",
    "with": "arranged first, then filtered by what the robot can do",
    "inside": "chosen among what the robot can do",
}
"""What `constraints` means."""
COLOURS = {
    "too wide to grasp": ("grey", (150, 155, 162)),
    "no standing place": ("purple", (170, 110, 220)),
    "no arm solution": ("blue", (80, 150, 245)),
    "goal in collision": ("red", (235, 70, 70)),
    "no path": ("yellow", (245, 205, 70)),
    "rejected by the exact check": ("pink", (245, 120, 190)),
    "falls": ("brown", (175, 120, 75)),
}
"""Name and colour of the reasons for which placements are rejected."""
OTHER = ("white", (235, 238, 242))
TAKEN = ("green", (90, 215, 120))
POSSIBLE = "possible"
N_TOLD = 8
"""Of so many placements it is told what became of each."""
HANDED = (
    "The robot starts at the most open spot of the floor with each object in its "
    "gripper."
)
FETCHED = "The robot fetches each object from where it stands."
USE = (
    "Drag the slider at the bottom, or press play. Blue outlines are placing "
    "areas; lines on the floor are the ways of the base, the bright one that of this "
    "object. Walls towards the eye are cut away; they are under `world/cloud/front`."
)


def colour_of(reason: str) -> tuple[int, int, int]:
    """Return the colour of what was tried, by why it was rejected."""
    return COLOURS.get(reason, OTHER)[1] if reason else TAKEN[1]


def story(content: PlanRecording) -> str:
    """Return how the plan was found as Markdown: order, what was tried, and why not."""
    search = content.search
    n, n_placed = len(search.order) + len(search.refused), len(search.order)
    lines = [
        f"# {content.scene}: {n_placed} of {n} objects placed by the robot",
        f"Data set `{content.dataset}`, {content.task} room, objects "
        f"{WORDS.get(content.constraints, content.constraints)}.",
        *(f"\n{note}" for note in search.notes),
        *("", f"{_start(content)} {USE}", "", _legend(content), "", "## Order"),
    ]
    for turn, name in enumerate(search.order, start=1):
        grasp = search.grasps.get(name, "")
        lines.append(f"{turn}. **{name}**" + (f", grasp `{grasp}`" if grasp else ""))
        lines += [f"    - {line}" for line in _lines(_of(content, name))]
    if search.refused:
        lines += ["", "## Not placed"]
    for name, reason in search.refused.items():
        lines.append(f"- **{name}**: {reason}")
        lines += [f"    - {line}" for line in _lines(_of(content, name))]
    return "\n".join(lines)


def _start(content: PlanRecording) -> str:
    """Return where the robot has the objects from."""
    is_fetched = any(phase.startswith("pick") for phase in content.film.phase)
    return FETCHED if is_fetched else HANDED


def _of(content: PlanRecording, name: str) -> list[Tried]:
    """Return what was tried of an object."""
    return [one for one in content.search.tried if one.object_id == name]


def _lines(tried: list[Tried]) -> list[str]:
    """Return what was tried of an object: counts, the first ones, the last possible."""
    if not tried:
        return []
    counts = Counter(one.reason or POSSIBLE for one in tried)
    told = [f"{n} {reason}" for reason, n in counts.most_common()]
    lines = [f"asked {len(tried)} times: {', '.join(told)}"]
    if len(tried) <= N_TOLD:
        return lines + [_line(one) for one in tried]
    lines += [_line(one) for one in tried[: N_TOLD - 1]]
    last = next((one for one in reversed(tried) if not one.reason), tried[-1])
    return [*lines, f"... {len(tried) - N_TOLD} more ...", _line(last)]


def _line(one: Tried) -> str:
    """Return one placement and what became of it."""
    x, y, z = one.T_world_object[4:]
    where = f"place {one.number} at ({x:.2f}, {y:.2f}, {z:.2f}) m"
    behind = f", blocked by {', '.join(one.blockers)}" if one.blockers else ""
    beside = f" beside {', '.join(one.among)}" if one.among else ""
    return f"{where}{beside}: {one.reason or POSSIBLE}{behind}"


def _legend(content: PlanRecording) -> str:
    """Return what the colours of placements mean, of those that occur."""
    occur = {one.reason for one in content.search.tried}
    found = [reason for reason in COLOURS if reason in occur]
    names = [f"{COLOURS.get(reason, OTHER)[0]} {reason}" for reason in found]
    every = ", ".join([f"{TAKEN[0]} {POSSIBLE}", *names])
    return f"Dots and boxes are what was tried of the object of this time: {every}."


def moments(content: PlanRecording) -> list[tuple[float, str]]:
    """Return what happens from which time on, as Markdown."""
    film, order = content.film, content.search.order
    found = []
    for time, number, phase in phases(film):
        name = film.objects[number] if number >= 0 else ""
        turn = order.index(name) + 1 if name in order else 0
        title = f"## {turn} of {len(order)}: {name}" if turn else "## The robot waits"
        found.append((time, f"{title}\n**{phase}**"))
    return found
