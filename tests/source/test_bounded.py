"""Each bound by itself: just beyond it, where Python's own function would still come back."""

import pytest

from urdftool.source import safe_builtins

TEXT = "a" * 1000
MANY = safe_builtins.MAX_LENGTH // 1000 + 1


@pytest.mark.parametrize(
    ("function", "arguments"),
    [
        (safe_builtins.multiply, (TEXT, MANY)),
        (safe_builtins.multiply, (MANY, TEXT)),
        (safe_builtins.multiply, (1 << 60_000, 1 << 60_000)),
        (safe_builtins.add, (TEXT * (MANY - 1), TEXT)),
        (safe_builtins.compute_power, (2, safe_builtins.MAX_BITS + 1)),
        (safe_builtins.shift, (1, safe_builtins.MAX_BITS + 1)),
        (safe_builtins.compute_remainder, ("%99999d", 1)),
        (safe_builtins.round_number, (1.5, safe_builtins.MAX_DIGITS + 1)),
        (safe_builtins.MATH["factorial"], (5001,)),
        (safe_builtins.BOUNDED_METHODS["ljust"][1], ("a", safe_builtins.MAX_WIDTH + 1)),
        (safe_builtins.BOUNDED_METHODS["join"][1], ("", [TEXT] * MANY)),
        (safe_builtins.BOUNDED_METHODS["replace"][1], (TEXT, "a", "b" * 10 * MANY)),
    ],
)
def test_just_beyond_the_bound(function, arguments):
    with pytest.raises(OverflowError):
        function(*arguments)


@pytest.mark.parametrize(
    ("function", "arguments", "limit"),
    [
        (safe_builtins.make_range, (10**10,), "the range exceeds the limit of 1000000 numbers"),
        (safe_builtins.round_number, (1.5, 401), "rounding exceeds the limit of 400 digits"),
        (safe_builtins.MATH["lcm"], (2,) * 101, "the function exceeds the limit of 100 arguments"),
        (safe_builtins.MATH["factorial"], (5001,), "the argument exceeds the limit of 5000"),
        (safe_builtins.compute_power, (2, 10**6), "the number exceeds the limit of 100000 bits"),
    ],
)
def test_the_limit_that_is_exceeded_is_named(function, arguments, limit):
    with pytest.raises(OverflowError, match=limit):
        function(*arguments)


def test_what_xacro_wraps_is_said_once(write, urdftool):
    text = '<robot name="r" xmlns:xacro="x"><link name="$(eval 1/0)"/></robot>'
    result = urdftool("expand", write("r.xacro", text))
    assert result.err.count("division by zero") == 1


def test_within_the_bounds_it_is_pythons_own():
    assert safe_builtins.multiply(TEXT, 2) == TEXT * 2
    assert safe_builtins.add([1], [2]) == [1, 2]
    assert safe_builtins.compute_power(2, 10) == 1 << 10
    assert safe_builtins.BOUNDED_METHODS["replace"][1]("abc", "b", "x") == "axc"


def test_lists_in_lists_count_as_often_as_they_stand_there():
    line = [1] * 1000
    safe_builtins.check_size([line] * 100)
    with pytest.raises(OverflowError):
        safe_builtins.check_size([line] * 10_000)
    with pytest.raises(OverflowError):
        safe_builtins.check_size({"a": [[line] * 1000] * 1000})
    with pytest.raises(OverflowError):
        safe_builtins.check_size([1 << 90_000] * 1000)


def test_a_list_in_itself_ends():
    itself = [1]
    itself.append(itself)
    safe_builtins.check_size(itself)
