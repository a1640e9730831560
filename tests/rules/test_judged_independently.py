"""Findings that an independent reader judged as wrong, by their causes, with counter-cases."""

import math

import pytest
import trimesh

from urdftool.api.lint import check
from urdftool.diagnostic import Severity

LINK = '<link name="{}">{}</link>'
JOINT = (
    '<joint name="{0}" type="{1}"><parent link="{2}"/><child link="{3}"/><axis xyz="0 0 1"/>{4}'
    "</joint>"
)
LIMIT = '<limit lower="{}" upper="{}" effort="1" velocity="1"/>'
INERTIAL = (
    '<inertial><mass value="{}"/><inertia ixx="{}" ixy="0.0" ixz="0.0" iyy="{}" iyz="0.0" '
    'izz="{}"/></inertial>'
)


def find(folder, rule, *parts, **options):
    folder.mkdir(exist_ok=True)
    path = folder / "r.urdf"
    path.write_text(f'<robot name="r">{"".join(parts)}</robot>', "utf-8")
    return check(path, select=[rule], **options)


def make_ring_and_rod(folder, radius, gazebo=""):
    """Write a robot with a rod through a ring of inner radius 0.07 m, and its SRDF."""
    trimesh.creation.torus(0.1, 0.03).export(folder / "ring.stl")
    ring = '<collision><geometry><mesh filename="ring.stl"/></geometry></collision>'
    rod = f'<collision><geometry><cylinder radius="{radius}" length="0.3"/></geometry></collision>'
    srdf = '<robot name="r"><group name="all"><link name="ring"/></group></robot>'
    (folder / "r.srdf").write_text(srdf, "utf-8")
    return [
        *(LINK.format("ring", ring), LINK.format("rod", rod)),
        *(JOINT.format("turn", "continuous", "ring", "rod", ""), gazebo),
    ]


@pytest.mark.parametrize(("radius", "count"), [(0.068, 0), (0.075, 1)])
def test_moveit_compares_surfaces_and_not_hulls(tmp_path, radius, count):
    parts = make_ring_and_rod(tmp_path, radius)
    found = find(tmp_path, "adjacent-pair-not-disabled", *parts)
    assert len(found) == count
    assert all(one.severity is Severity.WARNING for one in found)


def test_of_surfaces_that_are_not_compared_only_the_hulls_are_said(tmp_path, monkeypatch):
    monkeypatch.setattr("urdftool.rules.moveit.adjacent.find_contact", lambda *links: None)
    found = find(tmp_path, "adjacent-pair-not-disabled", *make_ring_and_rod(tmp_path, 0.068))
    assert [one.severity for one in found] == [Severity.INFO]
    assert found[0].message.startswith("the convex hulls of links 'ring' and 'rod'")
    assert not found[0].effects


@pytest.mark.parametrize(("radius", "count"), [(0.068, 0), (0.075, 1)])
def test_gazebo_compares_surfaces_and_not_hulls(tmp_path, radius, count):
    gazebo = "<gazebo><self_collide>true</self_collide></gazebo>"
    parts = make_ring_and_rod(tmp_path, radius, gazebo)
    parts[2] = JOINT.format("turn", "continuous", "ring", "frame", "")
    parts += [LINK.format("frame", ""), JOINT.format("slide", "continuous", "frame", "rod", "")]
    ball = '<collision><geometry><sphere radius="0.001"/></geometry></collision>'
    parts[-2] = LINK.format("frame", ball)
    found = find(tmp_path, "self-collide-at-spawn", *parts, targets=["gazebo-classic"])
    assert sum("'ring'" in one.message for one in found) == count


@pytest.mark.parametrize(
    ("mount", "optical", "severity"),
    [
        (f"{math.pi} 0.82 0", "1.5708 0 1.5708", None),
        (f"{math.pi / 2} 0 0", "0 1.5708 0", Severity.WARNING),
        ("0 0.82 0", "1.5708 0 1.5708", None),  # mounted upside down in it
        ("0 0 0", "-1.5708 0 -1.5708", None),
        ("0 0 0", "-1.5708 0 1.5708", Severity.WARNING),
        (f"{math.pi / 2} 1.5708 0", "0 1.5708 0", Severity.WARNING),  # a vertical view has no top
    ],
)
def test_an_optical_frame_may_correct_how_its_camera_is_mounted(tmp_path, mount, optical, severity):
    parts = [
        *(LINK.format(name, "") for name in ("head", "cam_link", "cam_optical_link")),
        JOINT.format("m", "fixed", "head", "cam_link", f'<origin rpy="{mount}"/>'),
        JOINT.format("o", "fixed", "cam_link", "cam_optical_link", f'<origin rpy="{optical}"/>'),
    ]
    found = find(tmp_path, "optical-frame-orientation", *parts)
    assert [one.severity for one in found] == ([severity] if severity else [])


@pytest.mark.parametrize(("upper", "is_sign"), [(0.055, True), (0.02, False)])
def test_the_sign_of_a_multiplier_comes_before_the_limits(tmp_path, upper, is_sign):
    mimic = '<mimic joint="a" multiplier="-1"/>'
    parts = [
        *(LINK.format(name, "") for name in "xyz"),
        JOINT.format("a", "prismatic", "x", "y", LIMIT.format(-0.005, 0.055)),
        JOINT.format("b", "prismatic", "x", "z", LIMIT.format(-0.005, upper) + "\n" + mimic),
    ]
    (found,) = find(tmp_path, "mimic-limits-inconsistent", *parts)
    assert ("multiplier 1 in place of -1" in found.message) is is_sign
    assert found.location.line == (2 if is_sign else 1)


@pytest.mark.parametrize(
    ("name", "where", "codes"),
    [
        ("arm", "meshes", {"relative-uri-in-ros"}),
        ("other", "meshes", {"relative-uri-in-ros"}),
        ("arm", "elsewhere", {"mesh-not-found"}),
    ],
)
def test_a_package_uri_is_advised_for_a_file_of_the_package(tmp_path, name, where, codes):
    folder = tmp_path / "arm"
    (folder / where).mkdir(parents=True)
    (folder / "package.xml").write_text(
        f'<package format="3"><name>{name}</name></package>', "utf-8"
    )
    trimesh.creation.box((1, 1, 1)).export(folder / where / "a.stl")
    shape = '<visual><geometry><mesh filename="meshes/a.stl"/></geometry></visual>'
    found = find(folder, "relative-uri-in-ros", LINK.format("a", shape), targets=["ros2"])
    both = check(
        folder / "r.urdf", select=["relative-uri-in-ros", "mesh-not-found"], targets=["ros2"]
    )
    assert {one.code for one in both} == codes
    for one in found:
        assert f"package://{name}/meshes/a.stl" in one.message
        assert ("PyBullet" in one.message) is (name != "arm")


@pytest.mark.parametrize("folder", ["meshes", "elsewhere"])
def test_a_file_uri_with_a_relative_path(tmp_path, monkeypatch, folder):
    monkeypatch.chdir(tmp_path)  # where a reader of paths would find it, and RViz does not
    (tmp_path / folder).mkdir()
    trimesh.creation.box((1, 1, 1)).export(tmp_path / folder / "a.stl")
    shape = '<visual><geometry><mesh filename="file://meshes/a.stl"/></geometry></visual>'
    (found,) = find(
        tmp_path,
        "mesh-not-found",
        LINK.format("a", INERTIAL.format(1, 1, 1, 1) + shape),
        targets=["gz", "ros2"],
    )
    there = folder == "meshes"
    assert ("exists at the description or above it" in found.message) is there
    assert ("gz" in found.effects) is not there
    assert "rviz" in found.effects


@pytest.mark.parametrize(("name", "count"), [("grey", 1), ("", 0)])
def test_pybullet_takes_one_color_for_all_materials_without_a_name(tmp_path, name, count):
    color = f'<material name="{name}"><color rgba="1 0 0 0 1"/></material>'
    shape = f'<visual><geometry><sphere radius="1"/></geometry>{color}</visual>'
    (found,) = find(tmp_path, "wrong-arity", LINK.format("a", shape))
    assert sum("pybullet" in reader for reader in found.effects) == count
    assert any("urdfdom" in reader for reader in found.effects)


@pytest.mark.parametrize(("name", "count"), [("hinge", 0), ("left_leg_joint", 1)])
def test_a_root_of_mass_0_may_be_intended(tmp_path, name, count):
    parts = [
        LINK.format("frame", INERTIAL.format(0, 0, 0, 0)),
        LINK.format("door", INERTIAL.format(1, 0.1, 0.1, 0.1)),
        JOINT.format(name, "continuous", "frame", "door", ""),
    ]
    found = find(tmp_path, "zero-mass", *parts)
    assert [one.severity for one in found] == [Severity.INFO] * count
    assert all("Keep it if PyBullet is to fix it" in one.message for one in found)


CAD = [
    ("0.0043", "0.0087", "0.0087"),
    ("0.0028", "0.0111", "0.0112"),
    ("0.0016", "0.003", "0.0035"),
]


@pytest.mark.parametrize(
    ("others", "moment", "size", "count"),
    [
        (CAD, "0.0001", 0.08, 0),
        (CAD, "0.0001", 1.5, 1),  # too large for a moment that rounds to it
        (CAD, "0.001", 0.08, 1),  # not the last decimal
        (CAD[:2], "0.0001", 0.08, 1),
        ([("0.0001",) * 3] * 5, "0.0001", 0.08, 1),
        ([*CAD, ("0.00162", "0.003", "0.0035")], "0.0001", 0.08, 0),
        ([*CAD, *[("0.00162", "0.003", "0.0035")] * 4], "0.0001", 0.08, 1),
    ],
)
def test_a_moment_that_is_rounded_to_the_last_decimal(tmp_path, others, moment, size, count):
    box = f'<visual><geometry><box size="{size} {size} {size / 8}"/></geometry></visual>'
    box += f'<visual><geometry><box size="{size} {size} {size / 8}"/></geometry></visual>'
    parts = [LINK.format("base", "")]
    for number, moments in enumerate([*others, (moment,) * 3]):
        name = f"link{number}"
        parts.append(LINK.format(name, INERTIAL.format(0.1354, *moments) + box))
        parts.append(JOINT.format(f"j{number}", "continuous", "base", name, ""))
    found = find(tmp_path, "placeholder-inertia", *parts)
    assert sum(f"'{name}'" in one.message for one in found) == count


@pytest.mark.parametrize(
    ("name", "near"),
    [("left_tip_joint", "mimic_left_tip_joint"), ("Left_tap_joint", "left_tap_joint")],
)
def test_a_joint_that_moves_is_meant_unless_only_the_case_differs(tmp_path, name, near):
    parts = [
        *(LINK.format(link, "") for link in "abcd"),
        JOINT.format("left_tap_joint", "fixed", "a", "b", ""),
        JOINT.format("mimic_left_tip_joint", "continuous", "a", "c", ""),
        JOINT.format("follower", "continuous", "a", "d", f'<mimic joint="{name}"/>'),
    ]
    (found,) = find(tmp_path, "mimic-unknown-joint", *parts)
    assert found.data["suggestion"] == near
    assert f"did you mean '{near}'?" in found.message


@pytest.mark.parametrize(
    ("limit", "words"),
    [
        ('lower="-100" upper="100" effort="1000" velocity="100"', "make the joint continuous"),
        ('lower="-100" upper="100" effort="12" velocity="3"', "looks like degrees"),
        ('lower="-90" upper="90" effort="100" velocity="100"', "looks like degrees"),
    ],
)
def test_a_round_limit_among_round_numbers_is_no_limit(tmp_path, limit, words):
    file = tmp_path / "r.urdf"
    file.write_text(
        '<robot name="r"><link name="a"/><link name="b"><inertial><mass value="1"/></inertial>'
        '</link><joint name="j" type="revolute"><parent link="a"/><child link="b"/>'
        f"<limit {limit}/></joint></robot>"
    )
    (finding,) = check(file, select=["limit-in-degrees"])
    assert words in finding.message


def test_a_gripper_is_mirrored_in_its_own_frame(tmp_path):
    """Its frame is turned by 45 degrees about the arm's axis, as of the Panda."""
    body = (
        '<link name="{0}"><inertial><mass value="1"/><inertia ixx="1e-3" ixy="0" ixz="0" '
        'iyy="1e-3" iyz="0" izz="1e-3"/></inertial></link>'
    )
    joint = (
        '<joint name="{0}_joint" type="revolute"><parent link="{1}"/><child link="{0}"/>'
        '<origin xyz="{2}" rpy="{3}"/><axis xyz="1 0 0"/>'
        '<limit lower="0" upper="1" effort="1" velocity="1"/></joint>'
    )
    arms = [("left_arm", "base", "0 0.2 0"), ("right_arm", "base", "0 -0.2 0")]
    arms += [("left_leg", "base", "0.3 0.2 0"), ("right_leg", "base", "0.3 -0.2 0")]
    arms += [("left_foot", "left_leg", "0.3 0 0"), ("right_foot", "right_leg", "0.3 0 0")]

    def lint(*fingers):
        parts = [*arms, ("hand", "base", "0 0 0.3", "0 0 0.785"), *fingers]
        text = body.format("base") + "".join(
            body.format(name) + joint.format(name, parent, xyz, *(rest or ("0 0 0",)))
            for name, parent, xyz, *rest in parts
        )
        file = tmp_path / "r.urdf"
        file.write_text(f'<robot name="r">{text}</robot>')
        return [finding.name for finding in check(file, select=["joint-not-mirrored"])]

    assert (
        lint(("left_finger", "hand", "0 0.05 0.1"), ("right_finger", "hand", "0 -0.05 0.1")) == []
    )
    moved = ("left_finger", "hand", "0 0.05 0.1"), ("right_finger", "hand", "0 -0.09 0.1")
    assert lint(*moved) == ["right_finger_joint"]
    same = ("left_finger", "hand", "0.02 0.05 0.1"), ("right_finger", "hand", "0.02 0.05 0.13")
    assert lint(*same) == ["right_finger_joint"]
