"""Reading SDF: frames, axes, defaults and includes by the specification of each version."""

import json
import math

import pytest

from tests.conftest import FIXTURES
from tests.reading import line_of, make_reading_fixtures
from urdftool.errors import ModelError, SourceError
from urdftool.formats.sdf.read import read
from urdftool.model.elements import Ellipsoid, Plane, UnknownShape
from urdftool.model.kinematics import link_poses
from urdftool.model.pose import IDENTITY, Pose, make_pose, rotation_from_quaternion

READERS = FIXTURES / "readers"
MECHANISM = READERS / "mechanism.sdf"
HAND = READERS / "hand" / "hand.sdf"


mechanism, robot = make_reading_fixtures(read, MECHANISM)


def sdf(tmp_path, body, version="1.9", name="m"):
    file = tmp_path / "m.sdf"
    file.write_text(f'<sdf version="{version}">\n<model name="{name}">\n{body}\n</model></sdf>')
    return file


def poses(robot):
    """Return the poses of the links, as written, in the world."""
    start = make_pose(robot.base.origin) if robot.base is not None else IDENTITY
    written = {
        frame.link: make_pose(frame.origin) for frame in robot.frames if frame.kind == "body"
    }
    return {
        name: start @ pose @ written.get(name, IDENTITY) for name, pose in link_poses(robot).items()
    }


def test_links_are_where_drake_has_them(robot):
    """The poses are those of Drake 1.51.1, without the loop, which it does not read."""
    found = poses(robot)
    expected = json.loads(MECHANISM.with_suffix(".poses.json").read_text("utf-8"))
    assert {link.name for link in robot.links if not link.is_virtual} == set(expected)
    for name, pose in expected.items():
        assert found[name].translation == pytest.approx(pose["xyz"], abs=1e-9), name
        rotation = rotation_from_quaternion(tuple(pose["wxyz"]))
        for row, wanted in zip(found[name].rotation, rotation, strict=True):
            assert row == pytest.approx(wanted, abs=1e-9), name


def test_parts_have_the_place_of_their_element(robot):
    for part, text, file in (
        (robot.link["arm"], '<link name="arm"', MECHANISM),
        (robot.link["left::thumb"], '<link name="thumb"', HAND),
        (robot.joint["bend"], '<joint name="bend"', HAND),
        (robot.joint["left::bend"].limit, "<limit>", HAND),
        (robot.link["base"].inertial, "<inertial>", MECHANISM),
        (robot.cameras[0], 'name="eye"', MECHANISM),
        (robot.closures[0], 'name="loop"', MECHANISM),
    ):
        assert (part.place.path, part.place.line) == (str(file), line_of(text, file))
    assert robot.source.files[0].path == str(MECHANISM)


def test_joints(robot):
    kinds = {joint.name: joint.type for joint in robot.joints}
    assert kinds == {
        "swing": "continuous",
        "swing~2": "revolute",
        "thread": "screw",
        "socket": "ball",
        "grip": "fixed",
        "wrist": "prismatic",
        "bend": "revolute",
        "left::bend": "revolute",
        "weld": "fixed",
    }
    first, second = robot.joint["swing"], robot.joint["swing~2"]
    assert (first.child, second.parent, second.child) == ("arm~1", "arm~1", "arm")
    assert robot.link["arm~1"].is_virtual
    assert second.spring == (5.0, 0.2)
    assert robot.joint["thread"].thread_pitch == pytest.approx(0.01)
    bend = robot.joint["left::bend"].limit
    assert (bend.lower, bend.upper, bend.effort, bend.velocity) == (-1.0, 1.5, 4.0, None)
    assert robot.joint["wrist"].limit is None
    assert (robot.joint["wrist"].parent, robot.joint["wrist"].child) == ("tool::tip", "left::palm")


def test_a_second_joint_of_a_link_closes_a_loop(robot):
    (loop,) = robot.closures
    assert (loop.name, loop.type, loop.parent, loop.child) == (
        *("loop", "revolute", "thumb", "left::thumb"),
    )
    found = link_poses(robot)
    one = found[loop.parent] @ make_pose(loop.origin)
    other = found[loop.child] @ make_pose(loop.child_origin)
    assert one.translation == pytest.approx(other.translation)
    assert loop.axis == pytest.approx((0.0, 0.0, 1.0))


def test_shapes_and_sensors(robot):
    base = robot.link["base"]
    plane = base.collisions[0]
    assert plane.geometry == Plane(plane.geometry.provenance, (2.0, 3.0))
    assert make_pose(plane.origin).transform((0.0, 0.0, 1.0)) == pytest.approx((1.0, 0.0, -0.1))
    body, hill = base.visuals
    assert body.geometry == Ellipsoid(body.geometry.provenance, (0.1, 0.2, 0.3))
    assert body.material.color == (0.1, 0.2, 0.3, 1.0)  # Gazebo ignores the alpha of <diffuse>
    assert isinstance(hill.geometry, UnknownShape)
    assert (hill.geometry.tag, hill.geometry.files) == ("heightmap", ("hill.png",))
    mesh = robot.link["left::palm"].visuals[0].geometry
    assert robot.source.resolve(mesh.filename).is_file()
    (eye,) = robot.cameras
    assert eye.origin.xyz == pytest.approx((0.5, 0.0, 0.2))
    assert eye.vertical_fov == pytest.approx(2 * math.atan(math.tan(0.6) * 0.75))
    assert [(s.name, s.type, s.link, s.joint) for s in robot.mounted_sensors] == [
        ("imu", "imu", "base", ""),
        ("torque", "force_torque", "", "swing"),
    ]


def test_frames(robot):
    frames = {frame.name: (frame.kind, frame.link) for frame in robot.frames}
    assert frames == {
        "arm": ("body", "arm"),
        "ball": ("body", "ball"),
        "thumb": ("body", "thumb"),
        "left::thumb": ("body", "left::thumb"),
        "foot": ("frame", "base"),
        "shelf": ("frame", "base"),
        "mount": ("frame", "palm"),
        "left::mount": ("frame", "left::palm"),
    }
    foot = next(frame for frame in robot.frames if frame.name == "foot")
    placed = make_pose(robot.base.origin) @ make_pose(foot.origin)
    assert placed.translation == pytest.approx((1.0, 2.0, 3.0))  # placement_frame


def test_what_the_model_lacks_is_reported_once_each(mechanism):
    found = {loss.code: (loss.severity.label, loss.data["count"]) for loss in mechanism.losses}
    assert found == {
        "unread-shape-heightmap": ("warning", 1),
    }


ROLLED = """
<link name="a"/><link name="b"><pose>1 0 0 0 0 1.5707963267948966</pose></link>
<joint name="j" type="revolute"><pose>0 0 0.5 1.5707963267948966 0 0</pose>
<parent>a</parent><child>b</child>
<axis><xyz>{xyz}</xyz>{flag}<limit><lower>-1</lower><upper>1</upper></limit></axis></joint>
"""
FLAG = "<use_parent_model_frame>true</use_parent_model_frame>"


@pytest.mark.parametrize(
    ("version", "flag", "axis"),
    [
        ("1.4", "", (1, 0, 0)),
        ("1.5", "", (0, 1, 0)),
        ("1.6", "", (0, 1, 0)),
        ("1.6", FLAG, (1, 0, 0)),
        ("1.9", "", (0, 1, 0)),
        ("1.12", "", (0, 1, 0)),
    ],
)
def test_the_frame_of_an_axis_depends_on_the_version(tmp_path, version, flag, axis):
    """The axes are those of libsdformat 12 and Drake 1.51.1 for 1 0 0."""
    robot = read(sdf(tmp_path, ROLLED.format(xyz="1 0 0", flag=flag), version)).robot
    joint = robot.joint["j"]
    turned = poses(robot)["b"].rotation
    found = Pose(turned).transform(joint.axis.xyz)
    assert found == pytest.approx(axis, abs=1e-12)
    assert joint.origin.xyz == pytest.approx((1.0, 0.0, 0.5))


def test_defaults(tmp_path):
    body = """<link name="a"/>
    <link name="b"><inertial><mass>3</mass></inertial></link>
    <link name="c"><inertial><inertia><ixx>2</ixx></inertia></inertial>
    <collision name="x"><geometry><box/></geometry></collision>
    <collision name="x"><geometry><capsule/></geometry></collision></link>
    <joint name="j" type="revolute"><parent>a</parent><child>b</child></joint>
    <joint name="k" type="prismatic"><parent>b</parent><child>c</child>
    <axis><limit><lower>-1e16</lower><upper>2</upper><effort>0</effort></limit></axis></joint>"""
    robot = read(sdf(tmp_path, body)).robot
    inertials = {link.name: link.inertial for link in robot.links}
    assert {name: inertial.mass for name, inertial in inertials.items()} == {"a": 1, "b": 3, "c": 1}
    assert inertials["a"].inertia.six == inertials["b"].inertia.six == (1, 0, 0, 1, 0, 1)
    assert inertials["c"].inertia.six == (2, 0, 0, 1, 0, 1)
    assert robot.joint["j"].type == "continuous"
    assert robot.joint["j"].axis.xyz == (0.0, 0.0, 1.0)
    limit = robot.joint["k"].limit
    assert (limit.lower, limit.upper, limit.effort, limit.velocity) == (-math.inf, 2.0, 0.0, None)
    box, capsule = (collision.geometry for collision in robot.link["c"].collisions)
    assert box.size == (1.0, 1.0, 1.0)
    assert (capsule.radius, capsule.length) == (0.5, 1.0)
    assert robot.base.is_free


@pytest.mark.parametrize(
    ("version", "pitch", "expected"),
    [
        ("1.9", "<thread_pitch>200</thread_pitch>", -math.tau / 200),
        ("1.10", "<screw_thread_pitch>0.02</screw_thread_pitch>", 0.02),
    ],
)
def test_the_pitch_of_a_screw(tmp_path, version, pitch, expected):
    body = f"""<link name="a"/><link name="b"/><joint name="j" type="screw">{pitch}
    <parent>a</parent><child>b</child></joint>"""
    assert read(sdf(tmp_path, body, version)).robot.joint["j"].thread_pitch == expected


def test_a_mimic_joint_refers_to_the_offset_of_its_leader(tmp_path):
    body = """<link name="a"/><link name="b"/><link name="c"/>
    <joint name="j" type="revolute"><parent>a</parent><child>b</child></joint>
    <joint name="k" type="revolute"><parent>a</parent><child>c</child><axis>
    <mimic joint="j"><multiplier>2</multiplier><offset>0.5</offset><reference>0.1</reference>
    </mimic></axis></joint>"""
    mimic = read(sdf(tmp_path, body, "1.11")).robot.joint["k"].mimic
    assert (mimic.joint, mimic.multiplier, mimic.offset) == ("j", 2.0, pytest.approx(0.3))


@pytest.mark.parametrize(("static", "kind"), [("", "floating"), ("<static>1</static>", "fixed")])
def test_links_without_joints_hang_on_the_world(tmp_path, static, kind):
    body = f"""{static}<pose>0 0 1 0 0 0</pose><link name="a"/>
    <link name="b"><pose>1 0 0 0 0 0</pose></link>"""
    robot = read(sdf(tmp_path, body)).robot
    assert [(joint.type, joint.parent, joint.child) for joint in robot.joints] == [
        (kind, "world", "a"),
        (kind, "world", "b"),
    ]
    assert robot.joints[1].origin.xyz == (1.0, 0.0, 1.0)
    assert robot.tree.root.name == "world"


def test_a_joint_to_the_world_fixes_the_robot(tmp_path):
    body = """<pose>0 0 2 0 0 0</pose><link name="a"/>
    <joint name="j" type="fixed"><parent>world</parent><child>a</child></joint>"""
    robot = read(sdf(tmp_path, body)).robot
    assert (robot.base, robot.tree.root.name) == (None, "world")
    assert robot.joint["j"].origin.xyz == (0.0, 0.0, 2.0)


def test_the_model_with_most_joints_is_read(tmp_path):
    file = tmp_path / "w.sdf"
    file.write_text("""<sdf version="1.6"><world name="w"><light name="sun"/>
    <model name="floor"><link name="f"/></model>
    <model name="arm"><link name="a"/><link name="b"/>
    <joint name="j" type="fixed"><parent>a</parent><child>b</child></joint></model>
    </world></sdf>""")
    reading = read(file)
    assert reading.robot.name == "arm"
    assert [(loss.code, loss.name) for loss in reading.losses] == [
        ("unread-world", "sun"),
        ("unread-model", "floor"),
    ]


WORLD = """<sdf version="{}"><world name="w">{}<model name="arm"><link name="a"/></model>
</world></sdf>"""


@pytest.mark.parametrize(
    ("uri", "code", "severity"),
    [
        ("model://sun", "unread-scenery", "info"),
        ("model://ground_plane", "unread-scenery", "info"),
        ("model://oak_tree", "unread-missing-model", "warning"),
        ("https://fuel.gazebosim.org/1.0/a/models/b", "unread-missing-model", "warning"),
    ],
)
def test_scenery_that_is_not_there_is_reported(tmp_path, uri, code, severity):
    file = tmp_path / "w.world"
    file.write_text(WORLD.format("1.6", f"<include><uri>{uri}</uri></include>"))
    reading = read(file)
    assert reading.robot.name == "arm"
    (loss,) = reading.losses
    assert (loss.code, loss.severity.name.lower(), loss.name) == (code, severity, uri)


def test_a_world_whose_only_model_is_not_there_is_refused(tmp_path):
    file = tmp_path / "w.world"
    includes = "".join(f"<include><uri>model://{n}</uri></include>" for n in ("sun", "iris"))
    file.write_text(f'<sdf version="1.6"><world name="w">{includes}</world></sdf>')
    with pytest.raises(SourceError, match="model 'model://iris' is not found"):
        read(file)


def test_a_model_without_its_parts_is_refused(tmp_path):
    file = tmp_path / "w.world"
    part = "<include><uri>model://gripper</uri></include>"
    file.write_text(f'<sdf version="1.6"><model name="m"><link name="a"/>{part}</model></sdf>')
    with pytest.raises(SourceError, match="model 'model://gripper' is not found"):
        read(file)


def test_rules_of_the_oldest_version_are_used_for_earlier_ones(tmp_path):
    file = tmp_path / "w.world"
    file.write_text(WORLD.format("1.3", ""))
    assert [(one.code, one.name) for one in read(file).losses] == [("unread-version", "1.3")]


def test_the_name_and_pose_of_an_include_replace_those_of_the_model(tmp_path, monkeypatch):
    monkeypatch.setenv("URDFTOOL_TRUST", "1")  # the model is outside of the project
    text = f"""<sdf version="1.9"><world name="w"><include><uri>file://{HAND}</uri>
    <name>claw</name><pose>0 0 5 0 0 0</pose></include></world></sdf>"""
    (tmp_path / "w.sdf").write_text(text)
    robot = read(tmp_path / "w.sdf").robot
    assert robot.name == "claw"
    assert robot.base.origin.xyz == pytest.approx((0.02, 0.0, 5.0))


MODEL = '<sdf version="1.9">\n<model name="m">\n{}</model></sdf>'
BAD = {
    "truncated": ('<sdf version="1.9"><model name="m">', 1),
    "no version": ('<sdf>\n<model name="m"><link name="a"/></model></sdf>', 1),
    "another format": ("<collada/>", 1),
    "no model": ('<sdf version="1.9"/>', 1),
    "no link": (MODEL.format(""), 1),
    "two worlds": ('<sdf version="1.9"><world name="a"/>\n<world name="b"/></sdf>', 2),
    "an unknown parent": (
        MODEL.format(
            '<link name="a"/><joint name="j" type="fixed">\n<parent>x</parent>'
            "<child>a</child></joint>"
        ),
        4,
    ),
    "an unknown type": (MODEL.format('<link name="a"/>\n<joint name="j" type="gear"/>'), 4),
    "an unknown frame": (
        MODEL.format('<link name="a">\n<pose relative_to="x">0 0 0 0 0 0</pose></link>'),
        3,
    ),
    "a cycle of frames": (
        MODEL.format(
            '<link name="a"/><frame name="f"><pose relative_to="g"/></frame>\n'
            '<frame name="g"><pose relative_to="f"/></frame>'
        ),
        4,
    ),
    "three numbers of a pose": (MODEL.format('<link name="a">\n<pose>1 2 3</pose></link>'), 4),
    "a word for a number": (
        MODEL.format('<link name="a"><inertial>\n<mass>much</mass></inertial></link>'),
        4,
    ),
    "a zero axis": (
        MODEL.format(
            '<link name="a"/><link name="b"/><joint name="j" type="revolute">'
            "<parent>a</parent><child>b</child>\n<axis><xyz>0 0 0</xyz></axis></joint>"
        ),
        4,
    ),
    "a mimic of nothing": (
        MODEL.format(
            '<link name="a"/><link name="b"/><joint name="j" type="revolute">'
            '<parent>a</parent><child>b</child><axis>\n<mimic joint="x"/></axis></joint>'
        ),
        4,
    ),
    "two links of a name": (MODEL.format('<link name="a"/>\n<link name="a"/>'), 4),
    "no such model": (MODEL.format("<include>\n<uri>model://none</uri></include>"), 3),
    "a model of the network": (
        MODEL.format("<include><uri>https://fuel.gazebosim.org/m</uri></include>"),
        3,
    ),
    "includes itself": (MODEL.format("\n<include><uri>bad.sdf</uri></include>"), 4),
    "a million links": (MODEL.format("\n" + '<link name="a"/>' * 200_001), 4),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_file_is_refused_with_a_place(tmp_path, name):
    text, line = BAD[name]
    file = tmp_path / "bad.sdf"
    file.write_text(text)
    with pytest.raises((SourceError, ModelError)) as error:
        read(file)
    assert (error.value.path, error.value.line) == (str(file), line)


def test_include_cycles_end(tmp_path):
    for one, other in (("a", "b"), ("b", "a")):
        include = f"<include><uri>{other}.sdf</uri></include>"
        text = f'<sdf version="1.9"><model name="{one}">{include}</model></sdf>'
        (tmp_path / f"{one}.sdf").write_text(text)
    with pytest.raises(SourceError, match="includes itself") as error:
        read(tmp_path / "a.sdf")
    assert error.value.path == str(tmp_path / "b.sdf")


def test_xml_that_libsdformat_accepts_is_read_and_reported(tmp_path):
    file = sdf(tmp_path, '<!-- a -- b --><link name="a"/>')
    file.write_text("\n" + file.read_text().replace("<sdf", '<?xml version="1.0"?><sdf') + "</sdf>")
    found = read(file)
    assert [link.name for link in found.robot.links] == ["a"]
    codes = [(loss.code, loss.location.line) for loss in found.losses]
    assert ("unread-not-well-formed", 2) in codes
    assert "unread-end-tag" in dict(codes)


def test_an_element_with_an_undeclared_prefix_is_passed_over(tmp_path):
    body = '<link name="a"><drake:joint name="x"/></link>'
    assert read(sdf(tmp_path, body)).robot.link["a"].mass == 1.0


def test_settings_of_model_links_joints_and_collisions(write):
    solid = (
        '<collision name="c"><geometry><box/></geometry><surface><friction><ode><mu>0.3</mu></ode>'
        "</friction></surface></collision>"
    )
    text = f"""<sdf version="1.9"><model name="m"><self_collide>1</self_collide>
    <link name="a"><gravity>0</gravity>
    <velocity_decay><linear>0.1</linear></velocity_decay>{solid}</link><link name="b"/>
    <joint name="j" type="revolute"><parent>a</parent><child>b</child>
    <axis><xyz>0 0 1</xyz></axis><physics><ode><limit><erp>0.4</erp></limit></ode></physics></joint>
    </model></sdf>"""
    reading = read(write("m.sdf", text))
    robot = reading.robot
    parts = (robot, robot.link["a"], robot.joint["j"])
    found = [{name: v.content for name, v in part.settings.items()} for part in parts]
    assert found == [
        {"self_collide": True},
        {"gravity": False, "linear_decay": 0.1},
        {"stop_erp": 0.4},
    ]
    (collision,) = robot.link["a"].collisions
    assert {name: v.content for name, v in collision.surface.items()} == {"friction": 0.3}
    assert collision.surface["friction"].place.line == 3
    assert [f.code for f in reading.losses] == []
