"""Where a part of a robot was written, in whatever format."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from ..source.location import Place, SourceFile

NOWHERE = Place(SourceFile("", b""), 0, 0)
"""Place of a part that was not read from a file."""


class Provenance(Protocol):
    """Where a part was written: an :class:`Element` of URDF, or a :class:`Written` elsewhere."""

    @property
    def place(self) -> Place:
        """Get the bytes in the source."""


@dataclass(frozen=True, slots=True)
class Written:
    """Where a part was written in a file of another format than URDF."""

    place: Place
