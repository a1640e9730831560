"""The ``<gazebo>`` blocks of a robot as elements: where they are written, not what they mean."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..source.document import Element

if TYPE_CHECKING:
    from .elements import Robot


def list_blocks(robot: Robot) -> list[tuple[str | None, Element]]:
    """Return the element of each block after its reference; None refers to the robot."""
    return [(block.reference, block.element) for block in robot.gazebo]


def list_elements_by_reference(robot: Robot) -> dict[str, list[Element]]:
    """Return the children of the blocks by reference; those of the robot by an empty one."""
    found: dict[str, list[Element]] = {}
    for block in robot.gazebo:
        found.setdefault(block.reference or "", []).extend(block.element.children)
    return found


def has_block(robot: Robot, name: str) -> bool:
    """Tell whether a block refers to a link or joint by its name."""
    return name in robot.extensions
