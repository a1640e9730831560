"""A pose in which a robot stands: feet below hips, within the limits; and the support polygon."""

import math

import numpy as np
import pytest

from tests.formats.mjcf.robots import export, find, robot, rules, tree
from urdftool.errors import ModelError
from urdftool.formats.common.home_positions import choose_home_positions
from urdftool.formats.common.legs import find_legs
from urdftool.formats.common.shape_box import ShapeBoxes
from urdftool.formats.common.standing_pose import choose_standing_positions
from urdftool.formats.common.support import (
    compute_center,
    compute_margin,
    list_contact_points,
    list_support_points,
)
from urdftool.formats.mjcf.structure import create_structure
from urdftool.formats.written import Written
from urdftool.model.elements import Box, Capsule, Collision, Cylinder, Ellipsoid, Sphere
from urdftool.model.kinematics import link_poses
from urdftool.model.load import load
from urdftool.model.pose import Pose, rotation_from_rpy


def collide(shape, at="0 0 0"):
    return f'<collision><origin xyz="{at}"/><geometry><{shape}/></geometry></collision>'


SOLE, POINT = (collide('sphere radius="0.02"', f"0 0 {z}") for z in (-0.2, -0.05))
FLAT = collide('box size="0.2 0.1 0.02"', "0.03 0 -0.05")
CORNERS = {"fl": (0.2, 0.1), "fr": (0.2, -0.1), "rl": (-0.2, 0.1), "rr": (-0.2, -0.1)}


def body(name, mass, collision=""):
    tensor = " ".join(f'{axis}="{mass * 0.01}"' for axis in ("ixx", "iyy", "izz"))
    inertia = f'<inertia {tensor} ixy="0" ixz="0" iyz="0"/>'
    inside = f'<inertial><mass value="{mass}"/>{inertia}</inertial>{collision}'
    return f'<link name="{name}">{inside}</link>'


def turn(name, parent, child, at, limits, axis="0 1 0"):
    lower, upper = limits
    return (
        f'<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{at}"/><axis xyz="{axis}"/>'
        f'<limit lower="{lower}" upper="{upper}" effort="30" velocity="20"/></joint>'
    )


def quadruped(knee=(-2.7, -0.9), hip=(-1, 3), *extra):
    parts = [body("base", 8, collide('box size="0.5 0.2 0.1"'))]
    for leg, (x, y) in CORNERS.items():
        parts += [
            body(f"{leg}_thigh", 1), body(f"{leg}_calf", 0.2, SOLE),
            turn(f"{leg}_hip", "base", f"{leg}_thigh", f"{x} {y} 0", hip),
            turn(f"{leg}_knee", f"{leg}_thigh", f"{leg}_calf", "0 0 -0.2", knee),
        ]  # fmt: skip
    return robot(*parts, *extra)


def biped(knee=(0.3, 2.4), foot=FLAT):
    parts = [body("base", 8, collide('box size="0.1 0.2 0.1"'))]
    for leg, y in (("l", 0.1), ("r", -0.1)):
        parts += [
            body(f"{leg}_thigh", 1), body(f"{leg}_shank", 0.5), body(f"{leg}_foot", 0.2, foot),
            turn(f"{leg}_hip", "base", f"{leg}_thigh", f"0 {y} 0", (-2, 2)),
            turn(f"{leg}_knee", f"{leg}_thigh", f"{leg}_shank", "0 0 -0.3", knee),
            turn(f"{leg}_ankle", f"{leg}_shank", f"{leg}_foot", "0 0 -0.3", (-1.5, 1.5), "0 -1 0"),
        ]  # fmt: skip
    return robot(*parts)


def stand(path, pose=None, state=""):
    """The tree of a robot, its home positions, and what is reported."""
    made, written = load(path), Written("r")
    structure = create_structure(made)
    chosen = choose_home_positions(made, pose or {}, state, None, written)
    return (
        structure,
        choose_standing_positions(structure, ShapeBoxes(made), chosen, written),
        written,
    )


@pytest.mark.parametrize(
    ("text", "joints"), [(quadruped(), 8), (quadruped((0.9, 2.7), (-3, 1)), 8), (biped(), 6)]
)
def test_each_foot_is_below_its_hip_and_the_robot_stands(write, text, joints):
    structure, home, written = stand(write("r.urdf", text))
    boxes, poses = ShapeBoxes(structure.robot), link_poses(structure.robot, home)
    legs = find_legs(structure, boxes, home)
    assert sum(len(leg.joints) for leg in legs) == joints
    soles = [list_contact_points(structure, boxes, leg.foot, poses) for leg in legs]
    assert np.ptp([sole[:, 2].min() for sole in soles]) < 1e-4
    for leg, sole in zip(legs, soles, strict=True):
        x, y, _ = poses[leg.hip.child].translation
        assert abs(sole[:, 0].mean() - x) < 0.06
        assert sole[:, 1].mean() == pytest.approx(y, abs=1e-6)
        for one in leg.joints:
            assert one.limit.lower < home[one.name] < one.limit.upper
    points = list_support_points(structure, boxes, poses)
    center = compute_center(structure.robot, poses)
    assert compute_margin(points, center) > 0.03
    assert center[:2] == pytest.approx(
        np.mean([s.mean(axis=0) for s in soles], axis=0)[:2], abs=0.01
    )
    assert [loss.code for loss in written.losses] == ["lossy-standing"]


def test_a_bent_leg_is_an_isosceles_triangle(write):
    """Equal links of 0.2 m: hip angle is half of the knee's where nothing shifts the feet."""
    structure, home, _ = stand(write("r.urdf", quadruped()))
    knees = [home[f"{leg}_knee"] for leg in CORNERS]
    poses = link_poses(structure.robot, home)
    for leg, knee in zip(CORNERS, knees, strict=True):
        x, _, z = np.array(poses[f"{leg}_calf"].transform((0, 0, -0.2)))
        start = poses[f"{leg}_thigh"].translation
        assert math.hypot(x - start[0], z - start[2]) == pytest.approx(0.4 * math.cos(knee / 2))


def test_a_flat_foot_stays_level(write):
    structure, home, _ = stand(write("r.urdf", biped()))
    pose = link_poses(structure.robot, home)["l_foot"]
    assert pose.rotation[2] == pytest.approx((0, 0, 1), abs=1e-9)


@pytest.mark.parametrize(
    ("pose", "bent"),
    [({}, True), ({"fl_knee": -1.0}, False), ({"*_knee": -1.5}, False), ({"neck": 0.1}, True)],
)
def test_positions_of_the_user_come_first(write, pose, bent):
    neck = [body("head", 0.1), turn("neck", "base", "head", "0 0 0.1", (-1, 1), "0 0 1")]
    _, home, written = stand(write("r.urdf", quadruped((-2.7, -0.9), (-1, 3), *neck)), pose)
    assert ("lossy-standing" in [loss.code for loss in written.losses]) == bent
    for name, value in pose.items():
        assert home[name.replace("*", "rr")] == value


def test_straight_legs_stay_unless_the_user_asks(write):
    path = write("r.urdf", quadruped((-2.7, 2.7)))
    assert set(stand(path)[1].values()) == {0.0}
    assert abs(stand(path, state="stand")[1]["fl_knee"]) > 0.3
    assert abs(stand(path, {"fl_knee": 0.0}, "stand")[1]["fl_knee"]) > 0.3


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (robot(body("a", 1)), "fewer than two legs"),
        (quadruped((-0.95, -0.9), (0, 0.1)), "do not reach one height below the hips"),
        (biped(foot=POINT), "not above the support polygon"),
        (quadruped().replace('axis xyz="0 1 0"', 'axis xyz="0 0 1"'), "parallel, level axes"),
    ],
)
def test_a_robot_that_cannot_stand(write, text, said):
    path = write("r.urdf", text)
    with pytest.raises(ModelError, match=said):
        stand(path, state="stand")
    stand(path)  # which asks for nothing


def test_the_export_starts_there_on_the_floor(write):
    path = write("r.urdf", quadruped())
    written = export(path, base="free", actuators="position")
    home = [float(word) for word in find(tree(written), "key", "home").get("qpos").split()]
    bend = 2 * math.acos((home[2] - 0.02) / 0.4)
    assert home[8::2] == pytest.approx([-bend] * 4, abs=0.05)
    assert "lossy-standing" in rules(written)
    with pytest.raises(ModelError, match=r"no joint that moves matches"):
        export(path, pose={"x_*": 1.0})


@pytest.mark.parametrize(
    ("points", "center", "margin"),
    [
        ([(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0.5)], (0.5, 0.25), 0.25),
        ([(0, 0), (1, 0), (1, 1), (0, 1)], (2, 2), -math.sqrt(2)),
        ([(0, 0), (2, 0), (0, 2)], (0.5, 0.5), 0.5),
        ([(0, 0), (1, 0)], (0.5, 0.2), -0.2),
        ([(0, 0)], (3, 4), -5),
        ([], (0, 0), -math.inf),
    ],
)
def test_margin_of_a_support_polygon(points, center, margin):
    assert compute_margin(points, center) == pytest.approx(margin)


@pytest.mark.parametrize(
    "shape",
    [
        Box(None, (0.1, 0.2, 0.3)),
        Cylinder(None, 0.1, 0.4),
        Capsule(None, 0.1, 0.4),
        Sphere(None, 0.2),
        Ellipsoid(None, (0.1, 0.2, 0.3)),
    ],
)
def test_the_outermost_point_is_where_the_box_ends(write, shape):
    boxes = ShapeBoxes(load(write("r.urdf", robot(body("a", 1)))))
    frame = Pose(rotation_from_rpy((0.4, -0.9, 1.3)), (0.1, -0.2, 0.3))
    collision = Collision(None, geometry=shape)
    low, high = boxes.compute_box(collision, frame)
    for axis in range(3):
        way = tuple(float(axis == number) for number in range(3))
        assert boxes.find_outermost(collision, frame, way)[axis] == pytest.approx(high[axis])
        way = tuple(-part for part in way)
        assert boxes.find_outermost(collision, frame, way)[axis] == pytest.approx(low[axis])


@pytest.mark.parametrize(("foot", "outside"), [(FLAT, False), (POINT, True)])
def test_a_robot_on_two_points_is_reported(write, foot, outside):
    """The knees are straight, and the center of mass is above the line through both feet or not."""
    path = write("r.urdf", biped((-2.4, 2.4), foot).replace('"0 0.1 0"', '"0.02 0.1 0"'))
    losses = [one for one in export(path, base="free").losses if one.code == "lossy-unsupported"]
    assert len(losses) == outside
    for loss in losses:
        assert loss.data["margin"] == pytest.approx(-0.007, abs=0.01)
        assert "'l_foot', 'r_foot'" in loss.message
        assert "the robot falls" in loss.message


def test_a_robot_that_a_small_tilt_tips_over_is_reported(write, urdftool, tmp_path):
    """The center of mass is 1.01 m above the sole, and the half width of the foot is 20 mm."""
    foot = collide('box size="0.04 0.04 0.02"', "0 0 -1")
    path = write("r.urdf", robot(body("a", 1, foot)))
    result = urdftool("export", "mjcf", path, "-o", tmp_path / "out", "--base", "free")
    assert "a tilt of 1.1° tips the robot over" in result.err


def test_a_robot_that_lies_on_its_trunk_gets_up(write):
    """Thighs and calves are level at zero, so that the trunk is on the ground."""
    text = quadruped((-3, 3), (-3, 3)).replace('"0 0 -0.2"', '"-0.2 0 0"')
    structure, home, written = stand(write("r.urdf", text))
    assert "lossy-standing" in [loss.code for loss in written.losses]
    assert link_poses(structure.robot, home)["fl_calf"].translation[2] < -0.1
