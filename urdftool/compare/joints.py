"""Differences of joints."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ..model.elements import Joint, Vector
from ..model.pose import compute_norm, make_pose
from .change import Change
from .links import describe_pose
from .tolerance import are_close, close, format_motion, is_same_pose

_X: Vector = (1.0, 0.0, 0.0)


def compare_joints(
    a: Joint, b: Joint, tolerance: float, renamed: Mapping[str, str]
) -> Iterator[Change]:
    """Yield the differences of a joint.

    Args:
        a: The joint in the first robot.
        b: The joint in the second.
        tolerance: Tolerance as in ``closeness.TOLERANCE``.
        renamed: New names of links and joints by old names.
    """

    def change(
        what: str, before: object, after: object, unit: str = "", remark: str = ""
    ) -> Change:
        part = getattr(b, what.partition(" ")[0], None)
        place = getattr(part, "place", None) or b.place
        return Change("joint", b.name, what, before, after, unit, remark, place)

    for what in ("type", "parent", "child"):
        before, after = getattr(a, what), getattr(b, what)
        if (before if what == "type" else renamed.get(before, before)) != after:
            yield change(what, before, after)
    one, two = make_pose(a.origin), make_pose(b.origin)
    if not is_same_pose(one, two, tolerance):
        yield change("origin", describe_pose(one), describe_pose(two), "", format_motion(one, two))
    if a.has_axis and b.has_axis:
        x, y = _get_axis(a), _get_axis(b)
        if not are_close(x, y, max(tolerance, 1e-12)):
            opposite = are_close(x, (-y[0], -y[1], -y[2]), max(tolerance, 1e-12))
            yield change("axis", x, y, "", "opposite direction" if opposite else "")
    yield from _compare_numbers(a, b, tolerance, renamed)


def _get_axis(joint: Joint) -> Vector:
    """Return the axis, normalized unless it is zero."""
    x, y, z = joint.axis.xyz if joint.axis is not None else _X
    length = compute_norm((x, y, z)) or 1.0
    return x / length, y / length, z / length


def _compare_numbers(
    a: Joint, b: Joint, tolerance: float, renamed: Mapping[str, str]
) -> Iterator[Change]:
    slides = b.type == "prismatic"
    here, force, rate = ("m", "N", "m/s") if slides else ("rad", "N·m", "rad/s")
    units = {
        "limit": {"lower": here, "upper": here, "effort": force, "velocity": rate},
        "dynamics": {
            "damping": "N·s/m" if slides else "N·m·s/rad",
            "friction": force,
            "armature": "kg" if slides else "kg·m²",
            "stiffness": "N/m" if slides else "N·m/rad",
            "spring_reference": here,
        },
        "mimic": {"joint": "", "multiplier": "", "offset": here},
        "safety_controller": {
            "soft_lower_limit": here,
            "soft_upper_limit": here,
            "k_position": "",
            "k_velocity": "",
        },
        "calibration": {"rising": here, "falling": here, "reference_position": here},
    }
    for part, properties in units.items():
        one, two = getattr(a, part), getattr(b, part)
        place = b.place if two is None else two.place
        for name, unit in properties.items():
            before = None if one is None else getattr(one, name)
            after = None if two is None else getattr(two, name)
            if part == "limit" and name in ("lower", "upper") and a.is_limited and b.is_limited:
                before, after = before or 0.0, after or 0.0  # default of readers
            if isinstance(before, str) or isinstance(after, str):
                same = renamed.get(before or "", before) == after
            else:
                same = close(before, after, tolerance)
            if not same:
                what = f"{part.replace('_', ' ')} {name.replace('_', ' ')}"
                yield Change("joint", b.name, what, before, after, unit, "", place)
