"""Reading MJCF: equal to what MuJoCo compiles, with the place of every part."""

import math
import os
from pathlib import Path

import numpy as np
import pytest

from tests.conftest import FIXTURES, ROOT
from tests.reading import line_of, make_reading_fixtures
from urdftool.errors import ModelError, SourceError, UrdftoolError
from urdftool.formats.mjcf.read import read
from urdftool.model.bounds import compute_bounds_at
from urdftool.model.elements import Box, Capsule, Ellipsoid, Mesh
from urdftool.model.kinematics import link_poses
from urdftool.model.pose import make_pose

pytestmark = pytest.mark.library("mujoco")

READERS = FIXTURES / "readers"
MECHANISM = READERS / "mechanism.xml"
WHEELS = Path(os.environ.get("URDFTOOL_MJCF", ROOT / ".venv-mjcf"))
TOLERANCE = 1e-9


mechanism, robot = make_reading_fixtures(read, MECHANISM)


def model(tmp_path, body, rest="", name="m.xml"):
    file = tmp_path / name
    file.write_text(f"<mujoco>{rest}\n<worldbody>\n{body}\n</worldbody></mujoco>")
    return file


def equal(path):
    from .compiled_robot import differences

    worst = differences(read(path).robot, path)
    assert max(worst.values()) < TOLERANCE, f"{path}: {worst}"


@pytest.mark.parametrize(
    "path",
    [MECHANISM, *sorted((FIXTURES / "formats" / "mjcf").glob("*.xml"))],
    ids=lambda path: path.stem,
)
def test_a_fixture_is_what_mujoco_compiles(path):
    equal(path)


@pytest.mark.slow
@pytest.mark.skipif(not WHEELS.exists(), reason=f"no wheels of MJCF models in {WHEELS}")
def test_models_of_wheels_are_what_mujoco_compiles():
    import mujoco

    seen = 0
    for path in sorted(WHEELS.rglob("*.xml")):
        if b"<mujoco" not in path.read_bytes():
            continue
        try:
            mujoco.MjModel.from_xml_path(str(path))
        except ValueError:
            with pytest.raises(UrdftoolError) as refused:
                read(path)
            assert refused.value.line
            continue
        equal(path)
        seen += 1
    assert seen > 50


def test_parts_have_the_place_of_their_element(robot):
    fingers = READERS / "parts" / "fingers.xml"
    for part, text, file in (
        (robot.link["base"], '<body name="base"', MECHANISM),
        (robot.link["base"].inertial, "<inertial", MECHANISM),
        (robot.joint["yaw"], 'name="yaw"', MECHANISM),
        (robot.link["left_finger"], 'name="left_finger"', fingers),
        (robot.joint["right"], 'name="right"', fingers),
        (robot.joint_actuators[0], 'name="servo"', MECHANISM),
        (robot.configurations[1], 'name="home"', MECHANISM),
        (robot.closures[0], 'name="loop"', MECHANISM),
        (robot.cameras[0], 'name="eye"', MECHANISM),
        (robot.exclusions[0], "<exclude", MECHANISM),
        (robot.base, 'name="base"', MECHANISM),
    ):
        assert (part.place.path, part.place.line) == (str(file), line_of(text, file))
    assert robot.link["base"].place.column == 5
    assert [file.path for file in robot.source.files] == [str(MECHANISM), str(fingers)]


def test_joints_of_one_body_are_a_chain(robot):
    chain = [robot.joint[name] for name in ("slide", "yaw", "pitch")]
    assert [joint.type for joint in chain] == ["prismatic", "revolute", "continuous"]
    assert [joint.parent for joint in chain] == ["base", "shoulder~1", "shoulder~2"]
    assert chain[-1].child == "shoulder"
    assert robot.link["shoulder~1"].is_virtual
    assert robot.tree.root.name == "base"


def test_values_of_joints(robot):
    yaw, left = robot.joint["yaw"], robot.joint["left"]
    assert yaw.limit.lower == pytest.approx(-math.pi / 2)
    assert yaw.limit.effort == 10.0  # 5 N·m of forcerange, gear 2
    assert left.limit.effort == 6.0  # control of 2, gear 3
    assert (left.dynamics.damping, left.dynamics.armature) == (0.1, 0.01)
    assert left.axis.xyz == (0.0, 1.0, 0.0)
    assert robot.joint["pitch"].spring[1] == pytest.approx(math.radians(15))
    assert robot.joint["ball"].limit.upper == pytest.approx(math.radians(40))
    assert robot.joint["plate_body1_joint"].limit is None  # an empty range is no limit
    mimic = robot.joint["right"].mimic
    assert (mimic.joint, mimic.multiplier, mimic.offset) == ("left", -1.0, 0.1)


def test_shapes(robot):
    upper = robot.link["shoulder"].collisions[0]
    length = math.hypot(0.3, 0.1)
    assert isinstance(upper.geometry, Capsule)
    assert upper.geometry.length == pytest.approx(length)
    ends = [make_pose(upper.origin).transform((0.0, 0.0, z)) for z in (length / 2, -length / 2)]
    frame = make_pose(next(f.origin for f in robot.frames if f.name == "shoulder")).invert()
    assert [frame.transform(end) for end in ends] == [
        pytest.approx((0.0, 0.0, 0.0)),
        pytest.approx((0.3, 0.1, 0.0)),
    ]
    assert robot.link["wrist"].collisions[0].geometry == Ellipsoid(
        robot.link["wrist"].collisions[0].provenance, (0.03, 0.04, 0.05)
    )
    assert robot.link["plate"].visuals[0].geometry.size == pytest.approx((0.2, 0.1, 0.04))
    assert isinstance(robot.link["plate"].visuals[0].geometry, Box)
    base = robot.link["base"]
    assert [visual.name for visual in base.visuals] == ["shell", "slab"]
    assert [collision.name for collision in base.collisions] == ["shell"]
    assert base.visuals[0].material.name == "steel"
    assert base.visuals[1].material.color == pytest.approx((0.2, 0.4, 0.6, 1.0))


def test_meshes_are_where_mujoco_has_them(robot):
    import mujoco

    from urdftool.geometry.load import load_mesh

    compiled = mujoco.MjModel.from_xml_path(str(MECHANISM))
    for visual in robot.link["base"].visuals:
        assert isinstance(visual.geometry, Mesh)
        geom = compiled.geom(visual.name)
        first = compiled.mesh_vertadr[geom.dataid[0]]
        count = compiled.mesh_vertnum[geom.dataid[0]]
        rotation = np.zeros(9)
        mujoco.mju_quat2Mat(rotation, geom.quat)
        theirs = compiled.mesh_vert[first : first + count] @ rotation.reshape(3, 3).T + geom.pos
        mesh = load_mesh(robot.source.resolve(visual.geometry.filename), visual.geometry.scale)
        pose = make_pose(visual.origin)
        ours = mesh.vertices @ np.array(pose.rotation).T + pose.translation
        assert np.allclose(in_order(ours), in_order(theirs), atol=1e-6)


def in_order(points):
    return points[np.lexsort(np.round(points, 4).T)]


def test_a_loop_is_closed_as_drawn(robot):
    drawn = next(one.positions for one in robot.configurations if one.name == "qpos0")
    assert drawn == {"yaw": pytest.approx(math.radians(20))}
    poses = link_poses(robot, drawn)
    for closure in robot.closures:
        one = poses[closure.parent] @ make_pose(closure.origin)
        other = poses[closure.child] @ make_pose(closure.child_origin)
        assert one.translation == pytest.approx(other.translation, abs=1e-12)
    glue = robot.closures[1]
    assert (glue.type, glue.is_active) == ("weld", False)
    assert np.allclose(one.rotation, other.rotation)


def test_mechanism(robot):
    servo, drive, speed = robot.joint_actuators
    assert (servo.mode, servo.gain, servo.bias, servo.gear) == ("position", 30, (0, -30, -2), 2)
    assert servo.control_range == (-1.0, 1.0)
    assert (drive.mode, drive.joint, speed.mode) == ("motor", "left", "velocity")
    home = robot.configurations[1]
    assert (home.name, home.positions["yaw"], home.positions["left"]) == ("home", 0.5, 0.3)
    (eye,) = robot.cameras
    assert eye.vertical_fov == pytest.approx(math.radians(60))
    assert make_pose(eye.origin).transform((1.0, 0.0, 0.0)) == pytest.approx((0.1, 0.0, -0.8))
    assert [(one.name, one.type, one.link, one.joint) for one in robot.mounted_sensors] == [
        ("gyro", "gyro", "base", ""),
        ("angle", "jointpos", "", "yaw"),
    ]
    assert [(one.link, one.other) for one in robot.exclusions] == [("base", "shoulder")]
    assert robot.base.is_free


def test_what_the_model_lacks_is_reported_once_each(mechanism):
    found = {loss.code: (loss.severity.label, loss.data["count"]) for loss in mechanism.losses}
    assert found == {
        "unread-actuator": ("warning", 1),
        "unread-coupling": ("warning", 1),
        "unread-display-attribute": ("info", 1),
        "unread-hidden-geom": ("info", 1),
        "unread-light": ("info", 1),
        "unread-mesh": ("warning", 1),
        "unread-scenery": ("info", 1),
        "unread-sensor": ("info", 1),
        "unread-setting": ("warning", 1),
        "unread-tendon": ("warning", 1),
    }
    tendon = next(loss for loss in mechanism.losses if loss.code == "unread-tendon")
    assert (tendon.name, tendon.place.line) == ("cable", line_of('name="cable"', MECHANISM))


def test_a_turn_too_small_for_the_real_part_of_its_quaternion_is_read(tmp_path):
    body = '<body name="b" quat="1 1e-8 2e-8 0"><geom size="1"/></body>'
    turned = link_poses(read(model(tmp_path, f'<body name="a">{body}</body>')).robot)["b"].rotation
    assert turned[2][1] == pytest.approx(2e-8)
    assert turned[0][2] == pytest.approx(4e-8)


def test_several_bodies_hang_on_the_world(tmp_path):
    bodies = """<geom type="plane" size="1 2 .1"/>
    <body name="cart"><joint name="rail" type="slide" axis="1 0 0"/><geom size=".1"/></body>
    <body name="ball" pos="0 0 3"><freejoint/><geom size=".1"/></body>"""
    path = model(tmp_path, bodies)
    robot = read(path).robot
    assert robot.tree.root.name == "world"
    assert robot.base is None
    assert [(joint.type, joint.child) for joint in robot.joints] == [
        ("prismatic", "cart"),
        ("floating", "ball"),
    ]
    assert robot.joint["ball_joint"].place.line == 5
    assert robot.link["world"].collisions[0].geometry.size == (2.0, 4.0)
    assert compute_bounds_at(robot.link["world"].collisions[0].geometry, make_pose(None)) is None
    equal(path)


def test_copies_and_attached_models_have_places(tmp_path):
    model(tmp_path, '<body name="tool"><joint name="j"/><geom size=".1"/></body>', name="tool.xml")
    bodies = """<body name="arm"><geom size=".1"/><joint name="a"/>
    <frame pos="0 0 1" euler="0 0 90"><attach model="t" body="tool" prefix="x_"/></frame>
    <replicate count="3" offset="1 0 0"><body name="post"><geom size=".1"/></body></replicate>
    </body>"""
    path = model(tmp_path, bodies, '<asset><model name="t" file="tool.xml"/></asset>')
    robot = read(path).robot
    assert robot.link["x_tool"].place.path == str(tmp_path / "tool.xml")
    assert robot.joint["x_j"].place.line == 3
    posts = [link for link in robot.links if link.name.startswith("post")]
    assert [link.place.line for link in posts] == [5, 5, 5]
    equal(path)


BAD = {
    "truncated": ("<mujoco><worldbody><body>", 1),
    "fragment": ("<mujocoinclude/>", 1),
    "two worlds of another name": ("<mujoco>\n<world/>\n<world/></mujoco>", 2),
    "unknown element": ("<mujoco><worldbody>\n<bodi/></worldbody></mujoco>", 2),
    "no such file": ('<mujoco>\n<include file="none.xml"/></mujoco>', 2),
    "no such mesh": ('<mujoco><asset>\n<mesh file="none.stl"/></asset></mujoco>', 2),
    "includes itself": ('<mujoco>\n<include file="bad.xml"/></mujoco>', 2),
    "attaches itself": ('<mujoco><asset>\n<model name="m" file="bad.xml"/></asset></mujoco>', 2),
    "no such joint": (
        '<mujoco><actuator>\n<motor name="m" joint="none"/></actuator></mujoco>',
        2,
    ),
    "massless": ("<mujoco><worldbody>\n<body><joint/></body></worldbody></mujoco>", 2),
    "a million bodies": (
        '<mujoco><worldbody>\n<replicate count="1000000"><body/></replicate></worldbody></mujoco>',
        2,
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_file_is_refused_with_a_place(tmp_path, name):
    text, line = BAD[name]
    file = tmp_path / "bad.xml"
    file.write_text(text)
    with pytest.raises((SourceError, ModelError)) as error:
        read(file)
    assert (error.value.path, error.value.line) == (str(file), line)
    assert not (tmp_path / "MUJOCO_LOG.TXT").exists()


def test_include_cycles_end(tmp_path):
    for one, other in (("a", "b"), ("b", "a")):
        text = f'<mujocoinclude>\n<include file="{other}.xml"/></mujocoinclude>'
        (tmp_path / f"{one}.xml").write_text(text)
    (tmp_path / "m.xml").write_text('<mujoco><include file="a.xml"/></mujoco>')
    with pytest.raises(SourceError, match="included twice") as error:
        read(tmp_path / "m.xml")
    assert (error.value.path, error.value.line) == (str(tmp_path / "b.xml"), 2)


def test_a_second_end_tag_is_ignored_as_by_mujoco(tmp_path):
    file = model(tmp_path, '<body name="b"><geom size="1"/></body>')
    file.write_text(file.read_text() + "\n</mujoco>\n")
    equal(file)
    (loss,) = read(file).losses
    assert (loss.code, loss.location.line) == ("unread-end-tag", 5)


def test_a_range_may_have_one_end(tmp_path):
    body = '<body name="b"><joint name="j" type="slide" range="-1e9 2" limited="true"/>'
    robot = read(model(tmp_path, body + '<geom size="1"/></body>')).robot
    limit = robot.joint["j"].limit
    assert (limit.lower, limit.upper) == (-math.inf, 2)
