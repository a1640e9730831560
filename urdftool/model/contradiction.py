"""Attributes of a stage that say the same for different simulators, with different values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from .part import Part


@dataclass(slots=True)
class Contradiction(Part):
    """Attributes of a prim of which each simulator reads its own.

    Attributes:
        kind: ``joint`` or ``link``.
        name: Name of the prim.
        values: Values in words by attribute, empty for a tensor; the robot has the first.
    """

    kind: str = ""
    name: str = ""
    values: Mapping[str, str] = field(default_factory=dict)

    @property
    def shown(self) -> str:
        """Return the attributes with their values in words."""
        return " and ".join(f"{name} {value}".strip() for name, value in self.values.items())
