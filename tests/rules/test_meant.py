"""Values that are meant are off by default, and the same kind of value by mistake is not."""

import pytest

from urdftool.api.lint import check

MASS = (
    '<inertial><mass value="1"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>'
    "</inertial>"
)
BODY = '<link name="{}">{}<visual>{}</visual><collision>{}</collision></link>'
JOINT = (
    '<joint name="{0}" type="revolute"><parent link="{1}"/><child link="{0}"/>'
    '<limit lower="-1" upper="1" effort="9" velocity="9"/></joint>'
)


def box(size, at="0 0 0"):
    return f'<origin xyz="{at}"/><geometry><box size="{size}"/></geometry>'


def ball(radius, at="0 0 0"):
    return f'<origin xyz="{at}"/><geometry><sphere radius="{radius}"/></geometry>'


def _find(tmp_path, text, rule, **options):
    path = tmp_path / options.pop("name", "r.urdf")
    path.write_text(f'<robot name="{options.pop("robot", "r")}">{text}</robot>')
    return [f for f in check(path, **options) if f.code == rule]


LARGER = "collision-much-larger-than-visual"


@pytest.mark.parametrize(
    ("radius", "at", "count"),
    [("0.15", "0 0 0", 0), ("0.3", "0 0 0", 1), ("0.15", "0 0 -0.1", 1)],
)
def test_a_sphere_around_a_drone_is_meant(tmp_path, radius, at, count):
    drone = BODY.format("drone", MASS, box("0.2 0.2 0.04"), ball(radius, at))
    assert len(_find(tmp_path, drone, LARGER)) == count


@pytest.mark.parametrize(
    ("middle", "length", "count"), [("-0.15", "0.3", 0), ("0.15", "0.4", 1), ("-0.15", "0.9", 1)]
)
def test_a_collision_of_a_whole_thigh_spans_what_its_joint_moves(tmp_path, middle, length, count):
    hip = BODY.format("hip", MASS, box("0.1 0.1 0.1"), box(f"0.1 0.1 {length}", f"0 0 {middle}"))
    thigh = f'<link name="thigh">{MASS}<visual>{box("0.1 0.1 0.3", "0 0 -0.15")}</visual></link>'
    base = BODY.format("base", MASS, box("0.1 0.1 0.1"), box("0.1 0.1 0.1"))
    robot = base + hip + thigh + JOINT.format("hip", "base") + JOINT.format("thigh", "hip")
    assert len(_find(tmp_path, robot, LARGER)) == count


TENSOR = '<inertia ixx="{0}" ixy="{1}" ixz="{1}" iyy="{0}" iyz="{1}" izz="{0}"/>'


@pytest.mark.parametrize(
    ("links", "product", "count"), [(3, "0.0013", 0), (1, "0.0013", 1), (3, "0", 3)]
)
def test_identified_inertias_of_several_links_are_meant(tmp_path, links, product, count):
    """Full tensors that are three times too long, as those of the Panda by Gaz et al."""
    own = '<inertial><mass value="1"/>' + TENSOR.format("0.0137", product) + "</inertial>"
    robot = BODY.format("base", MASS, box("0.3 0.3 0.3"), box("0.3 0.3 0.3"))
    for number in range(links):
        robot += BODY.format(f"l{number}", own, box("0.1 0.1 0.1"), box("0.1 0.1 0.1"))
        robot += JOINT.format(f"l{number}", "base")
    found = _find(tmp_path, robot, "inertia-exceeds-geometry")
    assert len(found) == count
    assert all(one.severity.name == "WARNING" for one in found)


@pytest.mark.parametrize(
    ("name", "robot", "targets", "count"),
    [
        ("arm_continuous.urdf", "r", (), 0),
        ("arm.urdf", "arm_continuous", (), 0),
        ("arm.urdf", "r", (), 1),
        ("arm_continuous.urdf", "r", ("newton",), 1),
    ],
)
def test_bounds_of_a_robot_that_is_called_continuous(tmp_path, name, robot, targets, count):
    joint = JOINT.format("b", "a").replace("revolute", "continuous")
    text = f'<link name="a"/><link name="b"/>{joint}'
    found = _find(tmp_path, text, "continuous-with-bounds", name=name, robot=robot, targets=targets)
    assert len(found) == count


@pytest.mark.parametrize(
    ("options", "count"),
    [({}, 0), ({"select": ["unknown-element"]}, 1), ({"select": ["pedantic"]}, 1)],
)
def test_infos_of_a_rule_that_were_rarely_useful_are_off(tmp_path, options, count):
    text = '<link name="a"><for_my_program/></link>'
    assert len(_find(tmp_path, text, "unknown-element", **options)) == count
    assert len(_find(tmp_path, '<link name="a"><colision/></link>', "unknown-element")) == 1


def test_infos_that_the_configuration_asks_for_are_on(tmp_path):
    (tmp_path / "urdftool.toml").write_text('[lint.severity]\nunknown-element = "info"\n')
    assert _find(tmp_path, '<link name="a"><for_my_program/></link>', "unknown-element")


@pytest.mark.parametrize(
    ("code", "count"), [("import pybullet\n", 0), ("import pinocchio\npinocchio.rnea\n", 1)]
)
def test_an_inertia_of_mass_zero_has_no_effect_in_pybullet(tmp_path, code, count):
    (tmp_path / "setup.py").write_text("")
    (tmp_path / "env.py").write_text(code)
    zero = MASS.replace('value="1"', 'value="0"')
    text = f'<link name="a">{MASS}</link><link name="tip">{zero}</link>'
    text += JOINT.format("tip", "a").replace("revolute", "fixed")
    assert len(_find(tmp_path, text, "zero-mass")) == count
