"""Links of a robot without any color are told apart; a robot with colors is shown as it is."""

from urdftool.drawing.materials import PLAIN, TINTS, Tints
from urdftool.model.load import load

LINK = '<link name="{0}"><visual><geometry><box size="1 1 1"/></geometry>{1}</visual></link>'
JOINT = '<joint name="j{1}" type="fixed"><parent link="{0}"/><child link="{1}"/></joint>'
RED = '<material name="red"><color rgba="1 0 0 1"/></material>'


def tints(write, *materials):
    names = "abcdefgh"[: len(materials)]
    links = "".join(map(LINK.format, names, materials))
    joints = "".join(map(JOINT.format, names, names[1:]))
    robot = load(write("r.urdf", f'<robot name="r">{links}{joints}</robot>'))
    found = Tints(robot)
    return [found.get_tint(link.visuals[0]) for link in robot.links]


def test_links_without_color_are_told_apart(write):
    assert tints(write, "", "", "") == list(TINTS[:3])


def test_with_many_links_the_tints_repeat(write):
    assert tints(write, *[""] * 7)[6] == TINTS[0]


def test_a_robot_with_a_color_is_shown_as_it_is(write):
    assert tints(write, "", RED, "") == [PLAIN] * 3


def test_one_link_alone_is_plain(write):
    assert tints(write, "") == [PLAIN]
