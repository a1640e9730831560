"""Defects that were an info or silent although the robot shows them."""

import pytest

from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

SIX = '<inertia ixx="{0}" ixy="0" ixz="0" iyy="{0}" iyz="0" izz="{0}"/>'
JOINT = (
    '<joint name="{0}_joint" type="{1}"><parent link="{2}"/><child link="{0}"/>'
    '<origin xyz="{3}"/><axis xyz="{4}"/>'
    '<limit lower="{5}" upper="{6}" effort="9" velocity="9"/></joint>'
)


def inertial(moment=0.0017, mass=1, xyz="0 0 0"):
    return f'<inertial><origin xyz="{xyz}"/><mass value="{mass}"/>{SIX.format(moment)}</inertial>'


def shape(part, xyz="0 0 0", size=0.1):
    box = f'<geometry><box size="{size} {size} {size}"/></geometry>'
    return f'<{part}><origin xyz="{xyz}"/>{box}</{part}>'


def link(name, *parts):
    return f'<link name="{name}">{"".join(parts)}</link>'


def joint(child, kind, parent="base", xyz="0 0 0", axis="0 0 1", low=0, high=0.5):
    return JOINT.format(child, kind, parent, xyz, axis, low, high)


def find(tmp_path, rule, *parts):
    path = tmp_path / "r.urdf"
    path.write_text(f'<robot name="r">{"".join(parts)}</robot>', "utf-8")
    report = check_file(path, Options(Settings(select=(rule,))))
    return [(f.name, f.severity.label) for f in report.findings]


WHOLE = (inertial(), shape("visual"), shape("collision"))


def legs(*right):
    """Two legs with feet that are fixed to them; the right leg has other parts."""
    parts = [link("base", *WHOLE)]
    for side, inside, y in (("left", WHOLE, 0.2), ("right", right, -0.2)):
        parts += [link(f"{side}_leg", *inside), link(f"{side}_foot", *WHOLE)]
        parts.append(joint(f"{side}_leg", "revolute", xyz=f"0 {y} 0"))
        parts.append(joint(f"{side}_foot", "fixed", f"{side}_leg", xyz="0 0 -0.2"))
    return parts


@pytest.mark.parametrize(
    ("right", "rule", "found"),
    [
        (WHOLE, "missing-inertial", []),
        (WHOLE[1:], "missing-inertial", [("right_leg", "warning")]),
        ((inertial(0), *WHOLE[1:]), "zero-inertia", [("right_leg", "warning")]),
        ((inertial(0, 0.01), *WHOLE[1:]), "zero-inertia", [("right_leg", "warning")]),
    ],
)
def test_what_the_mirror_image_has_is_missed(tmp_path, right, rule, found):
    assert find(tmp_path, rule, *legs(*right)) == found


@pytest.mark.parametrize(
    ("mass", "kind", "found"),
    [
        (0.5, "revolute", [("part", "warning")]),
        (0.05, "revolute", []),
        (1, "fixed", [("part", "info")]),
        (0.2, "fixed", []),
    ],
)
def test_the_link_that_a_joint_moves_needs_an_inertia(tmp_path, mass, kind, found):
    top = [] if kind == "revolute" else [link("top", *WHOLE), joint("top", "revolute")]
    parent = "base" if kind == "revolute" else "top"
    parts = [link("base", *WHOLE), *top, link("part", inertial(0, mass), shape("visual"))]
    parts += [joint("part", kind, parent), link("tip", *WHOLE), joint("tip", "fixed", "part")]
    assert find(tmp_path, "zero-inertia", *parts) == found


@pytest.mark.parametrize(
    ("axis", "places", "low", "found"),
    [
        ("0 0 1", (0.02, -0.02), 0, [("right_finger_joint", "warning")]),
        ("0 0 -1", (0.02, -0.02), 0, []),
        ("0 0 1", (0, 0), 0, []),
        ("0 0 1", (0.02, -0.02), -0.5, []),
    ],
)
def test_fingers_that_turn_the_same_way_do_not_grip(tmp_path, axis, places, low, found):
    left, right = (f"0 {y} 0" for y in places)
    parts = [link("base"), link("left_finger"), link("right_finger")]
    parts.append(joint("left_finger", "revolute", xyz=left, low=low))
    parts.append(joint("right_finger", "revolute", xyz=right, axis=axis, low=low))
    assert find(tmp_path, "fingers-move-together", *parts) == found


@pytest.mark.parametrize(("rail", "found"), [((), ["cart"]), (("collision",), [])])
def test_a_rail_without_a_collision_excuses_nothing(tmp_path, rail, found):
    long = "<visual><geometry><box size='3 .05 .05'/></geometry></visual>"
    parts = [link("rail", long, *(long.replace("visual", part) for part in rail))]
    parts += [link("cart", inertial(), shape("visual")), link("pole", *WHOLE)]
    parts.append(joint("cart", "prismatic", "rail", axis="1 0 0"))
    parts.append(joint("pole", "revolute", "cart"))
    names = {name for name, _ in find(tmp_path, "missing-collision", *parts)}
    names |= {name for name, _ in find(tmp_path, "odd-link-without-collision", *parts)}
    assert sorted(names - {"rail"}) == found


@pytest.mark.parametrize(
    ("distance", "found"),
    [(0.2, []), (0.09, []), (0.01, [("right", "warning")])],
)
def test_links_inside_one_another_are_a_warning(tmp_path, distance, found):
    parts = [link("base", inertial()), link("left", *WHOLE), link("right", *WHOLE)]
    parts += [joint("left", "revolute"), joint("right", "revolute", xyz=f"{distance} 0 0")]
    assert find(tmp_path, "self-collision-at-zero", *parts) == found


@pytest.mark.parametrize(
    ("xyz", "size", "found"),
    [("0.01 0 0", 0.1, []), ("0.4 0 0", 0.1, "warning"), ("0.4 0 0", 0.2, "warning")],
)
def test_a_collision_apart_from_visual_and_mass_is_a_warning(tmp_path, xyz, size, found):
    inside = (inertial(xyz="0.01 0 0"), shape("visual"), shape("collision", xyz, size))
    parts = [link("base"), link("a", *inside), joint("a", "revolute")]
    expected = [("a", found)] if found else []
    assert find(tmp_path, "collision-off-visual", *parts) == expected


@pytest.mark.parametrize(
    ("kind", "x", "found"),
    [("revolute", 0.1, []), ("revolute", 0.5, [("a", "warning")]), ("fixed", 0.5, [])],
)
def test_a_light_link_with_its_mass_far_away_is_reported_if_it_moves(tmp_path, kind, x, found):
    light = (inertial(1e-5, 0.001, f"{x} 0 0"), shape("visual"), shape("collision"))
    parts = [link("base", *WHOLE), link("a", *light), joint("a", kind)]
    assert find(tmp_path, "com-outside-geometry", *parts) == found


def test_a_package_with_the_same_ending_is_not_suggested(tmp_path):
    (tmp_path / "package.xml").write_text("<package><name>ur_description</name></package>")
    mesh = '<visual><geometry><mesh filename="package://{}/a.stl"/></geometry></visual>'
    path = tmp_path / "r.urdf"
    for name, suggested in (("pr2_description", False), ("urdescription", True)):
        path.write_text(f'<robot name="r"><link name="a">{mesh.format(name)}</link></robot>')
        report = check_file(path, Options(Settings(select=("package-not-found",))))
        assert ("did you mean" in report.findings[0].message) is suggested


@pytest.mark.parametrize(("mass", "found"), [(1.2, "info"), (6, "warning")])
def test_a_mass_many_times_that_of_the_mirror_image_is_a_warning(tmp_path, mass, found):
    right = (inertial(0.0017 * mass, mass), *WHOLE[1:])
    assert find(tmp_path, "left-right-asymmetry", *legs(*right)) == [("right_leg", found)]


@pytest.mark.parametrize("sensor", [0.001, 0.5])
@pytest.mark.parametrize(
    ("inside", "rule"), [((), "missing-inertial"), ((inertial(0, 0),), "zero-mass")]
)
def test_a_sensor_is_not_the_mass_of_a_trunk(tmp_path, inside, rule, sensor):
    """A trunk of 27 liters without mass and a sensor: 1 g is less than the air in it."""
    trunk = (*inside, shape("visual", size=0.3), shape("collision", size=0.3))
    parts = [link("trunk", *trunk), link("imu", inertial(1e-7, sensor), shape("visual", size=0.01))]
    parts += [
        joint("imu", "fixed", "trunk"),
        link("leg", *WHOLE),
        joint("leg", "revolute", "trunk"),
    ]
    found = find(tmp_path, rule, *parts)
    if sensor == 0.001:
        assert found == [("trunk", "warning")]
    else:
        assert ("trunk", "warning") not in found
