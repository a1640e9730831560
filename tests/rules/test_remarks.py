"""What nobody would act on is a remark, or not reported."""

import pytest

from urdftool import check
from urdftool.diagnostic import Severity

PAIR = (
    '<robot name="r"><link name="a"/><link name="b"/>{}<joint name="j" type="revolute">'
    '<parent link="a"/><child link="b"/><axis xyz="0 0 1"/><limit {}/></joint></robot>'
)
LIMIT = 'lower="-1" upper="1" effort="1" velocity="1"'


def found(path, rule, **options):
    return [f for f in check(path, select=[rule], **options) if f.code == rule]


def test_an_attribute_of_another_program_is_a_remark_beside_all_that_is_required(write):
    for limit, severity in ((LIMIT, Severity.INFO), ('effort="1"', Severity.WARNING)):
        path = write("r.urdf", PAIR.format("", f'{limit} current="3"'))
        (finding,) = found(path, "unknown-attribute")
        assert finding.severity is severity


def test_an_element_of_another_program_is_a_remark_and_a_slip_an_error(write):
    for tag, severity in (("self_filter", Severity.INFO), ("lnk", Severity.ERROR)):
        path = write("r.urdf", PAIR.format(f'<{tag} name="x"/>', LIMIT))
        (finding,) = found(path, "unknown-element")
        assert finding.severity is severity


@pytest.mark.parametrize(
    ("mesh", "text", "severity"),
    [
        ("m.obj", "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", Severity.INFO),
        ("m.gltf", '{"buffers": [{"uri": "gone.bin"}]}', Severity.WARNING),
    ],
)
def test_a_mesh_without_its_colors_is_a_remark(write, mesh, text, severity):
    write(mesh, text)
    visual = f'<visual><geometry><mesh filename="{mesh}"/></geometry></visual>'
    path = write("r.urdf", f'<robot name="r"><link name="a">{visual}</link></robot>')
    (finding,) = found(path, "missing-mesh-dependency")
    assert finding.severity is severity


@pytest.mark.parametrize(
    ("plugin", "count"),
    [("libgazebo_ros_control.so", 0), ("gazebo_ros_control", 0), ("libgazebo_ros_laser.so", 1)],
)
def test_transmissions_that_a_plugin_of_ros_1_reads_are_in_place(write, plugin, count):
    more = '<transmission name="t"><type>x</type><joint name="j"/></transmission>'
    more += f'<gazebo><plugin name="p" filename="{plugin}"/></gazebo>'
    more += '<ros2_control name="s" type="system"/>'
    path = write("r.urdf", PAIR.format(more, LIMIT))
    assert len(found(path, "ros1-transmission-in-ros2", targets=["ros2"])) == count


@pytest.mark.parametrize(("length", "count"), [(30, 0), (1, 1)])
def test_the_legs_of_a_gantry_are_as_far_apart_as_its_beam_is_long(write, length, count):
    box = f'<visual><geometry><box size="1 {length} 1"/></geometry></visual>'
    robot = PAIR.replace('<link name="a"/>', f'<link name="a">{box}</link>')
    path = write("r.urdf", robot.format("", LIMIT).replace("<axis", '<origin xyz="0 15 0"/><axis'))
    assert len(found(path, "prismatic-in-millimeters")) == count


def test_a_joint_that_was_removed_is_not_taken_for_one_of_the_same_arm(write):
    blocks = '<gazebo reference="{}"><provideFeedback>true</provideFeedback></gazebo>'
    robot = PAIR.replace('name="j"', 'name="wrist_left_ft_joint"')
    for name, near in (("arm_left_1_joint", ""), ("wrst_left_ft_joint", "wrist_left_ft_joint")):
        path = write("r.urdf", robot.format(blocks.format(name), LIMIT))
        (finding,) = found(path, "dangling-reference", targets=["gazebo-classic"])
        assert finding.data["suggestion"] == near
        assert ("did you mean" in finding.message) is bool(near)
