"""Conversion of IMU noise from the format before SDF 1.5."""

from __future__ import annotations

from ...model.read import number
from ...source.document import Element
from .xml import Node, add, get_or_create

KINDS = {"rate": "angular_velocity", "accel": "linear_acceleration"}
_NUMBERS = ("mean", "stddev", "bias_mean", "bias_stddev")


def write_imu_noise(made: Node, sensor: Element) -> None:
    """Write the values of ``imu/noise`` for each axis."""
    imu = sensor.find_child("imu")
    noise = imu.find_child("noise") if imu is not None else None
    holder = made.find("imu")
    if noise is None or holder is None:
        return
    kind = noise.find_child("type")
    for old, new in KINDS.items():
        old_noise = noise.find_child(old)
        for axis in "xyz" if old_noise is not None else "":
            node = get_or_create(holder, f"{new}/{axis}")
            if old_noise is None or node.find("noise") is not None:
                continue
            one = add(node, "noise", type=kind.text.strip() if kind is not None else "gaussian")
            for name in _NUMBERS:
                value = old_noise.find_child(name)
                if value is not None and number(value.text.strip()) is not None:
                    add(one, name, value.text.strip())


def is_old_noise(element: Element) -> bool:
    """Tell whether an element is noise that :func:`write_imu_noise` converts."""
    parent = element.parent
    return element.tag == "noise" and parent is not None and parent.tag == "imu"
