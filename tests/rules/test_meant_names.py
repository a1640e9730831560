"""Names that somebody meant for a reader, and that no reader has."""

import pytest

from urdftool.api.lint import check

ROBOT = '<robot name="r"><link name="a">{inside}</link>{block}</robot>'
INERTIAL = (
    '<inertial><mass {}/><inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial>'
)


@pytest.mark.parametrize(
    ("tag", "meant"),
    [
        ("gazeb", "gazebo"),
        ("Gazebo", "gazebo"),
        ("transmision", "transmission"),
        ("ros2control", "ros2_control"),
        ("gripper", None),
        ("odometry_source", None),
    ],
)
def test_a_misspelled_block_is_a_warning(write, tag, meant):
    inside = INERTIAL.format('value="1"')
    text = ROBOT.format(inside=inside, block=f'<{tag} name="x"/>')
    found = list(check(write("r.urdf", text), select=["unknown-element"]))
    warned = [f.message for f in found if f.severity.label == "warning"]
    assert warned == (
        [f"<robot> has the unknown element <{tag}>; write <{meant}>"] if meant else []
    )


@pytest.mark.parametrize("name", ["unit", "units"])
def test_an_attribute_that_names_units_is_a_warning(write, name):
    text = ROBOT.format(inside=INERTIAL.format(f'value="3" {name}="lb"'), block="")
    (finding,) = check(write("r.urdf", text), select=["unknown-attribute"])
    assert (finding.severity.label, f"'{name}'" in finding.message) == ("warning", True)
