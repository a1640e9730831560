"""What is advised for a ``<gazebo>`` block that does nothing where it refers to."""

import pytest

from urdftool import check

INERTIAL = (
    '<inertial><mass value="1"/>'
    '<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>'
)
ROBOT = (
    '<robot name="r"><link name="palm_link">{0}</link><link name="finger_link">{0}</link>'
    '<joint name="j" type="continuous"><parent link="palm_link"/><child link="finger_link"/>'
    '<axis xyz="0 0 1"/></joint>{1}</robot>'
)


def found(write, rule, blocks, **more):
    path = write("r.urdf", ROBOT.format(INERTIAL, blocks))
    return check(path, select=[rule], targets=["gazebo-classic"], **more)


@pytest.mark.parametrize(
    ("at_joint", "removed"),
    [
        ("", False),
        ('<gazebo reference="j"><stopKd>1</stopKd></gazebo>', False),
        ('<gazebo reference="j"><provideFeedback>1</provideFeedback></gazebo>', True),
    ],
)
def test_a_word_that_the_joint_has_is_to_be_removed(write, at_joint, removed):
    blocks = '<gazebo reference="finger_link"><provideFeedback>1</provideFeedback></gazebo>'
    (finding,) = found(write, "misplaced-extension", blocks + at_joint, fixes=True)
    assert ("remove it, because joint 'j' already has its own" in finding.message) == removed
    assert ("write it for joint 'j'" in finding.message) != removed
    assert finding.fix is not None
    assert ("remove" in finding.fix.message) == removed


@pytest.mark.parametrize(
    ("beside", "suggestion"),
    [
        ("", "palm_link"),
        ('<gazebo reference="palm_link"><kp>1</kp></gazebo>', "palm_link"),
        ('<gazebo reference="palm_link"><mu1>1</mu1></gazebo>', None),
    ],
)
def test_a_link_with_the_settings_of_a_block_is_not_meant_by_it(write, beside, suggestion):
    blocks = '<gazebo reference="plam_link"><mu1>1</mu1></gazebo>' + beside
    (finding,) = found(write, "dangling-reference", blocks)
    assert (finding.data["suggestion"] or None) == suggestion


def test_a_link_of_sdf_is_not_found_by_a_reference(write):
    blocks = (
        '<gazebo reference="palm_lnk"><mu1>1</mu1></gazebo><gazebo><link name="palm_lnk"/></gazebo>'
    )
    (finding,) = found(write, "dangling-reference", blocks)
    assert "suggestion" not in finding.data
    assert "an SDF link" in finding.message
