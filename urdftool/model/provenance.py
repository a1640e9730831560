"""Location of a part in a source file of any format."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..source.location import Place, SourceFile

if TYPE_CHECKING:
    from typing import Protocol

    from ..source.document import Element

    class Provenance(Protocol):
        """Source of a part: an element of URDF, or a :class:`Written` of another format."""

        @property
        def place(self) -> Place:
            """Return the span in the source."""


NOWHERE = Place(SourceFile("", b""), 0, 0)
"""Place of a part that was not read from a file."""


class Written:
    """Source of a part in a format other than URDF.

    Attributes:
        place: Span in the file.
        element: XML of the part, if a writer may copy it; else None.
    """

    __slots__ = ("element", "place")

    def __init__(self, place: Place, element: Element | None = None) -> None:
        """Store the place."""
        self.place = place
        self.element = element
