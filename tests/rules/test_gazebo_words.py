"""Which words Gazebo is told of, and which it is not."""

import pytest

from urdftool.api.lint import check

ROBOT = """<robot name="r">
  <link name="base"/>
  <link name="arm"/>
  <joint name="joint" type="fixed"><parent link="base"/><child link="arm"/></joint>
  <gazebo{reference}>
    {inside}
  </gazebo>
</robot>
"""


def _found(tmp_path, inside, reference="", select="unknown-extension"):
    file = tmp_path / "robot.urdf"
    file.write_text(ROBOT.format(inside=inside, reference=reference))
    return [(f.severity.label, f.message) for f in check(file, select=[select])]


@pytest.mark.parametrize(
    "inside",
    [
        "<mu1>1</mu1>",
        "<self_collide>true</self_collide>",
        "<sensor name='s' type='imu'><always_on>1</always_on><gz_frame_id>a</gz_frame_id></sensor>",
        "<plugin name='p' filename='libmine.so'><alwasyOn>true</alwasyOn></plugin>",
        "<plugin name='p' filename='libgazebo_ros_x.so'><joint_name_7>a</joint_name_7></plugin>",
        "<ns:anything/>",
    ],
)
def test_right_words_and_those_of_strange_plugins_pass(tmp_path, inside):
    inside = inside.replace("<ns:anything/>", '<ns:anything xmlns:ns="a"/>')
    assert _found(tmp_path, inside, ' reference="arm"') == []


@pytest.mark.parametrize(
    ("inside", "right"),
    [
        ("<Mu1>1</Mu1>", "<mu1>"),
        ("<mu>1</mu>", "<mu1> and <mu2>"),
        ("<max_contacts>1</max_contacts>", "<maxContacts>"),
        ("<turnGravityoff>1</turnGravityoff>", "<turnGravityOff>"),
        ("<sensor name='s' type='imu'><updateRate>1</updateRate></sensor>", "<update_rate>"),
        (
            "<sensor name='s' type='camera'><camera><horizontal_fow>1</horizontal_fow></camera>"
            "</sensor>",
            "<horizontal_fov>",
        ),
    ],
)
def test_word_that_is_nearly_right_is_an_error_with_the_right_one(tmp_path, inside, right):
    ((severity, message),) = _found(tmp_path, inside, ' reference="arm"')
    assert severity == "error"
    assert f"write {right}" in message


def test_misspelt_parameter_of_a_known_plugin(tmp_path):
    plugin = (
        "<plugin name='d' filename='libgazebo_ros_diff_drive.so'><alwasyOn>1</alwasyOn></plugin>"
    )
    assert _found(tmp_path, plugin) == [
        ("warning", "plugin 'd' has the unknown parameter <alwasyOn>; write <alwaysOn>")
    ]


@pytest.mark.parametrize(
    ("text", "severity"),
    [("", "error"), ("high", "error"), ("1.0d", "warning"), ("0,5", "warning")],
)
def test_numbers_as_gazebo_reads_them(tmp_path, text, severity):
    found = _found(tmp_path, f"<mu1>{text}</mu1>", ' reference="arm"', "bad-extension-number")
    assert [s for s, _ in found] == [severity]


@pytest.mark.parametrize("text", ["1", "1e-3", ".5", "-0.1", "+2.", "${mu}"])
def test_numbers_that_gazebo_reads(tmp_path, text):
    assert _found(tmp_path, f"<mu1>{text}</mu1>", ' reference="arm"', "bad-extension-number") == []
