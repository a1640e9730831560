"""Masses, inertias and limits of next to nothing, and readers that are named in one case only."""

import pytest

from urdftool.api.lint import check


def _messages(path, rule, *targets):
    return [finding.message for finding in check(path, select=[rule], targets=targets)]


BOX = "<{0}><geometry><box size='{1} {1} {1}'/></geometry></{0}>"
INERTIAL = (
    "<inertial><origin xyz='{1}'/><mass value='{0}'/>"
    "<inertia ixx='{2}' iyy='{3}' izz='{4}' ixy='0' ixz='0' iyz='0'/></inertial>"
)


def _body(name, mass, *, com="0 0 0", moments=(0.01, 0.01, 0.01), shapes=""):
    return f"<link name='{name}'>{INERTIAL.format(mass, com, *moments)}{shapes}</link>\n"


def _joint(name, parent, child, kind="continuous", xyz="0 0 0", inside=""):
    return (
        f"<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>"
        f"<origin xyz='{xyz}'/><axis xyz='0 1 0'/>{inside}</joint>\n"
    )


def _robot(tmp_path, *parts):
    file = tmp_path / "robot.urdf"
    file.write_text(f"<robot name='r'>\n{''.join(parts)}</robot>")
    return file


@pytest.mark.parametrize(("shapes", "count"), [(BOX.format("visual", 0.1), 1), ("", 0)])
def test_a_light_body_without_shapes_is_part_of_a_joint_with_two_axes(tmp_path, shapes, count):
    file = _robot(
        tmp_path,
        _body("base", 1),
        _joint("one", "base", "light"),
        _body("light", 0.001, shapes=shapes),
        _joint("two", "light", "heavy"),
        _body("heavy", 1),
    )
    assert len(_messages(file, "mass-ratio", "gazebo-classic")) == count


@pytest.mark.parametrize(
    ("link", "frictions", "expected"),
    [
        ("arm", (100, 100), ["mu1 of 'arm' is 100 and mu2 is 100; rubber on concrete has about 1"]),
        ("left_finger", (100, 100), []),
        ("left_finger", (100, 1), ["mu1 of 'left_finger' is 100; rubber on concrete has about 1"]),
        ("left_finger", (-1, -1), []),
    ],
)
def test_what_grips_may_have_a_high_friction(tmp_path, link, frictions, expected):
    one, two = frictions
    file = _robot(
        tmp_path,
        _body(link, 1),
        f"<gazebo reference='{link}'><mu1>{one}</mu1><mu2>{two}</mu2></gazebo>",
    )
    assert _messages(file, "implausible-friction") == expected


@pytest.mark.parametrize(("mass", "count"), [(0.0009, 0), (0.01, 1)])
def test_the_center_of_mass_of_next_to_nothing_may_be_outside(tmp_path, mass, count):
    file = _robot(
        tmp_path,
        _body("base", 1),
        _joint("turn", "base", "part"),
        _body("part", mass, com="0.2 0 0", shapes=BOX.format("visual", 0.1)),
    )
    assert len(_messages(file, "com-outside-geometry")) == count


@pytest.mark.parametrize(("mass", "count"), [(0.009, 0), (0.02, 1)])
def test_the_center_of_mass_of_a_small_part_of_a_body_may_be_anywhere(tmp_path, mass, count):
    file = _robot(
        tmp_path,
        _body("base", 1),
        _joint("mount", "base", "part", "fixed"),
        _body("part", mass, com="3 0 0", shapes=BOX.format("visual", 0.1)),
    )
    assert len(_messages(file, "com-outside-geometry")) == count


@pytest.mark.parametrize(
    ("moments", "rule"),
    [
        (("0.0133", "0.0133", "0.0267"), "inertia-triangle-inequality-rounding"),
        (("0.013300", "0.013300", "0.026700"), "inertia-triangle-inequality"),
    ],
)
def test_digits_tell_what_is_rounding(tmp_path, moments, rule):
    rules = ["inertia-triangle-inequality", "inertia-triangle-inequality-rounding"]
    file = _robot(tmp_path, _body("plate", 1, moments=moments))
    assert [finding.code for finding in check(file, select=rules)] == [rule]


@pytest.mark.parametrize(("kind", "named"), [("fixed", False), ("continuous", True)])
def test_gazebo_is_named_where_no_other_link_makes_an_inertia_possible(tmp_path, kind, named):
    file = _robot(
        tmp_path,
        _body("base", 1),
        _joint("mount", "base", "plate", kind),
        _body("plate", 1, moments=("0.001", "0.001", "0.003")),
    )
    (found,) = check(file, select=["inertia-triangle-inequality"])
    assert ("gz, gazebo-classic" in found.effects) == named
    assert "mujoco" in found.effects


HAND = "<limit lower='0' upper='1' effort='1' velocity='1'/>"


@pytest.mark.parametrize(
    ("right", "mass", "count"),
    [("0 -0.2 0", 1, 1), ("0 -0.2 0", 0, 0), ("0 0.2 0", 1, 0)],
)
def test_limits_are_compared_of_joints_that_mirror_each_other(tmp_path, right, mass, count):
    parts = [_body("base", 5)]
    for side, sign in (("left", 1), ("right", -1)):
        parts += [
            _joint(f"{side}_arm_joint", "base", f"{side}_arm", "continuous", f"0 {sign * 0.3} 0"),
            _body(f"{side}_arm", 1),
            _joint(f"{side}_leg_joint", "base", f"{side}_leg", "continuous", f"0 {sign * 0.4} 0"),
            _body(f"{side}_leg", 1),
            _joint(
                f"{side}_hand_joint",
                f"{side}_arm",
                f"{side}_hand",
                "revolute",
                "0 0.2 0" if side == "left" else right,
                HAND if side == "left" else HAND.replace("upper='1'", "upper='0.5'"),
            ),
            _body(f"{side}_hand", mass),
        ]
    assert len(_messages(_robot(tmp_path, *parts), "limits-not-mirrored")) == count


def test_moments_of_zero_are_left_to_their_own_rule(tmp_path):
    parts = [_body("base", 5)]
    for side, moments in (("left", (0.01, 0.01, 0.01)), ("right", (1e-19, 1e-19, 1e-19))):
        parts += [
            _joint(f"{side}_joint", "base", f"{side}_arm"),
            _body(f"{side}_arm", 1, moments=moments),
        ]
    assert _messages(_robot(tmp_path, *parts), "left-right-asymmetry") == []


@pytest.mark.parametrize(
    ("moments", "readers"),
    [
        (
            (0.01, 0.01, 0.005),
            ["gz, gazebo-classic, mujoco, drake", "pinocchio"],
        ),
        ((0.01, 0.001, 0.001), ["pinocchio"]),
    ],
)
def test_moments_that_differ_are_computed_anew_by_pybullet(tmp_path, moments, readers):
    parts = [_body("base", 5)]
    for side, values in (("left", (0.1, 0.1, 0.1)), ("right", moments)):
        parts += [
            _joint(f"{side}_joint", "base", f"{side}_arm"),
            _body(f"{side}_arm", 1, moments=values),
        ]
    (found,) = check(_robot(tmp_path, *parts), select=["left-right-asymmetry"])
    assert list(found.effects) == readers


@pytest.mark.parametrize(("scale", "count"), [("0.001", 0), ("0.01", 1), ("1000", 0)])
def test_a_mesh_may_be_in_another_unit(tmp_path, scale, count):
    visual = "<link name='{0}'><visual><geometry><mesh filename='{0}.stl' scale='{1} {1} {1}'/>"
    links = [
        f"{visual.format(name, scale if name == 'e' else 1)}</geometry></visual></link>\n"
        for name in "abcde"
    ]
    assert len(_messages(_robot(tmp_path, *links), "mesh-scale-outlier")) == count
