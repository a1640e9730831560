"""Review of one link: written and implied mass properties, their comparison, and faults."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..diagnostic import Diagnostic
from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.typo_detection import Proposal
from ..model.elements import Inertial, Link
from ..model.pose import Rotation, make_pose
from ..source.location import Place
from .comparison import Comparison
from .pieces import LinkBody


@dataclass(slots=True)
class Fault(Diagnostic):
    """A value that is invalid or physically inconsistent.

    Attributes:
        code: ``"unreadable"``, ``"mass"``, ``"positivity"``, ``"triangle"``, ``"box"``,
            ``"copied"`` or ``"placeholder"``.
        message: The fault and the remedy.
        location: Location of the value.
    """

    location: Place


@dataclass(eq=False)
class LinkReview:
    """Review of one link.

    Attributes:
        link: The link.
        body: Solid of its geometry; None if it has no geometry.
        written: Written mass properties, in the link frame; None if incomplete.
        missing: Missing values: ``inertial``, ``mass``, ``inertia``, or single numbers such as
            ``ixy``.
        mass: Mass [kg], written or assigned; None if unknown.
        implied: Mass properties of the geometry at that mass, in the link frame.
        comparison: Written relative to implied properties.
        faults: Invalid or physically inconsistent values.
        proposal: The one typing error that explains a wrong tensor.
        notes: Remarks.
    """

    link: Link
    body: LinkBody | None = None
    written: SpatialInertia | None = None
    missing: tuple[str, ...] = ()
    mass: float | None = None
    implied: SpatialInertia | None = None
    comparison: Comparison | None = None
    faults: list[Fault] = field(default_factory=list)
    proposal: Proposal | None = None
    notes: list[Diagnostic] = field(default_factory=list)

    @property
    def volume(self) -> float | None:
        """Return the volume of its geometry [m³]; None if it is not fully known."""
        return self.body.volume if self.body is not None and self.body.complete else None

    @property
    def status(self) -> str:
        """Return ``wrong``, ``doubtful``, ``frame``, ``missing``, ``incomplete`` or ``ok``."""
        if self.faults:
            return "wrong"
        if self.proposal is not None:
            return "doubtful"
        if self.link.is_frame:
            return "frame"
        if self.missing:
            return "missing" if self.missing == ("inertial",) else "incomplete"
        return "ok"


def get_inertial_rotation(inertial: Inertial | None) -> Rotation:
    """Return the rotation of an inertial's frame in the link frame."""
    return make_pose(inertial.origin if inertial else None).rotation
