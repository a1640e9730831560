"""Find the readers that ignore a number of a joint."""

from __future__ import annotations

from collections.abc import Collection

from ...source.document import Element

_ALL = frozenset({"urdfdom", "mujoco", "pybullet", "drake"})
_SIMULATORS = _ALL - {"urdfdom"}

_UNREAD = {
    "safety_controller": _SIMULATORS,
    "calibration": _SIMULATORS,
    "mimic": frozenset({"pybullet"}),
}
_UNREAD_ATTRIBUTES = {
    ("origin", "quat_xyzw"): _ALL,
    ("limit", "acceleration"): _ALL,
    ("limit", "deceleration"): _ALL,
    ("limit", "jerk"): _ALL,
    ("limit", "velocity"): frozenset({"mujoco"}),
}


def get_ignoring_readers(element: Element, name: str) -> frozenset[str]:
    """Get the readers that ignore an attribute, among urdfdom, mujoco, pybullet and drake.

    They depend on the type of the joint: only MuJoCo reads the axis of a fixed joint, and a
    continuous joint has no range in MuJoCo.
    """
    tag = element.tag
    unread = _UNREAD.get(tag, frozenset()) | _UNREAD_ATTRIBUTES.get((tag, name), frozenset())
    kind = element.parent.get("type") if element.parent is not None else None
    if kind in ("fixed", "floating"):
        if tag == "axis":
            unread |= _ALL - {"mujoco"}
        elif tag in ("limit", "dynamics"):
            unread |= {"mujoco", "drake"}
    elif kind == "continuous" and name in ("lower", "upper"):
        unread |= {"mujoco"}
    return unread


def select_read_effects(keys: Collection[str], element: Element, name: str) -> list[str]:
    """Select the effects of readers that read a number.

    Args:
        keys: Keys of effects; the first reader of each represents those with the same code.
        element: An element of URDF.
        name: One of its attributes that contains a number.
    """
    unread = get_ignoring_readers(element, name)
    return [key for key in keys if key.partition(" (")[0].partition(", ")[0] not in unread]
