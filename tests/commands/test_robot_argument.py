"""What a robot argument means is the same in every command: standard input, and xacro arguments."""

import io
import sys

import pytest

from tests.cases import list_cases
from tests.simulation.robots import inertial

XACRO = (
    '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<xacro:arg name="side" default="0.1"/><link name="a">'
    f"{inertial(1, 0.00167, 0.00167, 0.00167)}"
    '<visual><geometry><box size="$(arg side) .1 .1"/></geometry></visual>'
    '<collision><geometry><box size="$(arg side) .1 .1"/></geometry></collision></link></robot>'
)
SAID = "warning: no <xacro:arg> declares 'sides', so sides:=… has no effect; did you mean 'side'?"
COMMANDS = [
    ("expand",),
    ("info",),
    ("graph", "-o", "-"),
    ("simulate",),
    ("view", "--picture", "OUT.png"),
    ("export", "sdf", "-o", "OUT.sdf"),
    ("export", "mjcf", "-o", "OUT.xml"),
    ("inertia", "robot"),
    ("collision", "-o", "OUT.urdf"),
]


@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
def test_an_argument_that_nothing_declares_is_said_once(urdftool, write, tmp_path, words):
    if words == ("simulate",):
        pytest.importorskip("pybullet")
    path = write("r.urdf.xacro", XACRO)
    spelled = [str(tmp_path / word) if word.startswith("OUT") else word for word in words]
    result = urdftool(*spelled, path, "side:=0.1", "sides:=3")
    assert result.code == 0, result.err
    assert result.err.count(SAID) == 1


@pytest.mark.parametrize("words", [("simulate",), ("view", "--picture", "OUT.png")], ids=" ".join)
@pytest.mark.parametrize("text", list_cases([XACRO, XACRO.replace("$(arg side)", "0.1")], 2))
def test_a_robot_on_standard_input_is_as_one_in_a_file(
    urdftool, write, tmp_path, monkeypatch, words, text
):
    if words == ("simulate",):
        pytest.importorskip("pybullet")
    spelled = [str(tmp_path / word) if word.startswith("OUT") else word for word in words]
    from_file = urdftool(*spelled, write("r.urdf.xacro", text))
    drawn = (tmp_path / "OUT.png").read_bytes() if "view" in words else None
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text.encode())))
    piped = urdftool(*spelled, "-")
    assert (piped.code, from_file.code) == (0, 0), piped.err
    assert piped.out.replace("<stdin>", "") == from_file.out
    if drawn is not None:
        assert (tmp_path / "OUT.png").read_bytes() == drawn
