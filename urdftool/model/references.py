"""The ``<gazebo>`` blocks of a robot as elements: where they are written, not what they mean."""

from __future__ import annotations

from ..source.document import Element
from .elements import Robot


def list_blocks(robot: Robot) -> list[tuple[str | None, Element]]:
    """Return the element of each block after its reference; None refers to the robot."""
    return [(block.reference, block.element) for block in robot.gazebo]


def has_block(robot: Robot, name: str) -> bool:
    """Tell whether a block refers to a link or joint by its name."""
    return name in robot.extensions
