"""What a reader does with a defect is not said where it rejects the robot for another one."""

import pytest

from urdftool import check
from urdftool.lint.moot import convert_to_singular

LINK = (
    '<link name="{0}"><inertial><mass value="1"/>'
    '<inertia ixx="{1}" ixy="0" ixz="0" iyy="{1}" iyz="0" izz="{1}"/></inertial></link>'
)
JOINT = (
    '<joint name="{0}" type="revolute"><parent link="{1}"/><child link="{2}"/>'
    '<axis xyz="0 0 1"/>{3}</joint>'
)
LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def robot(*parts):
    return f'<robot name="r">{"".join(parts)}</robot>'


def effects(path, rule, *others):
    found = check(path, select=[rule, *others])
    return {name for f in found if f.code == rule for key in f.effects for name in key.split(", ")}


def test_urdfdom_takes_no_inertia_of_a_robot_that_it_rejects(write):
    links = LINK.format("a", 0.01), LINK.format("b", 1)
    path = write("r.urdf", robot(*links, JOINT.format("j", "a", "b", "")))
    alone = effects(path, "placeholder-inertia")
    assert {"gz", "gazebo-classic", "mujoco", "pinocchio", "drake"} <= alone
    beside = effects(path, "placeholder-inertia", "missing-limit")
    assert beside == alone - {"gz", "gazebo-classic", "pinocchio"}


def test_a_rejection_stays_with_its_own_finding(write):
    links = LINK.format("a", 0.01), LINK.format("b", 1)
    path = write("r.urdf", robot(*links, JOINT.format("j", "a", "b", "")))
    assert {"urdfdom", "gz", "pinocchio"} <= effects(path, "missing-limit", "placeholder-inertia")


def test_without_another_defect_all_is_said(write):
    links = LINK.format("a", 0.01), LINK.format("b", 1)
    path = write("r.urdf", robot(*links, JOINT.format("j", "a", "b", LIMIT)))
    alone = effects(path, "placeholder-inertia")
    assert alone == effects(path, "placeholder-inertia", "missing-limit")


@pytest.mark.parametrize(
    ("several", "one"),
    [
        ("take it as written", "takes it as written"),
        ("pass it on", "passes it on"),
        ("have no link", "has no link"),
        ("apply the unit", "applies the unit"),
        ("accept it: nothing", "accepts it: nothing"),
        ("display: nothing", "displays: nothing"),
    ],
)
def test_a_verb_in_singular(several, one):
    assert convert_to_singular(several) == one


def test_drake_loads_nothing_of_a_file_with_a_comma(write):
    links = LINK.format("a", 0.01), LINK.format("b", 1)
    limit = LIMIT.replace('effort="1"', 'effort=",5"')
    path = write("r.urdf", robot(*links, JOINT.format("j", "a", "b", limit)))
    assert "drake" in effects(path, "placeholder-inertia")
    assert not {"drake", "gz", "mujoco"} & effects(path, "placeholder-inertia", "not-a-number")
    assert "drake" in effects(path, "not-a-number")


def test_an_effect_of_another_case_rejects_nothing(write):
    mass = '<inertial><mass value="0"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
    light = f'<link name="c">{mass}</inertial></link>'
    links = LINK.format("a", 0.01), LINK.format("b", 1), light
    fixed = JOINT.format("k", "b", "c", "").replace("revolute", "fixed")
    path = write("r.urdf", robot(*links, JOINT.format("j", "a", "b", LIMIT), fixed))
    alone = effects(path, "placeholder-inertia")
    assert "gz" in alone
    assert "gz" in effects(path, "placeholder-inertia", "zero-mass")


BOX = '<link name="c"><{0}><geometry><mesh filename="{1}"/></geometry></{0}></link>'


@pytest.mark.parametrize(
    ("shape", "mesh", "rejecting"),
    [
        ("visual", "a.glb", {"pybullet"}),
        ("visual", "a.stl", set()),
        ("collision", "a.glb", {"pybullet", "mujoco", "drake"}),
        ("collision", "a.gltf", {"pybullet", "mujoco"}),
        ("collision", "a.STL", {"drake"}),
        ("collision", "a.dae", {"drake", "mujoco"}),
        ("collision", "a.obj", set()),
    ],
)
def test_a_format_of_meshes_rejects_whatever_rules_run(write, shape, mesh, rejecting):
    links = LINK.format("a", 0.01), LINK.format("b", 1), BOX.format(shape, mesh)
    fixed = JOINT.format("k", "a", "c", "").replace("revolute", "fixed")
    path = write("r.urdf", robot(*links, JOINT.format("j", "a", "b", LIMIT), fixed))
    write(mesh, "there")
    found = effects(path, "placeholder-inertia")
    assert {"mujoco", "drake", "pinocchio"} - found == rejecting - {"pybullet"}


def test_pybullet_takes_nothing_of_a_robot_with_a_gltf_visual(write):
    limit = LIMIT.replace('velocity="1"', 'velocity="1234"')
    links = LINK.format("a", 0.01), LINK.format("b", 0.01)
    for mesh, rejected in (("a.obj", False), ("a.glb", True)):
        visual = BOX.format("visual", mesh)
        fixed = JOINT.format("k", "a", "c", "").replace("revolute", "fixed")
        path = write("r.urdf", robot(*links, visual, JOINT.format("j", "a", "b", limit), fixed))
        assert ("pybullet" not in effects(path, "implausible-velocity")) == rejected


@pytest.mark.parametrize(("least", "rejected"), [("0", True), ("9e-15", True), ("2e-14", False)])
def test_mujoco_rejects_a_thin_part_whatever_it_is_fixed_to(write, least, rejected):
    thin = LINK.format("c", 0.01).replace('izz="0.01"', f'izz="{least}"')
    fixed = JOINT.format("k", "b", "c", "").replace("revolute", "fixed")
    links = LINK.format("a", 0.01), LINK.format("b", 1), thin
    path = write("r.urdf", robot(*links, JOINT.format("j", "a", "b", LIMIT), fixed))
    assert ("mujoco" not in effects(path, "placeholder-inertia")) == rejected


def test_six_zeros_of_a_part_reject_nothing(write):
    links = LINK.format("a", 0.01), LINK.format("b", 1), LINK.format("c", 0)
    fixed = JOINT.format("k", "b", "c", "").replace("revolute", "fixed")
    path = write("r.urdf", robot(*links, JOINT.format("j", "a", "b", LIMIT), fixed))
    assert "mujoco" in effects(path, "placeholder-inertia")


def test_gazebo_takes_nothing_of_a_joint_named_as_its_link_without_its_target(write):
    links = LINK.format("a", 0.01), LINK.format("b", 1)
    for name, rejected in (("j", False), ("b", True)):
        path = write("r.urdf", robot(*links, JOINT.format(name, "a", "b", LIMIT)))
        found = effects(path, "placeholder-inertia")
        assert ("gz" not in found) == rejected
        assert "link-joint-name-clash" not in {finding.code for finding in check(path)}
        assert "pinocchio" in found


def test_a_remark_waits_until_a_reader_gets_as_far(write):
    def reported(parent, **options):
        fast = LIMIT.replace('velocity="1"', 'velocity="1234"')
        links = (LINK.format(name, 0.01) for name in "abc")
        joints = JOINT.format("j", "a", "b", fast), JOINT.format("k", parent, "c", LIMIT)
        path = write("r.urdf", robot(*links, *joints))
        return {f.code for f in check(path, grouped=True, **options)}

    assert "implausible-velocity" in reported("b")
    assert "implausible-velocity" not in reported("nobody"), "no reader loads the robot"
    assert "implausible-velocity" in reported("nobody", select=["joint"])


def test_a_rejection_is_at_the_finding_that_the_reader_rejects(urdftool, write):
    """MuJoCo accepts a root without inertia, which it fixes, and rejects a moving link."""
    links = LINK.format("base", 0), LINK.format("arm", 0)
    path = write("r.urdf", robot(links[0], "\n", links[1], JOINT.format("j", "base", "arm", LIMIT)))
    lines = urdftool("lint", path).err.splitlines()
    assert "mujoco rejects the robot: zero-inertia (r.urdf:2)" in lines


@pytest.mark.parametrize(("limit", "count"), [("", 0), (LIMIT, 1)])
def test_a_remark_that_is_not_shown_is_not_fixed(
    write, urdftool, monkeypatch, tmp_path, limit, count
):
    monkeypatch.chdir(tmp_path)
    write("package.xml", "<package format='3'><name>r</name>\n  <export/>\n</package>")
    mesh = (
        '<visual><geometry><mesh filename="package://r/meshes/a.stl"/></geometry></visual></link>'
    )
    links = LINK.format("a", 0.01).replace("</link>", mesh), LINK.format("b", 0.01)
    write("urdf/r.urdf", robot(*links, JOINT.format("j", "a", "b", limit)))
    write("meshes/a.stl", "solid a\nendsolid a\n")
    options = "--target", "gz", "--target", "ros2"
    shown = urdftool("lint", "urdf/r.urdf", *options).out
    fixed = urdftool("lint", "urdf/r.urdf", *options, "--fix", "--diff").out
    assert ("[gazebo-path-not-exported]" in shown, "+++ package.xml" in fixed) == (count, count)
