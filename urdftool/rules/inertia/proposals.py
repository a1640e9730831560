"""What was probably meant by a wrong tensor, and how a message says it."""

from __future__ import annotations

from ...model.bounds import Bounds
from ...model.elements import Inertial, Link
from ...model.inertia_slips import NAMES, Proposal, propose
from ...model.pose import UPRIGHT, Rotation, pose_of, rotate, transpose
from ...model.tensor3 import Six
from .solids import box_of, solid_tensor, solid_text


def proposal_of(link: Link, inertial: Inertial, six: Six) -> Proposal | None:
    """The one simple slip that explains the tensor of a link, along the axes it is written in."""
    pose = pose_of(inertial.origin)
    upright = pose.rotation == UPRIGHT
    com, box = pose.translation, box_of(link)
    if not upright:
        back = transpose(pose.rotation)
        com = rotate(back, com)
        box = _turned(box, back) if box is not None else None
    return propose(
        link.mass,
        com,
        six,
        solid=solid_tensor(link),
        box=box,
        rotation=None if upright else pose.rotation,
    )


def remedy_text(link: Link, inertial: Inertial, six: Six) -> str:
    """What was probably meant; where that is not clear, what a solid shape has; or nothing."""
    proposal = proposal_of(link, inertial, six)
    if proposal is None:
        return solid_text(link)
    if proposal.kind in ("decimal", "sign", "copied"):
        return f"; {proposal.sentence}"
    return f"; {proposal.sentence}; write {attributes_text(proposal.tensor)}"


def attributes_text(six: Six) -> str:
    """Format the six numbers as attributes: ``ixx="1" ixy="0" …``, without ``-0``."""
    return " ".join(f'{name}="{value + 0.0:.6g}"' for name, value in zip(NAMES, six, strict=True))


def _turned(box: Bounds, rotation: Rotation) -> Bounds:
    """The box around a box that is turned."""
    centre = rotate(rotation, box.centre)
    half = [
        sum(abs(part) * length for part, length in zip(row, box.size, strict=True)) / 2
        for row in rotation
    ]
    x, y, z = centre
    a, b, c = half
    return Bounds((x - a, y - b, z - c), (x + a, y + b, z + c))
