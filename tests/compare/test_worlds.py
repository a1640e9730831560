"""Gravity and other settings of the world around a robot: compared, exported, proved."""

import pytest

import urdftool as api
from urdftool.compare.compare import compare_robots
from urdftool.compare.differences import compare
from urdftool.model.remarks import list_remarks

MODEL = """<model name="m"><link name="a"><inertial><mass>1</mass></inertial><collision name="c">
<geometry><box><size>1 1 1</size></box></geometry></collision></link></model>"""
SDF = '<sdf version="1.{version}">\n{start}\n{inside}\n{model}{end}</sdf>'
MJCF = """<mujoco model="m">\n<option gravity="0 0 {}"/><worldbody><body name="a"><freejoint/>
<geom name="c" type="box" size=".5 .5 .5" mass="1"/></body></worldbody></mujoco>"""
URDF = """<robot name="m"><link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"
ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry><box size="1 1 1"/></geometry></collision>
</link>{}</robot>"""
OF_URDF = '<mujoco><option gravity="0 0 -3.7"/></mujoco>'
GRAVITY = "<gravity>0 0 {}</gravity>"
EVERYTHING = """<wind><linear_velocity>{} 0 0</linear_velocity></wind>
<magnetic_field>0 0 {}</magnetic_field>
<atmosphere type="adiabatic"><temperature>{}</temperature><pressure>{}</pressure></atmosphere>
<physics name="p" type="ode"><max_step_size>{}</max_step_size></physics>
<light name="sun" type="directional"><pose>0 0 {} 0 0 0</pose></light>"""
WHAT = ("wind velocity", "magnetic field", "temperature", "pressure",
        "physics[p]/max_step_size", "light[sun]/pose")  # fmt: skip


def make_sdf(inside="", version=10, world=True):
    start, end = ("<world name='w'>", "</world>") if world else ("", "")
    return SDF.format(version=version, start=start, inside=inside, model=MODEL, end=end)


def read_two(write, one, two):
    ending = {"<s": "sdf", "<m": "xml", "<r": "urdf"}
    return [
        api.load(write(f"{name}.{ending[text[:2]]}", text))
        for name, text in (("one", one), ("two", two))
    ]


def find(robots, row="world"):
    found = compare_robots(*robots)
    return [one for one in found.differences if one.row == row], found.skipped.get(row)


@pytest.mark.parametrize(
    ("one", "two", "is_equal"),
    [
        (make_sdf(GRAVITY.format(-9.8)), make_sdf(), True),  # the default of SDF
        (make_sdf(GRAVITY.format(-9.81)), make_sdf(), False),
        (make_sdf(GRAVITY.format(-3.7)), make_sdf(GRAVITY.format("-3.70")), True),
        (make_sdf(f"<physics>{GRAVITY.format(-3.7)}</physics>", 5), make_sdf(), False),
        (make_sdf(GRAVITY.format(-3.7)), MJCF.format(-3.7), True),
        (make_sdf(GRAVITY.format(-3.7)), MJCF.format(-9.81), False),
        (make_sdf(GRAVITY.format(-9.81)), MJCF.format(-9.81), True),
        (URDF.format(OF_URDF), MJCF.format(-3.7), True),
        (URDF.format(OF_URDF), MJCF.format(-1.6), False),
        (URDF.format(OF_URDF), make_sdf(GRAVITY.format(-1.6)), False),
        # a simulator uses that of the Earth for a file without one
        (URDF.format(""), MJCF.format(-1.6), False),
        (URDF.format(""), make_sdf(GRAVITY.format(-1.6)), False),
        (make_sdf(), MJCF.format(-3.7), False),
        (make_sdf(world=False), MJCF.format(-3.7), False),
    ],
)
def test_gravity_is_compared(write, one, two, is_equal):
    robots = read_two(write, one, two)
    for first, second in (robots, robots[::-1]):
        found, reason = find((first, second))
        assert reason is None
        assert [d.what for d in found] == ([] if is_equal else ["gravity"])
        changes = [c.what for c in compare(first, second) if c.row == "world"]
        assert changes == [d.what for d in found]


def test_a_difference_is_at_its_line(write):
    robots = read_two(write, make_sdf(GRAVITY.format(-9.8)), make_sdf(GRAVITY.format(-3.7)))
    (found,), _ = find(robots)
    assert found.values == ("0 0 -9.8", "0 0 -3.7")
    assert [place.line for place in found.places] == [3, 3]


@pytest.mark.parametrize("number", range(len(WHAT)))
def test_everything_in_a_world_is_compared(write, number):
    values = [1, 2, 300, 1000, 0.001, 10]
    changed = [v * 2 if i == number else v for i, v in enumerate(values)]
    texts = [make_sdf(EVERYTHING.format(*each)) for each in (values, changed)]
    robots = read_two(write, *texts)
    assert [c.what for c in compare(*robots)] == [WHAT[number]]
    found, others = find(robots)[0], find(robots, "other elements")[0]
    assert [d.what for d in (*found, *others)] == [WHAT[number]]


@pytest.mark.parametrize(
    ("one", "two", "reason"),
    [
        (make_sdf(GRAVITY.format(-3.7)), make_sdf(world=False), "a file has no <world>"),
        (make_sdf(), MJCF.format(-9.81), "gravity is not written in every file"),
        (URDF.format(""), make_sdf(GRAVITY.format(-9.81)), "gravity is not written in every file"),
        (URDF.format(""), URDF.format(OF_URDF), "in the row of simulator data"),
    ],
)
def test_what_is_not_compared_is_said(write, one, two, reason):
    assert find(read_two(write, one, two)) == ([], reason)


def test_the_world_of_an_export_has_the_gravity_of_the_source(write, tmp_path):
    sources = read_two(write, MJCF.format(-3.7), make_sdf(GRAVITY.format(-1.6)))
    for source, value in zip(sources, (-3.7, -1.6), strict=True):
        out = tmp_path / f"{source.format}.sdf"
        written = api.export_sdf(source, out, world=True, verify=True)
        assert not [loss.code for loss in written.losses if "world" in loss.code]
        assert all(check.verdict != "differs" for check in written.checks)
        again = api.load(out)
        assert again.world["gravity"].content == (0, 0, value)
        assert find((source, again)) == ([], None)


def test_a_wrong_gravity_in_the_world_of_an_export_is_noticed(write, tmp_path):
    from urdftool.formats.sdf.options import Options
    from urdftool.formats.sdf.verify.compare import read_pair
    from urdftool.formats.sdf.verify.world import compare_world
    from urdftool.formats.sdf.write import write as write_sdf

    source = api.load(write("one.xml", MJCF.format(-3.7)))
    options = Options(world=True, file="m.sdf")
    written, place = write_sdf(source, options), tmp_path / "m.sdf"
    text = written.files["m.sdf"].decode()
    for wrong in (text, text.replace("-3.7", "-9.8"), text.replace("0 0 -3.7", "down")):
        place.write_text(wrong)
        check = compare_world(read_pair(source, written, place, options))
        assert bool(check.differing) is (wrong != text)


def test_an_export_without_a_world_reports_it(write):
    source = api.load(write("one.sdf", make_sdf(GRAVITY.format(-3.7))))
    codes = [loss.code for loss in api.export_sdf(source).losses]
    assert "lossy-world-setting" in codes
    assert "lossy-world" not in codes  # which would excuse mass and shapes
    text = api.export_mjcf(source).files["m.xml"].decode()
    assert 'gravity="0 0 -3.7"' in text


def test_a_text_in_place_of_a_number_is_said_and_not_used(write):
    robot = api.load(write("one.sdf", make_sdf(GRAVITY.format("down"))))
    assert robot.world == {}
    (remark,) = list_remarks(robot)
    assert remark.message.startswith("world 'w': gravity is '0 0 down', not three finite numbers")
    assert remark.place.line == 3


def test_the_ground_is_not_the_robot(write):
    ground = MODEL.replace('"m"', '"ground_plane"')
    robot = api.load(write("one.sdf", make_sdf(ground)))
    assert robot.name == "m"


COMMANDS = (
    "lint one.sdf",
    "info one.sdf",
    "diff one.sdf one.sdf",
    "export usd --force -o o one.sdf",
)


@pytest.mark.library("pxr")
@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_says_it(urdftool, write, command):
    write("one.sdf", make_sdf(GRAVITY.format("down")))
    result = urdftool(*command.split())
    if command.startswith("lint"):
        assert (
            "one.sdf:3:1: error: world 'w': gravity is '0 0 down', not three finite numbers"
            in result.out
        )
        return
    line = "one.sdf:3:1: warning: world 'w': gravity is '0 0 down', not three finite numbers; it"
    assert line in result.err
