"""What is known of one link: written, implied, compared, judged."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.typo_detection import Proposal
from ..model.elements import Inertial, Link
from ..model.pose import Rotation, pose_of
from ..source.location import Place
from .comparison import Comparison
from .pieces import LinkBody


@dataclass(frozen=True)
class Fault:
    """Something that cannot be.

    Attributes:
        kind: ``"unreadable"``, ``"mass"``, ``"positivity"``, ``"triangle"``, ``"box"``,
            ``"copied"`` or ``"placeholder"``.
        message: What is wrong, with what would be right.
        place: Where it is written.
    """

    kind: str
    message: str
    place: Place


@dataclass(eq=False)
class LinkReview:
    """One link.

    Attributes:
        link: The link.
        body: What its geometry encloses; None where it has none.
        written: Its mass properties as written, in the link frame; None where they are not whole.
        missing: What of them is not written: ``inertial``, ``mass``, ``inertia``, or single
            numbers such as ``ixy``.
        mass: What it weighs [kg], written or wanted; None where nothing says.
        implied: The geometry's mass properties at that mass, in the link frame.
        comparison: Written against implied.
        faults: What cannot be.
        proposal: The one simple slip that explains a wrong tensor.
        notes: What else is to be said.
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
    notes: list[str] = field(default_factory=list)

    @property
    def volume(self) -> float | None:
        """Volume of its geometry [m³]; None where it is not all known."""
        return self.body.volume if self.body is not None and self.body.complete else None

    @property
    def status(self) -> str:
        """``wrong``, ``doubtful``, ``frame``, ``missing``, ``incomplete`` or ``ok``."""
        if self.faults:
            return "wrong"
        if self.proposal is not None:
            return "doubtful"
        if self.link.is_frame:
            return "frame"
        if self.missing:
            return "missing" if self.missing == ("inertial",) else "incomplete"
        return "ok"


def inertial_rotation(inertial: Inertial | None) -> Rotation:
    """Return the rotation of an inertial's frame in the link frame."""
    return pose_of(inertial.origin if inertial else None).rotation
