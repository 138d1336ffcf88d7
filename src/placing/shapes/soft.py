"""Upholstered furniture: armchairs, couches, beds and rugs."""

from math import inf

from placing.shapes.colours import (
    BLACK,
    CREAM,
    GREY,
    LINEN,
    MUSTARD,
    NAVY,
    OAK,
    RUST,
    SAND,
    TEAL,
    WHITE,
)
from placing.shapes.joinery import Size, extent, legs, shrink
from placing.shapes.parts import (
    Colour,
    Interval,
    Part,
    assemble,
    box,
    cushion,
    cut,
    hull,
    patch,
    quarter_turn,
)
from placing.shapes.shape import Shape, Support
from placing.shapes.tables import l_outline

SEAT, ARM, MATTRESS, PILLOW, CARPET = 0.8, 0.6, 0.9, 1.0, 0.3
"""Softness of what upholstered furniture offers."""
ROUND_M, GROOVE_M = 0.02, 0.008
"""Radius of rounded edges, and how far cushions side by side press into each other."""


def armchair(size_m: Size) -> Shape:
    """Return an armchair: one seat cushion between two arms, a back that leans."""
    return _sofa(size_m, RUST, 9.9)


def couch(size_m: Size) -> Shape:
    """Return a couch: seat cushions about 0.75 m wide, two arms, a back that leans."""
    return _sofa(size_m, TEAL, 0.75)


def _sofa(size_m: Size, colour: Colour, cushion_m: float) -> Shape:
    """Return upholstered seats in a row between two arms."""
    x, y, z = extent(size_m)
    seat, foot = min(0.44, 0.55 * z[1]), min(0.06, 0.08 * z[1])
    arm_top = seat + 0.5 * (z[1] - seat)
    arm, base = min(0.2, 0.2 * size_m[1]), foot + 0.5 * (seat - foot)
    back = x[0] + min(0.28, 0.32 * size_m[0])
    inner = shrink(y, arm)
    parts = [
        cushion((x[0] + 0.02, x[1] - 0.01), y, (foot, base), colour, ROUND_M),
        *legs(shrink(x, 0.05), shrink(y, 0.05), (0, foot + 0.02), 0.05, BLACK, 0.7),
        _leaning_back(x[0], back, inner, (base - 0.02, z[1]), colour),
    ]
    supports: list[Support] = []
    arm_x = (x[0] + 0.03, x[1])
    for name, side in (("arm_right", (y[0], inner[0])), ("arm_left", (inner[1], y[1]))):
        parts.append(cushion(arm_x, side, (foot, arm_top), colour, ROUND_M))
        flat = shrink(arm_x, ROUND_M), shrink(side, ROUND_M)
        supports += patch(name, *flat, arm_top, inf, ARM)
    n = max(1, round((inner[1] - inner[0]) / cushion_m))
    seats = (back - 0.03, x[1])
    for lane in _lanes(inner, n, GROOVE_M):
        parts.append(cushion(seats, lane, (base - 0.02, seat), colour, ROUND_M))
    flat = (back, x[1] - ROUND_M), shrink(inner, ROUND_M)
    supports += patch("seat", *flat, seat, inf, SEAT)
    return assemble(parts, supports)


def _lanes(y: Interval, n: int, overlap: float = 0.0) -> list[Interval]:
    """Return `n` equal intervals side by side, each reaching into its neighbours."""
    step, low, high = (y[1] - y[0]) / n, y[0], y[1]
    return [
        (max(low, low + i * step - overlap), min(high, low + (i + 1) * step + overlap))
        for i in range(n)
    ]


def _leaning_back(
    rear: float, front: float, y: Interval, z: Interval, colour: Colour
) -> Part:
    """Return a back that is thin and rounded on top, so that nothing stands on it."""
    top = min(0.09, 0.4 * (front - rear))
    profile = [
        (rear, z[0]),
        (front, z[0]),
        (rear + top, z[1] - 0.015),
        (rear + top - 0.02, z[1]),
        (rear + 0.02, z[1]),
        (rear, z[1] - 0.015),
    ]
    return hull([(px, side, pz) for px, pz in profile for side in y], colour)


def corner_couch(size_m: Size) -> Shape:
    """Return an L-shaped couch whose free quadrant is at +x, +y.

    One wing runs along the back edge (-x) and is sat on towards +x, with an arm at
    its left end; the other runs along the right edge (-y), is sat on towards +y and
    is open at its front end. They meet in the corner at -x, -y.
    """
    x, y, z = extent(size_m)
    wing = min(0.95, 0.6 * min(size_m[:2]))
    seat, foot = min(0.44, 0.55 * z[1]), min(0.06, 0.08 * z[1])
    base, rest = foot + 0.5 * (seat - foot), min(0.28, 0.32 * wing)
    arm = min(0.2, 0.2 * size_m[1], 0.5 * (size_m[1] - wing))
    arm_top, arm_y = seat + 0.5 * (z[1] - seat), (y[1] - arm, y[1])
    along_x, along_y = (x[0], x[0] + wing), (y[0], y[0] + wing)
    arm_x, back_z = (x[0] + 0.03, along_x[1]), (base - 0.02, z[1])
    seats = (x[0] + rest, along_x[1]), (y[0] + rest, along_y[1])
    right_back = _leaning_back(y[0], seats[1][0], (-x[1], -x[0]), back_z, NAVY)
    parts = [
        cushion(along_x, y, (foot, base), NAVY, ROUND_M),
        cushion(x, along_y, (foot, base), NAVY, ROUND_M),
        *legs(shrink(x, 0.05), shrink(along_y, 0.05), (0, foot + 0.02), 0.05, BLACK),
        *legs(shrink(along_x, 0.05), shrink(y, 0.05), (0, foot + 0.02), 0.05, BLACK),
        _leaning_back(x[0], seats[0][0], (y[0], arm_y[0]), back_z, NAVY),
        quarter_turn(right_back),
        cushion(arm_x, arm_y, (foot, arm_top), NAVY, ROUND_M),
        *_corner_seats(seats, x[1], arm_y[0], (base - 0.02, seat)),
    ]
    outline = l_outline(
        (seats[0][0], x[1] - ROUND_M),
        (seats[1][0], arm_y[0] - ROUND_M),
        wing - rest - ROUND_M,
    )
    flat_arm = shrink(arm_x, ROUND_M), shrink(arm_y, ROUND_M)
    supports = patch("arm_left", *flat_arm, arm_top, inf, ARM)
    return assemble(parts, [Support("seat", outline, seat, inf, SEAT), *supports])


def _corner_seats(
    seats: tuple[Interval, Interval], front: float, left: float, z: Interval
) -> list[Part]:
    """Return the long cushion of the right wing and those of the back wing."""
    (rear, edge), (right, middle) = seats
    n = max(1, round((left - middle) / 0.75))
    # The cushions reach under the backs, which lean away from them.
    along = (rear - 0.03, front), (right - 0.03, middle)
    parts = [cushion(*along, z, NAVY, ROUND_M)]
    for lane in _lanes((middle - GROOVE_M, left), n, GROOVE_M):
        parts.append(cushion((rear - 0.03, edge), lane, z, NAVY, ROUND_M))
    return parts


def bed(size_m: Size) -> Shape:
    """Return a bed along x: headboard and pillows at the back (-x), foot in front."""
    x, y, z = extent(size_m)
    top, foot = min(0.52, 0.62 * z[1]), min(0.1, 0.15 * z[1])
    board, frame = min(0.06, 0.1 * size_m[0]), foot + 0.45 * (top - foot)
    head, split = x[0] + board, x[0] + board + min(0.5, 0.28 * size_m[0])
    n = max(1, round(size_m[1] / 0.9))
    inside, flat = shrink(y, 0.03), shrink(y, 0.03 + 0.04)
    mattress = cushion((head, x[1] - 0.03), inside, (frame - 0.02, top), WHITE, 0.04)
    spread = box((split, x[1] + 1), (y[0] - 1, y[1] + 1), (frame, top + 1), SAND)
    parts = [
        box((x[0], head), y, (0.0, z[1]), OAK),
        box((head, x[1]), y, (foot, frame), OAK),
        *legs((head, x[1]), y, (0.0, foot), 0.07, OAK),
        cut(mattress, spread),
        Part(mattress.solid ^ spread.solid, SAND),
    ]
    supports = patch("mattress", (split, x[1] - 0.07), flat, top, inf, MATTRESS)
    for i, lane in enumerate(_lanes(flat, n)):
        place = shrink((head, split), 0.02, 0.03), shrink(lane, 0.02)
        parts.append(cushion(*place, (top - 0.03, top + 0.09), LINEN, 0.05))
        flat_pillow = shrink(place[0], 0.05), shrink(place[1], 0.05)
        name = f"pillow{i + 1}"
        supports += patch(name, *flat_pillow, top + 0.09, inf, PILLOW)
    return assemble(parts, supports)


def rug(size_m: Size) -> Shape:
    """Return a rug with a border of another colour, flush with its middle."""
    x, y, z = extent(size_m)
    edge = 0.08 * min(size_m[:2])
    band = box(shrink(x, edge), shrink(y, edge), z, MUSTARD)
    middle = box(shrink(x, 1.6 * edge), shrink(y, 1.6 * edge), z, CREAM)
    parts = [cut(box(x, y, z, GREY), band), cut(band, middle), middle]
    return assemble(parts, patch("top", x, y, z[1], inf, CARPET))
