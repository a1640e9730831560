"""Gazebo Classic plugins and their replacements in gz, with parameters."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from ..source.document import Element
from .numbers import number


class System(NamedTuple):
    """System of gz that replaces a plugin.

    Attributes:
        word: Word in the name of the library, ``gz-sim-WORD-system``.
        name: Class in ``gz::sim::systems``.
        parameters: New parameter names by old ones; several old ones may map to one new one.
        defaults: Defaults of the plugin that differ from those of gz.
        halved: Old parameters that are diameters where the new ones are radii.
        remapped: New parameters that a remapping of a ROS 2 name sets.
        missing: Required parameters of gz that the plugin does not have.
    """

    word: str
    name: str
    parameters: dict[str, str]
    defaults: dict[str, str] = {}  # noqa: RUF012 -- a named tuple's default
    halved: tuple[str, ...] = ()
    remapped: dict[str, str] = {}  # noqa: RUF012
    missing: tuple[str, ...] = ()


class SensorPlugin(NamedTuple):
    """Plugin whose function is built into the sensor in gz.

    Attributes:
        system: Word of the system that the world requires.
        type: Sensor type required by gz; empty if unchanged.
        frame: Parameters that name the frame of the messages, by priority.
    """

    system: str
    type: str = ""
    frame: tuple[str, ...] = ("frameName", "frame_name", "frameId", "frame_id", "bodyName")


_WHEELS = {
    "leftJoint": "left_joint",
    "rightJoint": "right_joint",
    "left_joint": "left_joint",
    "right_joint": "right_joint",
    "leftFrontJoint": "left_joint",
    "leftRearJoint": "left_joint",
    "rightFrontJoint": "right_joint",
    "rightRearJoint": "right_joint",
    "wheelSeparation": "wheel_separation",
    "wheel_separation": "wheel_separation",
    "wheelDiameter": "wheel_radius",
    "wheel_diameter": "wheel_radius",
}
_ODOMETRY = {
    "commandTopic": "topic",
    "command_topic": "topic",
    "topicName": "topic",
    "odometryTopic": "odom_topic",
    "odometry_topic": "odom_topic",
    "odometryFrame": "frame_id",
    "odometry_frame": "frame_id",
    "robotBaseFrame": "child_frame_id",
    "robot_base_frame": "child_frame_id",
    "updateRate": "odom_publish_frequency",
    "update_rate": "odom_publish_frequency",
    "odometryRate": "odom_publish_frequency",
    "publish_rate": "odom_publish_frequency",
}
_TOPICS = {"topic": "cmd_vel", "odom_topic": "odom"}
_REMAPPED = {"cmd_vel": "topic", "odom": "odom_topic"}

DIFF_DRIVE = System(
    "diff-drive",
    "DiffDrive",
    {**_WHEELS, **_ODOMETRY},
    _TOPICS,
    ("wheelDiameter", "wheel_diameter"),
    _REMAPPED,
)

SYSTEM_PLUGINS: dict[str, tuple[System, ...]] = {
    "gazebo_ros_diff_drive": (DIFF_DRIVE,),
    "gazebo_ros_skid_steer_drive": (DIFF_DRIVE,),
    "DiffDrivePlugin": (DIFF_DRIVE,),
    "SkidSteerDrivePlugin": (
        System(
            "diff-drive",
            "DiffDrive",
            {
                "left_front": "left_joint",
                "left_rear": "left_joint",
                "right_front": "right_joint",
                "right_rear": "right_joint",
            },
            missing=("wheel_separation", "wheel_radius"),
        ),
    ),
    "gazebo_ros_ackermann_drive": (
        System(
            "ackermann-steering",
            "AckermannSteering",
            {
                "front_left_joint": "left_joint",
                "rear_left_joint": "left_joint",
                "front_right_joint": "right_joint",
                "rear_right_joint": "right_joint",
                "left_steering_joint": "left_steering_joint",
                "right_steering_joint": "right_steering_joint",
                "max_steer": "steering_limit",
                "max_speed": "max_velocity",
                **_ODOMETRY,
            },
            _TOPICS,
            (),
            _REMAPPED,
            ("wheel_base", "kingpin_width", "wheel_separation", "wheel_radius"),
        ),
    ),
    "gazebo_ros_planar_move": (
        System(
            "velocity-control",
            "VelocityControl",
            {"commandTopic": "topic", "command_topic": "topic"},
            {"topic": "cmd_vel"},
            (),
            {"cmd_vel": "topic"},
        ),
        System(
            "odometry-publisher",
            "OdometryPublisher",
            {
                "odometryTopic": "odom_topic",
                "odometryFrame": "odom_frame",
                "odometry_frame": "odom_frame",
                "robotBaseFrame": "robot_base_frame",
                "robot_base_frame": "robot_base_frame",
                "odometryRate": "odom_publish_frequency",
                "publish_rate": "odom_publish_frequency",
            },
            {"odom_topic": "odom"},
            (),
            {"odom": "odom_topic"},
        ),
    ),
    "gazebo_ros_joint_state_publisher": (
        System(
            "joint-state-publisher",
            "JointStatePublisher",
            {
                "jointName": "joint_name",
                "joint_name": "joint_name",
                "updateRate": "update_rate",
                "update_rate": "update_rate",
            },
            {"topic": "joint_states"},
            (),
            {"joint_states": "topic"},
        ),
    ),
    "gazebo_ros_joint_pose_trajectory": (
        System(
            "joint-trajectory-controller",
            "JointTrajectoryController",
            {"topicName": "topic"},
            {},
            (),
            {"set_joint_trajectory": "topic"},
        ),
    ),
    "gazebo_ros_p3d": (
        System(
            "odometry-publisher",
            "OdometryPublisher",
            {
                "topicName": "odom_topic",
                "topic_name": "odom_topic",
                "bodyName": "robot_base_frame",
                "body_name": "robot_base_frame",
                "frameName": "odom_frame",
                "frame_name": "odom_frame",
                "updateRate": "odom_publish_frequency",
                "update_rate": "odom_publish_frequency",
                "gaussianNoise": "gaussian_noise",
                "gaussian_noise": "gaussian_noise",
                "xyzOffset": "xyz_offset",
                "xyz_offset": "xyz_offset",
                "rpyOffset": "rpy_offset",
                "rpy_offset": "rpy_offset",
            },
            {"dimensions": "3"},
            (),
            {"odom": "odom_topic"},
        ),
    ),
    "gazebo_ros_wheel_slip": (System("wheel-slip", "WheelSlip", {"wheel": "wheel"}),),
    "gazebo_ros_elevator": (
        System(
            "elevator",
            "Elevator",
            {"lift_joint": "floor_joint_prefix", "door_joint": "door_joint_prefix"},
            missing=("cabin_joint",),
        ),
    ),
}
"""Systems by library name, without ``lib`` and ``.so``."""

CONTROL_PLUGINS = frozenset(("gazebo_ros_control", "gazebo_ros2_control"))
"""Plugins that ``gz_ros2_control`` replaces."""

MIMIC_PLUGINS = frozenset(
    ("roboticsgroup_gazebo_mimic_joint_plugin", "roboticsgroup_upatras_gazebo_mimic_joint_plugin",
     "gazebo_mimic_joint_plugin")
)  # fmt: skip
"""Plugins that ``<mimic>`` of an axis replaces."""

_SETUP = frozenset(("ros", "alwaysOn", "always_on", "robotNamespace", "rosDebugLevel"))
"""Parameters of every ROS plugin that have no meaning in gz."""

_BODY_FIRST = ("frameName", "frame_name", "frameId", "bodyName", "body_name")

SENSOR_PLUGINS: dict[str, SensorPlugin] = {
    "gazebo_ros_camera": SensorPlugin("sensors"),
    "gazebo_ros_multicamera": SensorPlugin("sensors"),
    "gazebo_ros_triggered_camera": SensorPlugin("sensors"),
    "gazebo_ros_depth_camera": SensorPlugin("sensors", "rgbd_camera"),
    "gazebo_ros_openni_kinect": SensorPlugin("sensors", "rgbd_camera"),
    "gazebo_ros_laser": SensorPlugin("sensors"),
    "gazebo_ros_gpu_laser": SensorPlugin("sensors"),
    "gazebo_ros_block_laser": SensorPlugin("sensors"),
    "gazebo_ros_ray_sensor": SensorPlugin("sensors"),
    "gazebo_ros_range": SensorPlugin("sensors"),
    "gazebo_ros_velodyne_laser": SensorPlugin("sensors"),
    "gazebo_ros_velodyne_gpu_laser": SensorPlugin("sensors"),
    "gazebo_ros_imu_sensor": SensorPlugin("imu", "", _BODY_FIRST),
    "gazebo_ros_imu": SensorPlugin("imu", "", _BODY_FIRST),
    "gazebo_ros_gps_sensor": SensorPlugin("navsat"),
    "hector_gazebo_ros_imu": SensorPlugin("imu", "", _BODY_FIRST),
    "hector_gazebo_ros_gps": SensorPlugin("navsat"),
    "hector_gazebo_ros_magnetic": SensorPlugin("magnetometer"),
    "gazebo_ros_ft_sensor": SensorPlugin("forcetorque"),
    "gazebo_ros_bumper": SensorPlugin("contact"),
}
"""Sensor plugins by library name, without ``lib`` and ``.so``."""


class BodySensor(NamedTuple):
    """A plugin that acts as a sensor.

    Attributes:
        type: SDF sensor type.
        names: Parameters that hold the name of the link or joint.
        noises: Elements of the sensor to which each standard deviation parameter applies.
        offsets: Elements of the sensor to which each constant error parameter applies.
    """

    type: str
    names: tuple[str, ...] = ("bodyName", "body_name")
    noises: dict[str, tuple[str, ...]] = {}  # noqa: RUF012
    offsets: dict[str, tuple[str, ...]] = {}  # noqa: RUF012


_TURNING = tuple(f"imu/angular_velocity/{axis}" for axis in "xyz")
_MOVING = tuple(f"imu/linear_acceleration/{axis}" for axis in "xyz")
_FIX = tuple(f"navsat/position_sensing/{way}" for way in ("horizontal", "horizontal", "vertical"))
_SPEED = tuple(f"navsat/velocity_sensing/{way}" for way in ("horizontal", "horizontal", "vertical"))
_IMU = BodySensor(
    "imu",
    noises={"gaussianNoise": (*_TURNING, *_MOVING), "gaussian_noise": (*_TURNING, *_MOVING)},
)

BODY_SENSORS = {
    "gazebo_ros_imu": _IMU,
    "gazebo_ros_imu_sensor": _IMU,
    "hector_gazebo_ros_imu": BodySensor(
        "imu",
        noises={"rateGaussianNoise": _TURNING, "accelGaussianNoise": _MOVING},
        offsets={"rateOffset": _TURNING, "accelOffset": _MOVING},
    ),
    "hector_gazebo_ros_gps": BodySensor(
        "navsat", noises={"gaussianNoise": _FIX, "velocityGaussianNoise": _SPEED}
    ),
    "hector_gazebo_ros_magnetic": BodySensor("magnetometer"),
    "gazebo_ros_ft_sensor": BodySensor("force_torque", ("jointName", "joint_name")),
}
"""By library name; inside a ``<sensor>`` they configure it, outside they define one."""


class Carried(NamedTuple):
    """Parameters that a system takes over from a plugin.

    Attributes:
        carried: New names with their texts, or with the element if it has children.
        left: Parameters without an equivalent.
    """

    carried: list[tuple[str, str | Element]]
    left: list[str]


def convert_parameters(plugin: Element, system: System) -> Carried:
    """Return the parameters of a plugin as a system reads them, including the plugin's defaults."""
    carried: list[tuple[str, str | Element]] = []
    left = []
    for child in plugin.children:
        new = system.parameters.get(child.tag)
        if new is None:
            left.append(child.tag)
        elif child.children:
            carried.append((new, child))
        else:
            carried += [(new, text) for text in _collect_texts(system, child)]
    there = {tag for tag, _ in carried}
    for old, new in _collect_remappings(plugin).items():
        tag = system.remapped.get(old)
        if tag is not None and tag not in there:
            carried.append((tag, new))
            there.add(tag)
    carried += [(tag, text) for tag, text in system.defaults.items() if tag not in there]
    others = {tag for one in SYSTEM_PLUGINS[get_library(plugin)] for tag in one.parameters}
    known = others | _SETUP
    return Carried(carried, [tag for tag in dict.fromkeys(left) if tag not in known])


def _collect_texts(system: System, child: Element) -> list[str]:
    text = child.text.strip()
    if child.tag in system.halved:
        value = number(text)
        return [text if value is None else f"{value / 2:.12g}"]
    if system.parameters[child.tag] == "joint_name":
        return [name.strip() for name in text.split(",") if name.strip()]
    return [text] if text else []


def _collect_remappings(element: Element) -> dict[str, str]:
    ros = element.find_child("ros")
    if ros is None:
        return {}
    pairs = (
        e.text.strip().partition(":=")
        for e in (*ros.list_children("remapping"), *ros.list_children("argument"))
    )
    return {old.strip(): new.strip() for old, arrow, new in pairs if arrow}


class ClassicParameter(NamedTuple):
    """A parameter that a system of gz does not read.

    Attributes:
        element: The parameter as written.
        name: The name that the system reads.
        text: The value that the system requires for the same behavior.
    """

    element: Element
    name: str
    text: str


def find_classic_parameters(plugin: Element) -> Iterator[ClassicParameter]:
    """Yield the parameters of a gz plugin that only its counterpart of Gazebo Classic reads.

    A parameter whose new name is there too is left out.
    """
    library = re.sub(r"^(ignition-gazebo|gz-sim)\d*-", "gz-sim-", get_library(plugin))
    systems = [one for ones in SYSTEM_PLUGINS.values() for one in ones if get_file(one) == library]
    names = {old: one for one in systems for old in one.parameters}
    read = {new for one in systems for new in one.parameters.values()}
    there = {child.tag for child in plugin.children}
    for child in plugin.children:
        if child.tag not in names or child.tag in read or child.children:
            continue
        system = names[child.tag]
        name, texts = system.parameters[child.tag], _collect_texts(system, child)
        if len(texts) == 1 and name not in there:
            yield ClassicParameter(child, name, texts[0])


def get_file(system: System) -> str:
    """Return the library of a system."""
    return f"gz-sim-{system.word}-system"


def get_class(system: System) -> str:
    """Return the class of a system."""
    return f"gz::sim::systems::{system.name}"


def get_library(element: Element) -> str:
    """Return the library name of a plugin, without folder, ``lib`` and ``.so``."""
    name = (element.get("filename") or "").strip().rpartition("/")[2]
    return name.removeprefix("lib").removesuffix(".so")


def is_for_gz(element: Element) -> bool:
    """Tell whether a plugin belongs to gz, by its library or class."""
    name, words = (element.get("name") or ""), get_library(element)
    return words.startswith(("gz-", "gz_", "ignition-", "ign_")) or name.startswith(
        ("gz::", "ignition::", "gz_ros2_control::", "ign_ros2_control::")
    )


def is_for_yarp(element: Element) -> bool:
    """Tell whether a plugin passes data to YARP, which has frames of its own instead of TF."""
    return "yarp" in get_library(element).lower()


def is_for_classic(element: Element) -> bool:
    """Tell whether a plugin is known to belong to Gazebo Classic."""
    words = get_library(element)
    return words.startswith(("gazebo_", "hector_gazebo_", "rotors_gazebo_")) or any(
        words in table for table in (SYSTEM_PLUGINS, SENSOR_PLUGINS, MIMIC_PLUGINS)
    )
