"""Validation of poses, numbers and flags in SDF elements of a ``<gazebo>`` block."""

from __future__ import annotations

from ...model.read import number, numbers
from ...source.document import Element
from ..common.gazebo_blocks import is_flag

SENSOR_NUMBERS = frozenset(
    ("update_rate", "horizontal_fov", "near", "far", "width", "height", "samples", "resolution",
     "min_angle", "max_angle", "min", "max", "mean", "stddev", "bias_mean", "bias_stddev",
     "precision", "dynamic_bias_stddev", "dynamic_bias_correlation_time")
)  # fmt: skip
"""Elements in a sensor that hold one number."""

SHAPE_NUMBERS = frozenset(
    ("mu", "mu2", "slip1", "slip2", "kp", "kd", "max_vel", "min_depth", "soft_cfm", "soft_erp",
     "restitution_coefficient", "threshold", "coefficient", "max_contacts", "laser_retro",
     "transparency")
)  # fmt: skip
"""Elements in a collision or visual that hold one number."""

FLAGS = frozenset(
    ("always_on", "visualize", "enable_metrics", "gravity", "self_collide", "enable_wind",
     "kinematic", "must_be_base_link", "allow_auto_disable", "cast_shadows", "static")
)  # fmt: skip
"""Elements that hold true or false, or 1 or 0."""

COLORS = frozenset(("ambient", "diffuse", "specular", "emissive"))
"""Elements in a material or light that hold a color, with or without alpha."""

WORDS = {
    ("force_torque", "frame"): ("parent", "child", "sensor"),
    ("force_torque", "measure_direction"): ("parent_to_child", "child_to_parent"),
}
"""Allowed words of elements, by parent tag and tag."""

_NUMBERS = {"sensor": SENSOR_NUMBERS, "collision": SHAPE_NUMBERS, "visual": SHAPE_NUMBERS}


def wanted(element: Element) -> str:
    """Describe the required value of an element; return "" if it is valid or not known."""
    text = element.text.strip()
    if element.children:
        return ""
    if element.tag == "pose":
        count = 7 if element.get("rotation_format") == "quat_xyzw" else 6
        return f"{count} finite numbers" if text and numbers(text, count) is None else ""
    words = WORDS.get((element.parent.tag if element.parent else "", element.tag), ())
    if words and text not in words:
        return " or ".join(words)
    if element.tag in COLORS and _inside(element) != "sensor":
        right = any(numbers(text, count) for count in (3, 4))
        return "" if right else "3 or 4 finite numbers"
    if element.tag in FLAGS:
        return "" if is_flag(element.get("value") or text) else "true or false"
    known = _NUMBERS.get(_inside(element), frozenset())
    if element.tag in known and number(text) is None:
        return "a finite number"
    return ""


def _inside(element: Element) -> str:
    """Return the tag of the enclosing sensor, collision or visual; empty for none."""
    above = element.parent
    while above is not None and above.tag != "plugin":
        if above.tag in _NUMBERS:
            return above.tag
        above = above.parent
    return ""
