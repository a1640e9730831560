"""No expression takes more time or memory than the limits, and each ends with a short message."""

import sys
import threading

import pytest

from tests.hostile import expression_bombs
from tests.hostile.test_escapes import by_argument, by_ros1, try_out
from urdftool import expand
from urdftool.errors import UrdftoolError

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="measures processes in /proc")

EXPAND = "expand robot.xacro"
LONG = "[0 for x in python.range(999999) for y in python.range(999999)]"


def list_bombs():
    """Return all bombs: name, body and files."""
    found = [(name, *by_argument(text)) for name, text in expression_bombs.EXPRESSIONS.items()]
    bodies = expression_bombs.BODIES.items()
    return found + [(name, body.text, body.files) for name, body in bodies]


USUAL = (
    *("power", "shift", "product of lists", "format width in parts", "percent star", "zfill"),
    *("replace", "join", "to_bytes", "factorial", "round", "int of many digits", "brackets"),
    *("brackets of an allowed length", "signs of an allowed length", "dollars", "long text"),
    *("lists that are compared", "tuples that are hashed", "lists as text", "extensions by itself"),
    *("properties that double", "macro that calls itself", "include of itself twice"),
    *("dollars in a text", "YAML aliases", "YAML that is deep", "message"),
)
"""Bombs of every kind, most of which end at once."""


def check(zygote, place, command, bombs):
    found = []
    for name, body, files in bombs:
        _, problems = try_out(zygote, place, command, body, files)
        found += [f"{name}: {problem}" for problem in problems]
    assert not found, "\n".join(found)


def test_they_are_named():
    assert set(USUAL) <= {name for name, *_ in list_bombs()}
    assert len(list_bombs()) > 200


@pytest.mark.parametrize("part", range(4))
def test_usual_bombs_end(zygote, place, part):
    check(zygote, place, EXPAND, [bomb for bomb in list_bombs() if bomb[0] in USUAL][part::4])


@pytest.mark.slow
@pytest.mark.parametrize("part", range(16))
def test_every_bomb_ends(zygote, place, part):
    check(zygote, place, EXPAND, list_bombs()[part::16])


@pytest.mark.slow
@pytest.mark.parametrize("part", range(16))
def test_every_bomb_ends_in_ros1(zygote, place, part):
    texts = list(expression_bombs.EXPRESSIONS.items())[part::16]
    check(zygote, place, EXPAND, [(name, *by_ros1(text)) for name, text in texts])


@pytest.mark.slow
@pytest.mark.parametrize("part", range(16))
def test_every_bomb_ends_in_lint(zygote, place, part):
    check(zygote, place, "lint robot.xacro --no-cache", list_bombs()[part::16])


@pytest.mark.parametrize("text", [LONG, "python.sorted([a60, b60])"])
def test_an_expression_ends_in_a_thread(tmp_path, text):
    """No signal reaches another thread than the main one."""
    path = tmp_path / "robot.xacro"
    body = expression_bombs.nest(60) + f'<link name="${{{text}}}"/>'
    path.write_text(f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{body}</robot>')
    errors = []

    def work():
        try:
            expand(path)
        except UrdftoolError as error:
            errors.append(error)

    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    thread.join(300)
    assert not thread.is_alive()
    assert len(errors) == 1
