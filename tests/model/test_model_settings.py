"""Settings of ``<gazebo>`` are read once, and are the same in every format."""

from functools import partial

import pytest

import urdftool as api
from tests.cases import list_cases
from urdftool.compare.compare import compare_robots
from urdftool.model.load import load
from urdftool.model.settings import SURFACE, TABLES, get_number
from urdftool.simulation.rigid_bodies import choose_surface

TENSOR = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
INERTIAL = f'<inertial><mass value="1"/>{TENSOR}</inertial>'
BOX = '<collision><geometry><box size="1 1 1"/></geometry></collision>'
ROBOT = f"""<robot name="r"><link name="world"/>
<link name="a">{INERTIAL}{{contact}}{BOX}</link>
<link name="b">{INERTIAL}</link>
<joint name="f" type="fixed"><parent link="world"/><child link="a"/></joint>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 2"/>
<axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
{{blocks}}</robot>"""
COLLISION = "<collision><surface><friction><ode><mu>0.9</mu></ode></friction></surface></collision>"
CONTACT = '<contact><lateral_friction value="0.2"/><restitution value="0.1"/></contact>'


def of(part, inside):
    return f'<gazebo reference="{part}">{inside}</gazebo>'


@pytest.fixture
def write(tmp_path):
    def write(blocks, contact=""):
        path = tmp_path / "r.urdf"
        path.write_text(ROBOT.format(blocks=blocks, contact=contact))
        return path

    return write


# what libsdformat 12.3 takes of each, as recorded in fixtures/effects
FRICTIONS = [
    (of("a", "<mu1>0.4</mu1><mu1>0.5</mu1>"), "", 0.5),
    (of("a", "<mu>0.3</mu><mu1>0.7</mu1>"), "", 0.7),
    (of("a", f"<mu1>0.1</mu1>{COLLISION}"), "", 0.1),
    (of("a", COLLISION), "", 0.9),
    (of("a", "<mu1>0.5</mu1>") + of("a", "<mu1>-1</mu1>"), "", 0.5),  # it rejects the file
    ("", CONTACT, 0.2),
    (of("a", "<mu1>0.5</mu1>"), CONTACT, 0.5),
]


@pytest.mark.usefixtures("stages_are_read_here")
@pytest.mark.parametrize(("blocks", "contact", "friction"), list_cases(FRICTIONS, 3))
@pytest.mark.library("mujoco")
@pytest.mark.library("pxr")
def test_every_format_has_the_friction_that_is_simulated(
    write, tmp_path, blocks, contact, friction
):
    robot = load(write(blocks, contact))
    assert choose_surface(robot, ["a"])["friction"] == friction
    for name, export in (
        ("sdf", api.export_sdf), ("mjcf", partial(api.export_mjcf, actuators="described")),
        ("usd", api.export_usd), ("urdf", api.export_urdf),
    ):  # fmt: skip
        written = export(robot, tmp_path / name, verify=True)
        assert [c.name for c in written.checks if c.verdict == "differs"] == []
        made = api.load(tmp_path / name / written.main)
        (collision,) = made.link["a"].collisions
        assert get_number(collision.surface, "friction") == pytest.approx(friction)
        differences = compare_robots(robot, made).differences
        # Bullet's friction is that of both directions, and <mu1> that of the first
        by_direction = (
            {"second friction"} if blocks and contact and name in ("mjcf", "usd") else set()
        )
        assert {d.what for d in differences} == by_direction


def test_a_later_spring_of_zero_removes_the_spring(write):
    stiff, slack = ("<springStiffness>5</springStiffness>", "<springStiffness>0</springStiffness>")
    assert load(write(of("j", stiff))).joint["j"].spring == (5.0, 0.0)
    assert load(write(of("j", stiff) + of("j", slack))).joint["j"].spring is None


@pytest.mark.slow
@pytest.mark.library("mujoco")
def test_every_format_has_no_spring_after_one_of_zero(write, tmp_path):
    stiff, slack = ("<springStiffness>5</springStiffness>", "<springStiffness>0</springStiffness>")
    for blocks, spring in ((of("j", stiff), (5.0, 0.0)), (of("j", stiff) + of("j", slack), None)):
        robot = load(write(blocks))
        for name, export in (
            ("sdf", api.export_sdf), ("mjcf", api.export_mjcf), ("urdf", api.export_urdf)
        ):  # fmt: skip
            out = tmp_path / f"{name}{spring is None}"
            written = export(robot, out, verify=True)
            assert [c.name for c in written.checks if c.verdict == "differs"] == []
            assert api.load(out / written.main).joint["j"].spring == spring


def test_gravity_is_that_of_the_tag_then_of_the_first_element(write):
    off = "<turnGravityOff>true</turnGravityOff>"
    for blocks, weightless in (
        (of("a", off + "<gravity>true</gravity>"), True),
        (of("a", "<gravity>false</gravity>") + of("a", "<gravity>true</gravity>"), True),
        (of("a", "<gravity>false</gravity>" + off.replace("true", "false")), False),
    ):
        assert load(write(blocks)).link["a"].is_weightless is weightless


def test_a_value_has_its_place_and_what_it_replaces(write):
    robot = load(write(of("a", "<mu1>0.4</mu1>\n<mu1>0.5</mu1>")))
    value = robot.link["a"].collisions[0].surface["friction"]
    assert [one.content for one in value.earlier] == [0.4]
    assert value.place.line == value.earlier[0].place.line + 1


def test_what_is_not_a_value_is_kept_with_its_place(write):
    robot = load(write(of("a", "<mu1>-1</mu1><kp>stiff</kp>") + of("j", "<stopErp/>")))
    found = [(one.name, one.tag, one.text, one.required) for one in robot.rejected_settings]
    assert found == [
        ("a", "mu1", "-1", "a finite number of at least 0"),
        ("a", "kp", "stiff", "a finite number"),
        ("j", "stopErp", "", "a finite number"),
    ]


def test_rows_have_names_and_paths_of_their_own():
    for rows in TABLES:
        assert len({row.name for row in rows}) == len(rows)
        paths = [row.path for row in rows if row.path]
        assert len(set(paths)) == len(paths)
    assert all(row.path for row in SURFACE)


@pytest.mark.usefixtures("stages_are_read_here")
@pytest.mark.library("pxr")
def test_restitution_reaches_the_formats_that_have_it(write, tmp_path):
    bounce = "<bounce><restitution_coefficient>0.3</restitution_coefficient></bounce>"
    robot = load(write(of("a", f"<collision><surface>{bounce}</surface></collision>")))
    for name, export in (("sdf", api.export_sdf), ("usd", api.export_usd)):
        written = export(robot, tmp_path / name)
        made = api.load(tmp_path / name / written.main)
        (collision,) = made.link["a"].collisions
        assert get_number(collision.surface, "restitution") == pytest.approx(0.3)
    losses = {loss.code for loss in api.export_mjcf(robot).losses}
    assert "lossy-restitution" in losses


def test_another_friction_is_named_in_verify_and_diff(write, tmp_path, urdftool):
    robot = load(write(of("a", "<mu1>0.4</mu1>")))
    api.export_sdf(robot, tmp_path / "sdf")
    path = tmp_path / "sdf" / "model.sdf"
    path.write_text(path.read_text().replace("<mu>0.4</mu>", "<mu>0.8</mu>"))
    for command in ("verify", "diff"):
        result = urdftool(command, tmp_path / "r.urdf", path)
        assert result.code == 1
        assert "friction" in result.out
        assert "0.8" in result.out


def test_a_caster_of_an_sdf_without_friction_is_found(tmp_path):
    ball = "<geometry><sphere><radius>0.1</radius></sphere></geometry>"
    shape = f"<collision name='c'>{ball}{{}}</collision>"
    grip = "<surface><friction><ode><mu>0.9</mu><mu2>0.9</mu2></ode></friction></surface>"
    text = (
        "<sdf version='1.9'><model name='m'><link name='base'/><link name='{0}_caster'>{1}</link>"
        "<joint name='j' type='revolute'><parent>base</parent><child>{0}_caster</child>"
        "<axis><xyz>0 1 0</xyz></axis></joint></model></sdf>"
    )
    path = tmp_path / "m.sdf"
    path.write_text(text.format("left", shape.format("")))
    (finding,) = api.check(path, select=["missing-friction"])
    assert finding.location.line == 1
    path.write_text(text.format("left", shape.format(grip)))
    assert api.check(path, select=["missing-friction"]) == []


def test_the_color_of_gazebo_is_that_of_an_sdf_and_no_difference(tmp_path, urdftool):
    red = '<material name="red"><color rgba="1 0 0 1"/></material>'
    visual = f'<visual><geometry><box size="1 1 1"/></geometry>{red}</visual>'
    path = tmp_path / "r.urdf"
    blocks = of("a", "<material>Gazebo/Blue</material>")
    path.write_text(f'<robot name="r"><link name="a">{INERTIAL}{visual}</link>{blocks}</robot>')
    api.export_sdf(load(path), tmp_path / "sdf")
    assert urdftool("verify", path, tmp_path / "sdf" / "model.sdf").code == 0
    path.write_text(path.read_text().replace("Blue", "Green"))
    result = urdftool("verify", path, tmp_path / "sdf" / "model.sdf")
    assert (result.code, "color of" in result.out) == (1, True)


@pytest.mark.library("mujoco")
@pytest.mark.parametrize(("kind", "tag"), [("sdf", "mu2"), ("urdf", "mu2")])
def test_the_friction_of_an_mjcf_is_that_of_both_directions(tmp_path, kind, tag):
    path = tmp_path / "r.xml"
    geom = '<geom type="box" size=".1 .1 .1" friction="0.5 0.005 0.0001"/>'
    body = f'<body name="b"><freejoint/>{geom}</body>'
    path.write_text(f"<mujoco><worldbody>{body}</worldbody></mujoco>")
    written = getattr(api, f"export_{kind}")(api.load(path), tmp_path / "out", verify=True)
    text = (tmp_path / "out" / written.main).read_text()
    assert f"<{tag}>0.5</{tag}>" in text
    assert {check.name: check.verdict for check in written.checks}["surface"] == "equal"


@pytest.mark.library("mujoco")
def test_parameters_of_a_sensor_that_an_mjcf_lacks_are_reported(write, tmp_path):
    stddev = "<noise type='gaussian'><stddev>1</stddev></noise>"
    noise = f"<imu><angular_velocity><x>{stddev}</x></angular_velocity></imu>"
    sensor = f"<sensor name='s' type='imu'><update_rate>9</update_rate>{noise}</sensor>"
    written = api.export_mjcf(load(write(of("a", sensor))), tmp_path / "out")
    (loss,) = [one for one in written.losses if one.code == "lossy-sensor-parameter"]
    assert loss.message.endswith(": rate, noise")


def test_a_block_reaches_the_collisions_that_gazebo_sets(tmp_path):
    """As sdformat 12.3 does (run): a name that does not begin with the link's gets nothing."""
    names = {"hull": False, "arm": True, "arm_hull": True, "army": True, "my_arm": False, "": True}
    shapes = "".join(
        f"<collision{f' name={name!r}' if name else ''}>"
        f'<origin xyz="0 0 {place}"/><geometry><box size="1 1 1"/></geometry></collision>'
        for place, name in enumerate(names)
    )
    block = "<mu1>0.4</mu1><maxContacts>3</maxContacts><collision><laser_retro>7</laser_retro>"
    path = tmp_path / "r.urdf"
    path.write_text(
        f'<robot name="r"><link name="arm"><inertial><mass value="1"/><inertia ixx="1" iyy="1" '
        f'izz="1" ixy="0" ixz="0" iyz="0"/></inertial>{shapes}</link>'
        f'<gazebo reference="arm">{block}</collision></gazebo></robot>',
    )
    robot = load(path)
    for collision, is_set in zip(robot.links[0].collisions, names.values(), strict=True):
        assert set(collision.surface) == (
            {"friction", "max_contacts", "laser_retro"} if is_set else set()
        )
    written = api.export_sdf(robot, tmp_path / "out", verify=True)
    assert not [check for check in written.checks if check.verdict == "differs"]
    assert written.text.count("<mu>0.4</mu>") == written.text.count("retro>7<") == 4
    unset = [loss for loss in written.losses if loss.code == "named-geometry-loses-extensions"]
    assert ["'hull'" in loss.message or "'my_arm'" in loss.message for loss in unset] == [True] * 2
