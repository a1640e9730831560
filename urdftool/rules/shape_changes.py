"""Change the geometry of links, and the origins of geometry and joints."""

from __future__ import annotations

from ..model.elements import Collision, Joint, Visual
from .fix import (
    Change,
    get_written_lines,
    insert_after,
    is_written_inside,
    prepend_child,
    remove_element,
    replace_element,
    set_attribute,
)


def copy_shape(shape: Visual | Collision, tag: str) -> Change | None:
    """Add an element with the origin and geometry of a shape after it.

    Returns:
        None if the geometry is missing, or not written inside the shape.
    """
    geometry = shape.geometry
    if geometry is None or not is_written_inside(geometry.element, shape.element):
        return None
    return insert_after(
        shape.element,
        f"<{tag}>",
        *(f"\t{line}" for line in _get_origin_lines(shape)),
        "\t<geometry>",
        *(f"\t\t{line}" for line in get_written_lines(geometry.element)),
        "\t</geometry>",
        f"</{tag}>",
    )


def copy_origin(shape: Visual | Collision, model: Visual | Collision) -> Change:
    """Copy the ``<origin>`` of a shape as written to another, or remove it if it has none."""
    lines = _get_origin_lines(model)
    if shape.origin is None:
        return prepend_child(shape.element, *lines)
    if lines:
        return replace_element(shape.origin.element, lines)
    return remove_element(shape.origin.element)


def set_in_origin(part: Visual | Collision | Joint, name: str, value: str) -> Change:
    """Set an attribute of the ``<origin>``, which is added if it is missing."""
    if part.origin is None:
        return prepend_child(part.element, f'<origin {name}="{value}"/>')
    return set_attribute(part.origin.element, name, value)


def _get_origin_lines(shape: Visual | Collision) -> tuple[str, ...]:
    origins = shape.element.list_children("origin")
    return tuple(line for origin in origins for line in get_written_lines(origin))
