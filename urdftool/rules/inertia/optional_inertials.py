"""Find out whether a description leaves out inertials on purpose."""

from __future__ import annotations

from ...source.description import Description
from ...source.document import Element, parse_once
from ...source.xacro_names import CONDITIONS


def has_optional_inertials(description: Description) -> bool:
    """Tell whether a condition of xacro in a link contains inertials or a macro of that name."""
    if description.expansion is None:
        return False
    return any(
        "inerti" in part.tag
        for file in description.files
        for element in parse_once(file).root.walk()
        if element.tag in CONDITIONS and _is_in_link(element)
        for part in element.walk()
    )


def _is_in_link(element: Element) -> bool:
    parent = element.parent
    while parent is not None and parent.tag != "link":
        parent = parent.parent
    return parent is not None
