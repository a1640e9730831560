"""Findings on masses, Gazebo and control need somebody who reads what they are about."""

from itertools import pairwise

import pytest

from urdftool.api.lint import check

BODY = (
    '<link name="{}"><inertial><mass value="{}"/><inertia ixx="0.01" iyy="0.01" izz="0.01" '
    'ixy="0" ixz="0" iyz="0"/></inertial>{}</link>'
)
BOX = '<visual><geometry><box size="{0} {0} {0}"/></geometry></visual>'
JOINT = (
    '<joint name="{0}" type="{1}"><parent link="{2}"/><child link="{3}"/><axis xyz="0 1 0"/>'
    '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
)
CAMERA = '<gazebo><plugin name="c" filename="libgazebo_ros_camera.so"/></gazebo>'
CONTROL = '<gazebo><plugin name="c" filename="libgazebo_ros_control.so"/></gazebo>'
SYSTEM = (
    '<ros2_control name="s" type="system"><hardware><plugin>mock_components/GenericSystem</plugin>'
    '</hardware><joint name="turn"><state_interface name="position"/></joint></ros2_control>'
)
TRANSMISSION = (
    '<transmission name="t"><type>transmission_interface/SimpleTransmission</type><joint '
    'name="{}"><hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface>'
    "</joint></transmission>"
)
ARM = (BODY.format("base", 1, ""), JOINT.format("turn", "revolute", "base", "arm"))


def find(folder, rule, *parts, **options):
    path = folder / "r.urdf"
    path.write_text(f'<robot name="r">{"".join(parts)}</robot>', "utf-8")
    return [(one.severity.label, one.message) for one in check(path, select=[rule], **options)]


def label(found):
    return [severity for severity, _ in found]


@pytest.mark.parametrize(
    ("name", "size", "mass", "count"),
    [
        ("cover", 0.2, 3, 1),
        ("cover", 0.2, 60, 0),  # 1 kg is little
        ("cover", 0.01, 3, 0),  # a marker
        ("tool0", 0.05, 3, 0),
        ("camera_link", 0.05, 3, 0),
        ("camera_link", 0.1, 3, 1),
        ("steel_plate", 0.05, 3, 1),  # no word of a device
    ],
)
def test_a_part_without_mass_is_named_where_pybullet_adds_much(tmp_path, name, size, mass, count):
    link = f'<link name="{name}">{BOX.format(size)}</link>'
    parts = [*ARM, BODY.format("arm", mass, ""), link, JOINT.format("m", "fixed", "arm", name)]
    found = find(tmp_path, "missing-inertial", *parts)
    assert label(found) == ["info"] * count
    assert all("PyBullet gives it 1 kg" in message for _, message in found)


@pytest.mark.parametrize(
    ("size", "kind", "labels"),
    [(0.009, "fixed", []), (0.009, "revolute", []), (0.03, "fixed", ["warning"])],
)
def test_a_marker_has_no_density(tmp_path, size, kind, labels):
    parts = [*ARM, BODY.format("arm", 0.5, ""), BODY.format("tip", 3, BOX.format(size))]
    found = find(tmp_path, "implausible-density", *parts, JOINT.format("m", kind, "arm", "tip"))
    assert label(found) == labels


@pytest.mark.parametrize(("reach", "count"), [(0.5, 1), (3, 0)])
def test_a_car_is_heavy(tmp_path, reach, count):
    mesh = '<visual><geometry><mesh filename="gone.stl"/></geometry></visual>'
    wheel = f'<joint name="w" type="fixed"><origin xyz="{reach} 0 0"/><parent link="base"/>'
    parts = [BODY.format("base", 1300, mesh), BODY.format("arm", 1, ""), wheel]
    parts[2] += '<child link="arm"/></joint>'
    other = JOINT.format("turn", "fixed", "base", "more") + BODY.format("more", 1, "")
    assert len(find(tmp_path, "implausible-mass", *parts, other)) == count


@pytest.mark.parametrize(
    ("more", "labels"),
    [
        ("", []),
        (CAMERA, []),
        (CAMERA + "<!-- " + CONTROL + " -->", []),
        ('<gazebo><plugin name="x" filename="libgazebo_ros_p3d.so"/></gazebo>', []),
        ('<gazebo><plugin name="x" filename="libgazebo_ros_vacuum.so"/></gazebo>', ["warning"]),
        (
            '<gazebo><plugin name="x" filename="libgazebo_ros_vacuum.so"/></gazebo>'
            f"<!-- {CONTROL} -->",
            [],
        ),
    ],
)
def test_a_drive_is_missing_only_where_gazebo_drives_something(tmp_path, more, labels):
    parts = [*ARM, BODY.format("arm", 1, ""), more]
    found = find(tmp_path, "missing-control-plugin", *parts, targets=["gazebo-classic"])
    assert label(found) == labels


@pytest.mark.parametrize(
    ("more", "targets", "labels"),
    [
        (CONTROL, ["ros1"], ["error"]),
        ("", ["ros1"], ["warning"]),
        (SYSTEM, ["ros2"], []),
        (SYSTEM, ["ros1"], ["warning"]),
    ],
)
def test_an_unknown_joint_stops_only_who_reads_it(tmp_path, more, targets, labels):
    parts = [*ARM, BODY.format("arm", 1, ""), TRANSMISSION.format("gone"), more]
    assert label(find(tmp_path, "transmission-unknown-joint", *parts, targets=targets)) == labels


@pytest.mark.parametrize(("more", "count"), [(SYSTEM, 1), ("", 0)])
def test_transmissions_of_ros_1_are_left_over_where_ros2_control_is_used(tmp_path, more, count):
    parts = [*ARM, BODY.format("arm", 1, ""), TRANSMISSION.format("turn"), more]
    assert len(find(tmp_path, "ros1-transmission-in-ros2", *parts, targets=["ros2"])) == count


@pytest.mark.parametrize(
    ("inside", "severity"),
    [
        ("<material>Gazebo/Red</material>", "info"),
        ("<visual><material><diffuse>1 0 0 1</diffuse></material></visual>", "info"),
        ("<mu1>1</mu1><mu2>1</mu2><material>Gazebo/Red</material>", "warning"),
        ('<sensor name="s" type="imu"/>', "error"),
        ('<plugin name="p" filename="libp.so"/>', "error"),
    ],
)
def test_a_lost_block_is_as_severe_as_what_it_holds(tmp_path, inside, severity):
    block = f'<gazebo reference="gone">{inside}</gazebo>'
    found = find(tmp_path, "dangling-reference", *ARM, BODY.format("arm", 1, ""), block)
    assert label(found) == [severity]


@pytest.mark.parametrize(
    ("plugin", "count"),
    [("", 0), ('<gazebo><plugin name="ft" filename="f.so"><j>m</j></plugin></gazebo>', 1)],
)
def test_feedback_of_a_fixed_joint_is_missed_by_a_plugin_that_names_it(tmp_path, plugin, count):
    parts = [*ARM, BODY.format("arm", 1, ""), BODY.format("tip", 1, ""), plugin]
    parts += [JOINT.format("m", "fixed", "arm", "tip")]
    block = '<gazebo reference="m"><provideFeedback>true</provideFeedback></gazebo>'
    options = {"targets": ["gazebo-classic"]}
    found = find(tmp_path, "lumped-joint-loses-content", *parts, block, **options)
    assert label(found) == ["warning"] * count
    assert all("plugin that names it" in message for _, message in found)


@pytest.mark.parametrize(
    ("rule", "block"),
    [
        ("no-effect-in-gz", '<gazebo reference="arm"><kp>1</kp><kd>1</kd></gazebo>'),
        ("missing-gz-frame-id", '<gazebo reference="arm"><sensor name="i" type="imu"/></gazebo>'),
    ],
)
def test_a_tag_alone_does_not_show_new_gazebo(tmp_path, rule, block):
    (tmp_path / "package.xml").write_text(
        "<package format='3'><name>r</name><depend>rclcpp</depend>"
        "<export><build_type>ament_cmake</build_type></export></package>",
        "utf-8",
    )
    parts = [*ARM, BODY.format("arm", 1, ""), block]
    assert find(tmp_path, rule, *parts) == []
    assert len(find(tmp_path, rule, *parts, targets=["gz", "ros2"])) == 1


def test_a_planar_base_is_not_driven_by_ros2_control(tmp_path):
    parts = [
        *(BODY.format(name, 1, "") for name in ("base", "arm", "hand")),
        *(JOINT.format("turn", "revolute", "base", "arm"), SYSTEM),
        JOINT.format("wrist", "revolute", "arm", "hand"),
        *('<link name="map"/>', JOINT.format("drive", "planar", "map", "base")),
    ]
    ((_, message),) = find(tmp_path, "joint-outside-ros2-control", *parts, targets=["ros2"])
    assert "'wrist'" in message


@pytest.mark.parametrize(("mass", "labels"), [(27, ["info"]), (3, ["warning"])])
def test_the_trunk_of_a_humanoid_may_have_1_kg_m2(tmp_path, mass, labels):
    trunk = BODY.format("trunk", mass, BOX.format(0.3)).replace("0.01", "1")
    parts = [*ARM, BODY.format("arm", 1, ""), trunk, JOINT.format("w", "revolute", "arm", "trunk")]
    found = find(tmp_path, "placeholder-inertia", *parts)
    assert [one for one, message in found if "'trunk'" in message] == labels


@pytest.mark.parametrize(("xyz", "severity"), [("0 0 0", "info"), ("0 0 0.1", "error")])
def test_a_misspelled_origin_of_zeros_changes_nothing(tmp_path, xyz, severity):
    visual = f'<visual><origion xyz="{xyz}"/><geometry><sphere radius="1"/></geometry></visual>'
    found = find(tmp_path, "unknown-element", BODY.format("ball", 1, visual))
    assert label(found) == [severity]


@pytest.mark.parametrize(("tag", "count"), [("xacro:inertial_props", 0), ("xacro:shape", 1)])
def test_inertials_under_a_condition_are_left_out_on_purpose(tmp_path, tag, count):
    path = tmp_path / "r.urdf.xacro"
    path.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        f'<xacro:macro name="{tag[6:]}" params=""/><xacro:arg name="sim" default="false"/>'
        f'<link name="a">{BOX.format(0.1)}<xacro:if value="$(arg sim)"><{tag}/></xacro:if></link>'
        "</robot>",
        "utf-8",
    )
    assert len(check(path, select=["missing-inertial"])) == count
    assert len(check(path, select=["missing-inertial"], targets=["gz"])) == 1


@pytest.mark.parametrize(("wheel", "count"), [("link_1", 0), ("wheel", 1)])
def test_the_inertia_of_the_root_of_an_arm_is_not_used(tmp_path, wheel, count):
    names = ["base", wheel, "link_2", "link_3", "link_4"]
    parts = [BODY.replace("0.01", "0.02").format(name, 20, BOX.format(0.5)) for name in names]
    for number, (one, other) in enumerate(pairwise(names)):
        parts.append(JOINT.format(f"j{number}", "revolute", one, other))
    found = find(tmp_path, "inertia-below-geometry", *parts)
    assert sum("'base'" in message for _, message in found) == count
