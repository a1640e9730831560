"""Findings on kinematics, collisions and SRDF judged as noise, by cause, with counter-cases."""

import importlib.util

import pytest

from urdftool.api.lint import check
from urdftool.diagnostic import Severity

LINK = '<link name="{}">{}</link>'
JOINT = (
    '<joint name="{0}" type="{1}"><parent link="{2}"/><child link="{3}"/><axis xyz="{4}"/>{5}'
    "</joint>"
)
LIMIT = '<limit lower="{}" upper="{}" effort="1" velocity="1"/>'
RANGE = LIMIT.format(-1, 1)
BOX = '<collision><origin xyz="{} 0 0"/><geometry><box size="{} {} {}"/></geometry></collision>'
INERTIAL = (
    '<inertial><mass value="1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>'
    "</inertial>"
)
SRDF = '<robot name="r"><disable_collisions link1="{}" link2="{}" reason="{}"/></robot>'
needs_fcl = pytest.mark.skipif(
    importlib.util.find_spec("fcl") is None, reason="requires python-fcl"
)


READERS = ("moveit", "mujoco")
"""Targets that compare links which no joint connects."""


def find(folder, rule, *parts, **options):
    path = folder / "r.urdf"
    path.write_text(f'<robot name="r">{"".join(parts)}</robot>', "utf-8")
    return check(path, select=[rule], **options)


def make_stages(axis="1 0 0", kind="prismatic"):
    """Make three bodies in each other: the first two are apart only by the axis of the last."""
    return [
        *(LINK.format(name, BOX.format(0, 1, size, size)) for name, size in ("a3", "b2", "c1")),
        JOINT.format("one", "prismatic", "a", "b", "1 0 0", RANGE),
        JOINT.format("two", kind, "b", "c", axis, RANGE),
    ]


@pytest.mark.parametrize(
    ("axis", "kind", "count"),
    [
        ("1 0 0", "prismatic", 0),
        ("-2 0 0", "prismatic", 0),
        ("0 1 0", "prismatic", 1),
        ("1 0 0", "revolute", 1),
    ],
)
def test_stages_of_a_telescope_are_in_each_other(tmp_path, axis, kind, count):
    assert (
        len(find(tmp_path, "self-collision-at-zero", *make_stages(axis, kind), targets=READERS))
        == count
    )


def test_two_fingers_of_a_palm_are_no_stages(tmp_path):
    parts = [LINK.format(name, BOX.format(x, 1, 1, 1)) for name, x in (("palm", 9), *STUCK)]
    for name, axis in (("left", "0 1 0"), ("right", "0 -1 0")):
        parts.append(JOINT.format(f"{name}_slide", "prismatic", "palm", name, axis, RANGE))
    assert len(find(tmp_path, "self-collision-at-zero", *parts, targets=READERS)) == 1


STUCK = (("left", 0), ("right", 0.5))
"""Names of fingers, and where their boxes of 1 m are [m]."""


@pytest.mark.parametrize(("pair", "count"), [(("a", "c"), 0), (("a", "b"), 1)])
def test_pairs_of_the_srdf_are_known_to_overlap(tmp_path, pair, count):
    (tmp_path / "r.srdf").write_text(SRDF.format(*pair, "Never"), "utf-8")
    assert (
        len(find(tmp_path, "self-collision-at-zero", *make_stages("0 1 0"), targets=READERS))
        == count
    )


@pytest.mark.parametrize(("fingers", "size", "count"), [(3, 0.1, 0), (2, 0.1, 1), (3, 0.7, 1)])
def test_an_envelope_encloses_several_smaller_links(tmp_path, fingers, size, count):
    parts = [
        LINK.format("palm", ""),
        LINK.format("box", BOX.format(0, 0.6, 0.6, 0.6)),
        JOINT.format("fix", "fixed", "palm", "box", "1 0 0", ""),
    ]
    for n in range(fingers):
        parts += [LINK.format(f"root_{n}", BOX.format(9 + n, 0.1, 0.1, 0.1))]
        parts += [LINK.format(f"finger_{n}", BOX.format(n / 5 - 0.2, size, 0.01, 0.01))]
        parts += [JOINT.format(f"a{n}", "revolute", "palm", f"root_{n}", "0 0 1", RANGE)]
        parts += [JOINT.format(f"b{n}", "revolute", f"root_{n}", f"finger_{n}", "0 0 1", RANGE)]
    found = find(tmp_path, "self-collision-at-zero", *parts, targets=READERS)
    assert any("'box'" in one.message for one in found) == count


@pytest.mark.parametrize(
    ("lower", "mujoco", "where"),
    [
        (-1, True, "with all joints at zero"),
        (0.1, False, "with 'two' in the middle of the range and other joints at zero"),
    ],
)
def test_simulators_start_a_joint_at_zero(tmp_path, lower, mujoco, where):
    """At zero the last box is 0.1 m in the first, or 0.9 m away from it."""
    x = 1 if lower < 0 else 1.5
    parts = [
        LINK.format("a", BOX.format(0, 1, 1, 1)),
        LINK.format("b", BOX.format(0, 0.01, 0.01, 0.01)),
        LINK.format("c", BOX.format(x - 0.1, 1, 0.2, 0.2)),
        JOINT.format("one", "revolute", "a", "b", "0 0 1", RANGE),
        JOINT.format("two", "prismatic", "b", "c", "-1 0 0", LIMIT.format(lower, 1)),
    ]
    (one,) = find(tmp_path, "self-collision-at-zero", *parts, targets=READERS)
    assert ("mujoco" in one.effects) is mujoco
    assert where in one.message


@needs_fcl
@pytest.mark.parametrize(
    ("name", "x", "count"),
    [("arm", 1.2, 1), ("arm", 0.9, 0), ("finger", 1.2, 0)],
    ids=["apart at zero", "in contact at zero", "fingers that close"],
)
def test_a_pair_that_touches_where_the_robot_works_has_to_be_disabled(tmp_path, name, x, count):
    (tmp_path / "r.srdf").write_text(SRDF.format(f"{name}_b", f"{name}_c", "Never"), "utf-8")
    parts = [LINK.format("a", BOX.format(9, 1, 1, 1))]
    for child, at, axis in (("b", 0, "1 0 0"), ("c", x, "-1 0 0.2")):  # no telescope
        parts.append(LINK.format(f"{name}_{child}", BOX.format(at, 1, 1, 1)))
        ends = f"{name}_{child}_joint", "prismatic", "a", f"{name}_{child}"
        parts.append(JOINT.format(*ends, axis, LIMIT.format(0, 0.2)))
    found = find(tmp_path, "disabled-pair-can-touch", *parts, targets=["moveit"])
    assert [one.severity for one in found] == [Severity.WARNING] * count


@pytest.mark.parametrize(
    ("name", "block", "severity"),
    [
        ("chasis", "<material>Gazebo/Red</material>", Severity.WARNING),
        ("removed", "<material>Gazebo/Red</material>", Severity.INFO),
        ("removed", "<implicitSpringDamper>true</implicitSpringDamper>", Severity.INFO),
        ("removed", "<mu1>1</mu1>", Severity.WARNING),
        ("removed", '<sensor name="s" type="imu"/>', Severity.ERROR),
    ],
)
def test_a_lost_block_is_as_bad_as_what_is_lost(tmp_path, name, block, severity):
    gazebo = f'<gazebo reference="{name}">{block}</gazebo>'
    parts = LINK.format("chassis", INERTIAL), gazebo
    (found,) = find(tmp_path, "dangling-reference", *parts, targets=["gazebo-classic"])
    assert found.severity is severity


@pytest.mark.parametrize(("reader", "count"), [("", 0), ("mount", 1)])
def test_nothing_reads_the_feedback_of_a_fixed_joint_without_a_plugin(tmp_path, reader, count):
    plugin = f'<plugin name="p" filename="libft.so"><jointName>{reader}</jointName></plugin>'
    parts = [
        *(LINK.format(name, INERTIAL) for name in "ab"),
        JOINT.format("mount", "fixed", "a", "b", "1 0 0", ""),
        '<gazebo reference="mount"><provideFeedback>true</provideFeedback></gazebo>',
        f"<gazebo>{plugin}</gazebo>",
    ]
    found = find(tmp_path, "lumped-joint-loses-content", *parts, targets=["gazebo-classic"])
    assert [one.severity for one in found] == [Severity.WARNING] * count


@pytest.mark.parametrize("rule", ["locked-by-limits", "zero-velocity-limit", "zero-effort-limit"])
@pytest.mark.parametrize(("name", "shape", "count"), [("dummy", "", 0), ("arm", "", 1)])
def test_a_dummy_joint_only_has_to_exist(tmp_path, rule, name, shape, count):
    lower = 0 if rule == "locked-by-limits" else -1
    limit = f'<limit lower="{lower}" upper="0" effort="0" velocity="0"/>'
    joint = JOINT.format(name, "revolute", "a", "b", "0 0 1", limit)
    parts = LINK.format("a", INERTIAL), LINK.format("b", shape), joint
    assert len(find(tmp_path, rule, *parts)) == count
    moved = LINK.format("b", BOX.format(0, 1, 1, 1))
    assert len(find(tmp_path, rule, parts[0], moved, joint)) == 1


def test_joints_with_a_wrong_sign_are_one_finding_and_other_ranges_another(tmp_path):
    """Four pairs whose limits have the wrong sign, and four with other limits."""
    parts = [LINK.format("base", "")]
    for n in range(8):
        for side, y in (("left", 1), ("right", -1)):
            name = f"{side}_limb_{n}"
            limit = LIMIT.format(-0.5, 1) if side == "left" else LIMIT.format(-1, 0.5)
            if n > 3 and side == "right":
                limit = LIMIT.format(-0.3, 2)
            origin = f'<origin xyz="{n} {y} 0"/>'
            parts.append(LINK.format(name, INERTIAL))
            ends = f"{name}_joint", "revolute", "base", name
            parts.append(JOINT.format(*ends, "0 1 0", limit + origin))
    found = find(tmp_path, "limits-not-mirrored", *parts)
    sign = [one for one in found if "wrong sign" in one.message]
    other = [one for one in found if one not in sign]
    assert (len(sign), len(other)) == (1, 1)
    assert "'right_limb_3_joint'" in sign[0].message
    assert "'right_limb_4_joint'" not in sign[0].message
    ranges = "the mirrored range is -0.5 to 1; also 'right_limb_5_joint' (-0.5 to 1)"
    assert ranges in other[0].message


@pytest.mark.parametrize(("name", "count"), [("left_leg", 0), ("left_wheel", 1), ("boom", 1)])
def test_the_root_of_a_robot_that_walks_is_the_body_that_moves(tmp_path, name, count):
    parts = [
        *(LINK.format(link, INERTIAL) for link in ("base", name)),
        JOINT.format("turn", "continuous", "base", name, "0 1 0", ""),
    ]
    assert len(find(tmp_path, "root-link-has-inertia", *parts, targets=["ros1"])) == count


@pytest.mark.parametrize(
    ("parent", "more", "count"),
    [("world", "", 0), ("base", "", 1), ("world", BOX.format(0, 1, 1, 1), 1)],
)
def test_a_robot_of_drake_without_collisions_is_only_for_motion(tmp_path, parent, more, count):
    visual = '<visual><geometry><box size="1 1 1"/></geometry></visual>'
    parts = [
        *(LINK.format("base", visual + more), LINK.format("arm", visual)),
        JOINT.format("swing", "revolute", "base", "arm", "0 0 1", RANGE),
        JOINT.format("weld", "fixed", parent, "base", "0 0 1", "") if parent == "world" else "",
    ]
    found = find(tmp_path, "missing-collision", *parts)
    assert bool(found) is bool(count)


@pytest.mark.parametrize(("pieces", "count"), [(1, 1), (2, 1), (3, 0)])
def test_several_primitives_may_be_larger_than_the_visual(tmp_path, pieces, count):
    visual = '<visual><geometry><box size="0.2 0.2 0.2"/></geometry></visual>'
    parts = LINK.format("a", visual + BOX.format(0, 1, 0.2, 0.2) * pieces)
    assert len(find(tmp_path, "collision-much-larger-than-visual", parts)) == count


@pytest.mark.parametrize(("kind", "severity"), [("fixed", "info"), ("continuous", "warning")])
def test_a_part_of_the_surroundings_without_collision_is_an_info(tmp_path, kind, severity):
    visual = '<visual><geometry><box size="1 1 1"/></geometry></visual>'
    parts = [
        *(LINK.format("world", ""), LINK.format("stand", visual), LINK.format("arm", visual)),
        JOINT.format("one", kind, "world", "stand", "0 0 1", ""),
        JOINT.format("two", "continuous", "stand", "arm", "0 0 1", '<origin xyz="5 0 0"/>'),
    ]
    found = find(tmp_path, "missing-collision", *parts, targets=["gz"])
    assert [one.severity.label for one in found if "'stand'" in one.message] == [severity]
