"""Each bound by itself: just beyond it, where Python's own function would still come back."""

import pytest

from urdftool.source import bounded

TEXT = "a" * 1000
MANY = bounded.MAX_LENGTH // 1000 + 1


@pytest.mark.parametrize(
    ("function", "arguments"),
    [
        (bounded.product, (TEXT, MANY)),
        (bounded.product, (MANY, TEXT)),
        (bounded.product, (1 << 60_000, 1 << 60_000)),
        (bounded.total, (TEXT * (MANY - 1), TEXT)),
        (bounded.power, (2, bounded.MAX_BITS + 1)),
        (bounded.shift, (1, bounded.MAX_BITS + 1)),
        (bounded.remainder, ("%99999d", 1)),
        (bounded.rounded, (1.5, bounded.MAX_DIGITS + 1)),
        (bounded.MATH["factorial"], (5001,)),
        (bounded.METHODS["ljust"], ("a", bounded.MAX_WIDTH + 1)),
        (bounded.METHODS["join"], ("", [TEXT] * MANY)),
        (bounded.METHODS["replace"], (TEXT, "a", "b" * 10 * MANY)),
    ],
)
def test_just_beyond_the_bound(function, arguments):
    with pytest.raises(OverflowError):
        function(*arguments)


def test_within_the_bounds_it_is_pythons_own():
    assert bounded.product(TEXT, 2) == TEXT * 2
    assert bounded.total([1], [2]) == [1, 2]
    assert bounded.power(2, 10) == 1 << 10
    assert bounded.METHODS["replace"]("abc", "b", "x") == "axc"


def test_lists_in_lists_count_as_often_as_they_stand_there():
    line = [1] * 1000
    bounded.check_size([line] * 100)
    with pytest.raises(OverflowError):
        bounded.check_size([line] * 10_000)
    with pytest.raises(OverflowError):
        bounded.check_size({"a": [[line] * 1000] * 1000})
    with pytest.raises(OverflowError):
        bounded.check_size([1 << 90_000] * 1000)


def test_a_list_in_itself_ends():
    itself = [1]
    itself.append(itself)
    bounded.check_size(itself)
