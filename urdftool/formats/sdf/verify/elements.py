"""Comparison of copied elements: lights, projectors, batteries, nested models, loop joints."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ....compare.check import Check
from ....model.appearance import APPEARANCE
from ....model.block_elements import list_model_elements, list_part_elements
from ....model.elements import Joint, Link, Robot
from ....model.kinematics import link_poses
from ....model.read import parse_numbers
from ....model.settings import JOINT_TAGS, LINK_TAGS, LUMPING_TAGS, OF_JOINTS, SURFACE
from ....source.document import Element
from .declared_losses import BLOCKS, MOTION
from .facts import EXACT, Facts, compare_facts, format_value, get_facts
from .frames import Array, invert_pose, make_pose, make_pose_of_six
from .pair import Pair

OTHER_ROWS = frozenset(
    ("sensor", "plugin", "visual", "collision", "material", "velocity_decay", "inertial", "pose",
     "parent", "child", "axis", "axis2", "physics", "static", "link", "joint", "frame",
     "allow_auto_disable", "placement_frame", *JOINT_TAGS, *LINK_TAGS,
     *LUMPING_TAGS, "canonicalBody")
)  # fmt: skip
"""Tags that other rows compare, or that SDF does not have."""


PLACED = ("collision", "visual", "joint")
"""Elements whose values are compared, except those of the robot."""

TABLES = {"collision": SURFACE, "visual": APPEARANCE, "joint": OF_JOINTS}
"""Values that the robot holds."""

CHILDREN = frozenset(("parent", "child", "sensor", "plugin"))
"""Children that other rows compare."""

ELSEWHERE = (
    *("material/pbr/metal/albedo_map", "material/script/", "axis/mimic", "axis/xyz"),
    *(f"axis/limit/{name}" for name in ("lower", "upper", "effort", "velocity")),
    *("axis/dynamics/damping", "axis/dynamics/friction"),
)
"""Beginnings of paths that other rows compare."""


def compare_elements(pair: Pair) -> Check:
    """Compare the elements of blocks that are copied unchanged."""
    check = Check("other elements", "lights, projectors, batteries, and what else is copied", EXACT)
    left = list(_list_written(pair))
    expected = list(_list_expected(pair))
    check.is_empty = not (left or expected)
    for owner, name, element in expected:
        about = f"<{element.tag}> of '{name}'" if name else f"<{element.tag}>"
        known = pair.declared.has_for(BLOCKS, name)
        alike = [one for one in left if one[0] == owner and one[1].tag == element.tag]
        expected_facts = get_facts(element, without=("pose",))
        alike.sort(key=lambda one: _get_unlike(one[1], expected_facts))
        if not alike:
            check.compare(
                np.inf,
                f"{about} is missing",
                known=known or pair.declared.has_for(BLOCKS, ""),
            )
            continue
        left.remove(alike[0])
        found = get_facts(alike[0][1], without=("pose",))
        compare_facts(check, about, found, expected_facts, known=known)
        _compare_pose(pair, check, about, owner, name, alike[0][1], element, known)
    for owner, element in left:
        check.compare(np.inf, f"<{element.tag}> of '{owner}' is not in the description")
    _compare_loops(pair, check)
    for kind in PLACED:
        _compare_rest(pair, check, kind)
    return check


def _get_unlike(element: Any, expected_facts: Facts) -> int:
    found = get_facts(element, without=("pose",))
    return sum(found.get(path) != value for path, value in expected_facts.items())


def _list_written(pair: Pair) -> Iterator[tuple[str, Any]]:
    model = pair.where.model
    own = {pair.get_joint(joint.name) for joint in pair.robot.joints}
    for owner, node in (("", model), *((e.get("name", ""), e) for e in model)):
        if owner and node.tag != "link" and not (node.tag == "joint" and owner in own):
            continue
        for element in node:
            if isinstance(element.tag, str) and element.tag not in OTHER_ROWS:
                yield owner, element


def _list_expected(pair: Pair) -> Iterator[tuple[str, str, Element]]:
    """Yield the copied elements, with their owner in the file and name in the description."""
    for element in list_model_elements(pair.robot):
        if element.tag not in OTHER_ROWS:
            yield "", "", element
    parts: list[Link | Joint] = [*pair.robot.links, *pair.robot.joints]
    for part in parts:
        if isinstance(part, Link):
            held = pair.place(part.name)
            if held is None:
                continue
            owner = held[0]
        else:
            owner = pair.get_joint(part.name)
            if owner not in pair.joints or part.name in pair.robot.link:
                continue
        for element in list_part_elements(pair.robot, part):
            if element.tag not in OTHER_ROWS:
                yield owner, part.name, element


def _compare_pose(
    pair: Pair,
    check: Check,
    about: str,
    owner: str,
    name: str,
    found: Any,
    element: Element,
    known: bool,
) -> None:
    link = pair.robot.link.get(name)
    child = found.find("pose")
    if (
        link is None
        or owner not in pair.bodies
        or (child is None and not element.find_child("pose"))
    ):
        return
    held = pair.place(name)
    if held is None:
        return
    place = invert_pose(held[1]) @ pair.where.get_local(owner, found)
    off = float(np.abs(place - _get_pose_of_element(pair, link, element)).max())
    check.compare(off, f"{about} is at another pose", known=known)


def _compare_loops(pair: Pair, check: Check) -> None:
    """Compare the loop-closing joints of blocks."""
    elements = {e.get("name", ""): e for e in pair.where.model.findall("joint")}
    own = {pair.get_joint(joint.name) for joint in pair.robot.joints}
    for block in list_model_elements(pair.robot):
        if block.tag != "joint":
            continue
        check.is_empty = False
        name = block.get("name") or ""
        known = pair.declared.has_for(BLOCKS, "")
        names = [n for n in elements if n not in own and (n == name or n.startswith(f"{name}_"))]
        own |= set(names[:1])
        if not names:
            check.compare(np.inf, f"joint '{name}' of a loop is missing", known=known)
            continue
        made = elements[names[0]]
        expected_facts = get_facts(block, without=("parent", "child"))
        compare_facts(
            check,
            f"joint '{name}' of a loop",
            get_facts(made, without=("parent", "child")),
            expected_facts,
            known=known,
        )
        if made.get("type") != block.get("type"):
            check.compare(np.inf, f"joint '{name}' of a loop has another type")
        for end in ("parent", "child"):
            child = block.find_child(end)
            text = child.text.strip() if child is not None else ""
            held = pair.place(text.rpartition("::")[2])
            found = (made.findtext(end) or "").strip()
            if held is not None and found not in (text, held[0], pair.link(text)):
                check.compare(np.inf, f"{end} of joint '{name}' of a loop is '{found}'")
    for name in elements.keys() - own:
        known = pair.declared.has_for(MOTION, name.removesuffix("_x"), name.removesuffix("_y"))
        check.compare(np.inf, f"joint '{name}' is not in the description", known=known)


def _compare_rest(pair: Pair, check: Check, kind: str) -> None:
    """Compare the values of all collisions, visuals or joints that the robot does not hold."""
    held = {path for row in TABLES[kind] for path in (row.path, row.also)}
    found = {
        (owner, path, value)
        for owner, element in _list_nodes(pair, kind)
        for path, value in get_facts(element, without=("geometry", "pose", *CHILDREN)).items()
        if path not in held and not path.startswith(ELSEWHERE)
    }
    expected = {
        (owner, path, value): name
        for name, owner, facts in _list_raw(pair, kind)
        for path, value in facts.items()
        if path not in held and not path.startswith(ELSEWHERE)
    }
    check.is_empty = check.is_empty and not (found or expected)
    for item in found ^ expected.keys():
        owner, path, value = item
        known = pair.declared.has_for(BLOCKS, expected.get(item, owner))
        what = "not in the description" if item in found else "missing"
        text = f"{kind} of '{owner}': {path} {format_value(value)} is {what}"
        check.compare(np.inf, text, known=known)


def _list_nodes(pair: Pair, kind: str) -> Iterator[tuple[str, Any]]:
    """Yield elements of the file with the name of their link or joint."""
    if kind == "joint":
        own = {pair.get_joint(joint.name) for joint in pair.robot.joints}
        for node in pair.where.model.findall("joint"):
            if node.get("name") in own:
                yield node.get("name", ""), node
        return
    for link in pair.where.model.findall("link"):
        for node in link.findall(kind):
            yield link.get("name", ""), node


def _list_raw(pair: Pair, kind: str) -> Iterator[tuple[str, str, Facts]]:
    """Yield values in blocks for parts of a kind, with the names in description and file."""
    if kind == "joint":
        for joint in pair.robot.joints:
            name = pair.get_joint(joint.name)
            for element in list_part_elements(pair.robot, joint) if name in pair.joints else ():
                if element.tag in ("physics", "axis", "axis2"):
                    yield joint.name, name, _add_prefix(element)
        return
    for link in pair.robot.links:
        shapes = link.collisions if kind == "collision" else link.visuals
        held = pair.place(link.name) if shapes else None
        for facts in _list_facts(pair, kind, link) if held is not None else ():
            yield link.name, held[0] if held is not None else "", facts


def _list_facts(pair: Pair, kind: str, link: Link) -> Iterator[Facts]:
    """Yield the values that blocks give the collisions or visuals of a link."""
    elements = list(list_part_elements(pair.robot, link))
    yield from (get_facts(element) for element in elements if element.tag == kind)
    materials = [element for element in elements if element.tag == "material"]
    if kind == "visual" and materials and materials[-1].children:
        yield _add_prefix(materials[-1])
    retro = link.surface.get("laser_retro")
    if kind == "visual" and retro is not None and not pair.options.classic:
        yield {"laser_retro": (float(retro.content),)}  # type: ignore[arg-type]


def _add_prefix(element: Element) -> Facts:
    return {f"{element.tag}/{path}": value for path, value in get_facts(element).items()}


def _get_pose_of_element(pair: Pair, part: Link | Joint, element: Element) -> Array:
    """Return the pose of an element of a block in the frame of its link."""
    child = element.find_child("pose")
    values = parse_numbers(child.text, 6) if child is not None else None
    pose = make_pose_of_six(values) if values is not None else np.eye(4)
    frame = child.get("relative_to") if child is not None else None
    if frame and isinstance(part, Link) and frame in pair.robot.link:
        placed = _compute_poses(pair.robot)
        pose = invert_pose(placed[part.name]) @ placed[frame] @ pose
    return pose


def _compute_poses(robot: Robot) -> dict[str, Array]:
    """Return the poses of links with all joints at zero, 4 × 4."""
    return {n: make_pose(p.rotation, p.translation) for n, p in link_poses(robot).items()}
