"""Find the probably intended tensor, and describe it in messages."""

from __future__ import annotations

from ...mechanics.tensor import SymmetricTensor
from ...mechanics.typo_detection import Proposal, infer_intended_tensor
from ...model.elements import Inertial, Link, Robot
from ...model.link import COMPONENTS
from ...model.pose import IDENTITY_ROTATION, make_pose, rotate, transpose
from ..mesh.link_extents import get_extents
from .solids import compute_box, compute_solid_tensor, describe_solid, get_solid_kind


def find_proposal(link: Link, inertial: Inertial, six: SymmetricTensor) -> Proposal | None:
    """Find the one simple mistake that explains a tensor, along the axes it is written in."""
    pose = make_pose(inertial.origin)
    upright = pose.rotation == IDENTITY_ROTATION
    com, box = pose.translation, compute_box(link)
    if not upright:
        back = transpose(pose.rotation)
        com = rotate(back, com)
        box = box.rotate(back) if box is not None else None
    return infer_intended_tensor(
        link.mass,
        com,
        six,
        solid=compute_solid_tensor(link),
        box=box,
        rotation=None if upright else pose.rotation,
    )


def get_recompute_hint(robot: Robot, link: Link) -> str:
    """Get the command that replaces the inertia of a link.

    Returns:
        An empty text if the size of the link is unknown, or if only ``lint`` reads the file.
    """
    source = robot.source
    if (source is not None and source.repaired) or get_extents(robot).get_link_box(link) is None:
        return ""
    return "'urdftool inertia robot --write --all --link LINK' writes that of its geometry"


def describe_remedy(link: Link, inertial: Inertial, six: SymmetricTensor) -> str:
    """Describe the intended tensor; if it is not clear, that of a solid shape; or nothing."""
    proposal = find_proposal(link, inertial, six)
    if proposal is None:
        return describe_solid(link)
    if proposal.kind in ("decimal", "sign", "copied"):
        return f"; {proposal.sentence}"
    return f"; {proposal.sentence}; write {format_tensor(proposal.tensor)}"


def get_remedy_kind(link: Link, inertial: Inertial, six: SymmetricTensor) -> str:
    """Name the kind of the remedy of :func:`describe_remedy`; empty if there is none."""
    proposal = find_proposal(link, inertial, six)
    return get_solid_kind(link) if proposal is None else proposal.kind


def format_tensor(six: SymmetricTensor) -> str:
    """Format the six numbers as attributes: ``ixx="1" ixy="0" …``, without ``-0``."""
    return " ".join(
        f'{name}="{value + 0.0:.6g}"' for name, value in zip(COMPONENTS, six, strict=True)
    )
