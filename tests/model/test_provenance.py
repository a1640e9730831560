"""Parts know where they were written, in whatever format."""

import pytest

from urdftool.model.elements import Box, Collision, Joint, Link, Robot
from urdftool.model.kinematics import link_poses
from urdftool.model.provenance import NOWHERE, Written
from urdftool.source.location import Place, SourceFile


def test_a_part_of_another_format_has_its_place_and_no_element():
    file = SourceFile("arm.xml", b"<mujoco>\n <body name='arm'/>\n</mujoco>")
    link = Link(Written(Place(file, 10, 28)), "arm")
    assert (link.place.path, link.place.line, link.place.column) == ("arm.xml", 2, 2)
    with pytest.raises(TypeError, match="Link was not read from URDF"):
        link.element.get("name")


def test_a_robot_without_a_source_can_be_computed_with():
    links = [
        Link(name="base"),
        Link(name="arm", collisions=[Collision(geometry=Box(size=(1, 1, 1)))]),
    ]
    joints = [Joint(name="j", type="fixed", parent="base", child="arm")]
    robot = Robot(name="made", links=links, joints=joints)
    assert robot.tree.root is links[0]
    assert link_poses(robot)["arm"].translation == (0.0, 0.0, 0.0)
    assert robot.place == links[1].place == NOWHERE
