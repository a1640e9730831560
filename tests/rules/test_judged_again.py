"""Findings of packages of PyPI that were noise or wrong, by their causes, with counter-cases."""

import json
from pathlib import Path

import pytest
import trimesh

from urdftool.api.lint import check
from urdftool.lint.robot_search import find_robots
from urdftool.workspace import Workspace

LINK = '<link name="{}">{}</link>'
JOINT = (
    '<joint name="{0}" type="{1}"><parent link="{2}"/><child link="{3}"/><axis xyz="0 0 1"/>{4}'
    "</joint>"
)
BODY = (
    '<inertial><mass value="{mass}"/><inertia ixx="{moment}" ixy="0" ixz="0" iyy="{moment}" '
    'iyz="0" izz="{moment}"/></inertial>'
)
TURNS = '<limit lower="-20" upper="20" effort="1" velocity="1"/>'


def find(tmp_path, rule, *parts, files=()):
    for name, text in dict(files).items():
        (tmp_path / name).write_text(text, "utf-8")
    path = tmp_path / "r.urdf"
    path.write_text(f'<robot name="r">{"".join(parts)}</robot>', "utf-8")
    return check(path, select=[rule])


@pytest.mark.parametrize(("body", "count"), [("", 0), (BODY.format(mass=1, moment=0.01), 1)])
def test_the_last_joint_of_a_free_base_may_turn_often(tmp_path, body, count):
    parts = [
        *(LINK.format("root", ""), LINK.format("frame", body)),
        LINK.format("hand", BODY.format(mass=1, moment=0.01)),
        JOINT.format("z", "prismatic", "root", "frame", TURNS),
        JOINT.format("turn", "revolute", "frame", "hand", TURNS),
    ]
    assert len(find(tmp_path, "limit-in-degrees", *parts)) == count


@pytest.mark.parametrize(("xyz", "count"), [("0 0 0", 0), ("0 0 0.1", 1)])
def test_an_origin_of_a_link_that_moves_nothing(tmp_path, xyz, count):
    part = LINK.format("a", f'<origin xyz="{xyz}" rpy="0 -0 0"/>')
    assert len(find(tmp_path, "unknown-element", part)) == count


@pytest.mark.parametrize(("kind", "count"), [("fixed", 0), ("revolute", 1)])
def test_a_fixed_joint_is_not_advised_another_leader(tmp_path, kind, count):
    limit = '<limit lower="0" upper="1" effort="1" velocity="1"/>'
    mimic = limit + '<mimic joint="{}"/>'
    parts = [LINK.format(name, "") for name in "abcd"]
    parts += [
        JOINT.format("one", "revolute", "a", "b", limit),
        JOINT.format("two", "revolute", "a", "c", mimic.format("one")),
        JOINT.format("three", kind, "a", "d", mimic.format("two")),
    ]
    assert len(find(tmp_path, "mimic-chain", *parts)) == count


@pytest.mark.parametrize(("name", "count"), [("arm_visuals", 0), ("arm", 1)])
def test_a_link_that_is_only_to_be_seen_needs_no_collision(tmp_path, name, count):
    visual = '<visual><geometry><box size="0.5 0.5 0.5"/></geometry></visual>'
    ball = '<collision><geometry><sphere radius="0.1"/></geometry></collision>'
    parts = [LINK.format("base", ball), LINK.format(name, visual)]
    parts.append(JOINT.format("j", "continuous", "base", name, ""))
    assert len(find(tmp_path, "missing-collision", *parts)) == count


@pytest.mark.parametrize(("value", "severity"), [("1e-5", "info"), ("2e-5", "warning")])
def test_a_lower_half_that_repeats_the_upper_is_an_info(tmp_path, value, severity):
    inertial = BODY.format(mass=1, moment=0.01).replace('ixy="0"', f'ixy="1e-5" iyx="{value}"')
    (found,) = find(tmp_path, "redundant-inertia-attributes", LINK.format("a", inertial))
    assert found.severity.label == severity


def test_pinocchio_does_not_use_the_inertia_of_the_root(tmp_path):
    zero = BODY.format(mass=1, moment=0)
    parts = [LINK.format("a", zero), LINK.format("b", zero)]
    parts.append(JOINT.format("j", "continuous", "a", "b", ""))
    found = find(tmp_path, "zero-inertia", *parts)
    assert {f.name: "pinocchio" in f.effects for f in found} == {"a": False, "b": True}


@pytest.mark.parametrize(("roll", "count"), [(0.07, 0), (0.09, 1)])
def test_a_joint_that_takes_a_displacement_back(tmp_path, roll, count):
    inertial = BODY.format(mass=1, moment=0.01)
    steps = {"hip": 0.1, "knee": 0.2, "ankle": 0.3, "pitch": 0.15, "roll": 0.08, "elbow": 0.2}
    parts = [LINK.format("base", inertial)]
    for side, sign in (("left", 1), ("right", -1)):
        above = "base"
        for name, step in steps.items():
            above = "base" if name in ("hip", "pitch") else above
            if side == "right":
                step = {"pitch": 0.16, "roll": roll}.get(name, step)
            link = f"{side}_{name}"
            parts.append(LINK.format(link, inertial))
            origin = f'<origin xyz="0 {sign * step} 0"/>'
            parts.append(JOINT.format(f"{link}_joint", "continuous", above, link, origin))
            above = link
    found = find(tmp_path, "joint-not-mirrored", *parts)
    assert len(found) == count


@pytest.mark.parametrize(("shift", "count"), [(0.03, 0), (0.0, 1)])
def test_centers_that_mirror_each_other_in_the_root_frame(tmp_path, shift, count):
    """The frames of the right side are displaced along the joint, and so is the center of mass."""
    parts = [LINK.format("base", "")]
    for side, sign in (("left", 1), ("right", -1)):
        moved = 0.03 if side == "right" else 0.0
        back = shift if side == "right" else 0.0
        inertial = BODY.format(mass=1, moment=0.01)
        at = f'<inertial><origin xyz="0 {sign * (0.05 + moved)} 0"/>'
        parts.append(LINK.format(f"{side}_arm", inertial.replace("<inertial>", at)))
        origin = f'<origin xyz="0 {sign * (0.2 - back)} 0"/>'
        joint = JOINT.format(f"{side}_j", "continuous", "base", f"{side}_arm", origin)
        parts.append(joint.replace("0 0 1", "0 1 0"))
    assert len(find(tmp_path, "left-right-asymmetry", *parts)) == count


STL = (
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
    "endfacet\nendsolid a\n"
)


@pytest.mark.parametrize(
    ("uri", "files", "effects", "right"),
    [
        ("package:///a.stl", {"a.stl": STL}, ["mujoco"], "a.stl'"),
        ("package://a.stl", {"a.stl": STL}, ["mujoco"], "a.stl'"),
        ("package:///b.stl", {"a.stl": STL}, ["pybullet, drake", "mujoco"], "/meshes/FILE"),
    ],
)
def test_a_uri_without_a_package_that_readers_open(tmp_path, uri, files, effects, right):
    shape = f'<collision><geometry><mesh filename="{uri}"/></geometry></collision>'
    (found,) = find(tmp_path, "malformed-uri", LINK.format("a", shape), files=files)
    assert found.severity.label == "error"
    assert list(found.effects) == effects
    assert found.message.endswith(right)


@pytest.mark.parametrize(
    ("part", "count"),
    [
        ('<link name="a" drake_ignore="true"/>', 0),
        (
            '<link name="a"/><link name="b"/><joint name="j" type="fixed" drake_ignore="true">'
            '<parent link="a"/><child link="b"/></joint>',
            0,
        ),
        (
            '<link name="a"><visual drake_ignore="true"><geometry><sphere radius="1"/></geometry>'
            "</visual></link>",
            1,
        ),
    ],
)
def test_what_drake_reads_is_known(tmp_path, part, count):
    """Drake 1.51.1 leaves out links and joints, but no shapes."""
    assert len(find(tmp_path, "unknown-attribute", part)) == count


def test_the_path_of_a_mesh_that_is_read_from_a_folder_of_the_name(tmp_path):
    (tmp_path / "arm" / "meshes").mkdir(parents=True)
    (tmp_path / "arm" / "meshes" / "a.stl").write_text(STL)
    (tmp_path / "urdf").mkdir()
    shape = '<visual><geometry><mesh filename="package://arm/meshes/a.stl"/></geometry></visual>'
    found = find(tmp_path / "urdf", "package-not-found", LINK.format("a", shape))
    assert [f.message.rpartition("write ")[2] for f in found] == ["'../arm/meshes/a.stl'"]


@pytest.mark.parametrize(("size", "count"), [((0.1, 0.2, 0.6), 1), ((0.1, 0.6, 0.2), 0)])
def test_a_gltf_file_with_z_up_is_one_finding(tmp_path, size, count):
    box = trimesh.creation.box(size)
    box.export(tmp_path / "arm.glb")
    visual = '<visual><geometry><mesh filename="arm.glb"/></geometry></visual>'
    solid = '<collision><geometry><box size="0.1 0.2 0.6"/></geometry></collision>'
    parts = [LINK.format(name, visual + solid) for name in ("a", "b", "c")]
    parts += [JOINT.format(name, "fixed", "a", name, "") for name in ("b", "c")]
    rules = ("collision-off-visual", "collision-much-larger-than-visual")
    found = [f for rule in rules for f in find(tmp_path, rule, *parts)]
    assert ["has Z up, and so do those of 'b', 'c'" in f.message for f in found] == [True] * count


def test_a_file_that_is_included_by_a_computed_folder_is_part_of_a_robot(tmp_path):
    head = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    (tmp_path / "xacro").mkdir()
    for name, inside in (
        ("top.xacro", '<link name="a"/><xacro:include filename="$(arg dir)/xacro/main.xacro"/>'),
        ("xacro/main.xacro", '<link name="b"/>'),
        ("xacro/other.xacro", '<link name="c"/>'),
    ):
        (tmp_path / name).write_text(f"{head}{inside}</robot>", "utf-8")
    found = find_robots([str(tmp_path)], workspace=Workspace())
    names = {robot.path.rpartition("/")[2] for robot in found.robots.values()}
    assert names == {"top.xacro", "other.xacro"}


ROOT = '<robot name="{}" xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'


@pytest.mark.parametrize(
    ("name", "inside", "advice"),
    [
        ("$(arg n)", '<xacro:arg name="n" default="ur"/>', "pass n:=ur"),
        ("$(arg n)", '<xacro:arg name="n" default="$(arg m)"/>', "pass n:=VALUE"),
        (
            "r",
            '<xacro:arg name="kind" default="five"/><xacro:property name="f" '
            'value="${xacro.load_yaml(\'config/$(arg kind)/limits.yaml\')}"/><a b="${f}"/>',
            "'five' is the default of xacro argument 'kind': pass kind:=…",
        ),
    ],
)
def test_the_argument_that_a_robot_needs_is_named(tmp_path, name, inside, advice):
    path = tmp_path / "r.urdf.xacro"
    path.write_text(ROOT.format(name, inside), "utf-8")
    messages = [finding.message for finding in check(path)]
    assert any(advice in message for message in messages), messages


BOX = '<{0}><geometry><box size="{1}"/></geometry></{0}>'


@pytest.mark.parametrize(("shape", "count"), [("0.2 0.2 0.2", 0), ("0.2 0.2 0.05", 1)])
def test_a_rail_inside_of_what_slides_on_it_needs_no_collision(tmp_path, shape, count):
    cart = BOX.format("visual", shape) + BOX.format("collision", shape)
    parts = [LINK.format("rail", BOX.format("visual", "2 0.1 0.1")), LINK.format("cart", cart)]
    joint = JOINT.format("slide", "prismatic", "rail", "cart", '<origin xyz="0 0 0.07"/>' * count)
    assert len(find(tmp_path, "missing-collision", *parts, joint)) == count


@pytest.mark.parametrize(("targets", "count"), [((), 1), (("mujoco",), 0), (("pybullet",), 0)])
def test_the_mass_of_a_rail_that_is_fixed_to_the_world_matters_to_gazebo(tmp_path, targets, count):
    parts = [LINK.format("world", ""), LINK.format("rail", BOX.format("collision", "1 1 1"))]
    parts.append(JOINT.format("j", "fixed", "world", "rail", ""))
    (tmp_path / "r.urdf").write_text(f'<robot name="r">{"".join(parts)}</robot>', "utf-8")
    found = check(tmp_path / "r.urdf", select=["missing-inertial"], targets=targets)
    effects = [{"gz, gazebo-classic": "load nothing: a model must have at least one link"}]
    assert [finding.effects for finding in found] == effects * count


@pytest.mark.parametrize(("plugin", "count"), [("gz-sim-yarp-controlboard", 0), ("gz-sim-x", 1)])
def test_sensors_of_a_robot_that_uses_yarp_need_no_frame_of_tf(tmp_path, plugin, count):
    parts = [
        LINK.format("head", BODY.format(mass=1, moment=0.01)),
        f'<gazebo><plugin name="gz::sim" filename="{plugin}-system"/></gazebo>',
        '<gazebo reference="head"><sensor name="imu" type="imu"/></gazebo>',
    ]
    assert len(find(tmp_path, "missing-gz-frame-id", *parts)) == count


def test_the_center_of_mass_waits_for_the_inertia_that_lacks(tmp_path):
    inertial = '<inertial><mass value="1"/></inertial>'
    shape = '<visual><origin xyz="0.2 0 0"/><geometry><box size="0.2 0.1 0.1"/></geometry></visual>'
    parts = [LINK.format("base", BODY.format(mass=1, moment=0.01)), LINK.format("a", inertial)]
    parts[1] = parts[1].replace("</link>", f"{shape}</link>")
    joint = JOINT.format("j", "continuous", "base", "a", "")
    (tmp_path / "r.urdf").write_text(f'<robot name="r">{"".join(parts)}{joint}</robot>', "utf-8")
    codes = {finding.code for finding in check(tmp_path / "r.urdf")}
    assert "incomplete-inertial" in codes
    assert "inertial-not-at-com-suspect" not in codes


@pytest.mark.parametrize(("folder", "names"), [("$(arg dir)", {"top"}), ("parts", {"top", "tool"})])
def test_a_urdf_file_that_uses_arguments_of_another_is_its_part(tmp_path, folder, names):
    include = f'<link name="a"/><xacro:include filename="{folder}/main.xacro"/>'
    (tmp_path / "top.xacro").write_text(ROOT.format("top", include), "utf-8")
    tool = LINK.format("b", f"<visual><geometry>{MESH.format('$(arg dir)')}</geometry></visual>")
    (tmp_path / "tool.urdf").write_text(f'<robot name="tool">{tool}</robot>', "utf-8")
    found = find_robots([str(tmp_path)], workspace=Workspace())
    assert {Path(robot.path).stem for robot in found.robots.values()} == names


MESH = '<mesh filename="{}/a.stl"/>'


@pytest.mark.parametrize("scale", [1, 1000])
def test_a_visual_in_millimeters_covers_no_collision_of_its_neighbor(tmp_path, scale):
    trimesh.creation.box((0.3, 0.3, 0.3)).export(tmp_path / "shin.stl")
    shin = f'<visual><geometry><mesh filename="shin.stl" scale="{scale} {scale} {scale}"/>'
    near, far = (
        BOX.format(*one) for one in (("visual", "0.4 0.1 0.1"), ("collision", "0.1 0.1 0.1"))
    )
    far = far.replace("<collision>", '<collision><origin xyz="2 0 0"/>')
    parts = [LINK.format("thigh", BODY.format(mass=1, moment=0.01) + near + far)]
    parts += [LINK.format("shin", f"{shin}</geometry></visual>")]
    parts += [JOINT.format("knee", "continuous", "thigh", "shin", '<origin xyz="0 0 -0.4"/>')]
    assert len(find(tmp_path, "collision-off-visual", *parts)) == 1


OUTSIDE = LINK.format(
    "a", '<visual><geometry><mesh filename="../parts/a.stl"/></geometry></visual>'
)


def test_a_mesh_that_may_not_be_read_is_counted_in_the_summary(tmp_path, monkeypatch, urdftool):
    trimesh.creation.box().export(tmp_path / "a.stl")
    for folder in ("parts", "urdf"):
        (tmp_path / folder).mkdir()
    (tmp_path / "a.stl").rename(tmp_path / "parts" / "a.stl")
    path = tmp_path / "urdf" / "r.urdf"
    path.write_text(f'<robot name="r">{OUTSIDE}</robot>', "utf-8")
    monkeypatch.delenv("URDFTOOL_TRUST", raising=False)
    done = urdftool("lint", path, "--select", "mesh-not-found", "--format", "json")
    assert (done.code, json.loads(done.out)["findings"]) == (0, [])
    (unread,) = json.loads(done.out)["summary"]["unread_meshes"]
    assert unread["mesh"] == "../parts/a.stl"
    assert "not checked: mesh '../parts/a.stl' is outside of the project; pass" in done.err
    done = urdftool("lint", path, "--select", "mesh-not-found", "--trust")
    assert "not checked" not in done.err


SHAPES = {kind: BOX.format(kind, "0.1 0.1 0.1") for kind in ("visual", "collision")}


@pytest.mark.parametrize(
    ("collides", "found"),
    [("ac", []), ("ab", ["c"]), ("c", ["a", "b"]), ("bc", ["a"]), ("", ["a", "b", "c"])],
)
def test_a_link_between_links_with_collisions_needs_none(tmp_path, collides, found):
    parts = [
        LINK.format(n, SHAPES["visual"] + SHAPES["collision"] * (n in collides)) for n in "abc"
    ]
    parts += [JOINT.format("1", "continuous", "a", "b", '<origin xyz="1 0 0"/>')]
    parts += [JOINT.format("2", "continuous", "b", "c", '<origin xyz="1 0 0"/>')]
    rules = ("missing-collision", "odd-link-without-collision")
    named = [one.name for rule in rules for one in find(tmp_path, rule, *parts)]
    assert sorted(name for name in named if name in found) == found
    assert len([*find(tmp_path, rules[0], *parts)]) <= len(found)


@pytest.mark.parametrize(("name", "count"), [("chest_fake_x", 0), ("chest", 1)])
def test_a_tiny_sphere_of_a_helper_link_is_not_a_body(tmp_path, name, count):
    ball = '<{}><geometry><sphere radius="0.0005"/></geometry></{}>'
    parts = [
        LINK.format("base", BODY.format(mass=1, moment=0.01)),
        LINK.format(name, BODY.format(mass=0.01, moment=1e-4) + ball.format(*["visual"] * 2)),
        JOINT.format("j", "continuous", name, "base", ""),
    ]
    assert len(find(tmp_path, "implausible-density", *parts)) == count


@pytest.mark.parametrize(("root", "count"), [("world", 0), ("base", 1)])
def test_the_moments_of_a_link_that_only_slides_in_the_world_are_not_used(tmp_path, root, count):
    parts = [LINK.format(root, ""), LINK.format("slider", BODY.format(mass=1, moment=1))]
    parts.append(JOINT.format("x", "prismatic", root, "slider", TURNS))
    assert len(find(tmp_path, "placeholder-inertia", *parts)) == count


@pytest.mark.parametrize(("upper", "count"), [("1", 0), ("0.5", 1)])
def test_a_follower_that_reaches_what_its_leader_asks_need_not_be_mirrored(tmp_path, upper, count):
    from urdftool.model.load import load
    from urdftool.rules.joint.sides import _covers_demand

    limit = '<limit lower="{}" upper="{}" effort="1" velocity="1"/>'
    parts = [LINK.format(name, "") for name in "abc"]
    parts.append(JOINT.format("one", "revolute", "a", "b", limit.format(-0.7, 0)))
    follows = limit.format(-0.1, upper) + '<mimic joint="one" multiplier="-1"/>'
    parts.append(JOINT.format("two", "revolute", "a", "c", follows))
    path = tmp_path / "r.urdf"
    path.write_text(f'<robot name="r">{"".join(parts)}</robot>', "utf-8")
    robot = load(path)
    assert _covers_demand(robot, robot.joint["two"], (-0.1, float(upper))) is (count == 0)


@pytest.mark.parametrize(("velocity", "severity"), [("0", "info"), ("1", "warning")])
def test_a_joint_that_is_locked_on_purpose_is_one_info(tmp_path, velocity, severity):
    limit = f'<limit lower="0" upper="0" effort="0" velocity="{velocity}"/>'
    parts = [*map(LINK.format, "ab", ["", ""]), JOINT.format("j", "revolute", "a", "b", limit)]
    assert find(tmp_path, "zero-velocity-limit", *parts) == []
    (found,) = find(tmp_path, "locked-by-limits", *parts)
    assert found.severity.label == severity


@pytest.mark.parametrize(("name", "count"), [("libgazebo_ros_control.so", 1), ("libx.so", 0)])
def test_a_transmission_that_nothing_reads_needs_no_prefix(tmp_path, name, count):
    joint = '<joint name="j"><hardwareInterface>EffortJointInterface</hardwareInterface></joint>'
    part = f'<transmission name="t">{joint}</transmission>'
    part += f'<gazebo><plugin name="p" filename="{name}"/></gazebo>'
    (tmp_path / "r.urdf").write_text(f'<robot name="r"><link name="a"/>{part}</robot>', "utf-8")
    rule = "unprefixed-hardware-interface"
    assert len(check(tmp_path / "r.urdf", select=[rule], targets=["ros1"])) == count
