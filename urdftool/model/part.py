"""Base of all parts of a robot: a location in the source."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..source.document import Element
from ..source.location import Place
from .provenance import NOWHERE

if TYPE_CHECKING:
    from .provenance import Provenance

Vector = tuple[float, float, float]
ZERO: Vector = (0.0, 0.0, 0.0)


@dataclass(slots=True)
class Part:
    """Part of a robot.

    Attributes:
        provenance: Location in the source; None for a generated part.
    """

    provenance: Provenance | None = None

    @property
    def element(self) -> Element:
        """Return the URDF element from which the part was read.

        Raises:
            TypeError: The part was not read from URDF.
        """
        element = self.provenance
        if isinstance(element, Element):
            return element
        raise TypeError(f"{type(self).__name__} was not read from URDF")

    @property
    def xml(self) -> Element | None:
        """Return the URDF element from which the part was read; None for another source."""
        return self.provenance if isinstance(self.provenance, Element) else None

    def has_attribute(self, name: str) -> bool:
        """Tell whether the URDF element has an attribute; False without an element."""
        return self.xml is not None and name in self.xml.attributes

    @property
    def tag(self) -> str:
        """Return the tag of the URDF element; the name of the class in lower case without one."""
        return type(self).__name__.lower() if self.xml is None else self.xml.tag

    @property
    def sources(self) -> list[Provenance]:
        """Return the source in a list; an empty one for a generated part."""
        return [] if self.provenance is None else [self.provenance]

    def find_child_xml(self, tag: str) -> Element | None:
        """Return the first child with a tag of the URDF element; None without one."""
        return None if self.xml is None else self.xml.find_child(tag)

    def locate_attribute(self, name: str) -> Place:
        """Return the span of an attribute of the URDF element; of the part without one."""
        return self.place if self.xml is None else self.xml.locate_attribute(name)

    @property
    def place(self) -> Place:
        """Return the span of the start tag in the source; ``NOWHERE`` for a generated part."""
        return NOWHERE if self.provenance is None else self.provenance.place


@dataclass(slots=True)
class Origin(Part):
    """Pose of the child in the parent frame: ``xyz`` [m] and fixed-axis ``rpy`` [rad].

    ``quaternion`` is ``(x, y, z, w)`` if ``quat_xyzw`` of URDF 1.1 is present.
    """

    xyz: Vector = ZERO
    rpy: Vector = ZERO
    quaternion: tuple[float, float, float, float] | None = None
