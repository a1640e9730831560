"""The robot as read, however broken, and its tree."""

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from urdftool import load
from urdftool.errors import ModelError
from urdftool.model import pose
from urdftool.model.elements import Box, Capsule, Cylinder, Mesh, Sphere, UnknownShape


@pytest.fixture
def robot(write):
    """A robot of what stands inside ``<robot>``."""
    return lambda inside: load(write("r.urdf", f'<robot name="r">\n{inside}\n</robot>'))


LINK = '<link name="{}"/>'
JOINT = '<joint name="{0}_{1}" type="{2}"><parent link="{0}"/><child link="{1}"/></joint>'


def chain(*names, kind="fixed"):
    links = "".join(map(LINK.format, names))
    return links + "".join(JOINT.format(a, b, kind) for a, b in pairwise(names))


def test_values_are_as_written(robot):
    (link,) = robot(
        '<link name="a"><inertial><origin xyz="1 2 3" rpy="0.1 0.2 0.3"/><mass value="4"/>'
        '<inertia ixx="1" ixy="2" ixz="3" iyy="4" iyz="5" izz="6"/></inertial>'
        '<visual name="v"><geometry><mesh filename="a.stl" scale="1 2 -1"/></geometry>'
        '<material name="red"><color rgba="1 0 0 1"/></material></visual>'
        '<collision><geometry><box size="1 2 3"/></geometry></collision></link>'
    ).links
    assert link.mass == 4
    assert link.inertial.origin.rpy == (0.1, 0.2, 0.3)
    assert link.inertial.inertia.moments == (1, 4, 6)
    assert link.inertial.inertia.products == (2, 3, 5)
    (visual,), (collision,) = link.visuals, link.collisions
    assert isinstance(visual.geometry, Mesh)
    assert visual.geometry.scale == (1, 2, -1)
    assert visual.material.color == (1, 0, 0, 1)
    assert isinstance(collision.geometry, Box)
    assert collision.geometry.size == (1, 2, 3)


@pytest.mark.parametrize(
    ("shape", "kind"),
    [
        ('<cylinder radius="1" length="2"/>', Cylinder),
        ('<sphere radius="1"/>', Sphere),
        ('<capsule radius="1" length="2"/>', Capsule),
        ("<cone/>", UnknownShape),
    ],
)
def test_shapes(robot, shape, kind):
    inside = f'<link name="a"><visual><geometry>{shape}</geometry></visual></link>'
    assert isinstance(robot(inside).links[0].visuals[0].geometry, kind)


def test_what_cannot_be_read_has_its_default(robot):
    broken = robot(
        '<link name="a"><inertial><mass value="heavy"/></inertial>'
        '<visual><origin xyz="1 2"/><geometry/></visual><visual/></link>'
        '<joint name="j" type="revolute"><limit lower="nan"/><axis xyz="x"/></joint>'
    )
    (link,), (joint,) = broken.links, broken.joints
    assert link.inertial.mass is None
    assert link.mass == 0
    assert link.visuals[0].origin.xyz == (0, 0, 0)
    assert link.visuals[0].geometry is None
    assert joint.limit.lower is None
    assert joint.axis.xyz == (1, 0, 0)
    assert joint.parent == joint.child == ""


def test_gazebo_transmissions_and_ros2_control(robot):
    read = robot(
        '<gazebo reference="a"><mu1>0.5</mu1><kp value="10"/><sensor name="s" type=" camera ">'
        '<plugin name="p" filename="lib.so"/></sensor></gazebo>'
        '<transmission name="t"><type>x/Simple</type><joint name="j"><hardwareInterface>Effort'
        '</hardwareInterface></joint><actuator name="m"><mechanicalReduction>50'
        "</mechanicalReduction></actuator></transmission>"
        '<ros2_control name="c" type="system"><hardware><plugin>a/B</plugin></hardware>'
        '<joint name="j"><command_interface name="position"><param name="min">-1</param>'
        "</command_interface></joint></ros2_control>"
    )
    (block,) = read.extensions["a"]
    assert (block.get_value("mu1"), block.get_value("kp"), block.get_value("kd")) == (
        "0.5",
        "10",
        None,
    )
    assert block.sensors[0].type == "camera"
    assert [plugin.filename for plugin in read.plugins] == ["lib.so"]
    (transmission,) = read.transmissions
    assert transmission.type == "x/Simple"
    assert transmission.joints[0].hardware_interfaces == ["Effort"]
    assert transmission.actuators[0].mechanical_reduction == 50
    (control,) = read.ros2_controls
    assert control.plugin == "a/B"
    assert control.joints[0].command_interfaces[0].params == {"min": "-1"}


def test_every_part_knows_its_place(robot):
    read = robot('<link name="a">\n  <visual>\n    <geometry/>\n  </visual>\n</link>')
    assert str(read.links[0].place) == "r.urdf:2:1"
    assert str(read.links[0].visuals[0].place) == "r.urdf:3:3"


def test_a_file_of_another_kind_is_no_robot(write):
    with pytest.raises(ModelError, match="no model with a link"):
        load(write("w.urdf", '<sdf version="1.9"/>'))


def test_links_of_one_name_are_both_there(robot):
    read = robot('<link name="a"/>\n<link name="a"/>')
    assert len(read.links) == 2
    assert read.link["a"].place.line == 2


# The tree ------------------------------------------------------------------------------------


def test_a_chain(robot):
    tree = robot(chain("a", "b", "c")).tree
    assert tree.root.name == "a"
    assert tree.order == ["a", "b", "c"]
    assert list(tree.list_ancestors("c")) == ["b", "a"]
    assert list(tree.list_descendants("a")) == ["b", "c"]
    assert tree.detached == []


def test_faults_are_facts(robot):
    two = robot(LINK.format("a") + LINK.format("b")).tree
    assert [link.name for link in two.roots] == ["a", "b"]
    assert two.root is None
    loop = robot(chain("a", "b") + chain("x", "y") + JOINT.format("y", "x", "fixed")).tree
    assert [link.name for link in loop.detached] == ["x", "y"]
    assert list(loop.list_ancestors("x")) == ["y"]
    parents = robot(chain("a", "b") + LINK.format("c") + JOINT.format("c", "b", "fixed")).tree
    assert [joint.parent for joint in parents.joints_of_child["b"]] == ["a", "c"]
    itself = robot(LINK.format("a") + JOINT.format("a", "a", "fixed")).tree
    assert itself.roots == []
    assert list(itself.list_descendants("a")) == []


def test_rigid_bodies_are_joined_by_fixed_joints(robot):
    inside = chain("base", "mount") + LINK.format("arm") + LINK.format("tool")
    inside += JOINT.format("mount", "arm", "revolute") + JOINT.format("arm", "tool", "fixed")
    tree = robot(inside).tree
    assert tree.bodies == {"base": "base", "mount": "base", "arm": "arm", "tool": "arm"}
    assert tree.body_links == {"base": ["base", "mount"], "arm": ["arm", "tool"]}


# Poses ---------------------------------------------------------------------------------------

angles = st.floats(-4, 4) | st.sampled_from([0.0, math.pi / 2, -math.pi / 2, math.pi])
vectors = st.tuples(angles, angles, angles)


def close(a, b):
    return all(
        abs(x - y) < 1e-9
        for row, other in zip(a, b, strict=True)
        for x, y in zip(row, other, strict=True)
    )


@given(vectors)
def test_rpy_and_back(rpy):
    rotation = pose.rotation_from_rpy(rpy)
    assert close(pose.rotation_from_rpy(pose.rpy_from_rotation(rotation)), rotation)
    assert close(pose.rotation_from_quaternion(pose.quaternion_from_rpy(rpy)), rotation)


@given(vectors, vectors, vectors)
def test_a_pose_and_its_inverse_cancel(rpy, xyz, point):
    there = pose.Pose(pose.rotation_from_rpy(rpy), xyz)
    assert close([(there.invert() @ there).transform(point)], [point])
    assert close([there.invert().transform(there.transform(point))], [point])


def test_rpy_turns_about_fixed_axes_in_order():
    x, y, z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    quarter = math.pi / 2
    assert close([pose.rotate(pose.rotation_from_rpy((quarter, 0, 0)), y)], [z])
    assert close([pose.rotate(pose.rotation_from_rpy((0, quarter, 0)), z)], [x])
    assert close([pose.rotate(pose.rotation_from_rpy((0, 0, quarter)), x)], [y])
    # roll first, then yaw, both about the axes of the parent: y goes to z and stays there
    assert close([pose.rotate(pose.rotation_from_rpy((quarter, 0, quarter)), y)], [z])
