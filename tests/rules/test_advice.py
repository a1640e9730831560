"""What a finding advises fits its case, and so does its fix."""

import shutil
from pathlib import Path

import pytest

from tests.conftest import FIXTURES
from urdftool import check
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

MOVING = """<robot name="r">
  <link name="{root}">{inertial}</link>
  <link name="arm"><inertial><mass value="1"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
  <joint name="turn" type="{kind}"><parent link="{root}"/><child link="arm"/><axis xyz="0 0 1"/>
    </joint>
</robot>
"""
INERTIAL = """<inertial><mass value="{mass}"/>
    <inertia ixx="{i}" ixy="0" ixz="0" iyy="{i}" iyz="0" izz="{i}"/></inertial>"""


def one(path, rule, *targets):
    """Give the only finding of a rule."""
    (found,) = check(path, select=[rule], targets=targets)
    return found


@pytest.mark.parametrize(
    ("root", "mass", "kind", "targets", "remedy", "in_pybullet"),
    [
        (
            "base",
            5,
            "continuous",
            (),
            "add a root link without one above it, on a fixed joint",
            True,
        ),
        ("base", 5, "continuous", ("ros2", "pybullet"), "", False),
        ("base", 1e-4, "fixed", (), "remove its <inertial>", True),
        (
            "base",
            1e-4,
            "continuous",
            (),
            "add a root link without one above it, on a fixed joint",
            True,
        ),
        ("world", 5, "continuous", ("ros2", "pybullet"), "remove its <inertial>", False),
    ],
    ids=["body", "pybullet", "frame of a body", "frame", "world"],
)
def test_a_root_without_inertial_has_1_kg_in_pybullet(
    write, root, mass, kind, targets, remedy, in_pybullet
):
    inertial = INERTIAL.format(mass=mass, i=mass / 100)
    path = write("r.urdf", MOVING.format(root=root, inertial=inertial, kind=kind))
    found = one(path, "root-link-has-inertia", *targets)
    assert found.message.partition("not support")[2] == (remedy and f"; {remedy}")
    assert ("PyBullet gives a root without an <inertial> 1 kg" in found.hint) is in_pybullet


def test_it_is_so_in_pybullet(write):
    pybullet = pytest.importorskip("pybullet")
    client = pybullet.connect(pybullet.DIRECT)
    try:
        masses = []
        for root in ("base", "world"):
            text = MOVING.format(root=root, inertial="", kind="continuous")
            body = pybullet.loadURDF(str(write(f"{root}.urdf", text)))
            masses.append(pybullet.getDynamicsInfo(body, -1)[0])
        assert masses == [1, 0]
    finally:
        pybullet.disconnect(client)


FOLLOWING = """<robot name="r">
  <link name="base"/><link name="a"/><link name="b"/>
  <joint name="lead" type="continuous"><parent link="base"/><child link="a"/></joint>
  <joint name="follow" type="continuous"><parent link="base"/><child link="b"/>{mimic}</joint>
  <ros2_control name="c" type="system">
    <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
    <joint name="lead"><state_interface name="position"/></joint>
    <joint name="follow">
      <param name="mimic">lead</param>{param}
      <state_interface name="position"/>
    </joint>
  </ros2_control>
</robot>
"""
TWICE = '<param name="multiplier">2</param>'


@pytest.mark.parametrize(
    ("mimic", "param", "severity", "words", "has_fix"),
    [
        ("", "", "warning", "write <mimic joint='lead'/> into", True),
        ("", TWICE, "warning", "write <mimic joint='lead' multiplier=\"2\"/> into", True),
        ('<mimic joint="lead"/>', "", "info", "remove the <param>", True),
        ('<mimic joint="lead" multiplier="2.0"/>', TWICE, "info", "remove both <param>", True),
        ('<mimic joint="lead"/>', TWICE, "warning", "'lead' with multiplier 1 by its", False),
        ('<mimic joint="a_joint"/>', "", "warning", "'a_joint' with multiplier 1 by its", False),
    ],
)
def test_what_a_mimic_param_adds_to_the_mimic(write, mimic, param, severity, words, has_fix):
    path = write("r.urdf", FOLLOWING.format(mimic=mimic, param=param))
    (found,) = check(path, select=["ros2-control-legacy-mimic-param"], targets=["ros2"], fixes=True)
    assert (found.severity.label, bool(found.fix)) == (severity, has_fix)
    assert words in found.message


@pytest.mark.parametrize(
    ("rule", "targets", "count"),
    [
        ("visual-mesh-as-collision", [], 1),
        ("nonconvex-collision-mesh", ["pybullet", "mujoco"], 1),
        ("nonconvex-collision-mesh", ["pybullet"], 0),
    ],
)
def test_pybullet_keeps_the_triangles_of_a_concave_collision(tmp_path, rule, targets, count):
    pytest.importorskip("manifold3d")
    folder = FIXTURES / "rules" / rule
    shutil.copytree(folder, tmp_path, dirs_exist_ok=True)
    path = tmp_path / "bad.urdf"
    (plain,) = check(path, select=[rule], targets=targets)
    assert "convex hull" in plain.effects["pybullet"]
    path.write_text(path.read_text().replace("<collision>", '<collision concave="yes">'))
    found = check(path, select=[rule], targets=targets)
    assert len(found) == count
    for finding in found:
        assert "triangles" in finding.effects["pybullet"]
        assert "convex hull" in finding.effects["mujoco"]


LONE = '<robot name="r"><link name="base"/>{link}{more}{joint}</robot>'
TURN = """<joint name="turn" type="continuous"><parent link="base"/><child link="arm"/>
  <axis xyz="0 1 0"/></joint>"""
ARM = """<link name="arm"><inertial><origin xyz="{xyz}"/><mass value="{mass}"/>
  <inertia ixx="{0}" ixy="0" ixz="0" iyy="{1}" iyz="0" izz="{2}"/></inertial>{shapes}</link>"""
SHAPE = '<{0}><origin xyz="{2}"/><geometry>{1}</geometry></{0}>'
BOX = '<box size="0.1 0.1 0.4"/>'
TIP = f"""<link name="tip">{SHAPE.format("collision", '<sphere radius="0.05"/>', "0 0 0")}</link>
<joint name="weld" type="fixed"><parent link="arm"/><child link="tip"/>
  <origin xyz="0 0 0.2"/></joint>"""


def _arm(*moments, xyz="0 0 0", mass=1, shapes="", more=""):
    link = ARM.format(*moments, xyz=xyz, mass=mass, shapes=shapes)
    return LONE.format(link=link, more=more, joint=TURN)


def _fixed(path, rule):
    (found,) = check(path, select=[rule], fixes=True)
    return found


@pytest.mark.parametrize(
    ("moment", "radius", "in_mm", "has_fix"),
    [(13400, "1.2e+02", True, True), (40, "6.3", False, False), (4e12, "2e+06", False, False)],
)
def test_a_radius_of_gyration_is_called_so(write, moment, radius, in_mm, has_fix):
    found = _fixed(write("r.urdf", _arm(moment, moment, moment / 50)), "radius-of-gyration")
    assert f"radius of gyration of link 'arm' is {radius} m" in found.message
    assert ("kg·mm²" in found.message, found.fix is not None) == (in_mm, has_fix)


def test_the_radius_of_gyration_of_a_placeholder(write):
    found = one(write("r.urdf", _arm(1, 1, 1, mass=0.1)), "placeholder-inertia")
    assert "0.1 kg with a radius of gyration of 3.2 m" in found.message


@pytest.mark.parametrize(
    ("shapes", "more", "severity", "compared", "proposes"),
    [
        (SHAPE.format("collision", BOX, "0 0 0"), "", "warning", "its shapes were", True),
        (SHAPE.format("visual", BOX, "0 0 0"), "", "info", "its shapes were", False),
        (SHAPE.format("collision", BOX, "0 0 0"), TIP, "warning", "and those of 'tip' were", False),
    ],
    ids=["collision", "visual only", "with an attached link"],
)
def test_an_inertia_is_compared_with_the_shapes_that_are_named(
    write, shapes, more, severity, compared, proposes
):
    text = _arm(0.11, 0.12, 0.04, shapes=shapes, more=more)
    found = _fixed(write("r.urdf", text), "inertia-exceeds-geometry")
    assert found.severity.label == severity
    assert compared in found.message
    assert ("; " in found.message, found.fix is not None) == (proposes, proposes)


def test_visuals_alone_that_are_far_too_small_are_a_warning(write):
    text = _arm(2, 2, 0.4, shapes=SHAPE.format("visual", BOX, "0 0 0"))
    found = one(write("r.urdf", text), "inertia-exceeds-geometry")
    assert found.severity.label == "warning"


def test_each_moment_of_a_mirror_image_is_compared(write):
    sides = (
        ARM.format(*moments, xyz="0 0 0", mass=1, shapes="").replace('"arm"', f'"{side}_arm"')
        for side, moments in (("left", (0.01, 0.02, 0.02)), ("right", (0.04, 0.02, 0.03)))
    )
    joints = (
        TURN.replace("arm", f"{side}_arm").replace("turn", side) for side in ("left", "right")
    )
    path = write("r.urdf", LONE.format(link="".join(sides), more="", joint="".join(joints)))
    found = one(path, "left-right-asymmetry")
    assert (
        "in ascending order, are 1.5 to 2 times those of its mirror image 'left_arm'"
        in found.message
    )


ROD = SHAPE.format("collision", '<cylinder radius="0.02" length="0.4"/>', "0 0 0.2")
ABOUT_COM, ABOUT_FRAME = (0.01343, 0.01343, 0.0002), (0.05343, 0.05343, 0.0002)


@pytest.mark.parametrize(
    ("moments", "shapes", "words", "changes"),
    [
        (ABOUT_COM, ROD, "as the <origin> of its <inertial>", ["0 0 0.2"]),
        (
            ABOUT_FRAME,
            ROD,
            'only about the link frame: ixx="0.01343"',
            ["0 0 0.2", "0.01343", "0.01343"],
        ),
        ((0.03, 0.03, 0.0002), ROD, "and the inertia about that point", None),
        (
            ABOUT_FRAME,
            ROD + SHAPE.format("collision", '<sphere radius="0.03"/>', "0 0 0.37"),
            "only about the link frame",
            ["0 0 0.2", "0.01343", "0.01343"],
        ),
    ],
    ids=["about the center", "about the frame", "neither", "several shapes"],
)
def test_a_center_of_mass_and_the_inertia_about_it_are_written_together(
    write, moments, shapes, words, changes
):
    path = write("r.urdf", _arm(*moments, shapes=shapes))
    found = _fixed(path, "inertial-not-at-com-suspect")
    assert words in found.message
    assert found.message.endswith("<inertial>") is (moments == ABOUT_COM)
    if changes is None:
        assert found.fix is None
        return
    assert found.fix is not None
    written = [one.text for one in found.fix.replacements]
    assert len(written) == len(changes)
    for text, part in zip(written, changes, strict=True):
        assert part in text


DRIVEN = """<robot name="r">
  <link name="a"/><link name="b"/><link name="c"/>
  <joint name="one" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="{0}" velocity="{1}"/></joint>
  <joint name="two" type="revolute"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="{0}" velocity="{1}"/></joint>{more}
</robot>
"""
TRANSMISSION = """<transmission name="t"><type>transmission_interface/SimpleTransmission</type>
  <joint name="two"/><actuator name="m"/></transmission>"""
ROS2_CONTROL = """<ros2_control name="c" type="system">
  <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
  <joint name="one"><state_interface name="position"/></joint>
  <joint name="two"><command_interface name="effort"/></joint></ros2_control>"""
PLUGIN = '<gazebo><plugin name="p" filename="libdrive.so"><joint>two</joint></plugin></gazebo>'
PUBLISHER = PLUGIN.replace("libdrive", "libgazebo_ros_joint_state_publisher")


@pytest.mark.parametrize(
    ("rule", "limits"),
    [
        ("zero-effort-limit", ("0", "1")),
        ("implausible-velocity", ("1", "1e5")),
        ("implausible-effort", ("1e5", "1")),
    ],
)
@pytest.mark.parametrize(
    ("more", "names"),
    [
        ("", ["one", "two"]),
        (PUBLISHER, ["one", "two"]),
        (TRANSMISSION, ["two"]),
        (ROS2_CONTROL, ["two"]),
        (PLUGIN, ["two"]),
        (TRANSMISSION.replace('"two"', '"typo"'), ["one", "two"]),
    ],
    ids=["none", "publisher", "transmission", "ros2_control", "plugin", "typo"],
)
def test_a_joint_that_is_not_driven_where_others_are_needs_no_effort(
    write, rule, limits, more, names
):
    path = write("r.urdf", DRIVEN.format(*limits, more=more))
    if rule == "implausible-velocity" and more != ROS2_CONTROL:
        names = ["one", "two"] if more in (TRANSMISSION, PLUGIN) else []  # 1e5 is no limit
    found = check(path, select=[rule])
    assert [finding.name for finding in found] == names


@pytest.mark.parametrize(
    ("velocity", "words"),
    [
        ("1000", "is 1000 rad/s, in effect no limit"),
        ("1e10", "is 1e+10 rad/s, in effect no limit"),
        ("3.4e38", "is 3.4e+38 rad/s, in effect no limit"),
        ("280", "is 280 rad/s, above 200"),
    ],
)
def test_a_velocity_that_means_no_limit_is_called_so(write, velocity, words):
    path = write("r.urdf", DRIVEN.format(1, velocity, more=TRANSMISSION))
    found = check(path, select=["implausible-velocity"])
    assert all(words in finding.message for finding in found)
    assert [finding.name for finding in found] == ["one", "two"]


@pytest.mark.parametrize(
    ("attributes", "remedy", "fixed", "has_effects"),
    [
        ('ixy="0" iyx="0.0"', "remove it", True, True),
        (
            'ixy="0" iyx="0.001"',
            "its value differs from ixy, which is read; write one of them",
            False,
            True,
        ),
        ('iyx="0"', "rename it to ixy, which is missing", False, False),
    ],
)
def test_what_the_lower_half_of_an_inertia_repeats(write, attributes, remedy, fixed, has_effects):
    text = _arm(0.01, 0.01, 0.01).replace('ixy="0"', attributes)
    found = _fixed(write("r.urdf", text), "redundant-inertia-attributes")
    assert found.message.endswith(f"; {remedy}")
    assert (found.fix is not None, bool(found.effects)) == (fixed, has_effects)


@pytest.mark.parametrize(
    ("root", "kind", "fix"),
    [
        ("base", "fixed", "remove its <inertial>"),
        ("base", "continuous", "add a link 'base_root' without <inertial> above it"),
        ("world", "continuous", "remove its <inertial>"),
    ],
)
def test_the_fix_of_a_root_with_inertial_is_what_is_advised(write, root, kind, fix):
    inertial = INERTIAL.format(mass=1e-4, i=1e-6)
    path = write("r.urdf", MOVING.format(root=root, inertial=inertial, kind=kind))
    found = _fixed(path, "root-link-has-inertia")
    assert found.fix is not None
    assert found.fix.message.startswith(fix)


@pytest.mark.parametrize(
    ("moment", "severity", "has_fix"), [(0.02, "info", False), (0.77, "warning", True)]
)
def test_an_inertia_that_a_mesh_makes_doubtful_is_not_recomputed(
    tmp_path, moment, severity, has_fix
):
    shutil.copy(FIXTURES / "meshes" / "cube.stl", tmp_path)
    mesh = SHAPE.format("collision", '<mesh filename="cube.stl" scale="0.1 0.1 0.1"/>', "0 0 0")
    path = tmp_path / "r.urdf"
    path.write_text(_arm(moment, moment * 1.05, moment * 1.1, shapes=mesh))
    box = {"arm": (1.0, (0.0, 0.0, 0.0), (0.0017, 0.0, 0.0, 0.0017, 0.0, 0.0017))}
    settings = Settings(select=("inertia-exceeds-geometry",))
    options = Options(settings, fixes=True, compute_inertia=lambda robot, names: box)
    (found,) = check_file(path, options).findings
    assert found.severity.label == severity
    assert (found.fix is not None) is has_fix


@pytest.mark.parametrize(
    ("kind", "word"),
    [
        ("slide", "prismatic"),
        ("weld", "fixed"),
        ("revolut", "revolute"),
        ("hinge", None),
        ("ball", None),
        ("crank", None),
    ],
)
def test_a_joint_type_is_written_where_one_is_meant(write, urdftool, kind, word):
    text = MOVING.format(root="base", inertial="", kind=kind)
    path = write("r.urdf", text)
    assert one(path, "unknown-joint-type").data.get("write") == word
    only = ("--select", "unknown-joint-type", "--no-cache")
    urdftool("lint", path, "--fix", "--unsafe-fixes", *only)
    fixed = text.replace(f'"{kind}"', f'"{word or kind}"')
    assert Path(path).read_text() == fixed
