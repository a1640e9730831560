"""Describe the link, joint or material that contains an element."""

from __future__ import annotations

from ...source.document import Element


def describe_owner(element: Element) -> str:
    """Describe the nearest named element around an element: ``link 'arm'``, ``material 'red'``."""
    around: Element | None = element
    while around is not None:
        name = around.attributes.get("name", "")
        if around.tag in ("link", "joint") or (around.tag == "material" and name):
            return f"{around.tag} '{name}'"
        around = around.parent
    return "the robot"
