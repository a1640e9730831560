"""Plugin libraries of Gazebo: classes of new Gazebo, and counterparts of Gazebo Classic."""

from __future__ import annotations

from ...model.gazebo_plugins import CONTROL_PLUGINS, SYSTEM_PLUGINS, get_file

CLASSIC = (
    *("libgazebo_ros", "libhector_gazebo", "libhector_", "libroboticsgroup_", "libgazebo_"),
    "librotors_gazebo_",
)
"""Prefixes of libraries of Gazebo Classic."""

_PARTS = {
    "ackermann-steering": "AckermannSteering",
    "air-pressure": "AirPressure",
    "altimeter": "Altimeter",
    "apply-joint-force": "ApplyJointForce",
    "apply-link-wrench": "ApplyLinkWrench",
    "buoyancy": "Buoyancy",
    "contact": "Contact",
    "detachable-joint": "DetachableJoint",
    "diff-drive": "DiffDrive",
    "dvl": "DopplerVelocityLogSystem",
    "elevator": "Elevator",
    "forcetorque": "ForceTorque",
    "hydrodynamics": "Hydrodynamics",
    "imu": "Imu",
    "joint-controller": "JointController",
    "joint-position-controller": "JointPositionController",
    "joint-state-publisher": "JointStatePublisher",
    "joint-trajectory-controller": "JointTrajectoryController",
    "lift-drag": "LiftDrag",
    "linearbatteryplugin": "LinearBatteryPlugin",
    "magnetometer": "Magnetometer",
    "mecanum-drive": "MecanumDrive",
    "multicopter-control": "MulticopterVelocityControl",
    "multicopter-motor-model": "MulticopterMotorModel",
    "navsat": "NavSat",
    "odometry-publisher": "OdometryPublisher",
    "pose-publisher": "PosePublisher",
    "sensors": "Sensors",
    "thruster": "Thruster",
    "touchplugin": "TouchPlugin",
    "track-controller": "TrackController",
    "tracked-vehicle": "TrackedVehicle",
    "velocity-control": "VelocityControl",
    "wheel-slip": "WheelSlip",
}

SYSTEMS = {
    **{f"gz-sim-{part}-system": f"gz::sim::systems::{name}" for part, name in _PARTS.items()},
    "gz_ros2_control-system": "gz_ros2_control::GazeboSimROS2ControlPlugin",
}
"""Class by library, for libraries with one class."""

REPLACEMENTS = {
    **{old: get_file(systems[0]) for old, systems in SYSTEM_PLUGINS.items()},
    **dict.fromkeys(CONTROL_PLUGINS, "gz_ros2_control-system"),
    "gazebo_ros_tricycle_drive": "gz-sim-ackermann-steering-system",
    "gazebo_ros_force": "gz-sim-apply-link-wrench-system",
    "gazebo_ros_vacuum_gripper": "gz-sim-detachable-joint-system",
}
"""Counterpart in new Gazebo by plugin of Gazebo Classic."""
