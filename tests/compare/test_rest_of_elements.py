"""What a URDF has in its shapes and limits for one reader is compared as it is written."""

import pytest

INERTIAL = (
    '<inertial><mass value="1"/>'
    '<inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial>'
)
ROBOT = (
    '<robot name="r" xmlns:drake="http://drake.mit.edu"><link name="a">{inertial}{shape}</link>'
    '<link name="b">{inertial}</link><joint name="j" type="revolute"><parent link="a"/>'
    '<child link="b"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="5" velocity="2"'
    "{limit}/></joint></robot>"
)
BOX = '<geometry><box size="1 1 1"/></geometry>'
PLAIN = f"<collision>{BOX}</collision>"
FRICTION = "<collision>{}<drake:proximity_properties>{}</drake:proximity_properties></collision>"
RUBBER = '<contact><lateral_friction value="{}"/></contact>'

PAIRS = {
    "group": ((PLAIN, ""), (f'<collision group="0">{BOX}</collision>', ""), "collision/@group"),
    "mesh": (
        (PLAIN, ""),
        (PLAIN.replace("<box ", '<box drake:convex="1" '), ""),
        "collision/geometry/box/@drake:convex",
    ),
    "limit": ((PLAIN, ' acceleration="3"'), (PLAIN, ' acceleration="5"'), "limit/@acceleration"),
    "drake": (
        (FRICTION.format(BOX, '<drake:mu_static value=".1"/>'), ""),
        (FRICTION.format(BOX, '<drake:mu_static value=".9"/>'), ""),
        "collision/drake:proximity_properties/drake:mu_static/@value",
    ),
    "contact": (
        (RUBBER.format(".1"), ""),
        (RUBBER.format(".9"), ""),
        "contact/lateral_friction/@value",
    ),
    "second shape": (
        (PLAIN + PLAIN, ""),
        (PLAIN + f'<collision concave="yes">{BOX}</collision>', ""),
        "collision(2)/@concave",
    ),
}


@pytest.mark.parametrize("name", PAIRS)
def test_attributes_and_elements_of_one_reader_are_compared(urdftool, tmp_path, name):
    files = []
    for number, (shape, limit) in enumerate(PAIRS[name][:2]):
        files.append(tmp_path / f"{number}.urdf")
        files[-1].write_text(ROBOT.format(inertial=INERTIAL, shape=shape, limit=limit))
    for command in ("verify", "diff"):
        result = urdftool(command, *files)
        assert result.code == 1
        assert PAIRS[name][2] in result.out
        assert urdftool(command, files[0], files[0]).code == 0


def test_friction_that_applies_to_a_collision_is_compared_once(urdftool, tmp_path):
    files = []
    for number, value in enumerate((".1", ".9")):
        files.append(tmp_path / f"{number}.urdf")
        shape = PLAIN + RUBBER.format(value)
        files[-1].write_text(ROBOT.format(inertial=INERTIAL, shape=shape, limit=""))
    result = urdftool("verify", *files)
    assert result.code == 1
    assert "contact/lateral_friction" not in result.out
