"""What ``<gazebo>`` says is compared as each target has it, and what is translated is known."""

import re

import pytest

from urdftool.compare.check import is_faithful
from urdftool.formats.common.directory import write_directory
from urdftool.formats.sdf.options import Options
from urdftool.formats.sdf.verify.compare import compare, read_pair, verify
from urdftool.formats.sdf.write import write

from .robots import BOX, gazebo, inertial, joint, link, robot

IMU = '<plugin name="imu" filename="libgazebo_ros_imu.so"><bodyName>b</bodyName>'
PARTS = {
    "scanner": gazebo(
        "b",
        '<sensor name="scan" type="ray"><pose>0 0 0.1 0 0 0</pose><update_rate>5</update_rate>'
        "<ray><scan><horizontal><samples>9</samples></horizontal></scan></ray>"
        '<plugin name="p" filename="libgazebo_ros_laser.so"><topicName>scan</topicName>'
        "<frameName>b</frameName></plugin></sensor>",
    ),
    "cameras": gazebo(
        "b",
        '<sensor name="two" type="multicamera"><camera name="left"/><camera name="right">'
        "<pose>0 -0.1 0 0 0 0</pose></camera></sensor>",
    ),
    "old noise": gazebo(
        "b",
        '<sensor name="i" type="imu"><imu><noise><type>gaussian</type><rate><mean>0</mean>'
        "<stddev>0.1</stddev></rate></noise></imu></sensor>",
    ),
    "sensing plugin": "<gazebo>"
    + IMU
    + "<gaussianNoise>0.1</gaussianNoise><updateRate>50</updateRate><xyzOffset>0 0 1</xyzOffset>"
    "<topicName>imu</topicName></plugin></gazebo>",
    "drive": '<gazebo><plugin name="d" filename="libgazebo_ros_skid_steer_drive.so">'
    "<leftFrontJoint>j</leftFrontJoint><rightFrontJoint>k</rightFrontJoint>"
    "<wheelDiameter>0.3</wheelDiameter><commandTopic>go</commandTopic></plugin></gazebo>",
    "control": '<gazebo><plugin name="c" filename="libgazebo_ros_control.so">'
    "<robotNamespace>/r</robotNamespace><parameters>p.yaml</parameters></plugin></gazebo>",
    "unknown plugin": '<gazebo><plugin name="x" filename="libmine.so"><bodyName>c</bodyName>'
    "<some><deep>1 2 3</deep></some></plugin></gazebo>",
    "surface": gazebo(
        "b",
        "<mu1>0.4</mu1><mu1>0.5</mu1><fdir1>0 1 0</fdir1><maxContacts>4</maxContacts>"
        "<laserRetro>100</laserRetro><collision><surface><bounce>"
        "<restitution_coefficient>0.5</restitution_coefficient></bounce></surface></collision>",
    ),
    "flags": gazebo(
        "b",
        "<selfCollide>1</selfCollide><gravity>false</gravity><dampingFactor>0.1</dampingFactor>",
    ),
    "stops": gazebo("j", "<stopCfm>0.1</stopCfm><implicitSpringDamper>true</implicitSpringDamper>"),
    "scripts": gazebo(
        "b",
        "<material>mine</material><visual><material><ambient>0 1 0 1</ambient></material></visual>",
    )
    + gazebo("c", "<visual><material><script><name>other</name></script></material></visual>"),
    "looks": gazebo("b", "<material>Gazebo/RedTransparent</material>")
    + gazebo("c", "<material><ambient>1 0 0 1</ambient></material>"),
    "light": gazebo("c", '<light name="l" type="point"><pose>0 0 1 0 0 0</pose></light>'),
    "whole": "<gazebo><static>true</static><pose>1 2 3 0 0 1</pose>"
    "<self_collide>true</self_collide><enable_wind>true</enable_wind></gazebo>",
    "loop": '<gazebo><joint name="l" type="revolute"><parent>a</parent><child>c</child>'
    "<pose>0 0 1 0 0 0</pose><axis><xyz>0 0 1</xyz></axis></joint></gazebo>",
}

SHAPES = f'<visual>{BOX}<material name="m"><color rgba="1 0 0 0.5"/></material></visual>'
SHAPES += f"<collision>{BOX}</collision>"


def made(*parts):
    return robot(
        link("a", inertial() + SHAPES),
        joint("j", "a", "b"),
        link("b", inertial() + SHAPES),
        joint("w", "b", "c", "fixed", origin="1 2 3"),
        link("c", inertial() + SHAPES),
        joint("k", "c", "d", "continuous", inside='<axis xyz="0 1 0"/>'),
        link("d", inertial() + SHAPES),
        *parts,
    )


def checks_of(source, folder, change=lambda text: text, **choices):
    options = Options(folder="m", **choices)
    written = write(source, options)
    text = change(written.text)
    written.files[written.main] = text.encode()
    write_directory(folder / "m", written.files, main=written.main)
    pair = read_pair(source, written, folder / "m" / written.main, options)
    return {check.name: check for check in compare(pair)}


CHOICES = {
    "gz": {},
    "gz lumped": {"fixed_joints": "lump"},
    "gz 1.9": {"version": "1.9"},
    "gz 1.12": {"version": "1.12"},
    "classic": {"target": "gazebo-classic"},
    "classic kept": {"target": "gazebo-classic", "fixed_joints": "keep"},
    "classic 1.6": {"target": "gazebo-classic", "version": "1.6"},
}


@pytest.mark.parametrize("choices", CHOICES.values(), ids=CHOICES)
@pytest.mark.parametrize("part", PARTS.values(), ids=PARTS)
def test_an_export_is_faithful(tmp_path, part, choices):
    checks = checks_of(made(part), tmp_path, **choices)
    assert is_faithful(checks.values()), [c.differing for c in checks.values() if c.differing]


@pytest.mark.parametrize("choices", CHOICES.values(), ids=CHOICES)
def test_a_static_robot_of_two_trees_is_faithful(tmp_path, choices):
    checks = checks_of(made(PARTS["whole"], link("e", inertial())), tmp_path, force=True, **choices)
    assert is_faithful(checks.values()), [c.differing for c in checks.values() if c.differing]


@pytest.mark.parametrize(
    ("part", "old", "new", "row"),
    [
        ("scanner", "<topic>scan</topic>", "<topic>other</topic>", "sensors"),
        ("scanner", 'type="gpu_lidar"', 'type="ray"', "sensors"),
        ("cameras", r'(?s)<sensor name="two_right".*?</sensor>', "", "sensors"),
        ("old noise", "<stddev>0.1<", "<stddev>0.2<", "sensors"),
        ("sensing plugin", "<pose>0 0 1 ", "<pose>0 0 2 ", "sensors"),
        ("sensing plugin", "<stddev>0.1<", "<stddev>0.2<", "sensors"),
        ("drive", "<wheel_radius>0.15<", "<wheel_radius>0.3<", "plugins"),
        ("control", "<namespace>/r<", "<namespace>/s<", "plugins"),
        ("unknown plugin", "<deep>1 2 3<", "<deep>1 2 4<", "plugins"),
        ("surface", "<mu>0.5<", "<mu>0.4<", "surface"),
        ("surface", "<restitution_coefficient>0.5<", "<restitution_coefficient>0<", "surface"),
        ("flags", "<gravity>false<", "<gravity>true<", "link flags"),
        ("flags", "<angular>0.1<", "<angular>0.2<", "link flags"),
        ("stops", "<cfm>0.1<", "<cfm>0.2<", "joint physics"),
        ("looks", "<ambient>1 0 0 1<", "<ambient>0 0 1 1<", "looks"),
        ("light", '"c">0 0 1 ', '"b">0 0 1 ', "other elements"),
        ("whole", "<static>true<", "<static>false<", "base"),
        ("whole", "<pose>1 2 3 ", "<pose>1 2 4 ", "base"),
        ("loop", "<pose>0 0 1 0 0 0<", "<pose>0 0 2 0 0 0<", "loops"),
    ],
)  # fmt: skip
def test_a_change_is_found_in_its_row(tmp_path, part, old, new, row):
    def change(text):
        changed, count = re.subn(old, new, text, count=1)
        assert count
        return changed

    lump = {"fixed_joints": "lump"} if part == "light" else {}
    checks = checks_of(made(PARTS[part]), tmp_path, change, **lump)
    assert checks[row].verdict == "differs"


WORLDS = [
    ("<mass>1.0</mass>|<mass>1</mass>", "<mass>2</mass>", "mass is 2, not 1"),
    ('<world name="default">', '<world name="a"><gravity>0 0 -1.62</gravity>', "gravity"),
    ("gz-sim-sensors-system", "gz-sim-other-system", "the system 'sensors' is missing"),
    ('<model name="ground_plane">', '<model name="flat">', "2 models in addition to the ground"),
]


@pytest.mark.parametrize(
    ("file", "old", "new", "said"),
    [*(("", *row) for row in WORLDS), *(("m.sdf", *row) for row in WORLDS[1:]), ("", "", "", "")],
)
def test_a_world_is_compared(tmp_path, file, old, new, said):
    options = Options(folder="m", file=file, uri="file", world=True)
    source = made(PARTS["scanner"])
    written = write(source, options)
    name = file or "world.sdf"
    text, count = re.subn(old, new, written.files[name].decode(), count=1)
    assert count
    written.files[name] = text.encode()
    write_directory(tmp_path / "m", written.files, main=written.main)
    checks = verify(source, written, options, tmp_path / "m" / file)
    (differing,) = [check.differing for check in checks if check.name == "world"]
    assert [said in text for text in differing] == ([True] if said else [])
