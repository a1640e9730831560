"""What a description writes and a robot does not hold: one sentence, in every command."""

import pytest

import urdftool as api
from urdftool.lint.validate import validate
from urdftool.model.remarks import list_remarks

LINK = """<link name="base"><inertial><mass value="1"/>
<inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><sphere radius="1"/></geometry>{}</visual></link>"""
CASES = {
    "bad-extension-number": '<gazebo reference="base"><mu1>rough</mu1></gazebo>',
    "conflicting-references": '<gazebo reference="base"><mu1>1</mu1></gazebo>'
    '<gazebo reference="base"><mu1>2</mu1></gazebo>',
    "dangling-reference": '<gazebo reference="nolink"><mu1>1</mu1></gazebo>',
    "undefined-material": '<material name="nobody"/>',
}
ON_LINK, ON_ROBOT = '<gazebo reference="base">{}</gazebo>', "<gazebo>{}</gazebo>"
LOOP = '<joint name="k" type="{type}">{pose}<parent>{parent}</parent><child>base</child></joint>'
GOOD = {"type": "ball", "pose": "", "parent": "world"}
ALIKE = (
    ("bad-extension-number", ON_LINK.format("<selfCollide>maybe</selfCollide>")),
    ("bad-extension-number", ON_LINK.format("<turnGravityOff>maybe</turnGravityOff>")),
    ("bad-extension-number", ON_LINK.format("<fdir1>1 x</fdir1>")),
    ("bad-extension-number", ON_LINK.format("<mu1>1.0d</mu1>")),
    ("bad-extension-number", ON_ROBOT.format("<static>perhaps</static>")),
    ("setting-out-of-range", ON_LINK.format("<mu1>-1</mu1>")),
    ("invalid-sdf-value", ON_LINK.format("<gravity>perhaps</gravity>")),
    ("invalid-sdf-value", ON_LINK.format("<self_collide>yes</self_collide>")),
    ("bad-mujoco-value", '<mujoco><option timestep="x"/></mujoco>'),
    ("bad-mujoco-value", '<mujoco><option><flag contact="off"/></option></mujoco>'),
    ("bad-mujoco-value", '<mujoco><visual><map znear="near"/></visual></mujoco>'),
    ("invalid-sdf-value", ON_LINK.format("<visual><cast_shadows>x</cast_shadows></visual>")),
    (
        "invalid-sdf-value",
        ON_LINK.format('<sensor name="s" type="imu"><update_rate>fast</update_rate></sensor>'),
    ),
    ("invalid-sdf-value", ON_LINK.format('<sensor name="s" type="imu"><pose>x</pose></sensor>')),
    ("invalid-sdf-value", ON_LINK.format('<light name="s" type="point"><pose>x</pose></light>')),
    ("invalid-sdf-value", ON_ROBOT.format(LOOP.format(**GOOD | {"type": "odd"}))),
    ("invalid-sdf-value", ON_ROBOT.format(LOOP.format(**GOOD | {"pose": "<pose>x</pose>"}))),
    ("invalid-sdf-value", ON_ROBOT.format(LOOP.format(**GOOD | {"parent": ""}))),
    ("dangling-reference", ON_ROBOT.format(LOOP.format(**GOOD | {"parent": "base"}))),
    (
        "dangling-reference",
        ON_ROBOT.format(LOOP.format(**GOOD | {"pose": '<pose relative_to="no"/>'})),
    ),
)
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


@pytest.mark.parametrize(("code", "text"), [*CASES.items(), *ALIKE])
def test_lint_says_it_in_the_same_words_with_its_code_at_the_same_place(write, code, text):
    path = write("r.urdf", make(text))
    (remark,) = list_remarks(api.load(path))
    fact = remark.message.partition("; ")[0]
    alike = [(f.code, f.location.start) for f in api.check(path) if f.message.startswith(fact)]
    assert (remark.code, alike) == (code, [(code, remark.place.start)])


@pytest.mark.parametrize(("code", "text"), ALIKE)
def test_an_export_that_refuses_it_gives_the_same_code(write, code, text):
    robot = api.load(write("r.urdf", make(text)))
    (fact,) = [one.fact for one in robot.rejected_settings]
    for format in ("sdf", "mjcf"):
        found = validate(robot, f"export:{format}")
        assert [(one.code, one.message) for one in found] in ([], [(code, fact)])
