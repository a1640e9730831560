"""Export of robots that were read from SDF or MJCF, compared with their source."""

import math
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


PENDULUM = """<mujoco model="p"><worldbody><body name="b" pos="0 0 1" euler="{} 0 0">
<geom type="box" size=".05 .05 .05"/><body name="l"><joint name="j" axis="0 0 1" range="-90 90"/>
<geom type="capsule" fromto="0 0 0 .5 0 0" size=".02" mass="1"/></body></body></worldbody>
</mujoco>"""


def test_the_tilt_of_a_fixed_base_is_in_its_gravity(write, tmp_path):
    """The joint is vertical, and bears no weight, unless the base is tilted."""
    tilted, level = (write(f"{a}.xml", PENDULUM.format(a)) for a in (90, 0))
    rows = [(one.row, one.what) for one in api.verify(tilted, level).list_disagreements()]
    assert rows == [("gravity", "gravity")]
    for path, codes in ((tilted, set()), (level, {"lossy-base-pose"})):
        out = tmp_path / f"out-{len(codes)}"
        written = api.export_urdf(api.load(path), out, verify=True)
        assert differing(written) == {}
        assert {loss.code for loss in written.losses} & {"lossy-base-pose"} == codes
        assert ('<link name="world"/>' in written.text) is (path is tilted)
        assert api.verify(path, out / "p.urdf").is_equal


def test_the_tilt_of_a_fixed_base_is_compared_without_joints(write, tmp_path):
    """A plate without joints has no forces that show how it is mounted."""
    rigid = (
        '<mujoco><worldbody><body name="b" pos="0 0 1" euler="{}">{}</body></worldbody></mujoco>'
    )
    box = '<geom type="box" size=".05 .05 .2" mass="1"/>'
    angles = {"tilted": "90 0 0", "level": "0 0 0", "turned": "0 0 30"}
    paths = {name: write(f"{name}.xml", rigid.format(a, box)) for name, a in angles.items()}
    (change,) = api.verify(paths["tilted"], paths["level"]).list_disagreements()
    assert (change.row, change.what) == ("base", "direction of gravity")
    assert list(change.values) == [(0.0, -1.0, 0.0), (0.0, 0.0, -1.0)]
    assert api.verify(paths["turned"], paths["level"]).is_equal
    free = box + "<freejoint/>"
    free = [write(f"free-{a[:2]}.xml", rigid.format(a, free)) for a in ("90 0 0", "0 0 0")]
    assert api.verify(*free).is_equal
    written = api.export_urdf(api.load(paths["tilted"]), tmp_path / "out", verify=True)
    assert differing(written) == {}


def test_a_simulation_begins_with_the_tilt_of_the_base(write):
    from urdftool.api.start import choose_start
    from urdftool.simulation.settings import Settings

    settings, _ = choose_start(api.load(write("m.xml", PENDULUM.format(90))), Settings())
    assert settings.upright_rpy == pytest.approx((math.pi / 2, 0, 0))


@pytest.mark.library("pxr")
def test_several_actuators_of_a_joint_are_one_drive_of_usd(write, tmp_path):
    drives = '<actuator><position name="p" joint="j" kp="30" forcerange="-4 4"/><motor name="m" '
    drives += 'joint="j" ctrlrange="-9 9"/></actuator></mujoco>'
    robot = api.load(write("m.xml", PENDULUM.format(0).replace("</mujoco>", drives)))
    written = api.export_usd(robot, tmp_path / "m.usda", verify=True)
    (row,) = (check for check in written.checks if check.name == "actuators")
    assert row.verdict == "announced"
    assert [loss.name for loss in written.losses if loss.code == "lossy-actuator"] == ["j"]


SHIFTED = """<mujoco model="p"><worldbody><body name="b"><geom size=".1" mass="1"/>
<body name="c" pos="0 .4 0"><joint name="j" pos="0 .2 .1" axis="1 0 0" range="-60 60"/>
<geom size=".1" mass="1"/></body></body></worldbody></mujoco>"""
"""A body whose joint is not at its frame."""


@pytest.mark.library("pxr")
@pytest.mark.parametrize("kind", ["sdf", "usd", "urdf"])
def test_a_frame_that_moves_to_its_joint_is_announced(kind, write, tmp_path):
    written = getattr(api, f"export_{kind}")(
        api.load(write("m.xml", SHIFTED)), tmp_path / "out", verify=True
    )
    (row,) = (check for check in written.checks if check.name == "frames")
    assert row.verdict == "announced"
    assert "'c'" in row.announced[0]
    moved = [loss.name for loss in written.losses if loss.code == "lossy-link-frame"]
    assert moved == ["c"]


def test_bodies_keep_the_frames_of_the_links_of_an_sdf(write, tmp_path):
    import mujoco

    model = api.export_sdf(api.load(write("m.xml", SHIFTED))).text
    model = model.replace('<pose relative_to="j">0 0 0 0 0 0</pose>', "<pose>0 .4 0 0 0 0</pose>")
    model = model.replace('<pose relative_to="b">', '<pose relative_to="__model__">')
    written = api.export_mjcf(api.load(write("m.sdf", model)), tmp_path / "out", verify=True)
    assert differing(written) == {}
    compiled = mujoco.MjModel.from_xml_string(written.text)
    assert compiled.body("c").pos == pytest.approx((0, 0.4, 0))
    assert compiled.joint("j").pos == pytest.approx((0, 0.2, 0.1))


def test_a_simulation_has_the_bodies_at_their_joints(write):
    (verdict,) = api.simulate(api.load(write("m.xml", SHIFTED)), engine="mujoco")
    assert verdict.run.recording.read_back == []


@pytest.mark.library("pxr")
def test_a_law_that_no_drive_has_is_announced(write, tmp_path):
    drive = '<actuator><general name="g" joint="j" gainprm="8" biastype="affine" '
    drive += 'biasprm="0.5 -8 -0.2"/></actuator></mujoco>'
    robot = api.load(write("m.xml", PENDULUM.format(0).replace("</mujoco>", drive)))
    written = api.export_usd(robot, tmp_path / "m.usda", verify=True)
    (row,) = (check for check in written.checks if check.name == "actuators")
    assert row.verdict == "announced"
    assert [loss.name for loss in written.losses if loss.code == "lossy-actuator"] == ["j"]


@pytest.mark.library("pxr")
def test_a_loop_that_is_switched_off_stays_so_in_usd(write, tmp_path):
    loop = '<equality><connect body1="b" body2="l" anchor="0 0 0" active="false"/></equality>'
    robot = api.load(write("m.xml", PENDULUM.format(0).replace("</mujoco>", f"{loop}</mujoco>")))
    written = api.export_usd(robot, tmp_path / "m.usda", verify=True)
    (row,) = (check for check in written.checks if check.name == "loops")
    assert row.verdict == "equal"
    (closure,) = api.load(tmp_path / "m.usda").closures
    assert closure.is_active is False


@pytest.mark.library("pxr")
@pytest.mark.parametrize("kind", ["sdf", "mjcf", "usd", "urdf"])
def test_negative_damping_is_reported(kind, write, tmp_path):
    text = PLANAR.replace("planar", "continuous").replace('"0.3"', '"-0.3"')
    body = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
    text = text.replace('"b"/><joint', f'"b">{body}</inertial></link><joint')
    written = getattr(api, f"export_{kind}")(
        api.load(write("p.urdf", text)), tmp_path / "out", verify=True
    )
    assert differing(written) == {}
    assert "lossy-negative-dynamics" in {loss.code for loss in written.losses}


@pytest.mark.library("pxr")
@pytest.mark.parametrize(
    ("flag", "rows"), [("limit", {"limits"}), ("gravity", {"gravity"}), ("equality", {"tree"})]
)
def test_rows_that_a_world_decides_are_not_compared_with_a_stage(flag, rows, write, tmp_path):
    option = f'<option><flag {flag}="disable"/></option></mujoco>'
    robot = api.load(write("m.xml", PENDULUM.format(90).replace("</mujoco>", option)))
    checks = api.export_usd(robot, tmp_path / "m.usda", verify=True).checks
    assert {c.name for c in checks if "setting of the world" in c.skipped} >= rows
    assert differing(api.export_mjcf(robot, tmp_path / "out", verify=True)) == {}


def test_a_camera_below_a_ball_joint_stays_where_it_is(write, tmp_path):
    body = f'<body name="a">{BOX}<body name="b"><joint type="ball"/>{BOX}<camera name="c" {{}}/>'
    source = write("m.xml", mjcf(body.format('pos="0 0 .1"') + "</body></body>"))
    out = tmp_path / "out"
    assert differing(api.export_urdf(api.load(source), out, verify=True)) == {}
    moved = write("n.xml", mjcf(body.format('pos="0 0 .2"') + "</body></body>"))
    (target,) = out.glob("*.urdf")
    found = {one.what for one in api.verify(moved, target).list_disagreements()}
    assert "pose in the link" in found


def test_an_inertia_that_is_wrong_by_rounding_is_called_so(write):
    body = f'<inertial><mass value="1"/><inertia ixx="0.1" iyy="0.2" izz="{0.3 + 1e-8}" ixy="0" '
    body += 'ixz="0" iyz="0"/></inertial>'
    text = PLANAR.replace('"b"/><joint', f'"b">{body}</link><joint').replace("planar", "fixed")
    losses = api.export_mjcf(api.load(write("p.urdf", text))).losses
    assert any("only by rounding" in loss.message for loss in losses)


def test_a_light_wider_than_a_half_space_stays_so(write, tmp_path):
    light = '<light name="l" cutoff="100" dir="0 0 -1"/>'
    robot = api.load(write("m.xml", mjcf(f'<body name="a">{BOX}{light}</body>')))
    written = api.export_mjcf(robot, tmp_path / "out", verify=True)
    assert differing(written) == {}
    assert 'cutoff="100"' in written.text
