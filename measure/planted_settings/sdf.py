"""Changes of the SDF: what is changed, the parts of which one must be named, the edit."""

from __future__ import annotations

from ..planted.change import Planted, add, drop, move, put, say
from ..planted.sdf import DRIVE, JOINT, LINK, MODEL, POSES, SEEN, SENSOR, SOLID


def _in(path: str, name: str) -> str:
    return path.format(name)


ELBOW, SHOULDER = _in(JOINT, "elbow"), _in(JOINT, "shoulder")
IMU, CAMERA, SCAN = (_in(SENSOR, name) for name in ("imu", "camera", "scan"))
DRIVE_NAMES = "drive gz-sim-diff-drive-system"
POSE_NAMES = "gz::sim::systems::PosePublisher gz-sim-pose-publisher-system"

CHANGES = (
    Planted("model static", "everything", add(MODEL, "<static>true</static>")),
    Planted("model with wind", "everything", add(MODEL, "<enable_wind>true</enable_wind>")),
    Planted("link kinematic", "upper_arm", add(_in(LINK, "upper_arm"),
                                               "<kinematic>true</kinematic>")),
    Planted("prismatic for revolute", "elbow", put(ELBOW, "type", "prismatic")),
    Planted("other parent", "elbow", say(ELBOW + "/parent", "base_link")),
    Planted("mimic lost", "right_finger_joint", drop("//mimic")),
    Planted("leader of mimic", "right_finger_joint", put("//mimic", "joint", "elbow")),
    Planted("link moved by 0.1 mm", "camera_link camera_joint", say(
        _in(JOINT, "camera_joint") + "/pose", "0.3101 0 0.05 0 0.2 0")),
    Planted("frame turned", "imu_link imu_joint", say("//frame[@name='imu_joint']/pose",
                                                      "0.05 0.02 0.1 0 0 1.3")),
    Planted("axis reversed", "left_wheel_joint", say(
        _in(JOINT, "left_wheel_joint") + "/axis/xyz", "0 0 -1")),
    Planted("mass by 1 %", "upper_arm", say(_in(LINK, "upper_arm") + "/inertial/mass", "2.525")),
    Planted("center of mass by 1 mm", "forearm", say(_in(LINK, "forearm") + "/inertial/pose",
                                                     "0 0 0.151 0 0 0")),
    Planted("product lost", "base_link", say(_in(LINK, "base_link") + "/inertial/inertia/ixy",
                                             "0")),
    Planted("upper limit by 0.01", "elbow", say(ELBOW + "/axis/limit/upper", "2.11")),
    Planted("effort without bound", "elbow", say(ELBOW + "/axis/limit/effort", "-1")),
    Planted("velocity by 1 %", "elbow", say(ELBOW + "/axis/limit/velocity", "4.04")),
    Planted("damping lost", "elbow", drop(ELBOW + "/axis/dynamics/damping")),
    Planted("friction of a joint", "elbow", say(ELBOW + "/axis/dynamics/friction", "0.2")),
    Planted("spring lost", "elbow", drop(ELBOW + "/axis/dynamics/spring_stiffness")),
    Planted("stiffness of a limit", "elbow", add(ELBOW + "/axis/limit",
                                                 "<stiffness>1000</stiffness>")),
    Planted("erp of a stop", "elbow", say(ELBOW + "/physics/ode/limit/erp", "0.9")),
    Planted("feedback lost", "elbow", drop(ELBOW + "/physics/provide_feedback")),
    Planted("gravity flag lost", "upper_arm", drop(_in(LINK, "upper_arm") + "/gravity")),
    Planted("damping of a link", "forearm", add(
        _in(LINK, "forearm"), "<velocity_decay><linear>0.1</linear></velocity_decay>")),
    Planted("self_collide lost", "base_link", drop(_in(LINK, "base_link") + "/self_collide")),
    Planted("size of a collision by 1 %", "caster", say(
        _in(SOLID, "caster") + "/geometry/sphere/radius", "0.0303")),
    Planted("collision moved", "forearm", say(_in(SOLID, "forearm") + "/pose", "0 0 0.16 0 0 0")),
    Planted("scale of a mesh", "upper_arm", say(_in(SOLID, "upper_arm") + "//scale",
                                                "0.06 0.05 0.36")),
    Planted("collide bitmask", "caster", add(
        _in(SOLID, "caster") + "/surface",
        "<contact><collide_bitmask>0</collide_bitmask></contact>")),
    Planted("friction lost", "left_wheel", drop(_in(SOLID, "left_wheel") + "//mu")),
    Planted("friction by 1 %", "left_wheel", say(_in(SOLID, "left_wheel") + "//mu2", "0.909")),
    Planted("direction of friction", "left_wheel", say(_in(SOLID, "left_wheel") + "//fdir1",
                                                       "0 1 0")),
    Planted("stiffness of a contact lost", "base_link", drop(_in(SOLID, "base_link") + "//kp")),
    Planted("bounce", "caster", add(
        _in(SOLID, "caster") + "/surface",
        "<bounce><restitution_coefficient>1</restitution_coefficient></bounce>")),
    Planted("visual moved", "forearm", say(_in(SEEN, "forearm") + "/pose", "0 0 0.16 0 0 0")),
    Planted("color by 2 %", "left_wheel", say(_in(SEEN, "left_wheel") + "/material/diffuse",
                                              "0.62 0.62 0.65 1")),
    Planted("texture lost", "base_link", drop(_in(SEEN, "base_link") + "//pbr")),
    Planted("ambient lost", "left_wheel", drop(_in(SEEN, "left_wheel") + "/material/ambient")),
    Planted("transparency lost", "caster", drop(_in(SEEN, "caster") + "/transparency")),
    Planted("sensor lost", "imu", drop(IMU)),
    Planted("sensor moved", "imu", say(IMU + "/pose", "0.5 0 0.01 0 0 0")),
    Planted("sensor of another link", "imu", move(IMU, _in(LINK, "forearm"))),
    Planted("rate of a sensor", "imu", say(IMU + "/update_rate", "10")),
    Planted("noise of a sensor", "imu", say(IMU + "//stddev", "0.02")),
    Planted("type of a sensor", "scan", put(SCAN, "type", "lidar")),
    Planted("rays of a scanner", "scan", say(SCAN + "//samples", "50")),
    Planted("field of view", "camera", say(CAMERA + "//horizontal_fov", "1")),
    Planted("camera moved", "camera", add(CAMERA, "<pose>0.1 0 0 0 0 0</pose>")),
    Planted("frame of a force sensor", "wrist_force", say(
        _in(SENSOR, "wrist_force") + "//frame", "parent")),
    Planted("contact sensor of another collision", "bumper", say(
        _in(SENSOR, "bumper") + "//collision", "base_link_hull")),
    Planted("plugin lost", POSE_NAMES, drop(POSES)),
    Planted("parameter of a plugin", POSE_NAMES, say(POSES + "/update_frequency", "2")),
    Planted("wheel of a drive", DRIVE_NAMES, say(DRIVE + "/left_joint", "right_wheel_joint")),
    Planted("drive lost", DRIVE_NAMES, drop(DRIVE)),
)  # fmt: skip
"""What is changed, and the names of parts of which one has to be named."""
