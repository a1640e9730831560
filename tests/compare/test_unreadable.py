"""Values that readers take in different ways are equal only if their texts are."""

import pytest

import urdftool

URDF = """<robot name="r"><link name="a"><inertial><origin xyz="0 0 0"/><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size="1 1 1"/></geometry></collision></link><link name="b"/>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 1"/>
<axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="5" velocity="1"/></joint></robot>"""
CHANGES = {
    "decimal comma": ('value="1"', 'value="1,5"', 'value="2,5"', "mass"),
    "unit": ('effort="5"', 'effort="5N"', 'effort="6N"', "limits"),
    "too many numbers": ('xyz="0 0 1"', 'xyz="0 0 1 2"', 'xyz="0 0 1 3"', "frames"),
    "infinite": ('size="1 1 1"', 'size="1 1 inf"', 'size="1 1 -inf"', "collisions"),
    "missing": ('ixy="0" ', 'ixy="0" ', "", "inertia"),
    "second mass": ("<inertia ", "<inertia ", '<mass value="9"/><inertia ', "mass"),
    "second shape": (
        "<box ",
        "<box ",
        '<box size="1 1 1"/><sphere radius="9"/><box ',
        "collisions",
    ),
    "second link": ('<link name="b"/>', '<link name="b"/>', '<link name="b"/>' * 2, "tree"),
}


@pytest.mark.parametrize("change", CHANGES)
def test_other_texts_are_not_equal(tmp_path, change):
    old, one, two, row = CHANGES[change]
    robots = []
    for name, new in (("a", one), ("b", two), ("c", two)):
        path = tmp_path / name / "r.urdf"
        path.parent.mkdir()
        path.write_text(URDF.replace(old, new))
        robots.append(urdftool.load(path))
    agreement = urdftool.verify(*robots[:2])
    assert not agreement.is_equal
    (comparison,) = agreement.pairs.values()
    checks = {check.name: check.verdict for check in comparison.make_checks()}
    assert checks[row] in ("not compared", "differs")
    assert urdftool.verify(*robots[1:]).is_equal
