"""Whose an element is, in words."""

from __future__ import annotations

from ...source.document import Element


def owner(element: Element) -> str:
    """The nearest named thing an element is in or is: ``link 'arm'``, ``material 'red'``."""
    around: Element | None = element
    while around is not None:
        name = around.attributes.get("name", "")
        if around.tag in ("link", "joint") or (around.tag == "material" and name):
            return f"{around.tag} '{name}'"
        around = around.parent
    return "the robot"
