"""Where a part of a robot was written, in whatever format."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..source.location import Place, SourceFile

if TYPE_CHECKING:
    from typing import Protocol

    class Provenance(Protocol):
        """Where a part was written: an element of URDF, or a :class:`Written`."""

        @property
        def place(self) -> Place:
            """Get the bytes in the source."""


NOWHERE = Place(SourceFile("", b""), 0, 0)
"""Place of a part that was not read from a file."""


class Written:
    """Where a part was written in a file of another format than URDF.

    Attributes:
        place: The bytes.
    """

    __slots__ = ("place",)

    def __init__(self, place: Place) -> None:
        """Keep the place."""
        self.place = place
