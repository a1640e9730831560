"""Sensor types of Gazebo Classic and gz, and the gz system that each requires."""

from __future__ import annotations

from typing import NamedTuple


class SensorType(NamedTuple):
    """Conversion of a sensor type.

    Attributes:
        type: Type in the target; empty if the target has none.
        renamed: New tags of the element that holds its settings.
        note: Other changes.
    """

    type: str
    renamed: tuple[tuple[str, str], ...] = ()
    note: str = ""


TO_GZ = {
    "ray": SensorType("gpu_lidar", (("ray", "lidar"),), "rays are cast on the GPU"),
    "gpu_ray": SensorType("gpu_lidar", (("ray", "lidar"),)),
    "lidar": SensorType("gpu_lidar", (("ray", "lidar"),), "rays are cast on the GPU"),
    "gps": SensorType("navsat", (("gps", "navsat"),)),
    "depth": SensorType("depth_camera"),
    "multicamera": SensorType("camera", (), "one sensor for each of its cameras"),
    "wideanglecamera": SensorType("wide_angle_camera"),
    "sonar": SensorType(""),
    "rfid": SensorType(""),
    "rfidtag": SensorType(""),
    "wireless_receiver": SensorType(""),
    "wireless_transmitter": SensorType(""),
}
"""Types with another name in gz, or without a counterpart."""

TO_CLASSIC = {
    "gpu_lidar": SensorType("gpu_ray", (("lidar", "ray"),)),
    "lidar": SensorType("ray", (("lidar", "ray"),)),
    "navsat": SensorType("gps", (("navsat", "gps"),)),
    "depth_camera": SensorType("depth"),
    "rgbd_camera": SensorType("depth", (), "its colors require a plugin"),
    "wide_angle_camera": SensorType("wideanglecamera"),
    "air_pressure": SensorType(""),
    "air_speed": SensorType(""),
    "boundingbox_camera": SensorType(""),
    "custom": SensorType(""),
    "segmentation_camera": SensorType(""),
    "thermal_camera": SensorType(""),
}
"""Types with another name in Gazebo Classic, or without a counterpart."""

RENDERED = ("sensors", "Sensors")

SYSTEMS = {
    **dict.fromkeys(
        ("camera", "depth_camera", "rgbd_camera", "gpu_lidar", "thermal_camera",
         "segmentation_camera", "boundingbox_camera", "wide_angle_camera"),
        RENDERED,
    ),
    "air_pressure": ("air-pressure", "AirPressure"),
    "air_speed": ("air-speed", "AirSpeed"),
    "altimeter": ("altimeter", "Altimeter"),
    "contact": ("contact", "Contact"),
    "force_torque": ("forcetorque", "ForceTorque"),
    "imu": ("imu", "Imu"),
    "logical_camera": ("logical-camera", "LogicalCamera"),
    "magnetometer": ("magnetometer", "Magnetometer"),
    "navsat": ("navsat", "NavSat"),
}  # fmt: skip
"""The gz system for each sensor type: the word in its library's name, and its class."""
