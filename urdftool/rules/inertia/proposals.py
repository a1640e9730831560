"""Find the probably intended tensor, and describe it in messages."""

from __future__ import annotations

from ...mechanics.tensor import COMPONENTS, SymmetricTensor
from ...mechanics.typo_detection import Proposal, infer_intended_tensor
from ...model.elements import Inertial, Link, Robot
from ...model.pose import UPRIGHT, pose_of, rotate, transpose
from ..mesh.outlines import reaches
from .solids import box_of, solid_kind, solid_tensor, solid_text


def proposal_of(link: Link, inertial: Inertial, six: SymmetricTensor) -> Proposal | None:
    """Find the one simple mistake that explains a tensor, along the axes it is written in."""
    pose = pose_of(inertial.origin)
    upright = pose.rotation == UPRIGHT
    com, box = pose.translation, box_of(link)
    if not upright:
        back = transpose(pose.rotation)
        com = rotate(back, com)
        box = box.rotated(back) if box is not None else None
    return infer_intended_tensor(
        link.mass,
        com,
        six,
        solid=solid_tensor(link),
        box=box,
        rotation=None if upright else pose.rotation,
    )


def recomputing_hint(robot: Robot, link: Link) -> str:
    """Get the command that replaces the inertia of a link.

    Returns:
        An empty text if the size of the link is unknown, or if only ``lint`` reads the file.
    """
    source = robot.source
    if (source is not None and source.repaired) or reaches(robot).link(link) is None:
        return ""
    return "'urdftool inertia robot --write --all --link LINK' writes that of its geometry"


def remedy_text(link: Link, inertial: Inertial, six: SymmetricTensor) -> str:
    """Describe the intended tensor; if it is not clear, that of a solid shape; or nothing."""
    proposal = proposal_of(link, inertial, six)
    if proposal is None:
        return solid_text(link)
    if proposal.kind in ("decimal", "sign", "copied"):
        return f"; {proposal.sentence}"
    return f"; {proposal.sentence}; write {attributes_text(proposal.tensor)}"


def remedy_kind(link: Link, inertial: Inertial, six: SymmetricTensor) -> str:
    """Name the kind of the remedy of :func:`remedy_text`; empty if there is none."""
    proposal = proposal_of(link, inertial, six)
    return solid_kind(link) if proposal is None else proposal.kind


def attributes_text(six: SymmetricTensor) -> str:
    """Format the six numbers as attributes: ``ixx="1" ixy="0" …``, without ``-0``."""
    return " ".join(
        f'{name}="{value + 0.0:.6g}"' for name, value in zip(COMPONENTS, six, strict=True)
    )
