"""An MJCF that is read and written again is the same model, with what only MuJoCo has."""

import pytest

from urdftool.compare.compare import compare_robots
from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.read import read
from urdftool.formats.mjcf.verify import verify_copy
from urdftool.formats.mjcf.write import write as write_mjcf

pytest.importorskip("mujoco")

MODEL = """<mujoco model="rich">
<compiler angle="radian"/>
<option gravity="0 0 -3" density="1.2" integrator="RK4" cone="elliptic">
<flag energy="enable" midphase="disable"/></option>
<worldbody><body name="a" gravcomp="0.5" pos="0 0 0.1"><freejoint/>
<site name="s" pos="0.1 0 0"/><camera name="c" pos="0 0 0.1" fovy="40" resolution="320 200"/>
<light name="l" type="spot" dir="1 0 0" cutoff="30" diffuse="1 0.5 0.2" castshadow="false"/>
<geom name="g" size=".1 .1 .1" type="box" friction="0.4 0.01 0.002" condim="4" margin="0.002"
 solref="0.01 0.9" solimp="0.8 0.9 0.002 0.4 3" contype="2" conaffinity="5" mass="1"/>
<body name="b" gravcomp="1" pos="0 0 .5">
<joint name="j" range="-1 1" solreflimit="0.03 0.8" armature="0.1" damping="0.2"
 frictionloss="0.1" stiffness="3" springref="0.1" margin="0.05" actuatorgravcomp="true"/>
<geom name="h" size=".1" mass="1"/></body>
<body name="e" pos="0.5 0 .5"><joint name="k" axis="0 1 0"/><geom name="i" size=".1" mass="1"/>
</body></body></worldbody>
<contact><exclude body1="b" body2="e"/></contact>
<equality><connect name="loop" body1="b" body2="e" anchor="0.25 0 0" solref="0.005 1"
 solimp="0.95 0.99 0.001"/></equality>
<actuator><position name="servo" joint="j" kp="20" dampratio="1" ctrlrange="-1 1"/>
<motor name="m" joint="k" gear="2" ctrlrange="-3 3"/></actuator>
<sensor><gyro name="turn" site="s"/><jointpos name="angle" joint="j"/></sensor>
<keyframe><key name="home" qpos="0 0 0.1 1 0 0 0 0 0"/></keyframe>
</mujoco>"""


@pytest.fixture
def both(write, tmp_path):
    from urdftool.api.load import load

    source = load(write("rich.xml", MODEL))
    written = write_mjcf(source, Options())
    place = tmp_path / "made.xml"
    place.write_text(written.text)
    return source, load(place), written


def test_it_is_the_same(both):
    source, made, written = both
    found = compare_robots(source, made)
    assert [d.title for d in found.differences] == []
    assert written.losses == []


def test_the_proof_says_so(both):
    source, _, written = both
    checks = verify_copy(source, Options(), written)
    differing = {c.name: c.differing for c in checks if c.differing and c.name != "runs"}
    assert differing == {}


@pytest.mark.parametrize(
    ("old", "new", "row"),
    [
        ('condim="4"', 'condim="3"', "surface"),
        ('contype="2"', 'contype="1"', "surface"),
        ("0.4 0.01 0.002", "0.4 0.02 0.002", "surface"),
        ('solreflimit="0.03 0.8"', "", "joint physics"),
        ('gravcomp="0.5"', 'gravcomp="0.4"', "link flags"),
        ('density="1.2"', "", "world"),
        ('energy="enable"', "", "world"),
        ('dampratio="1"', 'dampratio="0.7"', "actuators"),
        ('name="s" pos="0.1', 'name="t" pos="0.1', "frames"),
        ('fovy="40"', 'fovy="50"', "sensors"),
        ('cutoff="30"', 'cutoff="40"', "sensors"),
        ("<gyro ", "<accelerometer ", "sensors"),
        ('anchor="0.25', 'anchor="0.2', "loops"),
        ('body1="b" body2="e"/>', 'body1="a" body2="e"/>', "contact pairs"),
    ],
)
def test_a_change_is_named(write, old, new, row):
    from urdftool.api.load import load

    one = load(write("one.xml", MODEL))
    assert old in MODEL
    changed = MODEL.replace(old, new, 1)
    changed = changed.replace('site="s"', 'site="t"') if '"t"' in new else changed
    two = load(write("two.xml", changed))
    assert row in {difference.row for difference in compare_robots(one, two).differences}


JOINT = (
    '<joint name="f" type="fixed"><parent link="world"/><child link="a"/></joint>'
    '<joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 2"/>'
    '<axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
)
INERTIAL = (
    '<inertial><mass value="1"/>'
    '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
)


def of(part, inside):
    return f'<gazebo reference="{part}">{inside}</gazebo>'


@pytest.mark.parametrize(
    ("blocks", "friction"),
    [
        (of("a", "<mu1>0.4</mu1><mu1>0.5</mu1>"), "0.5 "),
        (of("a", "<mu>0.3</mu><mu1>0.7</mu1>"), "0.7 "),
        (of("a", "<mu1>0.5</mu1>") + of("a", "<mu1>-1</mu1>"), "0.5 "),
        (
            of("j", "<springStiffness>5</springStiffness>")
            + of("j", "<springStiffness>0</springStiffness>"),
            None,
        ),
    ],
)
def test_a_setting_in_several_blocks_has_one_value(write, urdftool, tmp_path, blocks, friction):
    box = '<collision><geometry><box size="1 1 1"/></geometry></collision>'
    path = write(
        "r.urdf",
        f'<robot name="r"><link name="world"/><link name="a">{INERTIAL}{box}</link>'
        f'<link name="b">{INERTIAL}</link>{JOINT}{blocks}</robot>',
    )
    done = urdftool("export", "mjcf", path, "-o", "out", "--verify")
    assert done.code == 0, done.out + done.err
    text = (tmp_path / "out" / "r.xml").read_text()
    assert "stiffness" not in text
    assert (friction is None) == ("friction=" not in text)
    assert friction is None or f'friction="{friction}' in text


BALL = (
    '<mujoco><worldbody>{light}<body name="b"><joint name="j" type="ball" range="0 {end}"/>'
    '<geom size="1"/></body><body name="c"><geom size="1"/></body></worldbody></mujoco>'
)


def test_the_limit_of_a_ball_joint_is_compared(write):
    one, two = (read(write(f"{end}.xml", BALL.format(end=end, light=""))).robot for end in (20, 30))
    (difference,) = compare_robots(one, two).differences
    assert (difference.row, difference.title) == ("limits", "joint 'j': upper limit")


def test_a_light_without_a_name_is_the_same_with_one(write):
    path = write("m.xml", BALL.format(end=20, light='<light pos="0 0 3"/>'))
    robot = read(path).robot
    written = write_mjcf(robot, Options())
    assert b'type="ball" range="0 0.349' in written.files[written.main]
    rows = {row.name: row.verdict for row in verify_copy(robot, Options(), written)}
    assert (rows["sensors"], rows["limits"]) == ("equal", "equal")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        (
            "slide.xml",
            '<mujoco><worldbody><body name="a"><geom size=".1"/><body name="b" pos="1 0 0">'
            '<joint name="j" type="slide"/><geom size=".1"/></body></body></worldbody></mujoco>',
        ),
        (
            "slide.sdf",
            '<sdf version="1.9"><model name="m"><link name="a"/><link name="b"/><joint name="j" '
            'type="prismatic"><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis>'
            "</joint></model></sdf>",
        ),
    ],
)
def test_a_slide_without_a_range_loses_nothing(urdftool, write, tmp_path, name, text):
    """Only URDF requires a limit."""
    source = write(name, text)
    for kind in ("mjcf", "sdf"):
        out = tmp_path / f"made.{'xml' if kind == 'mjcf' else 'sdf'}"
        result = urdftool("export", kind, source, "-o", out, "--overwrite", "--strict", "--verify")
        assert result.code == 0, result.out + result.err
