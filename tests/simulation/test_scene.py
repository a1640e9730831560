"""The robot of a scene: free parts besides the robot, and planes of the world."""

import pytest

import urdftool as api
from urdftool.simulation.scene import take_robot

BALL = """
<link name="ball{n}"><pose>{n} 0 1 0 0 0</pose>
<collision name="c"><geometry><sphere><radius>.1</radius></sphere></geometry></collision></link>
"""
ARM = """
<link name="base"/><link name="arm"><sensor name="s" type="imu"/></link>
<joint name="j" type="revolute"><parent>base</parent><child>arm</child><axis><xyz>0 0 1</xyz></axis>
</joint>
"""
MJCF = """
<mujoco model="scene"><worldbody>
  <geom name="floor" type="plane" size="1 1 1"/>
  <geom name="wall" type="box" size="1 1 1" pos="5 0 0"/>
  <body name="box"><freejoint/><geom size=".1"/></body>
  <body name="robot" pos="0 0 1"><freejoint/><geom size=".1"/>
    <body name="leg" pos="0 0 -.2"><joint name="knee" axis="0 1 0"/><geom size=".1"/></body>
  </body>
</worldbody></mujoco>
"""


def test_the_free_part_with_most_joints_is_the_robot(write):
    body = BALL.format(n=1) + ARM + BALL.format(n=2)
    robot = api.load(write("m.sdf", f'<sdf version="1.9"><model name="m">{body}</model></sdf>'))
    assert len(robot.links) == 5
    part, left_out = take_robot(robot)
    assert [link.name for link in part.links] == ["world", "base", "arm"]
    assert [joint.type for joint in part.joints if joint.parent == "world"] == ["floating"]
    assert left_out == ["link 'ball1'", "link 'ball2'"]
    assert [sensor.link for sensor in part.mounted_sensors] == ["arm"]
    assert len(robot.links) == 5


def test_one_robot_is_returned_as_it_is(write):
    robot = api.load(write("m.sdf", f'<sdf version="1.9"><model name="m">{ARM}</model></sdf>'))
    assert take_robot(robot) == (robot, [])
    text = '<robot name="r"><link name="world"/><link name="a"/><joint name="j" type="floating">'
    text += '<parent link="world"/><child link="a"/></joint></robot>'
    robot = api.load(write("r.urdf", text))
    assert take_robot(robot)[0] is robot


@pytest.mark.library("mujoco")
def test_planes_and_scenery_of_mjcf_are_left_out(write):
    part, left_out = take_robot(api.load(write("m.xml", MJCF)))
    assert [link.name for link in part.links] == ["world", "robot", "leg"]
    assert left_out == ["plane 'floor'", "link 'box'", "collision 'wall' of link 'world'"]
    fixed = MJCF.replace("<freejoint/>", "")
    part, left_out = take_robot(api.load(write("m.xml", fixed)))
    assert left_out == ["plane 'floor'"]
    assert [c.name for c in part.link["world"].collisions] == ["wall"]
    assert {"box", "robot", "leg"} < set(part.link)


@pytest.mark.library("mujoco")
@pytest.mark.library("pybullet")
def test_a_scene_is_simulated(urdftool, write):
    result = urdftool("simulate", write("m.xml", MJCF), "--duration", "1", "--no-cache")
    assert result.code in (0, 1)
    assert "m.xml:2:1: warning: parts of the scene are not simulated: plane 'floor'" in result.err
    assert "<" not in result.out


BODY = '<link name="{}"><inertial><mass value="1"/></inertial></link>'
FLOAT = '<joint name="{0}" type="floating"><parent link="{1}"/><child link="{0}"/></joint>'
HINGE = '<joint name="h" type="continuous"><parent link="b"/><child link="c"/></joint>'


@pytest.mark.parametrize(
    ("root", "joints", "kept", "left_out"),
    [
        ('<link name="w"/>', [("a", "w"), ("b", "w")], ["b", "c"], ["link 'a'"]),
        ('<link name="w"/>', [("b", "w")], ["w", "b", "c"], []),
        (BODY.format("w"), [("a", "w"), ("b", "a")], ["b", "c"], ["link 'w'", "link 'a'"]),
        (BODY.format("w"), [("b", "w")], ["b", "c"], ["link 'w'"]),
    ],
)
def test_the_largest_part_of_a_urdf_that_floating_joints_divide(
    write, root, joints, kept, left_out
):
    bodies = [BODY.format(name) for name, _ in joints]
    text = "".join([root, *bodies, BODY.format("c"), HINGE, *(FLOAT.format(*j) for j in joints)])
    part, others = take_robot(api.load(write("r.urdf", f'<robot name="r">{text}</robot>')))
    assert [link.name for link in part.links] == kept
    assert others == left_out


PAIR = """<mujoco model="pair"><worldbody><geom name="floor" type="plane" size="5 5 1"/>
<body name="base" pos="0 0 .1"><freejoint/>
<geom name="foot" type="box" size=".2 .2 .05" contype="0" conaffinity="0"/></body></worldbody>
<contact><pair geom1="foot" geom2="floor"/></contact></mujoco>"""


@pytest.mark.library("mujoco")
def test_a_foot_that_touches_by_a_pair_stands(write, urdftool):
    write("r.xml", PAIR)
    result = urdftool("simulate", "r.xml", "--engine", "mujoco")
    assert (result.code, result.out.splitlines()[0]) == (0, "pair: stands")


@pytest.mark.parametrize(
    ("value", "is_named"), [("collide_bitmask>0<", True), ("collide_bitmask>65535<", False)]
)
def test_filters_of_contacts_are_named(write, urdftool, value, is_named):
    pytest.importorskip("pybullet")
    tag = value.partition(">")[0]
    text = f"""<sdf version="1.9"><model name="m"><link name="a"><inertial><mass>1</mass><inertia>
<ixx>.01</ixx><iyy>.01</iyy><izz>.01</izz></inertia></inertial><collision name="c"><geometry><box>
<size>.4 .4 .1</size></box></geometry><surface><contact><{value}/{tag}></contact></surface>
</collision></link></model></sdf>"""
    write("m.sdf", text)
    result = urdftool("simulate", "m.sdf")
    assert ("collide_bitmask of a collision of link 'a'" in result.err) is is_named


@pytest.mark.library("pybullet")
def test_what_only_pybullet_reads_of_a_collision_and_a_contact_with_the_world_are_named(
    urdftool, tmp_path
):
    file = tmp_path / "r.urdf"
    file.write_text(
        '<robot name="r"><link name="a"><inertial><mass value="1"/>'
        '<inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial>'
        '<collision group="0" mask="0"><geometry><box size="1 1 1"/></geometry></collision>'
        "</link></robot>"
    )
    result = urdftool("simulate", file)
    assert "group of a collision of link 'a', mask of a collision of link 'a'" in result.err


@pytest.mark.library("mujoco")
@pytest.mark.library("pybullet")
def test_a_contact_with_the_world_that_a_file_excludes_is_named(urdftool, tmp_path):
    file = tmp_path / "r.xml"
    file.write_text(
        '<mujoco><worldbody><geom name="floor" type="plane" size="5 5 .1"/>'
        '<body name="a" pos="0 0 .2"><freejoint/><geom type="box" size=".2 .2 .05"/></body>'
        '</worldbody><contact><exclude body1="world" body2="a"/></contact></mujoco>'
    )
    assert "no contact of 'world' and 'a'" in urdftool("simulate", file).err
    out = tmp_path / "out.xml"
    assert urdftool("export", "mjcf", file, "-o", out).code == 0
    assert '<exclude body1="world" body2="a"/>' in out.read_text()
    for language in ("urdf", "sdf", "usd"):
        place = tmp_path / f"out.{'usda' if language == 'usd' else language}"
        result = urdftool("export", language, file, "-o", place)
        assert result.code == 0
        assert "'world'" in result.err or "'world – a'" in result.err
        assert "[lossy-exclusion]" in result.err
