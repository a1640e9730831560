"""Kinds of the values in ``<gazebo>`` blocks: of keywords, and of the SDF elements in them."""

from __future__ import annotations

from ...model.read import number, parse_numbers
from ...model.settings import describe_kind, get_text, list_rows, parse
from ...source.document import Element
from ..words import split_words

SENSOR_NUMBERS = split_words(
    "update_rate horizontal_fov near far width height samples resolution min_angle max_angle min "
    "max mean stddev bias_mean bias_stddev precision dynamic_bias_stddev "
    "dynamic_bias_correlation_time"
)
"""Elements in a sensor that hold one number."""

SHAPE_NUMBERS = split_words(
    "mu mu2 slip1 slip2 kp kd max_vel min_depth soft_cfm soft_erp restitution_coefficient "
    "threshold coefficient max_contacts laser_retro transparency"
)
"""Elements in a collision or visual that hold one number."""

SDF_FLAGS = split_words(
    "always_on visualize enable_metrics gravity self_collide enable_wind kinematic "
    "must_be_base_link allow_auto_disable cast_shadows static"
)
"""Elements that hold true or false, or 1 or 0."""

COLORS = split_words("ambient diffuse specular emissive")
"""Elements in a material or light that hold a color, with or without alpha."""

WORDS = {
    ("force_torque", "frame"): ("parent", "child", "sensor"),
    ("force_torque", "measure_direction"): ("parent_to_child", "child_to_parent"),
}
"""Allowed words of elements, by parent tag and tag."""

_NUMBERS_IN = {"sensor": SENSOR_NUMBERS, "collision": SHAPE_NUMBERS, "visual": SHAPE_NUMBERS}


def is_flag(text: str) -> bool:
    """Tell whether a text is a flag."""
    return parse("flag", text) is not None


def get_kind(keyword: str) -> str:
    """Return the kind of a keyword's value: ``number``, ``count``, ``vector`` or ``flag``.

    Empty for a keyword without a value, and for what is not a keyword of a link or joint.
    """
    return next((row.kind for row in list_rows(keyword)), "")


def describe_required_keyword_value(element: Element) -> str:
    """Describe the value that a keyword requires; return "" if it has one or takes none."""
    kind = get_kind(element.tag)
    return "" if not kind or parse(kind, get_text(element)) is not None else describe_kind(kind)


def describe_required_value(element: Element) -> str:
    """Describe the value that an SDF element requires; return "" if it is valid or not known."""
    text = element.text.strip()
    if element.children:
        return ""
    if element.tag == "pose":
        count = 7 if element.get("rotation_format") == "quat_xyzw" else 6
        return f"{count} finite numbers" if text and parse_numbers(text, count) is None else ""
    parent = element.parent.tag if element.parent else ""
    if (parent, element.tag) == ("axis", "xyz"):
        return "3 finite numbers" if parse_numbers(text, 3) is None else ""
    allowed = WORDS.get((parent, element.tag), ())
    if allowed and text not in allowed:
        return " or ".join(allowed)
    if element.tag in COLORS and _get_enclosing_part(element) != "sensor":
        right = any(parse_numbers(text, count) for count in (3, 4))
        return "" if right else "3 or 4 finite numbers"
    if element.tag in SDF_FLAGS:
        return "" if is_flag(get_text(element)) else "true or false"
    known = _NUMBERS_IN.get(_get_enclosing_part(element), frozenset())
    if element.tag in known and number(text) is None:
        return "a finite number"
    return ""


def _get_enclosing_part(element: Element) -> str:
    """Return the tag of the enclosing sensor, collision or visual; empty for none."""
    above = element.parent
    while above is not None and above.tag != "plugin":
        if above.tag in _NUMBERS_IN:
            return above.tag
        above = above.parent
    return ""
