"""Joints far from their links, masses out of line, and meshes in two places."""

import re
import shutil

import pytest

from tests.conftest import FIXTURES
from urdftool import check

RULES = FIXTURES / "rules"
PART = (
    '<link name="{0}">{1}</link><joint name="{0}_joint" type="{2}"><parent link="{3}"/>'
    '<child link="{0}"/><origin xyz="{4}"/><axis xyz="0 1 0"/></joint>\n'
)
SHAPE = '<collision><origin xyz="{}"/><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'


def found(write, *parts):
    base = SHAPE.format("0 0 0")
    body = "".join(PART.format(*part) for part in parts)
    path = write("r.urdf", f"<robot name='r'><link name='base'>{base}</link>{body}</robot>")
    return check(path, select=("axis-misses-links",))


def test_one_axis_far_from_both(write):
    (one,) = found(write, ("lid", SHAPE.format("-1 0 0"), "continuous", "base", "1 0 0"))
    assert one.name == "lid_joint"
    assert "0.95 m from link 'lid' and 0.95 m from 'base'" in one.message


@pytest.mark.parametrize(
    ("shape", "kind"),
    [
        (SHAPE.format("0 0 0"), "continuous"),  # it touches the child
        (SHAPE.format("-1 0 0"), "prismatic"),  # which slides wherever its frame is
        ("", "continuous"),  # it moves a mere frame
        ('<visual><geometry><mesh filename="no.stl"/></geometry></visual>', "continuous"),
    ],
)
def test_an_axis_that_may_be_right(write, shape, kind):
    assert found(write, ("lid", shape, kind, "base", "1 0 0")) == []


def test_what_is_fixed_to_a_link_counts_as_the_link(write):
    lid = ("lid", SHAPE.format("-1 0 0"), "continuous", "base", "1 0 0")
    hinge = ("hinge", SHAPE.format("0 0 0"), "fixed", "lid", "0 0 0")
    assert found(write, lid, hinge) == []


def parts_of(spread, count=3):
    """Links that stand 0.5 m apart, with their joints at the base, or each at its own."""
    for number in range(1, count + 1):
        at = f"{0.5 * number} 0 0"
        yield f"l{number}", SHAPE.format("0 0 0" if spread else at), at if spread else "0 0 0"


@pytest.mark.parametrize(("spread", "count"), [(False, 1), (True, 0)])
def test_joints_in_one_place(write, spread, count):
    parts = [(name, shape, "continuous", "base", xyz) for name, shape, xyz in parts_of(spread)]
    findings = found(write, *parts)
    assert len(findings) == count
    assert all("the frames of 3 links are in one place" in one.message for one in findings)


def test_a_mass_in_grams_does_not_hide_another_mass(write):
    text = (RULES / "mass-outlier" / "bad.urdf").read_text()
    first = text.index("<mass value=", text.index("<mass value=") + 1)
    grams = text[:first] + re.sub(r'value="([\d.]+)"', r'value="\g<1>000"', text[first:], count=1)
    found = check(write("grams.urdf", grams), select=("mass-outlier",))
    assert "forearm" in [finding.name for finding in found]
    assert len(found) == 2


def test_a_mass_that_its_inertia_goes_with_is_another_material(write):
    text = (RULES / "mass-outlier" / "bad.urdf").read_text()
    assert [f.name for f in check(write("bad.urdf", text), select=("mass-outlier",))] == ["forearm"]
    heavy = '<mass value="5"/> <!-- mass-outlier -->\n      <inertia ixx="0.0047" ixy="0" '
    assert heavy in text
    text = re.sub(
        r'(<mass value="5"/>.*\n *)<inertia.*/>',
        r'\1<inertia ixx="0.0235" ixy="0" ixz="0" iyy="0.0235" iyz="0" izz="0.003"/>',
        text,
    )
    assert check(write("steel.urdf", text), select=("mass-outlier",)) == []


@pytest.mark.parametrize(
    ("link", "part", "found"), [("pillar", 1, 1), ("pillar", 0.4, 0), ("forearm", 0.4, 1)]
)
def test_a_root_with_motor_and_electronics_is_denser_than_the_others(write, link, part, found):
    """A root of 2400 kg/m³ beside links of 500 kg/m³, and one of 6000 kg/m³."""
    text = (RULES / "mass-outlier" / "bad.urdf").read_text()
    if link == "pillar":  # exchange the two
        names = {"pillar": "forearm", "forearm": "pillar"}
        text = re.sub(r'(<link name=")(pillar|forearm)"', lambda m: f'{m[1]}{names[m[2]]}"', text)
    numbers = re.compile(r'((?:mass value|i[xyz][xyz])=")([\d.]+)"')
    text = numbers.sub(lambda m: f'{m[1]}{float(m[2]) * part:g}"', text)
    assert len(check(write("root.urdf", text), select=("mass-outlier",))) == found


VISUAL = '<visual><origin xyz="{}"/><geometry><mesh filename="arm.stl"/></geometry></visual>'


@pytest.mark.parametrize(
    ("seen", "touched", "count"),
    [
        (["0 0 0"], ["0 0 0"], 0),
        (["0 0 0"], ["0 0 0.00005"], 0),
        (["0 0 0"], ["0 0 0.001"], 1),
        (["0 0 0", "0 1 0"], ["0 1 0", "0 0 0"], 0),  # in another order
        (["0 0 0", "0 1 0"], ["0 1 0"], 0),  # one of them is without a collision
        (["0 0 0"], ["0 0 0", "0 1 0"], 0),  # a copy made on purpose
        (["0 0 0", "0 1 0"], ["0 0 0", "0 1.1 0"], 1),
    ],
)
def test_copies_of_a_mesh_are_paired(write, tmp_path, seen, touched, count):
    shutil.copy(RULES / "collision-mesh-displaced" / "meshes" / "arm.stl", tmp_path)
    shapes = "".join(map(VISUAL.format, seen))
    shapes += "".join(VISUAL.format(xyz).replace("visual", "collision") for xyz in touched)
    path = write("r.urdf", f"<robot name='r'><link name='base'>{shapes}</link></robot>")
    assert len(check(path, select=("collision-mesh-displaced",))) == count
