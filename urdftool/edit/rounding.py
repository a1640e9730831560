"""Numbers of a description with fewer digits, within a tolerance."""

from __future__ import annotations

from ..errors import ModelError
from ..model.numbers import parse_numbers
from ..model.urdf_schema import VOCABULARY
from ..source.document import Element
from .draft import Draft
from .numbers import format_number, format_relative

_RELATIVE = {tag: VOCABULARY[tag].attributes for tag in ("mass", "inertia")}

_ATTRIBUTES = {
    tag: tuple(name for name in kind.numbers if name in kind.held and name != "quat_xyzw")
    for tag, kind in VOCABULARY.items()
    if kind.numbers and tag not in _RELATIVE
}
"""Attributes whose tolerance is absolute below 1."""


def round_numbers(draft: Draft, tolerance: float) -> int:
    """Write numbers with the fewest digits that are within a tolerance; return how many changed.

    Args:
        draft: The robot.
        tolerance: Largest change: of lengths [m], angles [rad] and others below 1 absolute, else
            relative; of masses relative; of tensors relative to their largest element.

    Raises:
        ModelError: The tolerance is not positive, or rounding makes an extent zero.
    """
    if not 0.0 < tolerance < 0.1:
        raise ModelError(f"tolerance {tolerance:g} is not between 0 and 0.1")
    count = 0
    for element in draft.root.walk():
        for name in (*_ATTRIBUTES.get(element.tag, ()), *_RELATIVE.get(element.tag, ())):
            count += _round_attribute(draft, element, name, tolerance)
    return count


def _round_attribute(draft: Draft, element: Element, name: str, tolerance: float) -> bool:
    text = element.get(name)
    values = parse_numbers(text, len((text or "").split()))
    if text is None or not values:
        return False
    words = [_round(element, name, value, tolerance) for value in values]
    pairs = zip(text.split(), words, strict=True)
    new = " ".join(old if len(old) <= len(word) else word for old, word in pairs)
    if name in ("size", "radius", "length", "scale") and "0" in words and 0.0 not in values:
        raise ModelError(f"tolerance {tolerance:g} would make a {name} zero", at=element.place)
    if new == " ".join(text.split()):
        return False
    draft.set(element, name, new)
    return True


def _round(element: Element, name: str, value: float, tolerance: float) -> str:
    if element.tag == "mass" or name in ("size", "radius", "length", "scale"):
        return format_relative(value, tolerance)
    if element.tag == "inertia":
        numbers = [parse_numbers(element.get(n), 1) or (0.0,) for n in _RELATIVE["inertia"]]
        largest = max(abs(number[0]) for number in numbers)
        scaled = value / largest if largest else 0.0
        return "0" if abs(scaled) <= tolerance else format_relative(value, tolerance)
    return format_number(value, tolerance)


def get_proof_tolerance(tolerance: float) -> float:
    """Return the tolerance of the comparison: roundings add up along some 100 joints."""
    return max(1e-8, 100.0 * tolerance)
