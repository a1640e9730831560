"""Robots in which ball joints and free bases are chains of hinges and slides.

The reference arithmetic has hinges and slides only. A chain has its axes in the frame of the first
robot in both, so that mass matrices can be compared element by element.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..mechanics.reference import Array, get_origin_matrix
from ..model.elements import Axis, Joint, Link, Robot
from ..model.part import Origin, Vector
from .frames import invert, make_origin
from .pair import Pair

_DIRECTIONS: tuple[Vector, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_TURNS = tuple(("continuous", axis) for axis in _DIRECTIONS)
_SLIDES = tuple(("prismatic", axis) for axis in _DIRECTIONS)
_CHAINS = {"ball": _TURNS, "spherical": _TURNS, "floating": _SLIDES + _TURNS}
SEVERAL = frozenset(_CHAINS)
"""Types of joints that become chains."""

BASE = "free base"
"""Name of the chain of a base."""


def expand_joints(pair: Pair) -> tuple[Robot, Robot, dict[str, str]]:
    """Return both robots with chains in place of matched joints of several positions.

    Returns:
        The robots, and the names of joints of the second by those of the first.
    """
    robots, names = [pair.a.robot, pair.b.robot], dict(pair.joints)
    for x, y in pair.joints.items():
        one, two = pair.a.joints[x], pair.b.joints[y]
        chain = _CHAINS.get(one.type)
        if chain is None or two.type != one.type:
            continue
        _, frame = pair.frames.get(one.child, ("", np.eye(4)))
        origins = get_origin_matrix(one.origin), get_origin_matrix(two.origin) @ invert(frame)
        robots[0] = _replace(robots[0], one, chain, origins[0], np.eye(4))
        robots[1] = _replace(robots[1], two, chain, origins[1], frame)
        del names[x]
        names |= {f"{x}~{i}": f"{y}~{i}" for i in range(len(chain))}
    return robots[0], robots[1], names


def place_root(robot: Robot, root: str, frame: Array) -> Robot:
    """Return a robot whose root is fixed at a pose, 4 × 4, on another link."""
    name = f"{BASE}~~"
    joint = Joint(None, name, "fixed", name, root, origin=make_origin(frame))
    return replace(robot, links=[Link(None, name), *robot.links], joints=[joint, *robot.joints])


def add_free_base(robot: Robot) -> Robot:
    """Return a robot whose root moves by a chain of three slides and three hinges."""
    base = Joint(None, BASE, "floating", f"{BASE}~~~", robot.tree.roots[0].name)
    links = [Link(None, base.parent), *robot.links]
    whole = replace(robot, links=links, joints=[base, *robot.joints])
    return _replace(whole, base, _CHAINS["floating"], np.eye(4), np.eye(4))


def _replace(
    robot: Robot,
    joint: Joint,
    chain: tuple[tuple[str, Vector], ...],
    origin: Array,
    frame: Array,
) -> Robot:
    """Return a robot with a chain in place of a joint."""
    links, joints, parent = (
        list(robot.links),
        [j for j in robot.joints if j is not joint],
        joint.parent,
    )
    at: Origin | None = make_origin(origin)
    for number, (kind, axis) in enumerate(chain):
        name = f"{joint.name}~{number}"
        links.append(Link(None, name))
        joints.append(Joint(None, name, kind, parent, name, origin=at, axis=Axis(None, axis)))
        parent, at = name, None
    name = f"{joint.name}~"
    joints.append(Joint(None, name, "fixed", parent, joint.child, origin=make_origin(frame)))
    return replace(robot, links=links, joints=joints)
