"""One problem that names several links or joints."""

import pytest

from urdftool import check, load
from urdftool.diagnostic import Severity
from urdftool.rules import get_rule

LINK = """<link name="{name}"><inertial><origin xyz="{com}"/><mass value="{mass}"/>
  <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
  <visual><geometry>{shape}</geometry></visual>
  <collision><geometry>{shape}</geometry></collision></link>
"""
JOINT = """<joint name="{child}_joint" type="revolute"><parent link="{parent}"/>
  <child link="{child}"/><origin xyz="{at}"/><axis xyz="0 1 0"/>
  <limit lower="{lower}" upper="1" effort="1" velocity="1"/></joint>
"""
BOX = '<box size="0.1 0.1 0.1"/>'
TETRAHEDRON = "v 0 0 0\nv .1 0 0\nv 0 .1 0\nv 0 0 .1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def problems(path, rule):
    """Run one rule."""
    return list(get_rule(rule).check(load(path)))


def chain(count, com="0 0 0", mass=1, shape=BOX):
    """Write links in a row."""
    body = "".join(LINK.format(name=f"l{n}", com=com, mass=mass, shape=shape) for n in range(count))
    body += "".join(
        JOINT.format(parent=f"l{n}", child=f"l{n + 1}", at="0 0 0", lower=-1)
        for n in range(count - 1)
    )
    return f'<robot name="r">\n{body}</robot>'


def test_odd_densities(write):
    path = write("few.urdf", chain(6, mass=15))
    assert [one.name for one in problems(path, "implausible-density")] == [
        f"l{n}" for n in range(6)
    ]
    (found,) = problems(write("many.urdf", chain(7, mass=15)), "implausible-density")
    assert (found.name, found.severity) == ("l0", Severity.INFO)
    assert found.data == {"mass": 15, "density": pytest.approx(15000), "is_too_large": True}
    others = ", ".join(f"'l{n}' 1.5e+04" for n in range(1, 7))
    assert found.message.endswith(f": {others}")


def test_impossible_densities_are_named_one_by_one(write):
    found = problems(write("r.urdf", chain(7, mass=30)), "implausible-density")
    assert {one.severity for one in found} == {Severity.WARNING}
    assert [one.name for one in found] == [f"l{n}" for n in range(7)]


def test_centers_of_mass_outside_of_meshes(write):
    write("part.obj", TETRAHEDRON)
    mesh, com = '<mesh filename="part.obj"/>', "0.17 0.05 0.05"
    path = write("few.urdf", chain(6, com=com, shape=mesh))
    assert [one.name for one in problems(path, "com-outside-geometry")] == [
        f"l{n}" for n in range(6)
    ]
    path = write("many.urdf", chain(7, com=com, shape=mesh))
    (found,) = problems(path, "com-outside-geometry")
    assert (found.name, found.severity) == ("l0", Severity.INFO)
    assert found.data == {"distance": pytest.approx(0.07), "axis": "x"}
    others = ", ".join(f"'l{n}' by 0.07 m along x" for n in range(1, 7))
    assert found.message.endswith(f": {others}")


def limbs(count, lower):
    """Write a body with limbs on both sides, of which the right ones have another lower limit."""
    body = LINK.format(name="base", com="0 0 0", mass=1, shape=BOX)
    for n in range(count):
        for side, y, low in (("left", 0.2, -1), ("right", -0.2, lower)):
            name, at = f"{side}_leg_{n}", f"{n} {y} 0"
            body += LINK.format(name=name, com="0 0 0", mass=1, shape=BOX)
            body += JOINT.format(parent="base", child=name, at=at, lower=low)
    return f'<robot name="r">\n{body}</robot>'


def test_limits_that_are_not_mirrored(write):
    found = problems(write("few.urdf", limbs(3, -0.5)), "limits-not-mirrored")
    assert [one.name for one in found] == [f"right_leg_{n}_joint" for n in range(3)]
    (found,) = problems(write("many.urdf", limbs(4, -0.5)), "limits-not-mirrored")
    assert found.data == {"twin": "left_leg_0_joint", "mirrored": [-1, 1]}
    others = ", ".join(f"'right_leg_{n}_joint' (-1 to 1)" for n in range(1, 4))
    assert found.message.endswith(f"-1 to 1; also {others}")
    assert found.place.line == found.subject.limit.place.line


def _list_grouped(path, code):
    return check(path, select=[code], grouped=True)


def _write_joints(count, joint):
    links = "".join(f"<link name='l{n}'/>" for n in range(count + 1))
    joints = (joint.format(parent=f"l{n}", child=f"l{n + 1}") for n in range(count))
    return f"<robot name='r'>{links}{''.join(joints)}</robot>"


@pytest.mark.parametrize(("count", "findings"), [(3, 3), (4, 1), (9, 1)])
def test_many_warnings_of_a_rule_are_one(write, count, findings):
    joint = (
        "<joint name='{child}_joint' type='continuous'><parent link='{parent}'/>"
        "<child link='{child}'/><axis xyz='1 1 0'/></joint>"
    )
    found = _list_grouped(write("r.urdf", _write_joints(count, joint)), "axis-not-unit")
    assert len(found) == findings
    assert sum(one.count for one in found) == count
    if findings == 1:
        assert f"(and {count - 1} more: 'l2_joint', 'l3_joint'" in found[0].message


def test_errors_are_each_reported(write):
    joint = (
        "<joint name='{child}_joint' type='continuous'><parent link='{parent}'/>"
        "<child link='{child}'/><axis xyz='0 0 0'/></joint>"
    )
    found = _list_grouped(write("r.urdf", _write_joints(5, joint)), "zero-axis")
    assert {one.severity for one in found} == {Severity.ERROR}
    assert len(found) == 5


def test_a_package_is_missing_once_for_a_repository(write, urdftool):
    mesh = "<mesh filename='package://lost_description/m.stl'/>"
    visual = f"<visual><geometry>{mesh}</geometry></visual>"
    for name in ("a", "b", "c"):
        write(f"{name}.urdf", f"<robot name='{name}'><link name='l'>{visual}</link></robot>")
    result = urdftool("lint", ".", "--select", "package-not-found", "--format", "concise")
    (line,) = (line for line in result.out.splitlines() if "lost_description" in line)
    assert "'lost_description' is not found, so the meshes of 3 places were not checked" in line
