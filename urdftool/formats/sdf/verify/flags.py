"""Comparison of base, pose, link flags and joint physics."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....compare.check import Check
from ....model.read import parse_numbers
from ....model.settings import OF_LINKS, get_text
from .blocks import get_expected_joint_physics, get_settings_facts, list_elements_of_whole
from .excuses import BLOCKS
from .facts import EXACT, Facts, compare_facts, get_facts, get_value
from .mechanism import Array, make_pose, rotate_by_angles
from .reader import read_pose
from .source import get_pose
from .surfaces import list_own_links

if TYPE_CHECKING:
    from .compare import Pair

NUMBERS = frozenset(
    ("axis/xyz", "axis/limit/lower", "axis/limit/upper", "axis/limit/effort",
     "axis/limit/velocity", "axis/dynamics/damping", "axis/dynamics/friction")
)  # fmt: skip
"""Properties of a joint that other rows compare."""

FLAGS = frozenset(
    ("static", "allow_auto_disable", "enable_wind", "self_collide", "placement_frame")
)
"""Flags of a model."""


def compare_base(pair: Pair) -> Check:
    """Compare whether the robot is static, its pose, and its fixed joints."""
    check = Check("base", "static, pose of the model, joints to the world, kinematic links", EXACT)
    model = pair.where.model
    expected: Facts = {}
    for element in list_elements_of_whole(pair.robot):
        if element.tag in FLAGS:
            expected[element.tag] = get_value(get_text(element))
    found = {tag: get_value(model.findtext(tag)) for tag in FLAGS if model.find(tag) is not None}
    for tag in ("placement_frame",):
        if model.get(tag):
            found[tag] = get_value(model.get(tag))
    known = pair.excuses.declared.has_for(BLOCKS, "")
    compare_facts(check, "the model", found, expected, known=known)
    off = float(np.abs(read_pose(model) - _place(pair)).max())
    check.compare(off, "the model is at another pose", known=known)
    for link, node in list_own_links(pair):
        flags = get_settings_facts(link.settings, [r for r in OF_LINKS if r.name == "kinematic"])
        said = {k: v for k, v in get_facts(node).items() if k == "kinematic"}
        excused = pair.excuses.declared.has_for(BLOCKS, link.name)
        compare_facts(check, f"link '{link.name}'", said, flags, known=excused)
    _compare_held(pair, check)
    return check


def _place(pair: Pair) -> Array:
    """Return the pose of the model: from a block, else from the robot's origin."""
    pose = np.eye(4)
    if pair.robot.base is not None and pair.robot.base.origin is not None:
        return get_pose(pair.robot.base.origin)
    origin = pair.robot.find_child_xml("origin")
    if origin is not None:
        xyz, rpy = (
            parse_numbers(origin.get(name), 3) or (0.0, 0.0, 0.0) for name in ("xyz", "rpy")
        )
        pose = make_pose(rotate_by_angles(rpy), xyz)
    for element in list_elements_of_whole(pair.robot):
        six = parse_numbers(element.text, 6) if element.tag == "pose" else None
        if six is not None:
            pose = make_pose(rotate_by_angles(six[3:]), six[:3])
    return pose


def _compare_held(pair: Pair, check: Check) -> None:
    """Compare which links fixed joints connect, to each other and to the world."""
    group = {name: name for name in ("world", *pair.made.bodies)}

    def top(name: str) -> str:
        while group[name] != name:
            name = group[name]
        return name

    closing = {e.get("name") for e in list_elements_of_whole(pair.robot) if e.tag == "joint"}
    for made in pair.made.joints:
        if made.kind == "fixed" and made.name not in closing:
            group[top(made.child)] = top(made.parent)
    anchored = any(root.name == "world" for root in pair.robot.tree.roots)
    expected: dict[str, str] = {}
    for name in pair.robot.tree.order:
        joint = pair.robot.tree.get_parent_joint(name)
        stays = joint is None or not (joint.is_fixed or joint.name in pair.excuses.motion)
        if joint is not None and joint.parent == "world" and not anchored:
            stays = stays and name != "world"
        expected[name] = name if stays or joint is None else expected[joint.parent]
    seen: dict[str, str] = {}
    owners = {"world": "world"}
    for name, rigid in expected.items():
        frame = pair.made.frames.get(pair.link(name))
        if frame is None or name in pair.excuses.frames:
            continue
        body = top(frame[0])
        if seen.setdefault(rigid, body) != body:
            check.compare(np.inf, f"link '{name}' is not joined to '{rigid}'")
        elif owners.setdefault(body, rigid) != rigid:
            check.compare(np.inf, f"link '{name}' is joined to '{owners[body]}'")


def compare_flags(pair: Pair) -> Check:
    """Compare gravity, damping and wind of links."""
    check = Check("link flags", "gravity, damping of motion, wind", EXACT)
    rows = [row for row in OF_LINKS if row.name not in ("self_collide", "kinematic")]
    paths = {row.path for row in rows}
    for link, element in list_own_links(pair):
        expected = get_settings_facts(link.settings, rows)
        found = {k: v for k, v in get_facts(element).items() if k in paths}
        known = pair.excuses.declared.has_for(BLOCKS, link.name)
        compare_facts(check, f"link '{link.name}'", found, expected, known=known)
    return check


def compare_joint_physics(pair: Pair) -> Check:
    """Compare springs, stops and other joint properties that no other row compares."""
    check = Check("joint physics", "springs, stiffness of limits, stops, feedback", EXACT)
    elements = {e.get("name"): e for e in pair.where.model.findall("joint")}
    for joint in pair.robot.joints:
        element = elements.get(pair.get_joint(joint.name))
        if element is None:
            continue
        expected = get_expected_joint_physics(pair.robot, joint)
        if element.find("axis") is None:
            expected = {k: v for k, v in expected.items() if not k.startswith("axis/")}
        found = get_facts(element, without=("pose", "parent", "child", "sensor", "plugin"))
        found = {k: v for k, v in found.items() if k not in NUMBERS and "/mimic" not in k}
        expected = {k: v for k, v in expected.items() if k not in NUMBERS}
        known = pair.excuses.declared.has_for(BLOCKS, joint.name)
        compare_facts(check, f"joint '{joint.name}'", found, expected, known=known)
    return check
