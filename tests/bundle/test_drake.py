"""URDF that other readers load and Drake refuses, as ``bundle --for drake`` writes it."""

from importlib.util import find_spec

import pytest

from urdftool.bundle.drake import change_for_drake
from urdftool.source.location import SourceFile

SHAPE = '<geometry><box size="1 1 1"/></geometry>'
RED, BLUE = '<color rgba="1 0 0 1"/>', '<color rgba="0 0 1 1"/>'


def material(content, name="m"):
    return f'<material name="{name}">{content}</material>'


def link(*materials, name="a"):
    visuals = "".join(f"<visual>{SHAPE}{one}</visual>" for one in materials)
    return f'<link name="{name}">{visuals}</link>'


def shape(text, kind="collision"):
    return f'<link name="a"><{kind}><geometry>{text}</geometry></{kind}></link>'


def joint(name, kind, parent, child, more=""):
    limit = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<axis xyz="0 0 1"/>{limit}{more}</joint>'
    )


LINKS = '<link name="a"/><link name="b"/><link name="c"/>'


def mimic(leader, follower, followed="j"):
    copy = f'<mimic joint="{followed}"/>'
    return LINKS + joint("j", leader, "a", "b") + joint("k", follower, "b", "c", copy)


TYPE = "<type>transmission_interface/SimpleTransmission</type>"
JOINTS = mimic("revolute", "revolute").replace('<mimic joint="j"/>', "")


def drive(joint="j", actuator="m", kind=TYPE, name="t"):
    of_joint = f'<joint name="{joint}"/>' if joint else ""
    return (
        f'<transmission name="{name}">{kind}{of_joint}<actuator name="{actuator}"/></transmission>'
    )


CASES = {
    "two colors of one name in visuals": (
        link(material(RED), material(BLUE)),
        link(material(RED), material(RED)),
        "material 'm' is defined with another color in line 1, which the visual gets",
    ),
    "a color on the robot and another in a visual": (
        material(RED) + link(material(BLUE)),
        material(RED) + link(material(RED)),
        "material 'm' is defined with another color in line 1, which the visual gets",
    ),
    "two colors of one name on the robot": (
        material(RED) + material(BLUE) + link('<material name="m"/>'),
        material(RED) + link('<material name="m"/>'),
        "material 'm' is defined with another color in line 1: it is left out",
    ),
    "a material that is never defined": (
        link('<material name="m"/>'),
        link(""),
        "material 'm' is not defined: the visual has the reader's default color",
    ),
    "a material without color on the robot, and its use": (
        '<material name="m"/>' + link('<material name="m"/>'),
        link(""),
        "material 'm' of the robot has no color and no image: it is left out",
    ),
    "a material without a name on the robot": (
        f"<material>{RED}</material>" + link(),
        link(),
        "a material of the robot has no name: it is left out",
    ),
    "a definition below the first use": (
        link('<material name="m"/>', material(BLUE)),
        link(material(BLUE), material(BLUE)),
        "its definition is copied there",
    ),
    "a color outside of 0 to 1, defined twice": (
        link(material('<color rgba="255 0 0 1"/>'), material(BLUE)),
        link(material(RED), material(RED)),
        "color '255 0 0 1' is outside of 0 to 1: it becomes 1 0 0 1",
    ),
    "a box of width 0": (
        shape('<box size="0 1 2"/>'),
        shape('<box size="1e-6 1 2"/>'),
        "box has a size of 0: it becomes 1e-6 m",
    ),
    "a cylinder without length": (
        shape('<cylinder radius="1" length="0.0"/>', "visual"),
        shape('<cylinder radius="1" length="1e-6"/>', "visual"),
        "cylinder has a length of 0",
    ),
    "a mimic of a fixed joint": (
        mimic("fixed", "revolute"),
        mimic("fixed", "revolute").replace('<mimic joint="j"/>', ""),
        "joint 'k': <mimic> of 'j' is left out",
    ),
    "a mimic in a fixed joint": (
        mimic("revolute", "fixed"),
        mimic("revolute", "fixed").replace('<mimic joint="j"/>', ""),
        "joint 'k': <mimic> of 'j' is left out",
    ),
    "a mimic of itself": (
        mimic("revolute", "revolute", "k"),
        JOINTS,
        "joint 'k': <mimic> of 'k' is left out",
    ),
    "two actuators of one name": (
        JOINTS + drive() + drive("k") + drive("k", "m_2"),
        JOINTS + drive() + drive("k", "m_2") + drive("k", "m_2_2"),
        "actuator 'm' exists already: this one is named 'm_2'",
    ),
    "a transmission of a joint that does not exist": (
        JOINTS + drive("z"),
        JOINTS,
        "transmission 't' is left out: joint 'z' does not exist",
    ),
    "a transmission without a type": (
        JOINTS + drive(kind=""),
        JOINTS,
        "transmission 't' is left out: it has no <type>",
    ),
    "a transmission without a joint": (
        JOINTS + drive(joint=""),
        JOINTS,
        "transmission 't' is left out: it has no <joint> with a name",
    ),
}

KEPT = (
    link(material(RED), material('<color rgba="1.0 0 0 1"/>'), '<material name="m"/>'),
    material(RED) + link('<material name="m"/>', f"<material>{BLUE}</material>"),
    mimic("revolute", "prismatic"),
    JOINTS + drive() + drive("k", "n"),
    shape('<sphere radius="0"/>'),
)


def change(content):
    file = SourceFile("r.urdf", f'<robot name="r">{content}</robot>'.encode())
    changed, findings = change_for_drake(file)
    text = changed.data.decode().removeprefix('<robot name="r">').removesuffix("</robot>")
    return text, [str(finding.message) for finding in findings]


@pytest.mark.parametrize("case", CASES)
def test_what_drake_refuses_is_written_otherwise(case):
    before, after, message = CASES[case]
    text, messages = change(before)
    assert text == after
    assert any(message in one for one in messages), messages
    assert change(after) == (after, [])


@pytest.mark.parametrize("content", KEPT)
def test_what_drake_loads_stays(content):
    assert change(content) == (content, [])


@pytest.mark.parametrize("content", [after for _, after, _ in CASES.values()])
@pytest.mark.skipif(not find_spec("pydrake"), reason="loads what was written in Drake")
def test_drake_loads_it(content):
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
    from pydrake.systems.framework import DiagramBuilder

    plant, _ = AddMultibodyPlantSceneGraph(DiagramBuilder(), 0.001)
    assert Parser(plant).AddModelsFromString(f'<robot name="r">{content}</robot>', "urdf")


def test_the_bundle_says_what_was_changed(urdftool, write, tmp_path):
    write("r.urdf", f'<robot name="r">{link(material(RED), material(BLUE))}</robot>')
    done = urdftool("bundle", "r.urdf", "-o", "out", "--for", "drake")
    assert "r.urdf:1:190: warning: material 'm' is defined with" in done.err
    assert "[adapted-for-drake]" in done.err
    assert (tmp_path / "out" / "r.urdf").read_text().count('rgba="1 0 0 1"') == 2
    assert "defined with another color" in (tmp_path / "out" / "bundle.json").read_text()
    assert "adapted" not in urdftool("bundle", "r.urdf", "-o", "plain").err
