"""Support of the robot at home: which links carry it, and whether its root is therefore free."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Set
from dataclasses import dataclass
from itertools import takewhile
from pathlib import PurePath

from ...listing import list_first
from ...model.drives import get_commanded_joints
from ...model.elements import Joint, Link
from ...model.kinematics import link_poses
from ...model.pose import Pose, rotate
from .base_pose import compute_level_poses
from .rigid_tree import RigidTree
from .shape_box import Bounds, ShapeBoxes
from .support import compute_center

LEVEL = 0.05
"""Height above the lowest point, relative to the size, up to which a rigid body is a support."""

CLEARANCE = 0.01
"""Height above the lowest point, relative to the size, up to which the root body is a support.

Less than ``LEVEL``, so that a root close to the ground does not count as a support.
"""

UPRIGHT = 0.3
"""Maximum vertical component of the unit axis of a wheel."""

CENTERED = 0.2
"""Maximum offset of a wheel from its axis and deviation from round, relative to its box height."""

ALIGNED = 0.95
"""Minimum x or y component of a wheel's axis for which the box shows the width of the wheel."""

FEET = frozenset(("leg", "foot", "feet", "toe", "ankle", "calf", "shank"))
"""Words in the names of the last links of legs."""

ROTORS = frozenset(("rotor", "propeller", "prop"))
"""Words in the names of links that lift a robot which flies; motors have rotors, too."""

_OF_ROTORS = frozenset(("front", "back", "rear", "left", "right", "top", "bottom", "upper", "lower",
                        "fl", "fr", "bl", "br", "rl", "rr", "cw", "ccw", "link"))  # fmt: skip
"""Other words in the names of rotors that lift a robot, in addition to its own name and numbers."""

FLYING = frozenset(("quadrotor", "quadcopter", "hexarotor", "hexacopter", "multirotor",
                    "multicopter", "drone", "uav", "flying"))  # fmt: skip
"""Words in the name of a robot, or of its file, that flies."""

LEGS = FEET | {"knee", "hip", "thigh", "wheel", "track"}
HANDS = frozenset(("hand", "gripper", "finger", "fingertip", "thumb", "index", "ring", "pinky",
                   "palm", "wrist", "arm", "forearm", "upperarm", "tool"))  # fmt: skip
"""Words in the names of links that do not support a robot, unless a word of ``LEGS`` occurs."""


@dataclass(frozen=True)
class Ground:
    """Geometry near the ground, in the frame of the root.

    Attributes:
        box: Bounding box of the collision geometry [m].
        boxes: Boxes of the shapes, by the topmost link of the rigid body.
        feet: Lowest link of each rigid body, by its topmost link.
    """

    box: Bounds
    boxes: Mapping[str, list[Bounds]]
    feet: Mapping[str, str]

    @property
    def low(self) -> float:
        """Return the lowest point [m]."""
        return self.box[0][2]

    @property
    def size(self) -> float:
        """Return the longest edge of the box [m]."""
        return max(b - a for a, b in zip(*self.box, strict=True))

    def get_lowest(self, body: str) -> float:
        """Return the lowest point of a rigid body [m]; infinity if it has no shapes."""
        return min((low[2] for low, _ in self.boxes.get(body, ())), default=math.inf)

    def get_near(self, level: float) -> list[str]:
        """Return the rigid bodies within ``level`` times the size above the lowest point."""
        return [
            body for body in self.boxes if self.get_lowest(body) <= self.low + level * self.size
        ]


def measure_ground(
    tree: RigidTree,
    boxes: ShapeBoxes,
    positions: Mapping[str, float],
    root: Pose | None = None,
) -> Ground | None:
    """Measure the collision geometry, or the visual geometry if there is none; None without both.

    The root is by default at zero, turned as in the description.
    """
    turned = compute_level_poses if root is None else link_poses
    poses = turned(tree.robot, positions)
    collides = any(link.collisions for link in tree.robot.links)
    found: dict[str, list[Bounds]] = {}
    lows: dict[str, tuple[float, str]] = {}
    for link in tree.robot.links:
        pose = poses[link.name] if root is None else root @ poses[link.name]
        for shape in link.collisions if collides else link.visuals:
            box = boxes.compute_box(shape, pose)
            if box is not None:
                body = tree.group[link.name]
                found.setdefault(body, []).append(box)
                lows[body] = min(lows.get(body, (math.inf, "")), (box[0][2], link.name))
    if not found:
        return None
    feet = {body: name for body, (_, name) in lows.items()}
    return Ground(_get_around(box for group in found.values() for box in group), found, feet)


def explain_free_base(
    tree: RigidTree, boxes: ShapeBoxes, positions: Mapping[str, float]
) -> str | None:
    """Describe the support of a robot with a floating base; None for a fixed base.

    The base floats if the robot stands on a driven wheel or on two wheels; if only bodies that move
    relative to the root reach the ground: on two or more chains, below the center of mass, and not
    named like hands; if two or more chains end in links named like feet or legs; or if it flies, by
    the names of its rotors, its own or that of its file. Chains that begin with the same joints, as
    legs below a waist, count from where they part. A robot without collision geometry has a fixed
    base.
    """
    if not any(link.collisions for link in tree.robot.links):
        return None  # it would fall through the floor
    if flying := _describe_flight(tree):
        return flying
    commanded = get_commanded_joints(tree.robot)
    branches = [j for j in tree.moving if tree.group[j.parent] == tree.root.name]
    may_roll = bool(commanded) or len(branches) > 1
    if not may_roll and any(joint.type in ("floating", "planar") for joint in branches):
        return None  # a joint moves the robot already
    ground = measure_ground(tree, boxes, positions)
    if ground is None:
        return None
    stands, poses = ground.get_near(LEVEL), compute_level_poses(tree.robot, positions)
    wheels = [
        joint.name
        for joint in (tree.moving if may_roll else ())
        if joint.child in stands and joint.type == "continuous"
        if is_wheel(joint, poses[joint.child], ground)
    ]
    driven = [name for name in wheels if name in commanded]
    if driven:
        return f"it has driven wheels {list_first(driven, 4)}"
    if len(wheels) > 1:
        return f"it stands on wheels {list_first(wheels, 4)}"
    return _describe_feet(tree, positions, ground, stands) or _describe_legs(tree)


def describe_feet(tree: RigidTree, boxes: ShapeBoxes, positions: Mapping[str, float]) -> str | None:
    """Describe the feet on which a robot stands at a pose; None if it does not stand on two."""
    ground = measure_ground(tree, boxes, positions)
    if ground is None:
        return None
    return _describe_feet(tree, positions, ground, ground.get_near(LEVEL))


def _describe_feet(
    tree: RigidTree, positions: Mapping[str, float], ground: Ground, stands: list[str]
) -> str | None:
    if tree.root.name in ground.get_near(CLEARANCE):
        return None
    stands = [body for body in stands if body != tree.root.name]
    chains = {body: get_chain(tree, body) for body in stands}
    stands = [body for body in stands if not _is_hand(chains[body])]
    if len({chain[0] for chain in _keep_own({b: chains[b] for b in stands}).values()}) < 2:
        return None
    feet = (
        box for body in stands for box in ground.boxes[body] if box[0][2] <= _compute_top(ground)
    )
    if not _is_above(tree, positions, *_get_around(feet)):
        return None
    lasts = [b for b in stands if not any(b in chains[other][:-1] for other in stands)]
    return f"it stands on {list_first([ground.feet[body] for body in lasts], 4)}"


def _describe_legs(tree: RigidTree) -> str | None:
    """Describe the legs of a robot, by the names of its links, independent of the pose."""
    inner = {tree.group[joint.parent] for joint in tree.moving}
    chains = {
        body: get_chain(tree, body)
        for body, members in tree.members.items()
        if body not in inner and body != tree.root.name and _has_word(members, FEET)
    }
    legs = _keep_first(_keep_own(chains))
    return f"it has legs: {list_first(list(legs), 4)}" if len(legs) > 1 else None


def _describe_flight(tree: RigidTree) -> str | None:
    """Describe the rotors of a robot that flies, or the name that shows it; None for others."""
    robot = tree.robot
    others = _OF_ROTORS | ROTORS | set(_split_words(robot.name))
    rotors = [link.name for link in robot.links if _is_rotor(_split_words(link.name), others)]
    if len(rotors) > 1:
        return f"it has rotors: {list_first(rotors, 4)}"
    stem = "" if robot.source is None else PurePath(robot.source.path).stem
    for name in (robot.name, stem):
        if FLYING & set(_split_words(name)):
            return f"it flies, by its name: {name}"
    return None


def _is_rotor(words: Iterable[str], others: Set[str]) -> bool:
    """Tell whether a name is that of a rotor and of nothing else, such as the motor of a hip."""
    named = {word for word in words if not word.isdigit()}
    return bool(named & ROTORS) and named <= others


def _compute_top(ground: Ground) -> float:
    return ground.low + LEVEL * ground.size


def is_wheel(joint: Joint, pose: Pose, ground: Ground) -> bool:
    """Tell whether a joint rotates a round body about a horizontal axis through its center.

    Args:
        joint: The joint.
        pose: Pose of its child in the frame in which the ground was measured.
        ground: The boxes of the bodies.
    """
    x, y, z = rotate(pose.rotation, joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0))
    length = math.hypot(x, y, z)
    low, high = _get_around(ground.boxes[joint.child])
    height = high[2] - low[2]
    centered = abs((low[2] + high[2]) / 2 - pose.translation[2]) <= CENTERED * height
    along = 0 if abs(y) > abs(x) else 1
    is_aligned = max(abs(x), abs(y)) > ALIGNED * length
    is_round = abs(high[along] - low[along] - height) <= CENTERED * height
    return centered and abs(z) <= UPRIGHT * length and (is_round or not is_aligned)


def find_leg_chains(
    tree: RigidTree, boxes: ShapeBoxes, positions: Mapping[str, float]
) -> dict[str, list[str]]:
    """Find the rigid bodies that end chains near the ground, or are named like feet; one a chain.

    Returns:
        The rigid bodies from the trunk (excluded) to each, by its name.
    """
    ground = measure_ground(tree, boxes, positions)
    near = set() if ground is None else set(ground.get_near(LEVEL))
    inner = {tree.group[joint.parent] for joint in tree.moving}
    chains = {
        body: get_chain(tree, body)
        for body, members in tree.members.items()
        if body not in inner and body != tree.root.name
        if body in near or _has_word(members, FEET)
    }
    return _keep_first(_keep_own({b: chain for b, chain in chains.items() if not _is_hand(chain)}))


def _keep_own(chains: Mapping[str, list[str]]) -> dict[str, list[str]]:
    """Return chains without the bodies that all have, such as a waist above both legs.

    They stay as they are if a rest is not a leg: a single body, as a toe, or named like no part of
    a leg.
    """
    in_step = zip(*chains.values(), strict=False)
    shared = sum(1 for _ in takewhile(lambda bodies: len(set(bodies)) == 1, in_step))
    own = {body: chain[shared:] for body, chain in chains.items()}
    if all(len(chain) > 1 and LEGS & _list_words(chain) for chain in own.values()):
        return own
    return dict(chains)


def _keep_first(chains: dict[str, list[str]]) -> dict[str, list[str]]:
    """Return the first of the chains that begin with the same body."""
    found = {chain[0]: body for body, chain in reversed(chains.items())}
    return {body: chain for body, chain in chains.items() if found[chain[0]] == body}


def _has_word(links: Iterable[Link], words: Set[str]) -> bool:
    """Tell whether the name of a link contains one of some words."""
    return bool(words & _list_words(link.name for link in links))


def _list_words(names: Iterable[str]) -> set[str]:
    return {word for name in names for word in _split_words(name)}


def get_chain(tree: RigidTree, body: str) -> list[str]:
    """Return the topmost links of the rigid bodies from the root (excluded) to a rigid body."""
    chain: list[str] = []
    while body != tree.root.name:
        chain.insert(0, body)
        joint = tree.robot.tree.get_parent_joint(body)
        assert joint is not None
        body = tree.group[joint.parent]
    return chain


def _is_hand(chain: Iterable[str]) -> bool:
    words = _list_words(chain)
    return not words & LEGS and bool(words & HANDS)


def _split_words(name: str) -> list[str]:
    """Split a name into words: ``leftHand_2`` into left and hand."""
    return [word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name)]


def _is_above(
    tree: RigidTree,
    positions: Mapping[str, float],
    low: Iterable[float],
    high: Iterable[float],
) -> bool:
    """Tell whether the center of mass is above a box; true for a robot without mass."""
    poses = compute_level_poses(tree.robot, positions)
    center = compute_center(tree.robot, poses)
    if center is None:
        return True
    (a, b, _), (c, d, _), (x, y, _) = low, high, center
    return a <= x <= c and b <= y <= d


def _get_around(boxes: Iterable[Bounds]) -> Bounds:
    """Return the bounding box of boxes."""
    lows, highs = zip(*boxes, strict=True)
    low, high = ([pick(axis) for axis in zip(*corners, strict=True)]
                 for pick, corners in ((min, lows), (max, highs)))  # fmt: skip
    return (low[0], low[1], low[2]), (high[0], high[1], high[2])
