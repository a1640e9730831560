"""Export to URDF from SDF and MJCF."""

import json

import pytest

import urdftool as api
from tests.compare.test_verify import MJCF, SDF
from tests.conftest import FIXTURES

pytestmark = pytest.mark.usefixtures("stages_are_read_here")

READERS = FIXTURES / "readers"
mujoco = pytest.mark.library("mujoco")
FILES = [
    pytest.param("robot.sdf", SDF, id="sdf"),
    pytest.param("robot.xml", MJCF, id="mjcf", marks=mujoco),
]


@mujoco
def test_a_keyframe_of_several_trees_is_that_of_the_robot(tmp_path):
    source = FIXTURES / "formats" / "mjcf" / "platform.xml"
    written = api.export_urdf(api.load(source), tmp_path / "out.urdf", verify=True)
    assert [check.name for check in written.checks if check.verdict == "differs"] == []


@pytest.mark.parametrize(("name", "text"), FILES)
def test_the_result_equals_its_source(urdftool, write, name, text, tmp_path):
    result = urdftool(
        *("export", "urdf", write(name, text), "-o", tmp_path / "out.urdf", "--verify"),
        *("--format", "json"),
    )
    assert result.code == 0
    report = json.loads(result.out)
    verdicts = {check["check"]: check["verdict"] for check in report["checks"]}
    skipped = {name for name, verdict in verdicts.items() if verdict == "not compared"}
    assert skipped <= {"base", "gravity", "looks", "textures", "other data"}
    assert {verdicts[name] for name in verdicts.keys() - skipped} == {"equal", "none"}
    robot = api.load(tmp_path / "out.urdf")
    assert [joint.type for joint in robot.joints if not joint.is_fixed] == ["revolute", "prismatic"]
    assert (robot.joint["shoulder"].limit.lower, robot.joint["shoulder"].limit.upper) == (-1, 2)


DRAWN = """<mujoco><worldbody><body name="base"><freejoint/>
<geom name="seen" type="box" size="0.1 0.1 0.1" contype="0" conaffinity="0"/>
<geom name="hit" type="box" {}/></body></worldbody></mujoco>"""


@mujoco
@pytest.mark.parametrize(
    ("second", "names"),
    [
        ('size="0.1 0.1 0.1"', ["seen"]),
        ('size="0.1 0.1 0.1" rgba="1 0 0 1"', ["hit"]),  # the colored one
        ('size="0.1 0.1 0.1" pos="0 0 0.001"', ["seen", "hit"]),
        ('size="0.1 0.1 0.101"', ["seen", "hit"]),
    ],
)
def test_a_visual_that_is_drawn_twice_is_written_once(urdftool, write, tmp_path, second, names):
    source, target = write("r.xml", DRAWN.format(second)), tmp_path / "r.urdf"
    result = urdftool("export", "urdf", source, "-o", target, "--verify", "--strict")
    assert result.code == 0, result.err
    link = api.load(target).link["base"]
    assert [visual.name for visual in link.visuals] == names
    assert [collision.name for collision in link.collisions] == ["hit"]
    assert urdftool("verify", source, target).code == 0


@pytest.mark.parametrize("path", ["mechanism.sdf", pytest.param("mechanism.xml", marks=mujoco)])
def test_every_loss_of_a_mechanism_is_announced(urdftool, tmp_path, path):
    result = urdftool("export", "urdf", READERS / path, "-o", tmp_path / "out", "--verify")
    assert result.code == 0, result.err
    assert "[lossy-" in result.err
    assert len(list((tmp_path / "out").glob("*.urdf"))) == 1


def test_a_changed_export_differs(write):
    """The comparison of an export finds what the writer did not write."""
    from urdftool.formats.registry import format_named
    from urdftool.formats.urdf.checks import check_output
    from urdftool.formats.urdf.options import Options

    robot = format_named("sdf").read(write("robot.sdf", SDF)).robot
    options = Options(file="robot.urdf")
    written = format_named("urdf").write(robot, options)
    written.files["robot.urdf"] = written.files["robot.urdf"].replace(b'"0.7"', b'"0.8"')
    checks = check_output(robot, options, written, None)
    assert [check.name for check in checks if check.verdict == "differs"] == ["joint physics"]


def test_a_capsule_and_a_screw(urdftool, write, tmp_path):
    text = SDF.replace(
        "<cylinder><radius>0.05</radius><length>0.4</length></cylinder>",
        "<capsule><radius>0.05</radius><length>0.4</length></capsule>",
    )
    result = urdftool(
        *("export", "urdf", write("r.sdf", text), "-o", tmp_path / "r.urdf", "--verify"),
        *("--format", "json"),
    )
    assert result.code == 0
    report = json.loads(result.out)
    assert [f["rule"] for f in report["findings"]] == ["lossy-capsule"]
    verdicts = {check["check"]: check["verdict"] for check in report["checks"]}
    assert verdicts["collisions"] == "equal"
    shapes = api.load(tmp_path / "r.urdf").link["upper"].collisions
    assert len(shapes) == len({shape.name for shape in shapes}) == 3
    assert urdftool("verify", write("r.sdf", text), tmp_path / "r.urdf").code == 0
    assert urdftool("verify", tmp_path / "r.urdf", write("r.sdf", text)).code == 0
    longer = (tmp_path / "r.urdf").read_text().replace('length="0.4"', 'length="0.41"')
    for name, changed in (("length", longer), ("sphere", longer.replace("0 0 0.2", "0 0 0.21"))):
        (tmp_path / "c.urdf").write_text(changed)
        assert urdftool("verify", write("r.sdf", text), tmp_path / "c.urdf").code == 1, name
    text = text.replace("<capsule>", "<ellipsoid><radii>1 2 3</radii>").replace(
        "</capsule>", "</ellipsoid>"
    )
    result = urdftool("export", "urdf", write("r.sdf", text), "-o", tmp_path / "b", "--strict")
    assert result.code == 2
    assert not (tmp_path / "b").exists()


def test_nothing_is_written_without_the_mesh(urdftool, write, tmp_path):
    text = SDF.replace(
        "<box><size>0.2 0.3 0.1</size></box>", "<mesh><uri>meshes/gone.stl</uri></mesh>"
    )
    result = urdftool("export", "urdf", write("r.sdf", text), "-o", tmp_path / "out")
    assert result.code == 2
    assert "r.sdf:" in result.err
    assert not (tmp_path / "out").exists()


SCENE = """<mujoco model="bot"><worldbody>
  <geom name="floor" type="plane" size="0 0 1"/>
  <body name="ball" pos="1 0 0.5"><freejoint/><geom size="0.05" mass="0.2"/></body>
  <body name="base" pos="0 0 0.5"><freejoint/><geom type="box" size="0.2 0.1 0.05" mass="3"/>
    <body name="wheel" pos="0.1 0.1 0"><joint name="w" axis="0 1 0"/>
      <geom type="cylinder" size="0.06 0.02" euler="90 0 0" mass="0.4"/></body>
    <body name="arm" pos="0 0 0.1"><joint name="a" axis="0 0 1" range="-60 60"/>
      <geom type="capsule" size="0.02" fromto="0 0 0 0 0 0.3" mass="0.5"/></body>
  </body></worldbody>
  <actuator>
    <velocity name="w" joint="w" kv="3.5" forcerange="-4 4" ctrlrange="-9 9"/>
    <position name="a" joint="a" kp="30" kv="2" forcerange="-8 8" ctrlrange="-1 0.5"/>
  </actuator></mujoco>"""


@mujoco
def test_bodies_next_to_the_robot_are_left_out_and_named(write):
    robot = api.load(write("scene.xml", SCENE))
    written = api.export_urdf(robot, verify=True)
    assert {check.verdict for check in written.checks} <= {"equal", "none", "not compared"}
    assert {loss.code: loss.severity.name for loss in written.losses}["lossy-tree"] == "WARNING"
    made = api.load(write("bot.urdf", written.files[written.main].decode()))
    assert [link.name for link in made.links] == ["base", "wheel", "arm"]
    assert {joint.name: joint.type for joint in made.joints} == {"w": "continuous", "a": "revolute"}
    ball = api.export_urdf(robot, root="ball")
    assert b'<link name="ball">' in ball.files[ball.main]
    assert b'<link name="base">' not in ball.files[ball.main]
    with pytest.raises(api.errors.ModelError, match="its trees begin at 'ball', 'base'"):
        api.export_urdf(robot, root="bal")


@mujoco
def test_numbers_have_no_noise_and_gains_come_back(write):
    written = api.export_urdf(api.load(write("scene.xml", SCENE)))
    text = written.files[written.main].decode()
    assert "00000000" not in text.replace("1000000000", "")
    assert "e-1" not in text
    back = api.export_mjcf(api.load(write("bot.urdf", text)))
    model = back.files[back.main].decode()
    assert '<velocity name="w" joint="w" kv="3.5" ctrlrange="-9 9"/>' in model
    assert '<position name="a" joint="a" kp="30" kv="2" ctrlrange="-1 0.5"/>' in model
    assert "lossy-gains" not in {loss.code for loss in back.losses}


def test_two_actuators_of_one_joint_are_announced(write, urdftool, tmp_path):
    pytest.importorskip("mujoco")
    write(
        "m.xml",
        """<mujoco><worldbody><body><geom size="0.1"/><joint type="slide" name="s"/></body>
</worldbody>
<actuator><motor name="m" joint="s"/><velocity name="v" joint="s"/></actuator></mujoco>""",
    )
    result = urdftool("export", "urdf", "m.xml", "-o", tmp_path / "out", "--verify")
    assert result.code == 0
    assert "act together, but ros2_control has them as modes of one joint" in result.err
    assert "actuators: announced: joint 's': actuator is missing" in result.out


def test_what_is_not_of_urdf_in_a_joint_is_reported(write, tmp_path):
    joint = '<joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="1 0 0"'
    joint += ' speed="2"/><drive power="3"/></joint>'
    text = f'<robot name="r"><link name="a"/><link name="b"/>{joint}</robot>'
    written = api.export_urdf(api.load(write("r.urdf", text)), tmp_path / "out", verify=True)
    found = [loss.message for loss in written.losses if loss.code == "lossy-addition"]
    assert found == ["speed of <axis> of joint 'j' is dropped", "<drive> of joint 'j' is dropped"]
    (row,) = (check for check in written.checks if check.name == "simulator data")
    assert row.verdict == "announced"
