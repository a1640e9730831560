"""Names of planning groups, guessed from the names of joints and links."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from ..model.elements import Joint
from .chains import KinematicChain
from .name_parts import find_common_prefix, split_name

_KINDS = (
    ("arm", frozenset(["arm", "shoulder", "elbow", "wrist", "forearm", "hand"])),
    (
        "leg",
        frozenset(["leg", "hip", "knee", "ankle", "calf", "thigh", "haa", "hfe", "kfe", "foot"]),
    ),
    ("head", frozenset(["head", "neck"])),
    ("torso", frozenset(["torso", "waist", "lift", "spine"])),
)


def guess_kind(chain: KinematicChain) -> str:
    """Guess what a chain is: ``arm``, ``leg``, ``head`` or ``torso``; empty if it is unknown."""
    if chain.is_trunk:
        return "torso"
    names = [set(split_name(f"{joint.name} {joint.child}")) for joint in chain.joints]
    votes = Counter(kind for kind, known in _KINDS for words in names if words & known)
    return votes.most_common(1)[0][0] if votes else ""


def guess_chain_name(chain: KinematicChain, kind: str) -> str:
    """Guess the name of a chain's group: its kind, after what the names of its joints share."""
    prefix = find_common_prefix([joint.name for joint in chain.joints])
    if kind in ("torso", "head") or not prefix:
        return _add_side(kind, chain.joints)
    return prefix if kind in prefix.lower() else f"{prefix}_{kind}"


def _add_side(kind: str, joints: Sequence[Joint]) -> str:
    """Add the side that the names of all joints have, as in ``shoulder_pan_left``."""
    for side, words in (("left", {"left", "l"}), ("right", {"right", "r"})):
        if joints and all(words & set(split_name(joint.name)) for joint in joints):
            return f"{side}_{kind}"
    return kind


def guess_gripper_name(carrier: str, kind: str, *, alone: bool) -> str:
    """Guess the name of a gripper's group: that of its arm, with another kind.

    Args:
        carrier: Name of the group of its arm; empty without one.
        kind: ``gripper`` or ``hand``.
        alone: Whether it is the only gripper.
    """
    if not carrier or alone:
        return kind
    return carrier.replace("arm", kind) if "arm" in carrier else f"{carrier}_{kind}"
