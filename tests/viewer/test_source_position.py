"""The link at a line of the source."""

import pytest

from tests.conftest import FIXTURES
from urdftool import load
from urdftool.viewer.source_position import find_link_at

URDF = FIXTURES / "robots" / "demo_arm" / "urdf"
ARM = URDF / "arm_sound.urdf.xacro"
MACROS = URDF / "link_sound.macro.xacro"


@pytest.fixture(scope="module")
def robot():
    return load(ARM)


@pytest.mark.parametrize(
    ("text", "link"),
    [
        ('<link name="${prefix}base_link">', "base_link"),
        ('<mass value="3"/>', "base_link"),  # inside of the link
        ('<joint name="${prefix}pan"', "shoulder"),  # its child
        ('<limit lower="-1.57"', "upper_arm"),
        ('<xacro:arm_link name="${prefix}forearm"', "forearm"),  # by the call of the macro
        ('<link name="${prefix}flange">', "flange"),
    ],
)
def test_a_line_leads_to_its_link(robot, text, link):
    lines = ARM.read_text().splitlines()
    (line,) = [number for number, one in enumerate(lines, 1) if text in one]
    assert find_link_at(robot, str(ARM), line) == link


def test_a_line_in_a_macro_leads_to_the_first_link_of_it(robot):
    lines = MACROS.read_text().splitlines()
    (line,) = [number for number, one in enumerate(lines, 1) if "<link " in one]
    assert find_link_at(robot, str(MACROS), line + 1) == "shoulder"


def test_nothing_before_the_first_element(robot):
    assert find_link_at(robot, str(ARM), 1) is None
    assert find_link_at(robot, str(FIXTURES / "robots/ten_links.urdf"), 5) is None


@pytest.mark.parametrize("at", ["arm.urdf", ":3", "arm.urdf:x"])
def test_a_place_in_another_form_is_an_error(urdftool, at):
    done = urdftool("view", ARM, "--at", at)
    assert done.code == 2
    assert "--at requires FILE:LINE" in done.err
