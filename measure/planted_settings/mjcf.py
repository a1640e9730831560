"""Changes of the MJCF: what is changed, the parts of which one must be named, the edit."""

from __future__ import annotations

from ..planted.change import Planted, Root, add, both, drop, move, put
from ..planted.mjcf import ACTUATOR, BODY, COUPLING, JOINT, OPTION, SEEN, SOLID, TETRAHEDRON


def _in(path: str, name: str) -> str:
    return path.format(name)


def _make_motor(root: Root) -> None:
    """Replace the servo of the elbow by a motor."""
    (servo,) = root.xpath(_in(ACTUATOR, "elbow"))
    servo.tag = "motor"
    for name in ("kp", "dampratio", "inheritrange"):
        del servo.attrib[name]


def _make_velocimeter(root: Root) -> None:
    (sensor,) = root.xpath("//sensor/gyro")
    sensor.tag = "velocimeter"


IMU = "imu_gyro imu_accelerometer imu_orientation"
CAMERA = "//camera[@name='camera']"
ELBOW, SHOULDER = _in(JOINT, "elbow"), _in(JOINT, "shoulder")

CHANGES = (
    Planted("link lost", "camera_link", both(drop(_in(BODY, "camera_link")),
                                             drop("//sensor/rangefinder"))),
    Planted("joint lost", "left_wheel_joint", both(
        drop(_in(JOINT, "left_wheel_joint")),
        drop("//numeric[@name='left_wheel_joint_velocity_limit']"),
        drop(_in(ACTUATOR, "left_wheel_joint")), drop("//keyframe"))),
    Planted("hinge for a slide", "left_finger_joint", drop(_in(JOINT, "left_finger_joint"),
                                                                  "type")),
    Planted("other parent", "caster", move(_in(BODY, "caster"), _in(BODY, "upper_arm"))),
    Planted("mimic lost", "right_finger_joint", drop(COUPLING)),
    Planted("mimic inactive", "right_finger_joint", put(COUPLING, "active", "false")),
    Planted("multiplier of mimic", "right_finger_joint", put(COUPLING, "polycoef",
                                                             "-0.001 -1 0 0 0")),
    Planted("link moved by 0.1 mm", "imu_link", put(_in(BODY, "imu_link"), "pos",
                                                    "0.0501 0.02 0.1")),
    Planted("link turned", "camera_link", put(_in(BODY, "camera_link"), "quat", "1 0 0.1 0")),
    Planted("axis reversed", "left_wheel_joint", put(_in(JOINT, "left_wheel_joint"), "axis",
                                                     "0 0 -1")),
    Planted("axis turned by 1°", "elbow", put(ELBOW, "axis", "0.0175 1 0")),
    Planted("mass by 1 %", "upper_arm", put(_in(BODY, "upper_arm") + "/inertial", "mass", "2.525")),
    Planted("center of mass by 1 mm", "forearm", put(_in(BODY, "forearm") + "/inertial", "pos",
                                                     "0 0 0.151")),
    Planted("moment by 5 %", "left_wheel", put(_in(BODY, "left_wheel") + "/inertial", "diaginertia",
                                               "0.0022 0.0022 0.0042")),
    Planted("sign of a product", "base_link", put(
        _in(BODY, "base_link") + "/inertial", "fullinertia",
        "0.21030166089555147 0.31969833910444856 0.42 0.00700654682338 0.0016905081 0.00318468")),
    Planted("upper limit by 0.01", "elbow", put(ELBOW, "range", "-2 2.11")),
    Planted("limits lost", "shoulder", drop(SHOULDER, "range")),
    Planted("effort doubled", "elbow", put(ELBOW, "actuatorfrcrange", "-50 50")),
    Planted("damping lost", "elbow", drop(ELBOW, "damping")),
    Planted("friction of a joint", "elbow", put(ELBOW, "frictionloss", "0.2")),
    Planted("velocity doubled", "elbow", put("//numeric[@name='elbow_velocity_limit']", "data",
                                             "8")),
    Planted("spring lost", "elbow", drop(ELBOW, "stiffness")),
    Planted("rest of a spring reversed", "elbow", put(ELBOW, "springref", "-0.4")),
    Planted("armature", "shoulder", put(SHOULDER, "armature", "0.1")),
    Planted("gravity of the moon", "everything", put(OPTION, "gravity", "0 0 -1.62")),
    Planted("gravity flag lost", "upper_arm", drop(_in(BODY, "upper_arm"), "gravcomp")),
    Planted("gravity flag", "left_wheel", put(_in(BODY, "left_wheel"), "gravcomp", "1")),
    Planted("box for a cylinder", "forearm", both(put(_in(SOLID, "forearm"), "type", "box"),
                                                  put(_in(SOLID, "forearm"), "size",
                                                      "0.03 0.03 0.14"))),
    Planted("size of a collision by 1 %", "caster", put(_in(SOLID, "caster"), "size", "0.0303")),
    Planted("collision moved", "forearm", put(_in(SOLID, "forearm"), "pos", "0 0 0.16")),
    Planted("collision lost", "left_wheel", drop(_in(SOLID, "left_wheel"))),
    Planted("collision added", "forearm", add(_in(BODY, "forearm"), "<geom size='0.2'/>",
                                              first=True)),
    Planted("scale of a mesh", "upper_arm", put("//asset/mesh", "scale", "0.06 0.05 0.36")),
    Planted("another mesh", "upper_arm", both(drop("//asset/mesh", "file"),
                                              put("//asset/mesh", "name", "cube"),
                                              put("//asset/mesh", "vertex", TETRAHEDRON))),
    Planted("friction lost", "left_wheel", drop(_in(SOLID, "left_wheel"), "friction")),
    Planted("friction by 1 %", "left_wheel", put(_in(SOLID, "left_wheel"), "friction",
                                                 "0.909 0.005 0.0001")),
    Planted("actuator lost", "shoulder", both(drop(_in(ACTUATOR, "shoulder")),
                                              drop("//keyframe"))),
    Planted("actuator of another joint", "shoulder", put(_in(ACTUATOR, "shoulder"), "joint",
                                                         "right_wheel_joint")),
    Planted("gear 1 for 50", "shoulder", put(_in(ACTUATOR, "shoulder"), "gear", "1")),
    Planted("motor for a servo", "elbow", _make_motor),
    Planted("range of a motor", "shoulder", put(_in(ACTUATOR, "shoulder"), "ctrlrange",
                                                "-0.4 0.4")),
    Planted("force of a servo", "elbow", put(_in(ACTUATOR, "elbow"), "forcerange", "-1 1")),
    Planted("sensor lost", IMU, drop("//sensor/gyro")),
    Planted("sensor moved", IMU, put("//site[@name='imu']", "pos", "0.5 0 0.01")),
    Planted("sensor of another link", IMU, move("//site[@name='imu']", _in(BODY, "forearm"))),
    Planted("type of a sensor", IMU, _make_velocimeter),
    Planted("ray turned", "scan_2", put("//site[@name='scan_2']", "quat", "1 0 1.1 0")),
    Planted("camera turned", "camera", put(CAMERA, "quat", "1 1 -1 -0.9")),
    Planted("field of view", "camera", put(CAMERA, "fovy", "45")),
    Planted("resolution", "camera", put(CAMERA, "resolution", "320 240")),
    Planted("visual moved", "forearm", put(_in(SEEN, "forearm"), "pos", "0 0 0.16")),
    Planted("color by 2 %", "left_wheel right_wheel upper_arm", put(
        "//material[@name='steel']", "rgba", "0.62 0.62 0.65 1")),
    Planted("texture lost", "base_link", both(drop("//material[@name='checker']", "texture"),
                                              drop("//texture"))),
)  # fmt: skip
"""What is changed, and the names of parts of which one has to be named."""
