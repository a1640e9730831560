"""Changes to the inertial of one link: elements to add and attributes to set.

Existing values are kept if possible: the tensor is written along the axes of an existing ``rpy``,
and attributes that are already correct are not changed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.tensor import as_tensor, get_components, rotate_tensor
from ..model.elements import Link
from ..model.link import COMPONENTS
from ..model.numbers import format_numbers_text, number_text
from ..model.pose import transpose
from ..model.read import number, parse_numbers
from ..source.document import Element
from .link_review import LinkReview, get_inertial_rotation
from .requirements import require_consistent
from .rounding import DIGITS, round_properties

_SAME = 10.0 ** (1 - DIGITS)
"""Relative difference of equal numbers: that of numbers with the digits of ``rounding``."""


@dataclass
class RequestedEdit:
    """A change to one expanded element: lines of a child to add, or an attribute to set."""

    element: Element
    attribute: str | None = None
    value: str = ""
    child: str = ""
    lines: tuple[str, ...] = ()
    after: str | None = None

    @property
    def description(self) -> str:
        """Describe the change for a user who makes it by hand."""
        if self.attribute is not None:
            return f'set {self.attribute}="{self.value}"'
        return "add " + " ".join(line.strip() for line in self.lines)


@dataclass
class LinkEdits:
    """All changes to one link, and its resulting mass properties."""

    item: LinkReview
    result: SpatialInertia
    edits: list[RequestedEdit] = field(default_factory=list)

    @property
    def link(self) -> Link:
        """Return the link."""
        return self.item.link


def determine_edits(item: LinkReview, *, recompute: bool) -> LinkEdits:
    """Determine the changes to a link whose implied mass properties are known.

    Raises:
        InertiaError: The result would be physically inconsistent.
    """
    assert item.implied is not None
    result = round_properties(item.implied, f"link '{item.link.name}'")
    inertial = item.link.inertial
    if inertial is None:
        lines = ("<inertial>", *(f"\t{line}" for line in _collect_children(result)), "</inertial>")
        request = RequestedEdit(item.link.element, child="inertial", lines=lines)
        return LinkEdits(item, result, [request])
    element = inertial.element
    origin, mass, inertia = (element.find_child(tag) for tag in ("origin", "mass", "inertia"))
    back = transpose(get_inertial_rotation(inertial))
    along = round_properties(
        replace(result, tensor=rotate_tensor(result.tensor, back)),
        f"link '{item.link.name}'",
    )
    if not element.children:
        return LinkEdits(
            item, result, [RequestedEdit(element, child="mass", lines=_collect_children(along))]
        )
    found = LinkEdits(item, result)
    texts = dict(zip(("origin", "mass", "inertia"), _collect_children(along), strict=True))
    if origin is None:
        if any(along.com):
            found.edits.append(RequestedEdit(element, child="origin", lines=(texts["origin"],)))
    elif recompute and not _is_same_number(origin.get("xyz") or "0 0 0", along.com):
        found.edits.append(RequestedEdit(origin, "xyz", format_numbers_text(along.com)))
    if mass is None or "value" not in mass.attributes:
        if mass is None:
            found.edits.append(
                RequestedEdit(element, child="mass", lines=(texts["mass"],), after="origin")
            )
        else:
            found.edits.append(RequestedEdit(mass, "value", number_text(along.mass)))
    elif recompute and not _is_same_number(mass.get("value"), [along.mass]):
        found.edits.append(RequestedEdit(mass, "value", number_text(along.mass)))
    if inertia is None:
        found.edits.append(
            RequestedEdit(element, child="inertia", lines=(texts["inertia"],), after="mass")
        )
    else:
        found.edits += _set_numbers(inertia, along, recompute=recompute)
    return found


def _set_numbers(
    inertia: Element, along: SpatialInertia, *, recompute: bool
) -> list[RequestedEdit]:
    """Set those of the six numbers that are missing or, if one is not the same, that differ.

    Unless ``recompute``, a missing product of inertia is set to 0 if all moments are written.

    Raises:
        InertiaError: The written numbers with the missing ones added are inconsistent.
    """
    meant = get_components(along.tensor)
    missing = [name for name in COMPONENTS if name not in inertia.attributes]
    if not recompute:
        if not any(name in missing for name in ("ixx", "iyy", "izz")):
            meant |= dict.fromkeys(missing, 0.0)
        kept = {
            name: number(inertia.get(name)) or 0.0 for name in COMPONENTS if name not in missing
        }
        tensor = as_tensor([{**meant, **kept}[name] for name in COMPONENTS])
        require_consistent(replace(along, tensor=tensor), "the written tensor")
        return [RequestedEdit(inertia, name, number_text(meant[name])) for name in missing]
    largest = max(map(abs, along.tensor))
    if all(_is_same_number(inertia.get(name), [meant[name]], largest) for name in COMPONENTS):
        return []
    return [
        RequestedEdit(inertia, name, number_text(meant[name]))
        for name in COMPONENTS
        if not _is_same_number(inertia.get(name), [meant[name]])
    ]


def _collect_children(properties: SpatialInertia) -> tuple[str, str, str]:
    six = get_components(properties.tensor)
    numbers_written = " ".join(f'{name}="{number_text(six[name])}"' for name in COMPONENTS)
    return (
        f'<origin xyz="{format_numbers_text(properties.com)}" rpy="0 0 0"/>',
        f'<mass value="{number_text(properties.mass)}"/>',
        f"<inertia {numbers_written}/>",
    )


def _is_same_number(text: str | None, values: Sequence[float], scale: float = 0.0) -> bool:
    written = parse_numbers(text, len(values))
    if written is None:
        return False
    size = max(scale, *(abs(value) for value in values))
    return all(abs(a - b) <= _SAME * size for a, b in zip(written, values, strict=True))
