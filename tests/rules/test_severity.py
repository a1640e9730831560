"""Severity by consequence: what no reader uses, and what is no defect, is at most an info."""

import pytest

from urdftool import check

INERTIAL = (
    '<inertial>{0}<mass value="{1}"/>'
    '<inertia ixx="{2}" iyy="{2}" izz="{2}" ixy="0" ixz="0" iyz="0"/></inertial>'
)
BOX = '<{0}><geometry><box size="{1} {1} {1}"/></geometry></{0}>'
LINK = '<link name="{0}">{1}</link>'
JOINT = (
    '<joint name="{0}" type="{1}"><parent link="{2}"/><child link="{3}"/><axis xyz="0 0 1"/>'
    '<limit lower="-1" upper="1" effort="9" velocity="9"/>{4}</joint>'
)


def robot(*parts):
    return f'<robot name="r">{"".join(parts)}</robot>'


def levels(path, rule, **options):
    return [(f.name, f.severity.label) for f in check(path, select=[rule], **options)]


def arm(root, kind, *, mass="1", moment="0.5", origin=""):
    """A body whose inertia is 75 times what its size allows, on a root."""
    body = INERTIAL.format(origin, mass, moment) + BOX.format("collision", "0.2")
    return robot(
        LINK.format(root, ""),
        LINK.format("body", body),
        JOINT.format("mount", kind, root, "body", ""),
    )


@pytest.mark.parametrize(
    ("root", "kind", "level"),
    [
        ("world", "fixed", []),
        ("base", "fixed", [("body", "warning")]),
        ("world", "revolute", [("body", "warning")]),
    ],
)
def test_an_inertia_that_is_welded_to_the_world_is_left_out(write, root, kind, level):
    path = write("r.urdf", arm(root, kind))
    assert levels(path, "inertia-exceeds-geometry") == level
    path = write("r.urdf", arm(root, kind, moment="0.01", origin='<origin xyz="0 0 5"/>'))
    assert levels(path, "com-outside-geometry") == level


@pytest.mark.parametrize(("root", "found"), [("world", []), ("base", [("body", "info")])])
def test_a_remark_on_the_motion_of_what_is_welded_to_the_world_is_left_out(write, root, found):
    path = write("r.urdf", arm(root, "fixed", moment="0.1"))
    assert levels(path, "placeholder-inertia") == found


def test_what_readers_reject_stays_an_error(write):
    text = arm("world", "fixed").replace('izz="0.5"', 'izz="5"')
    path = write("r.urdf", text)
    assert levels(path, "inertia-triangle-inequality") == [("body", "error")]


def test_a_severity_of_the_configuration_holds(write):
    write("urdftool.toml", '[lint.severity]\ninertia-exceeds-geometry = "error"\n')
    path = write("r.urdf", arm("world", "fixed"))
    assert levels(path, "inertia-exceeds-geometry") == [("body", "error")]


@pytest.mark.parametrize(("kind", "level"), [("fixed", "info"), ("revolute", "error")])
def test_dynamics_of_a_fixed_joint_are_an_info(write, kind, level):
    body = INERTIAL.format("", "1", "0.01") + BOX.format("collision", "0.2")
    joint = JOINT.format("j", kind, "base", "body", '<dynamics damping="-1"/>')
    path = write("r.urdf", robot(LINK.format("base", body), LINK.format("body", body), joint))
    assert levels(path, "negative-dynamics") == [("j", level)]


@pytest.mark.parametrize("target", [(), ("gz",), ("gazebo-classic",), ("moveit",)])
def test_a_joint_that_cannot_be_at_0_is_no_warning(write, target):
    joint = JOINT.format("elbow", "revolute", "a", "b", "").replace('lower="-1"', 'lower="0.5"')
    path = write("r.urdf", robot(LINK.format("a", ""), LINK.format("b", ""), joint))
    assert levels(path, "zero-outside-limits", targets=target) == [("elbow", "info")]


CMAKE = "cmake_minimum_required(VERSION 3.5)\nproject(p)\nfind_package({0})\n{1}\n"
MANIFEST = '<package format="{0}"><name>p</name><buildtool_depend>{1}</buildtool_depend></package>'
MESH = (
    '<link name="a"><visual><geometry><mesh filename="package://p/meshes/a.stl"/>'
    "</geometry></visual></link>"
)


@pytest.mark.parametrize(
    ("tool", "installs", "level"),
    [
        ("catkin", "", "info"),
        ("catkin", "install(DIRECTORY launch DESTINATION share/p)", "warning"),
        ("ament_cmake", "", "error"),
        ("ament_cmake", "install(DIRECTORY launch DESTINATION share/p)", "error"),
    ],
)
def test_a_folder_that_is_not_installed(write, tool, installs, level):
    write("p/package.xml", MANIFEST.format("2", tool))
    write("p/CMakeLists.txt", CMAKE.format(tool, installs))
    write("p/meshes/a.stl", "solid a\nendsolid a\n")
    path = write("p/urdf/r.urdf", robot(MESH))
    assert levels(path, "directory-not-installed") == [("r", level)]


SPHERE = '<{0}><geometry><sphere radius="{1}"/></geometry></{0}>'


@pytest.mark.parametrize(
    ("radius", "target", "level"),
    [
        ("0.001", (), None),  # the frame of a tool or sensor
        ("0.001", ("mujoco",), None),
        ("0.001", ("pybullet",), "error"),  # which gives it 1 kg
        ("0.05", (), "info"),  # it is fixed to a link with a mass
        ("0.05", ("mujoco",), "info"),
        ("0.05", ("pybullet",), "error"),
    ],
)
def test_a_marker_of_milligrams_without_inertial(write, radius, target, level):
    body = INERTIAL.format("", "1", "0.01") + BOX.format("collision", "0.2")
    marker = SPHERE.format("visual", radius) + SPHERE.format("collision", radius)
    path = write(
        "r.urdf",
        robot(
            LINK.format("base", body),
            LINK.format("marker", marker),
            JOINT.format("j", "fixed", "base", "marker", ""),
        ),
    )
    assert levels(path, "missing-inertial", targets=target) == (
        [("marker", level)] if level else []
    )


@pytest.mark.parametrize(
    ("mass", "kind", "expected"),
    [
        ("0.0001", "fixed", []),  # a part of the body that it is fixed to
        ("0.002", "fixed", []),
        ("0.0001", "revolute", [("dummy", "warning")]),
    ],
)
def test_a_sensor_dummy_of_a_gram_is_no_warning(write, mass, kind, expected):
    body = INERTIAL.format("", "1", "0.01") + BOX.format("collision", "0.2")
    dummy = INERTIAL.format("", mass, "1e-7") + BOX.format("collision", "0.2")
    path = write(
        "r.urdf",
        robot(
            LINK.format("base", body),
            LINK.format("dummy", dummy),
            JOINT.format("j", kind, "base", "dummy", ""),
        ),
    )
    assert levels(path, "implausible-density") == expected


@pytest.mark.parametrize(
    ("name", "value", "level"),
    [
        ("pi", "3.14159265358979", "info"),
        ("pi", "3.1415", "info"),
        ("pi", "3.14", "warning"),
        ("pi", "${22/7}", "warning"),
        ("e", "2.718281828", "info"),
        ("e", "0.1", "warning"),
    ],
)
def test_pi_defined_as_pi_is_no_warning(xacro_file, name, value, level):
    text = f'<xacro:property name="{name}" value="{value}"/><link name="a${{{name}}}"/>'
    path = xacro_file("r.urdf.xacro", text)
    assert [f.severity.label for f in check(path, select=["shadowed-builtin"])] == [level]


def test_a_track_of_15_m_is_no_warning(write):
    track = JOINT.format("track", "prismatic", "a", "cart", "").replace('upper="1"', 'upper="15"')
    cart = INERTIAL.format("", "1", "0.01") + BOX.format("visual", "0.2")
    path = write("r.urdf", robot(LINK.format("a", ""), LINK.format("cart", cart), track))
    assert levels(path, "prismatic-in-millimeters") == [("track", "info")]


def test_only_robots_for_gazebo_are_asked_for_its_tags(write):
    wheel = (
        '<visual><origin rpy="1.5708 0 0"/><geometry><cylinder radius="0.1" length="0.05"/>'
        "</geometry></visual>" + INERTIAL.format("", "1", "0.01")
    )
    axle = JOINT.format("axle", "continuous", "base", "left_caster", "")
    text = robot(
        LINK.format("base", BOX.format("collision", "0.2")),
        LINK.format(
            "left_caster", wheel + wheel.partition("<inertial>")[0].replace("visual", "collision")
        ),
        axle.replace("0 0 1", "0 1 0"),
    )
    path = write("r.urdf", text)
    assert levels(path, "missing-gazebo-tags", targets=("gz",)) == [("left_caster", "warning")]
    assert "missing-gazebo-tags" not in {f.code for f in check(path)}
    assert levels(path, "missing-gazebo-tags", targets=("mujoco",)) == []


@pytest.mark.parametrize(
    ("plane", "targets", "severity"),
    [
        ('<plane normal="0 0 1"/>', ("pybullet",), "info"),
        ('<plane normal="0 0 1"/>', ("pybullet", "gz"), "error"),
        ('<plane normal="0 0 1"/>', (), "warning"),
        ("<plane/>", ("pybullet",), "error"),
    ],
)
def test_a_plane_is_an_extension_of_pybullet(write, plane, targets, severity):
    text = f"<robot name='r'><link name='l'><collision><geometry>{plane}</geometry></collision>"
    path = write("r.urdf", f"{text}</link></robot>")
    (finding,) = check(path, select=("unsupported-shape",), targets=targets)
    assert finding.severity.label == severity
    assert ("only PyBullet reads" in finding.message) == ("normal" in plane)


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        (robot(LINK.format("a", "")), "missing-inertial"),
        (
            f'<robot name="__m__">{LINK.format("a", INERTIAL.format("", 1, 0.1))}</robot>',
            "reserved-name",
        ),
    ],
)
def test_gazebo_rejects_a_robot_without_bodies_and_one_with_a_reserved_name(write, text, rule):
    """As ``sdf::Root`` does: a model must have a link, and names like __m__ are reserved."""
    assert [level for _, level in levels(write("r.urdf", text), rule, targets=["gz"])] == ["error"]


@pytest.mark.parametrize(
    ("part", "readers"),
    [
        (INERTIAL.format("", "${mass}", 0.1), ["mujoco", "drake"]),
        (BOX.format("collision", "${size}"), ["mujoco"]),
        (BOX.format("visual", "${size}"), []),
    ],
)
def test_an_unexpanded_number_is_rejected(write, part, readers):
    path = write("r.urdf", robot(LINK.format("a", part)))
    (finding,) = check(path, select=["unexpanded-expression"])
    rejecting = [name for name, text in finding.effects.items() if "rejects the file" in text]
    assert rejecting == readers
