"""Libraries of Gazebo: the classes in those of new Gazebo, and what took the place of the old."""

from __future__ import annotations

from ...model.gazebo_plugins import CONTROL_PLUGINS, SYSTEM_PLUGINS, file_of

CLASSIC = (
    *("libgazebo_ros", "libhector_gazebo", "libhector_", "libroboticsgroup_", "libgazebo_"),
    "librotors_gazebo_",
)
"""How the libraries of Gazebo Classic begin."""

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
"""The class by its library, for libraries that hold one class."""

REPLACEMENTS = {
    **{old: file_of(systems[0]) for old, systems in SYSTEM_PLUGINS.items()},
    **dict.fromkeys(CONTROL_PLUGINS, "gz_ros2_control-system"),
    "gazebo_ros_tricycle_drive": "gz-sim-ackermann-steering-system",
    "gazebo_ros_force": "gz-sim-apply-link-wrench-system",
    "gazebo_ros_vacuum_gripper": "gz-sim-detachable-joint-system",
}
"""What to load in new Gazebo instead of a plugin of Gazebo Classic."""
