"""A link ``world`` that joints name and nobody declares is the world itself, in every command."""

import json

import pytest

from tests.simulation.robots import inertial
from urdftool.model.load import load
from urdftool.model.world import add_world

LINK = (
    f'<link name="arm">{inertial(1, 0.0142, 0.0142, 0.00167, "0 0 0.2")}'
    '<visual><origin xyz="0 0 0.2"/><geometry><box size=".1 .1 .4"/></geometry></visual>'
    '<collision><origin xyz="0 0 0.2"/><geometry><box size=".1 .1 .4"/></geometry></collision>'
    "</link>"
)
JOINT = (
    '<joint name="j" type="revolute">\n<parent link="world"/><child link="arm"/>'
    '<origin xyz="0 0 0.5"/><axis xyz="0 1 0"/>'
    '<limit lower="-1" upper="1" effort="9" velocity="1"/></joint>'
)
UNDECLARED = f'<robot name="r">{LINK}{JOINT}</robot>'
DECLARED = f'<robot name="r"><link name="world"/>{LINK}{JOINT}</robot>'
SAID = ":2:9: warning: parent link 'world' of joint 'j' is not defined"


@pytest.fixture
def robot(write):
    return write("r.urdf", UNDECLARED)


def test_the_robot_stays_as_it_is(robot):
    read = load(robot)
    whole, joint = add_world(read)
    assert joint is read.joint["j"]
    assert [link.name for link in read.links] == ["arm"]
    assert whole.tree.root.name == "world"
    assert whole.source is read.source


@pytest.mark.parametrize(
    "text",
    [
        DECLARED,
        UNDECLARED.replace('"world"', '"World"'),
        UNDECLARED.replace('child link="arm"', 'child link="leg"'),
        UNDECLARED.replace('<parent link="world"/>', ""),
    ],
)
def test_any_other_robot_has_no_world(write, text):
    read = load(write("r.urdf", text))
    assert add_world(read) == (read, None)


@pytest.mark.parametrize(
    "words",
    [
        ("simulate", "IN", "--format", "json"),
        pytest.param(
            ("simulate", "IN", "--format", "json", "--engine", "mujoco"), marks=pytest.mark.slow
        ),
        ("info", "IN", "--format", "json"),
        ("graph", "IN", "-o", "-"),
        pytest.param(("view", "IN", "--picture", "OUT.png"), marks=pytest.mark.slow),
        ("inertia", "robot", "IN", "--format", "json"),
        ("collision", "IN", "-o", "OUT.urdf"),
    ],
)
def test_commands_do_what_they_do_with_the_link_written_and_say_it_once(
    urdftool, write, tmp_path, words
):
    if "mujoco" in words:
        pytest.importorskip("mujoco")
    elif words[0] == "simulate":
        pytest.importorskip("pybullet")
    results = []
    for name, text in (("bare", UNDECLARED), ("whole", DECLARED)):
        (tmp_path / name).mkdir()
        path = write(f"{name}/r.urdf", text)
        spelled = [str(path) if word == "IN" else word for word in words]
        spelled = [
            str(tmp_path / name / word) if word.startswith("OUT") else word for word in spelled
        ]
        results.append(urdftool(*spelled))
    bare, whole = results
    assert bare.code == whole.code == 0
    assert bare.err.count(SAID) == 1
    assert SAID not in whole.err
    if words[0] == "view":
        images = [(tmp_path / name / "OUT.png").read_bytes() for name in ("bare", "whole")]
        assert images[0] == images[1]
    if words[0] == "simulate":
        (trial,), (other,) = (json.loads(result.out)["trials"] for result in results)
        assert trial["fixed"]
        assert trial["series"] == other["series"]


def test_it_differs_from_no_robot_that_writes_the_link(urdftool, write):
    one, other = write("a.urdf", UNDECLARED), write("b.urdf", DECLARED)
    result = urdftool("diff", one, other)
    assert (result.code, result.err.count(SAID)) == (0, 1)


@pytest.mark.parametrize("form", ["sdf", "mjcf"])
def test_exports_refuse_it_and_take_it_for_the_world_if_forced(urdftool, robot, tmp_path, form):
    if form == "mjcf":
        pytest.importorskip("mujoco")
    out = tmp_path / ("r.sdf" if form == "sdf" else "r.xml")
    refused = urdftool("export", form, robot, "-o", out)
    assert refused.code == 2
    assert refused.err.count("error:") == 1
    assert "r.urdf:2:9: error: " in refused.err
    assert "[unknown-parent-link]" in refused.err
    assert not out.exists()
    forced = urdftool("export", form, robot, "-o", out, "--force", "--verify")
    assert forced.code == 0, forced.err
    assert "r.urdf:2:9: " in forced.err
    assert "unknown-parent-link]" in forced.err
    assert 'name="j"' in out.read_text("utf-8")


def test_lint_keeps_its_finding(urdftool, robot):
    result = urdftool("lint", robot, "--select", "unknown-parent-link")
    assert (result.code, "unknown-parent-link" in result.out) == (1, True)
