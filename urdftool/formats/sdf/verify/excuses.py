"""Reported losses, sorted by the differences that they explain."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from ....diagnostic import Severity
from ....finding import Finding
from ....model.elements import Joint, Robot
from ...common.losses import DeclaredLosses

MASS = frozenset(("lossy-inertia", "lossy-mass", "lossy-world", "lossy-negative-mass"))
MOTION = frozenset(("lossy-axis", "lossy-joint-type", "lossy-planar"))
LIMITS = MOTION | {"lossy-limit"}
FRAMES = frozenset(("lossy-frame",))
SHAPES = frozenset(("lossy-mesh", "lossy-shape", "lossy-capsule", "lossy-world"))
COLORS = SHAPES | {"lossy-material", "lossy-texture"}
BLOCKS = frozenset(
    (
        "lossy-element",
        "lossy-extension",
        "lossy-reference",
        "bad-extension-number",
        "lossy-bad-extension-number",
    )
)
"""Contents of a ``<gazebo>`` block were dropped or changed."""

MIMIC = MOTION | {"lossy-mimic"}


@dataclass
class Excuses:
    """Names of links and joints with reported losses, by the difference that is accepted.

    Attributes:
        heavy: Joints above a link whose mass was changed.
        massy: Whether any mass was changed, or ``<gazebo>`` adds bodies.
        motion: Joints with a changed motion.
        frames: Links whose frame was dropped, or is below a joint with a changed motion.
        limits: Joints with changed limits.
        mimic: Joints with a changed mimic.
        shapes: Links with changed shapes.
        colors: Links with changed colors.
        declared: Every loss that changes the robot's behavior.
    """

    heavy: set[str] = field(default_factory=set)
    massy: bool = False
    motion: set[str] = field(default_factory=set)
    frames: set[str] = field(default_factory=set)
    limits: set[str] = field(default_factory=set)
    mimic: set[str] = field(default_factory=set)
    shapes: set[str] = field(default_factory=set)
    colors: set[str] = field(default_factory=set)
    declared: DeclaredLosses = field(default_factory=DeclaredLosses)


def sort_excuses(losses: list[Finding], robot: Robot) -> Excuses:
    """Sort losses by the differences that they explain."""
    blocks = (block.element for block in robot.gazebo if not block.reference)
    more = any(block.find_child(tag) for block in blocks for tag in ("link", "model", "include"))
    made = Excuses(massy=more)
    declared: set[tuple[str, str]] = set()
    for loss in losses:
        rule, name = loss.code, loss.name
        if loss.severity > Severity.INFO:  # losses of severity info do not change the behavior
            declared.add((rule, name))
            if rule in BLOCKS and not name:
                declared |= {(rule, block) for block in _list_blocks_at(robot, loss)}
        if rule in MASS:
            made.massy = True
            made.heavy |= {joint.name for joint in _get_parent_joints(robot, name)}
        if rule in MOTION or (rule == "lossy-floating" and _is_moved_by_parents(robot, name)):
            made.motion.add(name)
            joint = robot.joint.get(name)
            if joint is not None:
                below = {joint.child, *robot.tree.list_descendants(joint.child)}
                made.frames |= below
                made.shapes |= below
                made.heavy |= {j.name for link in below for j in _get_parent_joints(robot, link)}
                made.massy = True
        if rule in LIMITS:
            made.limits.add(name)
        if rule in FRAMES:
            made.frames.add(name)
        if rule in MIMIC:
            made.mimic.add(name)
        if rule in SHAPES:
            made.shapes.add(name)
        if rule in COLORS:
            made.colors.add(name)
    made.declared = DeclaredLosses(frozenset(declared))
    return made


def _list_blocks_at(robot: Robot, loss: Finding) -> Iterator[str]:
    """Yield the reference of the ``<gazebo>`` block in which a loss occurred."""
    for block in robot.gazebo:
        element, place = block.element, loss.location
        same = element.place.path == place.path
        if same and element.start <= place.start < element.end:
            yield block.reference or ""


def _is_moved_by_parents(robot: Robot, name: str) -> bool:
    """Tell whether joints above move the parent of a joint, which a free link does not follow."""
    joint = robot.joint.get(name)
    return joint is not None and any(
        not j.is_fixed for j in _get_parent_joints(robot, joint.parent)
    )


def _get_parent_joints(robot: Robot, link: str) -> list[Joint]:
    chain = []
    for name in (link, *robot.tree.list_ancestors(link)):
        joint = robot.tree.get_parent_joint(name)
        if joint is not None:
            chain.append(joint)
    return chain
