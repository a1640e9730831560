"""What SDF and MJCF have and URDF lacks: shapes, joints, loops, actuators."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tests.build import arm, joint, robot
from urdftool.formats import registry
from urdftool.formats.mjcf.options import Options as MjcfOptions
from urdftool.formats.sdf.options import Options as SdfOptions
from urdftool.geometry.penetration import compute_overlap, make_convex
from urdftool.geometry.tessellate import tessellate
from urdftool.inertia.pieces import _get_primitive
from urdftool.info.counts import count
from urdftool.model.bounds import compute_bounds_at
from urdftool.model.elements import Box, Cone, Dynamics, Ellipsoid, Plane, UnknownShape
from urdftool.model.kinematics import add_mimic_positions, link_poses
from urdftool.model.load import load
from urdftool.model.mechanism import (
    Base,
    Camera,
    Closure,
    Configuration,
    ContactExclusion,
    Frame,
    JointActuator,
    MountedSensor,
)
from urdftool.model.pose import IDENTITY, Pose, rotation_from_rpy
from urdftool.model.shapes import describe_shape, get_shape_name

TURNED = Pose(rotation_from_rpy((0.4, -0.7, 1.9)), (1.0, 2.0, 3.0))


@pytest.mark.parametrize(
    ("shape", "size"),
    [
        (Ellipsoid(radii=(0.1, 0.2, 0.3)), (0.1, 0.2, 0.3)),
        (Cone(radius=0.2, length=0.5), (0.2, 0.5)),
    ],
    ids=["ellipsoid", "cone"],
)
def test_the_box_of_a_turned_shape_is_that_of_its_surface(shape, size):
    vertices, faces = tessellate(get_shape_name(shape), size, 96)
    points = vertices @ np.array(TURNED.rotation).T + TURNED.translation
    bounds = compute_bounds_at(shape, TURNED)
    assert np.allclose(bounds.low, points.min(axis=0), atol=1e-3)
    assert np.allclose(bounds.high, points.max(axis=0), atol=1e-3)
    corners = vertices[faces]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert volume == pytest.approx(_get_primitive(shape)[0].mass, rel=0.01)


def test_a_cone_touches_with_its_tip():
    cone, box = Cone(radius=0.5, length=1.0), Box(size=(1.0, 1.0, 1.0))

    def depth(z):
        return compute_overlap(
            make_convex(cone, IDENTITY), make_convex(box, Pose(translation=(0.0, 0.0, z)))
        )

    assert depth(0.9) == pytest.approx(0.1)
    assert depth(1.1) <= 0
    assert depth(-0.9) == pytest.approx(0.1)


def test_an_ellipsoid_reaches_as_far_as_its_radii():
    box = make_convex(Box(size=(2.0, 2.0, 2.0)), Pose(translation=(0.0, 0.0, 1.25)))
    shape = make_convex(Ellipsoid(radii=(1.0, 1.0, 0.3)), IDENTITY)
    assert compute_overlap(shape, box) == pytest.approx(0.05, abs=1e-3)


def test_shapes_are_named_without_an_element():
    assert describe_shape(Ellipsoid(radii=(1, 2, 3))) == {"shape": "ellipsoid", "radii": (1, 2, 3)}
    assert describe_shape(Plane(size=(1.0, 2.0))) == {"shape": "plane", "size": (1.0, 2.0)}
    assert describe_shape(UnknownShape(tag="heightmap")) == {"shape": "heightmap"}
    assert compute_bounds_at(Plane(), IDENTITY) is None


def test_a_screw_turns_and_advances():
    made = robot(
        ["base", "nut"],
        [joint("s", "base", "nut", "screw", axis=(0, 0, 2), thread_pitch=0.01)],
    )
    pose = link_poses(made, {"s": math.pi / 2})["nut"]
    assert pose.translation == pytest.approx((0.0, 0.0, 0.0025))
    assert pose.transform((1.0, 0.0, 0.0)) == pytest.approx((0.0, 1.0, 0.0025))
    assert add_mimic_positions(made, {}) == {"s": 0.0}


def test_a_ball_joint_has_three_degrees_of_freedom():
    made = robot(["base", "arm"], [joint("b", "base", "arm", "ball")])
    assert count(made).freedom == 3
    assert link_poses(made, {"b": 1.0})["arm"] == IDENTITY


EXTRA = {
    "base": Base(is_free=True),
    "closures": [Closure(name="loop", type="connect", parent="base", child="tip")],
    "frames": [Frame(name="grip", link="tip")],
    "joint_actuators": [JointActuator(name="motor", joint="j")],
    "exclusions": [ContactExclusion(link="base", other="tip")],
    "configurations": [Configuration(name="home")],
    "cameras": [Camera(name="eye", link="tip")],
    "mounted_sensors": [MountedSensor(name="gyro", type="gyro", link="tip")],
}
CODES = {
    *("lossy-closure", "lossy-frame", "lossy-joint-actuator", "lossy-exclusion"),
    *("lossy-configuration", "lossy-camera", "lossy-sensor"),
}
WRITTEN = {"lossy-closure", "lossy-frame", "lossy-joint-actuator", "lossy-exclusion"}
"""Codes of what an MJCF has."""

TEXT = """
<robot name="r">
  <link name="base"/>
  <link name="tip">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <joint name="j" type="continuous"><parent link="base"/><child link="tip"/></joint>
</robot>
"""


@pytest.mark.parametrize(("name", "options"), [("mjcf", MjcfOptions()), ("sdf", SdfOptions())])
def test_an_export_reports_what_it_does_not_write(name, options, tmp_path):
    file = tmp_path / "r.urdf"
    file.write_text(TEXT)
    plain = load(file)
    written = registry.format_named(name).write(plain, options)
    assert not CODES & {loss.code for loss in written.losses}
    plain.joints[0].dynamics = Dynamics(armature=0.1)
    written = registry.format_named(name).write(replace(plain, **EXTRA), options)
    codes = {loss.code for loss in written.losses}
    assert codes >= CODES - (WRITTEN if name == "mjcf" else {"lossy-frame"})
    assert ("lossy-joint-armature" in codes) == (name == "sdf")  # MJCF has it
    if name != "sdf":
        return
    loop = next(loss for loss in written.losses if loss.code == "lossy-closure")
    assert (loop.name, loop.kind, loop.severity.label) == ("loop", "closed loop", "warning")


def test_an_arm_is_a_chain():
    made = arm(3, length=0.5)
    assert link_poses(made)["link3"].translation == (1.5, 0.0, 0.0)
    assert link_poses(made, {"j1": math.pi / 2})["link3"].translation == pytest.approx((0.5, 1, 0))
    assert count(made).mass == 4.0
