"""Pictures on disk: the same one is drawn once."""

import numpy as np
import pytest

from urdftool.drawing import picture_cache
from urdftool.drawing.picture_cache import draw_or_read, read_size
from urdftool.drawing.shapes import make_bare_shapes

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]]), np.array([[0, 1, 2], [0, 2, 3]])


@pytest.fixture
def drawn(monkeypatch):
    """A counter of pictures that are drawn slowly enough to be kept, and what draws them."""
    monkeypatch.setattr(picture_cache, "_SLOW", 0.0)
    calls = []

    def draw():
        calls.append(1)
        return np.full((6, 9, 3), len(calls), np.uint8)

    return calls, draw


def square(color=(1.0, 0.0, 0.0, 1.0)):
    return make_bare_shapes([(*SQUARE, color)])


def test_the_same_picture_is_drawn_once(drawn):
    calls, draw = drawn
    one, two = (draw_or_read(square(), ["pose", 0.1], draw) for _ in range(2))
    assert one == two
    assert len(calls) == 1
    assert read_size(one) == (9, 6)


def test_another_pose_or_color_is_another_picture(drawn):
    calls, draw = drawn
    draw_or_read(square(), ["pose", 0.1], draw)
    draw_or_read(square(), ["pose", 0.2], draw)
    draw_or_read(square((0.0, 1.0, 0.0, 1.0)), ["pose", 0.1], draw)
    assert len(calls) == 3


def test_a_picture_that_is_fast_to_draw_is_not_kept(monkeypatch):
    monkeypatch.setattr(picture_cache, "_SLOW", 60.0)
    calls = []
    for _ in range(2):
        draw_or_read(square(), [], lambda: calls.append(1) or np.zeros((2, 2, 3), np.uint8))
    assert len(calls) == 2
