"""Stages of other tools: units, up axis, joint frames, planar joints, loops."""

import math

import pytest

import urdftool
from tests.formats.usd.stages import body, export, joint, link, robot, stage, turning

pytestmark = pytest.mark.library("pxr")


def test_units_are_converted(read):
    text = stage(
        body("a", at="(0, 0, 0)"),
        body("b", at="(100, 0, 0)"),
        turning("j", "a", "b", "        point3f physics:localPos0 = (100, 0, 0)"),
        unit=0.01,
    )
    robot = read(text).robot
    assert robot.joint["j"].origin.xyz == pytest.approx((1, 0, 0))
    assert robot.joint["j"].type == "continuous"
    assert robot.link["a"].inertial.inertia.ixx == pytest.approx(1e-4)


def test_y_up_turns_the_base(read):
    base = read(stage(body("a"), up="Y")).robot.base
    assert base.is_free
    assert base.origin.rpy == pytest.approx((math.pi / 2, 0, 0))


def test_a_link_moves_to_the_axis_of_its_joint(read):
    text = stage(
        body("a"),
        body("b", at="(1, 0, 0)"),
        turning(
            "j",
            "a",
            "b",
            "        point3f physics:localPos0 = (0.5, 0, 0)\n"
            "        point3f physics:localPos1 = (-0.5, 0, 0)",
        ),
    )
    robot = read(text).robot
    assert robot.joint["j"].origin.xyz == pytest.approx((0.5, 0, 0))
    assert robot.link["b"].inertial.origin.xyz == pytest.approx((0.5, 0, 0))
    assert [(frame.link, frame.kind) for frame in robot.frames] == [("b", "body")]


def test_a_joint_that_points_to_the_root_is_reversed(read):
    root = '    def PhysicsFixedJoint "hold"\n    {\n        rel physics:body1 = </r/a>\n    }\n'
    text = stage(body("a"), body("b"), turning("j", "b", "a"), root)
    robot = read(text).robot
    assert (robot.joint["j"].parent, robot.joint["j"].child) == ("a", "b")
    assert robot.joint["j"].axis.xyz == pytest.approx((0, 0, -1))
    assert not robot.base.is_free


def test_a_cycle_becomes_a_closure(read):
    text = stage(
        body("a"), body("b"), body("c"),
        turning("one", "a", "b"), turning("two", "b", "c"),
        turning("three", "c", "a", "        bool physics:excludeFromArticulation = 1"),
    )  # fmt: skip
    robot = read(text).robot
    assert sorted(robot.joint) == ["one", "two"]
    assert [(c.name, c.parent, c.child) for c in robot.closures] == [("three", "c", "a")]


def test_a_body_without_mass_is_reported(read):
    reading = read(stage(body("a", mass=0)))
    assert reading.robot.link["a"].inertial is None
    assert [loss.code for loss in reading.losses] == ["unread-mass"]


def test_places_are_lines_of_the_text(read):
    text = stage(body("a"), body("b"))
    place = read(text).robot.link["b"].place
    assert text[place.start :].startswith('def Xform "b"')


@pytest.mark.parametrize("text", ["", "#usda 1.0\n(", "not usd", "#usda 1.0\n"])
def test_a_damaged_stage_is_an_error_with_a_place(read, text):
    from urdftool.errors import UrdftoolError

    with pytest.raises(UrdftoolError) as error:
        read(text)
    assert error.value.message


def test_planar_and_ball_joints_come_back(write, tmp_path):
    from urdftool.formats.usd.read import read

    path = write("r.urdf", robot(
        link("a"), link("b"), link("c"),
        joint("p", "a", "b", "planar", '<axis xyz="0 1 0"/>'),
        joint("q", "b", "c", "floating"),
    ))  # fmt: skip
    written = export(path, file="r.usda")
    made = write("r.usda", written.files["r.usda"])
    back = read(made, mesh_folder=tmp_path).robot
    assert back.joint["p"].type == "planar"
    assert back.joint["p"].axis.xyz == pytest.approx((0, 1, 0))
    assert (back.joint["q"].type, back.joint["q"].parent) == ("floating", "b")


def test_a_joint_of_a_link_without_mass_in_the_world(tmp_path):
    """The link is no rigid body, so the joint holds the world in the stage."""
    body = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
    (tmp_path / "r.urdf").write_text(
        f'<robot name="r"><link name="world"/><link name="a">{body}</inertial></link>'
        '<joint name="j" type="revolute"><parent link="world"/><child link="a"/>'
        '<origin xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>'
    )
    urdftool.export_usd(urdftool.load(tmp_path / "r.urdf"), tmp_path / "r.usda")
    robot = urdftool.load(tmp_path / "r.usda")
    assert [link.name for link in robot.tree.roots] == ["world"]
    assert [(j.name, j.type, j.parent) for j in robot.joints] == [("j", "revolute", "world")]
    assert urdftool.verify(tmp_path / "r.urdf", robot).is_equal


HOLD = """    def PhysicsFixedJoint "hold"
    {{
        rel physics:body1 = </r/a>
        bool physics:jointEnabled = {}
    }}
"""


@pytest.mark.parametrize("enabled", [True, False])
def test_a_disabled_joint_to_the_world_holds_no_base(read, enabled):
    robot = read(stage(body("a"), HOLD.format(int(enabled)))).robot
    assert robot.base.is_free is not enabled


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('FixedJoint "root_joint"', 'FixedJoint "root_joint" (active = false)'),
        ("rel physics:body1 = </r/a>", "bool physics:jointEnabled = 0\nrel physics:body1 = </r/a>"),
    ],
)
def test_a_stored_link_world_does_not_hold_a_base(tmp_path, old, new):
    body_ = '<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
    (tmp_path / "r.urdf").write_text(
        f'<robot name="r"><link name="world"/><link name="a">{body_}</inertial></link>'
        '<joint name="w" type="fixed"><parent link="world"/><child link="a"/></joint></robot>'
    )
    urdftool.export_usd(urdftool.load(tmp_path / "r.urdf"), tmp_path / "r.usda")
    text = (tmp_path / "r.usda").read_text()
    assert old in text
    (tmp_path / "r.usda").write_text(text.replace(old, new))
    robot = urdftool.load(tmp_path / "r.usda")
    assert robot.base.is_free
    assert [link.name for link in robot.links] == ["a"]
    verified = urdftool.verify(tmp_path / "r.urdf", robot)
    assert not verified.is_equal


@pytest.mark.parametrize(
    ("at", "kind", "is_apart"),
    [
        ("(0, 0, 0)", "Revolute", False),
        ("(0.01, 0, 0)", "Revolute", True),
        ("(0, 0, 0.01)", "Revolute", True),
        ("(0, 0, 0.01)", "Prismatic", False),
        ("(0.01, 0, 0.01)", "Prismatic", True),
        ("(0.00001, 0, 0)", "Fixed", False),
        ("(0, 0.01, 0)", "Fixed", True),
        ("(0, 0.01, 0)", "Spherical", True),
    ],
)
def test_a_body_apart_from_its_joint_is_reported(read, at, kind, is_apart):
    text = stage(body("a"), body("b", at=at), turning("j", "a", "b"))
    reading = read(text.replace("PhysicsRevoluteJoint", f"Physics{kind}Joint"))
    codes = [loss.code for loss in reading.losses]
    assert ("unread-joint-apart" in codes) is is_apart


@pytest.mark.parametrize("value", [90, 180])
def test_attributes_that_contradict_each_other_are_reported(read, value):
    more = (
        "        float newton:velocityLimit = 90\n"
        f"        float physxJoint:maxJointVelocity = {value}"
    )
    reading = read(stage(body("a"), body("b"), turning("j", "a", "b", more)))
    assert reading.robot.joint["j"].limit.velocity == pytest.approx(math.pi / 2)
    found = [loss for loss in reading.losses if loss.code == "unread-contradiction"]
    assert len(found) == (value != 90)
