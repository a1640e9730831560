"""A short form of ``python -m measure.fuzz``: some damaged robots through every command."""

import sys

import pytest

from measure.fuzz.__main__ import warm
from measure.fuzz.case import run_case
from measure.fuzz.commands import COMMANDS
from measure.fuzz.robots import candidates

CASES = 2

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="needs fork and resource limits")


@pytest.fixture(scope="module")
def robots():
    warm()
    return candidates()[:1]


@pytest.mark.parametrize("command", COMMANDS)
def test_damaged_robots_do_no_harm(command, robots, tmp_path):
    outcomes = [run_case(0, n, robots, tmp_path / "case", command) for n in range(CASES)]
    assert not [f"{o.number}: {problem}" for o in outcomes for problem in o.problems]


def test_a_harm_is_seen(robots, tmp_path, monkeypatch):
    """The judge judges: a command that breaks, and one that touches its input."""
    from urdftool import cli

    def breaks(words):
        raise RuntimeError

    def harms(words):
        path = next(word for word in words if word.endswith((".urdf", ".xacro")))
        with open(path, "ab") as file:
            file.write(b" ")
        return 2

    monkeypatch.setattr(cli, "call", breaks)
    assert run_case(0, 1, robots, tmp_path / "a", "info").problems
    monkeypatch.setattr(cli, "call", harms)
    said = run_case(0, 1, robots, tmp_path / "b", "info").problems
    assert any("inputs changed" in problem for problem in said)
    assert any("nothing is said" in problem for problem in said)
