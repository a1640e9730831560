"""Export of robots that were read from SDF or MJCF, compared with their source."""

from dataclasses import replace

import pytest

import urdftool as api
from tests.conftest import FIXTURES
from tests.formats.defective import joint, link, mjcf, sdf
from urdftool.compare.compare import compare_robots
from urdftool.model.elements import Origin

READERS = FIXTURES / "readers"
FORMATS = FIXTURES / "formats"
ROBOTS = {
    "mechanism of MJCF": READERS / "mechanism.xml",
    "arm of MJCF": FORMATS / "mjcf" / "arm.xml",
    "gripper of SDF": FORMATS / "sdf" / "gripper_arm.gz.sdf",
}
BOX = '<geom type="box" size=".1 .1 .1"/>'

pytestmark = [
    pytest.mark.library("mujoco"),
    pytest.mark.usefixtures("stages_are_read_here"),
]


def differing(written):
    return {check.name: check.differing for check in written.checks if check.differing}


@pytest.mark.parametrize("path", ROBOTS.values(), ids=ROBOTS)
@pytest.mark.parametrize("export", [api.export_sdf, api.export_mjcf])
def test_an_export_equals_its_source(path, export, tmp_path):
    written = export(api.load(path), tmp_path / "out", verify=True)
    assert len(written.checks) > 5
    assert differing(written) == {}


def test_every_part_that_is_left_out_is_reported():
    robot = api.load(READERS / "mechanism.xml")
    written = api.export_sdf(robot)
    codes = {loss.code for loss in written.losses}
    assert {"lossy-closure", "lossy-joint-actuator", "lossy-joint-armature"} <= codes
    assert {loss.code for loss in robot.unread} <= codes
    assert all(loss.location.path for loss in written.losses)


@pytest.mark.parametrize(
    ("body", "fixed"),
    [(f'<body name="a">\n{BOX}</body>', True), (f'<body name="a"><freejoint/>{BOX}</body>', False)],
)
def test_the_base_is_as_in_the_source(write, body, fixed, tmp_path):
    robot = api.load(write("m.xml", mjcf(body)))
    text = api.export_sdf(robot, tmp_path / "a.sdf", verify=True).text
    assert ("<parent>world</parent>" in text) is fixed
    text = api.export_mjcf(robot, tmp_path / "a.xml", verify=True).text
    assert ("<freejoint" in text) is not fixed


def test_a_slide_without_limits_stays_so(write):
    robot = api.load(write("m.sdf", sdf(link("a") + link("b") + joint("a", "b", kind="prismatic"))))
    assert " range=" not in api.export_mjcf(robot).text.partition("<worldbody>")[2]
    again = api.load(write("m.xml", api.export_mjcf(robot).text))
    assert "<lower>" not in api.export_sdf(again).text


def test_a_world_without_a_body_is_no_model_of_sdf(write):
    robot = api.load(write("m.xml", mjcf('<body name="a"/><body name="b"/>')))
    with pytest.raises(api.UrdftoolError) as refused:
        api.export_sdf(api.load(write("n.xml", mjcf('<geom type="plane" size="1 1 1"/>'))))
    assert refused.value.path
    assert robot.links


@pytest.mark.parametrize("kind", ["sdf", "mjcf"])
def test_the_command_takes_any_format(urdftool, kind, tmp_path):
    for path in (ROBOTS["arm of MJCF"], ROBOTS["gripper of SDF"]):
        result = urdftool("export", kind, path, "-o", tmp_path / path.stem, "--verify")
        assert result.code == 0, result.err
        assert "differs" not in result.out


def test_strict_counts_what_was_not_read(urdftool, tmp_path):
    path = READERS / "mechanism.xml"
    result = urdftool("export", "sdf", path, "-o", tmp_path / "a.sdf", "--strict")
    assert result.code == 2
    assert result.err.count("[unread-actuator]") == 1
    assert not (tmp_path / "a.sdf").exists()


SDF_TYPO = """
<sdf version="1.9"><model name="m"><link name="a"><inertial><mass>1</mass><inertia>
<ixx>0.0066</ixx><iyy>0.0066</iyy><izz>0.00066</izz></inertia></inertial>
<collision name="c"><geometry><box><size>.2 .2 .2</size></box></geometry></collision>
</link></model></sdf>
"""
MJCF_TYPO = """
<mujoco><worldbody><body name="a"><freejoint/>
<inertial pos="0 0 0" mass="1" diaginertia="0.0066 0.0066 0.00066" quat="1 1 0 0"/>
<geom type="box" size=".1 .1 .1"/></body></worldbody></mujoco>
"""


def test_a_proposed_tensor_has_the_syntax_of_the_file(urdftool, write):
    result = urdftool("inertia", "robot", write("m.sdf", SDF_TYPO))
    assert "<inertia><ixx>0.0066</ixx><ixy>0</ixy>" in result.out
    assert "ixx=" not in result.out


@pytest.mark.library("mujoco")
def test_a_proposed_tensor_of_mjcf_is_in_the_axes_of_the_body(urdftool, write):
    result = urdftool("inertia", "robot", write("m.xml", MJCF_TYPO))
    assert 'diaginertia="0.0066 0.0066 0.0066", without quat' in result.out
    turned = MJCF_TYPO.replace('size=".1 .1 .1"', 'size=".1 .1 .05"').replace("1 1 0 0", "1 0 0 1")
    robot = urdftool("inertia", "robot", write("n.xml", turned.replace("0.00066", "0.0006")))
    assert "<inertia" not in robot.out


def test_an_inertia_without_mass_is_the_reason(urdftool, write):
    text = SDF_TYPO.replace("<mass>1</mass>", "<mass>0</mass>").replace("0.00066", "0.0066")
    result = urdftool("export", "mjcf", write("m.sdf", text))
    assert (result.code, "but no mass" in result.err) == (2, True)


@pytest.mark.library("pxr")
def test_usd_is_written_from_every_format(urdftool, write, tmp_path):
    path = write("m.sdf", SDF_TYPO)
    result = urdftool("export", "usd", path, "-o", tmp_path / "m.usda", "--verify")
    assert result.code == 0, result.err


@pytest.mark.library("pxr")
def test_a_ball_that_closes_a_loop_is_a_point_in_usd(write, tmp_path):
    """SDF names the joint, MJCF and the reader of USD the constraint; both are the same."""
    body = link("a") + link("b") + link("c") + joint("a", "b") + joint("a", "c", name="k")
    loop = '<joint name="loop" type="ball"><parent>b</parent><child>c</child></joint>'
    robot = api.load(write("m.sdf", sdf(body + loop)))
    (row,) = (
        check
        for check in api.export_usd(robot, tmp_path / "m.usda", verify=True).checks
        if check.name == "loops"
    )
    assert row.verdict == "equal"
    moved = replace(robot, closures=[replace(robot.closures[0], origin=Origin(xyz=(0, 0, 1)))])
    comparison = compare_robots(robot, moved)
    assert {difference.row for difference in comparison.differences} == {"loops"}


SLIDER = """<sdf version="1.9"><model name="m">{}<link name="a"><visual name="v"><geometry>
<box><size>1 1 1</size></box></geometry><material><diffuse>0 1 0 1</diffuse></material></visual>
</link><link name="b"/><joint name="j" type="prismatic"><parent>a</parent><child>b</child>
<axis><xyz>0 0 1</xyz></axis></joint></model></sdf>"""


@pytest.mark.parametrize("static", ["", "<static>true</static>"])
def test_static_models_and_ambient_light_in_urdf(tmp_path, static):
    (tmp_path / "a.sdf").write_text(SLIDER.format(static))
    written = api.export_urdf(api.load(tmp_path / "a.sdf"), tmp_path / "u", verify=True)
    assert [check.name for check in written.checks if check.verdict == "differs"] == []
    assert "lossy-appearance" in {loss.code for loss in written.losses}


def test_a_slide_without_limits_compiles(tmp_path):
    (tmp_path / "a.sdf").write_text(SLIDER.format(""))
    written = api.export_mjcf(api.load(tmp_path / "a.sdf"), tmp_path / "m", verify=True)
    assert "inheritrange" not in written.text


BALL = 'type="ball" damping="0.1" frictionloss="0.02"'
PLANAR = (
    '<robot name="p"><link name="a"/><link name="b"/><joint name="j" type="planar"><parent '
    'link="a"/><child link="b"/><axis xyz="0 0 1"/><dynamics damping="0.3"/></joint></robot>'
)


@pytest.mark.library("pxr")
@pytest.mark.parametrize("kind", ["sdf", "usd", "urdf"])
def test_lost_resistance_of_a_ball_joint_is_reported(kind, urdftool, write, tmp_path):
    body = f'<body name="a">{BOX}<body name="b"><joint name="j" {BALL}/>{BOX}</body></body>'
    out = tmp_path / "out"
    result = urdftool("export", kind, write("m.xml", mjcf(body)), "-o", out, "--verify")
    assert result.code == 0, result.out
    (line,) = (line for line in result.err.splitlines() if "friction" in line)
    assert "damping" in line
    assert "'j'" in line


@pytest.mark.library("pxr")
def test_resistance_of_a_planar_joint_is_written_or_reported(write, tmp_path):
    robot = api.load(write("p.urdf", PLANAR))
    written = api.export_usd(robot, tmp_path / "p.usda", verify=True)
    assert differing(written) == {}
    assert "lossy-joint-resistance" in {loss.code for loss in written.losses}
    again = api.load(write("p.sdf", api.export_sdf(robot).text))
    assert {j.name: j.get_resistance("damping") for j in again.joints if j.has_axis} == {
        "j_x": 0.3, "j_y": 0.3, "j": 0.3,
    }  # fmt: skip


def test_a_site_of_the_world_is_no_frame_of_an_sdf(write):
    """A frame of a model of SDF cannot be attached to the world."""
    body = f'<site name="target"/><body name="a">{BOX}</body><body name="b">{BOX}<site name="s"/>'
    written = api.export_sdf(api.load(write("m.xml", mjcf(f"{body}</body>"))))
    assert 'attached_to="world"' not in written.text
    assert '<frame name="s" attached_to="b"' in written.text
    assert [loss.name for loss in written.losses if loss.code == "lossy-frame"] == ["target"]


@pytest.mark.library("pxr")
def test_what_a_reader_left_out_is_not_compared_with_a_stage(write, tmp_path):
    """The elements of an MJCF are compared in another MJCF only."""
    body = f'<body name="a">{BOX}<body name="b"><joint name="j"/>{BOX}<body name="c">'
    body += f'<joint name="k"/>{BOX}</body></body></body>'
    rest = '<equality><joint joint1="k" joint2="j" polycoef="0 1 2 0 0"/></equality><actuator>'
    rest += '<muscle joint="j" ctrlrange="0 1" lengthrange="-1 1"/></actuator></mujoco>'
    robot = api.load(write("m.xml", mjcf(body).replace("</mujoco>", rest)))
    rows = {c.name: c for c in api.export_usd(robot, tmp_path / "m.usda", verify=True).checks}
    assert {rows[name].verdict for name in ("tree", "actuators")} == {"not compared"}
