"""What a description writes and a robot does not hold: one sentence, in every command."""

import pytest

import urdftool as api
from urdftool.model.remarks import list_remarks

LINK = """<link name="base"><inertial><mass value="1"/>
<inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><sphere radius="1"/></geometry>{}</visual></link>"""
CASES = {
    "rejected-setting": '<gazebo reference="base"><mu1>rough</mu1></gazebo>',
    "repeated-setting": '<gazebo reference="base"><mu1>1</mu1></gazebo>'
    '<gazebo reference="base"><mu1>2</mu1></gazebo>',
    "dangling-block": '<gazebo reference="nolink"><mu1>1</mu1></gazebo>',
    "undefined-material": '<material name="nobody"/>',
}
SENSOR = '<gazebo reference="nolink"><sensor name="s" type="imu"/></gazebo>'
COMMANDS = (
    "info",
    "graph",
    "export usd --force -o out",
    "export urdf --force -o o.urdf",
)


def make(text):
    inside = text if text.startswith("<material") else ""
    return f'<robot name="r">{LINK.format(inside)}{"" if inside else text}</robot>'


@pytest.mark.parametrize("code", CASES)
def test_each_is_found_once(write, code):
    path = write("r.urdf", make(CASES[code]))
    (remark,) = list_remarks(api.load(path))
    assert remark.code == code
    assert remark.place.line == 3
    assert list(list_remarks(api.load(write("good.urdf", make(""))))) == []


@pytest.mark.parametrize(
    ("values", "counts"), [(("false", "true"), "true"), (("true", "false"), "false")]
)
def test_the_value_that_counts_is_that_of_the_element(write, values, counts):
    """``turnGravityOff`` is the opposite of the setting ``gravity``."""
    block = '<gazebo reference="base"><turnGravityOff>{}</turnGravityOff></gazebo>'
    robot = api.load(write("r.urdf", make("".join(map(block.format, values)))))
    (remark,) = list_remarks(robot)
    text = f"turnGravityOff is set several times ({', '.join(values)}); {counts} counts"
    assert text in remark.message
    assert robot.link["base"].settings["gravity"].content is (counts == "false")


def test_a_sensor_of_no_link_is_said_once(write):
    assert len(list(list_remarks(api.load(write("r.urdf", make(SENSOR)))))) == 1


@pytest.mark.library("pxr")
@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_says_all(urdftool, write, command):
    text = "".join(CASES[code] for code in CASES if code != "undefined-material")
    write("r.urdf", make(text).replace("</visual>", '<material name="nobody"/></visual>'))
    said = urdftool(*command.split(), "r.urdf").err
    words = ("'rough'", "set several times", "'nolink'", "'nobody' is not defined")
    assert [word for word in words if f"{word}" not in said] == []
    assert said.count("'rough'") == 1


@pytest.mark.parametrize("code", CASES)
def test_lint_says_it_in_the_same_words_at_the_same_place(write, code):
    path = write("r.urdf", make(CASES[code]))
    (remark,) = list_remarks(api.load(path))
    fact = remark.message.partition("; ")[0]
    places = [f.location.start for f in api.check(path) if f.message.startswith(fact)]
    assert places == [remark.place.start]
