"""Objects are put down until they touch, and no further than the hand can trust."""

import pytest
from test_settling import BOOK_M, CONFIG, TOP_M, block, body_of, book, pieces, table

from placing import rigid
from placing.physics.settling import settle


@pytest.mark.parametrize("offset_m", [-0.012, -0.004, 0.0, 0.02])
def test_a_book_a_little_off_its_table_ends_on_it(offset_m):
    placed = {"book": book(0.1, 0.2, TOP_M + offset_m)}
    settled = settle(table(), placed, CONFIG, reach_m=0.03)["book"]
    assert settled.penetration_m < 0.001
    assert settled.moved_m < 0.004
    assert settled.supports == ("table",)


def test_without_reach_it_penetrates_or_falls():
    low = settle(table(), {"book": book(0.1, 0.2, TOP_M - 0.012)}, CONFIG)["book"]
    high = settle(table(), {"book": book(0.1, 0.2, TOP_M + 0.02)}, CONFIG)["book"]
    assert low.penetration_m > 0.01
    assert high.moved_m > 0.01


def test_what_is_farther_than_the_reach_stays_where_it_is():
    placed = {"book": book(0.1, 0.2, TOP_M - 0.1)}
    assert settle(table(), placed, CONFIG, reach_m=0.03)["book"].penetration_m < 1e-6
    deep = {"book": book(0.1, 0.2, TOP_M - 0.015)}
    held = table() | {"lid": pieces(block((1, 1, 0.02), (0, 0, TOP_M + 0.02)))}
    assert settle(held, deep, CONFIG, reach_m=0.03)["book"].penetration_m > 0.003


def test_of_two_in_a_stack_the_lower_one_is_put_down_first():
    lower, upper = book(0, 0, TOP_M - 0.01), book(0, 0, TOP_M + BOOK_M[2] - 0.01)
    placed = {"upper": upper, "lower": lower}
    settled = settle(table(), placed, CONFIG, reach_m=0.03)
    assert settled["upper"].supports == ("lower",)
    assert max(s.penetration_m for s in settled.values()) < 0.001


def test_a_leaning_box_touches_with_its_lowest_corner():
    T = rigid.from_yaw(0.0, (0.0, 0.0, TOP_M + 0.14))
    T[:4] = [0.98, 0.199, 0.0, 0.0]
    body = body_of(block((0.1, 0.1, 0.2)), 0.5, CONFIG.margin_m)
    settled = settle(table(), {"box": (body, T)}, CONFIG, reach_m=0.03)["box"]
    assert settled.penetration_m < 0.001
