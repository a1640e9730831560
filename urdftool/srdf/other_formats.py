"""Pairs without collision checks in the formats of other planners and simulators."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence

from ..model.elements import Robot
from ..model.semantic import DisabledPair
from ..source.escape import escape_attribute


def format_mjcf(robot: Robot, pairs: Sequence[DisabledPair]) -> str:
    """Format the pairs as ``<exclude>`` of a file that a model of MuJoCo can include.

    MuJoCo ignores contacts of a body and its parent, except if the parent is fixed to the world;
    pairs of adjacent links are therefore written only for the root's body.
    """
    lines = ["<mujoco>", "  <contact>"]
    for pair in pairs:
        if pair.reason == "Adjacent" and not _is_by_world(robot, pair):
            continue
        names = f'body1="{escape_attribute(pair.link1)}" body2="{escape_attribute(pair.link2)}"'
        lines.append(f"    <exclude {names}/>")
    return "\n".join([*lines, "  </contact>", "</mujoco>", ""])


def _is_by_world(robot: Robot, pair: DisabledPair) -> bool:
    """Tell whether a link of a pair is fixed to the root."""
    roots = {link.name for link in robot.tree.roots}
    return any(robot.tree.bodies.get(name, name) in roots for name in pair.links)


def format_curobo(robot: Robot, pairs: Sequence[DisabledPair]) -> str:
    """Format the pairs as ``self_collision_ignore`` of cuRobo's robot configuration, in YAML.

    JSON strings are strings of YAML, too.
    """
    ignored: dict[str, list[str]] = {}
    for pair in pairs:
        ignored.setdefault(pair.link1, []).append(pair.link2)
    lines = ["robot_cfg:", "  kinematics:", "    self_collision_ignore:"]
    if not ignored:
        lines[-1] += " {}"
    for name, others in ignored.items():
        lines.append(f"      {json.dumps(name)}: {json.dumps(others)}")
    return "\n".join([*lines, ""])


def format_pyroki(robot: Robot, pairs: Sequence[DisabledPair]) -> str:
    """Format the pairs as JSON, for ``user_ignore_pairs`` of pyroki's ``RobotCollision``."""
    lines = [json.dumps([pair.link1, pair.link2]) for pair in pairs]
    return "[\n" + ",\n".join(f"  {line}" for line in lines) + "\n]\n" if lines else "[]\n"


def format_usd(robot: Robot, pairs: Sequence[DisabledPair]) -> str:
    """Format the pairs as a layer for the stage that ``export usd`` writes for the robot.

    Links that are fixed to each other are one body there. Two bodies are a pair if all their links
    with collision geometry are.
    """
    others: dict[str, list[str]] = {}
    root = _make_identifier(robot.name or "robot")
    for one, other in _pair_bodies(robot, pairs):
        others.setdefault(one, []).append(other)
    lines = ["#usda 1.0", "(", f'    defaultPrim = "{root}"', ")", "", f'over "{root}"', "{"]
    for name, targets in others.items():
        paths = ", ".join(f"</{root}/{_make_identifier(target)}>" for target in targets)
        lines += [
            f'    over "{_make_identifier(name)}" (',
            '        prepend apiSchemas = ["PhysicsFilteredPairsAPI"]',
            "    )",
            "    {",
            f"        rel physics:filteredPairs = [{paths}]",
            "    }",
        ]
    return "\n".join([*lines, "}", ""])


def _pair_bodies(robot: Robot, pairs: Sequence[DisabledPair]) -> list[tuple[str, str]]:
    """List the pairs of bodies all of whose links with geometry are pairs, by topmost links."""
    disabled = {pair.links for pair in pairs}
    body_of = robot.tree.bodies
    shaped = {
        top: [name for name in names if robot.link[name].collisions]
        for top, names in robot.tree.body_links.items()
    }
    found: dict[tuple[str, str], None] = {}
    for pair in pairs:
        one, other = body_of.get(pair.link1), body_of.get(pair.link2)
        if one is None or other is None or one == other:
            continue
        if all(frozenset((a, b)) in disabled for a in shaped[one] for b in shaped[other]):
            found[one, other] = None
    return list(found)


def _make_identifier(text: str) -> str:
    """Replace the characters that a prim name cannot have, as ``export usd`` does."""
    name = re.sub(r"[^A-Za-z0-9_]", "_", text)
    return f"_{name}" if name[:1].isdigit() else name


FORMATS: dict[str, Callable[[Robot, Sequence[DisabledPair]], str]] = {
    "mjcf": format_mjcf,
    "curobo": format_curobo,
    "pyroki": format_pyroki,
    "usd": format_usd,
}
"""Formats of pairs next to SRDF, by name."""
