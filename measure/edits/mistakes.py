"""Mistakes planted in edited robots, each of which ``verify --map`` has to find."""

from __future__ import annotations

import random
import re
from pathlib import Path

import urdftool
from urdftool.compare.correspondence import parse_correspondence
from urdftool.compare.declared import compare_declared
from urdftool.compare.rows import ROWS, limit_tolerances

NUMBERS = re.compile(
    r"(<(?:origin|axis|limit|mimic|inertia|mass)\b[^<>]*?\b"
    r'(xyz|rpy|lower|upper|multiplier|offset|ixx|ixy|ixz|iyz|value)=")([^"]*)(")'
)


def plant(data, generator):
    """Change one number or name of a URDF as a mistake would; return the text and what it is."""
    text = data.decode()
    places = [match for match in NUMBERS.finditer(text) if not _is_in_visual(text, match.start())]
    generator.shuffle(places)
    for match in places:
        words = match[3].split()
        index = generator.randrange(len(words))
        value = float(words[index])
        key, tag = match[2], re.match(r"<(\w+)", match[1])[1]
        if key in ("ixy", "ixz", "iyz", "offset", "multiplier") or tag == "axis":
            if abs(value) < 1e-7:
                continue
            new, what = -value, f"sign of {key}"
        elif key in ("xyz", "rpy", "lower", "upper"):
            new, what = value + generator.choice((1e-3, -1e-3)), f"0.001 in {key}"
        else:
            if not value:
                continue
            new, what = value * 1.001, f"0.1 % of {key}"
        words[index] = repr(new)
        changed = text[: match.start(3)] + " ".join(words) + text[match.end(3) :]
        line = text.count("\n", 0, match.start()) + 1
        context = " ".join(text[max(0, match.start() - 60) : match.end() + 90].split())
        return changed, f"{tag}: {what} in line {line}: {context}"
    return None, ""


def _is_in_visual(text, at):
    """Tell whether a place is in something that has no effect on motion: a comment, or a block."""
    before = text[:at]
    if text[at:].startswith("<origin") and before.rfind("<joint ") < before.rfind("<link "):
        return True  # it may be of a shape or body that has no direction
    return any(
        before.rfind(start) > before.rfind(end)
        for start, end in (("<!--", "-->"), ("<gazebo", "</gazebo"), ("<ros2_control", "</ros2_c"))
    )


def has_effect(changed, original):
    """Tell whether a change is one of the mechanism, by the model of both texts."""
    return _describe(changed) != _describe(original)


def _describe(robot):
    found = []
    for joint in robot.joints:
        limit = joint.limit if joint.type in ("revolute", "prismatic") else None
        axis = joint.axis.xyz if joint.axis and joint.has_axis else None
        mimic = joint.mimic and (joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset)
        ends = limit and (limit.lower, limit.upper)
        found.append(
            (joint.name, joint.origin and (joint.origin.xyz, joint.origin.rpy), axis, ends, mimic)
        )
    for link in robot.links:
        body = link.inertial
        if body and (body.mass or (body.inertia and any(body.inertia.six))):
            six = body.inertia.six if body.inertia else ()
            turned = len(set(six[::3])) > 1 or any((six[1], six[2], six[4])) if six else False
            at = body.origin and (body.origin.xyz, turned and body.origin.rpy)
            found.append((link.name, body.mass, at, six))
        for shape in (*link.visuals, *link.collisions):
            at = shape.origin and (shape.origin.xyz, shape.origin.rpy)
            found.append((link.name, at))
    return found


def is_found(robot, edited, text, folder):
    """Tell whether the comparison of a changed result names a difference; None if none is due."""
    path = Path(folder) / "planted.urdf"
    path.write_text(text)
    changed = urdftool.load(path)
    if not has_effect(changed, edited.robot):
        return None
    changed.source.packages = edited.robot.source.packages
    equal = []
    for proof in edited.proofs:
        declared = parse_correspondence(list(enumerate(proof.lines, 1)), 2)
        rows = limit_tolerances(ROWS, declared.tolerance)
        equal.append(compare_declared(robot, changed, declared, rows=rows).is_equal)
    return not all(equal)


def make_generator(name):
    """Return a generator of random numbers for a robot and operation, independent of others."""
    return random.Random(name)
