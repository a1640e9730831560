"""Parts know where they were written, in whatever format."""

import pytest

from tests.build import joint, link, robot
from urdftool.model.elements import Box, Link
from urdftool.model.kinematics import link_poses
from urdftool.model.provenance import NOWHERE, Written
from urdftool.source.location import Place, SourceFile


def test_a_part_of_another_format_has_its_place_and_no_element():
    file = SourceFile("arm.xml", b"<mujoco>\n <body name='arm'/>\n</mujoco>")
    part = Link(Written(Place(file, 10, 28)), "arm")
    assert (part.place.path, part.place.line, part.place.column) == ("arm.xml", 2, 2)
    with pytest.raises(TypeError, match="Link was not read from URDF"):
        part.element.get("name")


def test_a_robot_without_a_source_can_be_computed_with():
    made = robot([link("base"), link("arm", Box(size=(1, 1, 1)))], [joint("j", "base", "arm")])
    assert made.tree.root is made.links[0]
    assert link_poses(made)["arm"].translation == (0.0, 0.0, 0.0)
    assert made.place == made.links[1].place == NOWHERE
