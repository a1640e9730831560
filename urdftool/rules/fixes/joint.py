"""Fixes of joints."""

from __future__ import annotations

import math
from collections import Counter

from ...model.elements import Joint, Limit
from ...model.pose import norm
from ...model.read import number
from ..joint.range import says_unlimited
from ..rule import Problem
from .proposal import (
    Around,
    Proposal,
    after,
    attribute_at,
    drop,
    element_at,
    figures,
    is_computed,
    may_vary,
    meant,
    put,
    remove,
    replace,
    safe,
    to_write,
    unsafe,
)

_FAR, _FARTHEST = 100.0, 1e4  # [m]


def unknown_joint_type(problem: Problem, around: Around) -> Proposal | None:
    """The type that was meant."""
    joint, word = around.joint(problem), to_write(problem)
    if word not in ("revolute", "continuous", "prismatic", "fixed", "floating", "planar"):
        return None
    if "type" not in joint.element.attributes or " or " in problem.message:
        return None
    return unsafe(f"make it {word}", put(joint.element, "type", word))


def redundant_on_fixed(problem: Problem, around: Around) -> Proposal | None:
    """Remove what means nothing, where the joint is fixed whatever the arguments are."""
    element = element_at(problem)
    if element is None or is_computed(around.joint(problem).element, "type"):
        return None
    return safe(f"take the <{element.tag}> away", remove(element))


def axis_not_unit(problem: Problem, around: Around) -> Proposal | None:
    """Write the same direction at unit length.

    PyBullet takes the axis as it is written: at length 2 a revolute joint accelerates by half, and
    a prismatic one moves by twice its position.
    """
    joint = around.joint(problem)
    if joint.axis is None:
        return None
    length = norm(joint.axis.xyz)
    unit = figures((part / length for part in joint.axis.xyz), 17)
    return unsafe(f'write xyz="{unit}"', put(joint.axis.element, "xyz", unit))


def axis_omitted(problem: Problem, around: Around) -> Proposal | None:
    """Write the default, where no argument puts another axis there."""
    joint = around.joint(problem)
    behind = joint.child_element or joint.parent_element
    if behind is None or may_vary(joint.element):
        return None
    return safe('write <axis xyz="1 0 0"/>', after(behind, '<axis xyz="1 0 0"/>'))


def axis_nearly_canonical(problem: Problem, around: Around) -> Proposal | None:
    """Along x, y or z."""
    joint = around.joint(problem)
    if joint.axis is None:
        return None
    sizes = [abs(part) for part in joint.axis.xyz]
    place = sizes.index(max(sizes))
    sign = "-1" if joint.axis.xyz[place] < 0 else "1"
    snapped = " ".join(sign if i == place else "0" for i in range(3))
    return unsafe(f'write xyz="{snapped}"', put(joint.axis.element, "xyz", snapped))


def rpy_in_degrees(problem: Problem, around: Around) -> Proposal | None:
    """The same angles in radians."""
    found = attribute_at(problem)
    if found is None or "looks like degrees" not in problem.message:
        return None
    element, name = found
    text = _radians([float(word) for word in (element.get(name) or "").split()])
    return unsafe(f'write rpy="{text}"', put(element, name, text))


def _radians(degrees: list[float]) -> str:
    return figures((math.radians(value) for value in degrees), 9)


def missing_limit(problem: Problem, around: Around) -> Proposal | None:
    """A revolute joint without stops is continuous."""
    joint = around.joint(problem)
    if joint.type != "revolute":
        return None
    return unsafe("make it continuous", put(joint.element, "type", "continuous"))


def limit_without_effort_or_velocity(problem: Problem, around: Around) -> Proposal | None:
    """What most joints of its type have; a fixed joint needs none."""
    joint = around.joint(problem)
    limit = joint.limit
    if limit is None:
        return None
    if joint.is_fixed:
        if is_computed(joint.element, "type"):
            return None
        return safe("take the <limit> of the fixed joint away", remove(limit.element))
    changes, said = [], []
    for name in ("effort", "velocity"):
        if name not in limit.element.attributes:
            value = _usual(around, joint, name)
            if value is None:
                return None
            changes.append(put(limit.element, name, value))
            said.append(f'{name}="{value}"')
    if not changes:
        return None
    return unsafe(f"write {' and '.join(said)}, as at its other joints", *changes)


def _usual(around: Around, joint: Joint, name: str) -> str | None:
    """The limit that the robot's other joints of one type have most often, as it is written."""
    counts: Counter[str] = Counter()
    for other in around.robot.joints:
        limit = other.limit
        if other is joint or limit is None or other.is_fixed:
            continue
        if (other.type == "prismatic") != (joint.type == "prismatic"):
            continue
        text = limit.element.get(name)
        value = number(text)
        if text is not None and value is not None and value > 0:
            counts[text] += 1
    return counts.most_common(1)[0][0] if counts else None


def limit_without_bounds(problem: Problem, around: Around) -> Proposal | None:
    """Make a revolute joint without stops continuous; write 0 for one bound that is missing.

    Readers differ on what a missing bound is: pinocchio and urdfdom read 0, PyBullet reads an upper
    one as -1, and MuJoCo takes a joint with one bound for one without limits.
    """
    joint = around.joint(problem)
    if joint.limit is None:
        return None
    element = joint.limit.element
    missing = [name for name in ("lower", "upper") if name not in element.attributes]
    if len(missing) == 2:
        if joint.type != "revolute":
            return None
        return unsafe("make it continuous", put(joint.element, "type", "continuous"))
    return unsafe(f'write {missing[0]}="0"', put(element, missing[0], "0"))


def continuous_with_bounds(problem: Problem, around: Around) -> Proposal | None:
    """Without bounds."""
    limit = around.joint(problem).limit
    if limit is None:
        return None
    names = [name for name in ("lower", "upper") if name in limit.element.attributes]
    return unsafe(f"take {' and '.join(names)} out", *(drop(limit.element, name) for name in names))


def _bounds(joint: Joint) -> tuple[Limit, float, float] | None:
    limit = joint.limit
    if limit is None or limit.lower is None or limit.upper is None:
        return None
    return limit, limit.lower, limit.upper


def lower_above_upper(problem: Problem, around: Around) -> Proposal | None:
    """The two swapped; a joint without limits, as PyBullet says it, is continuous."""
    joint = around.joint(problem)
    found = _bounds(joint)
    if found is None:
        return None
    element = found[0].element
    if says_unlimited(*found[1:]):
        if joint.type != "revolute":
            return None
        return unsafe(
            "make it continuous",
            put(joint.element, "type", "continuous"),
            drop(element, "lower"),
            drop(element, "upper"),
        )
    lower, upper = element.get("lower") or "", element.get("upper") or ""
    return unsafe("swap the two", put(element, "lower", upper), put(element, "upper", lower))


def locked_by_limits(problem: Problem, around: Around) -> Proposal | None:
    """A joint that cannot leave 0 is fixed; but one that something drives is not."""
    joint = around.joint(problem)
    found = _bounds(joint)
    if found is None or found[1] != 0.0 or joint.mimic is not None:
        return None
    robot = around.robot
    driven = {part.name for t in robot.transmissions for part in t.joints}
    driven |= {part.name for control in robot.ros2_controls for part in control.joints}
    driven |= {other.mimic.joint for other in robot.joints if other.mimic is not None}
    if joint.name in driven or robot.extensions.get(joint.name):
        return None
    return unsafe("make it fixed", put(joint.element, "type", "fixed"))


def limit_in_degrees(problem: Problem, around: Around) -> Proposal | None:
    """The same range in radians; a number that means none is no limit."""
    joint = around.joint(problem)
    limit = joint.limit
    if limit is None:
        return None
    element = limit.element
    if "means none" in problem.message:
        sentinels = [value for value in (limit.lower, limit.upper) if value is not None]
        if len(sentinels) < 2 or min(map(abs, sentinels)) < 1e3:
            return None
        return unsafe(
            "make it continuous",
            put(joint.element, "type", "continuous"),
            drop(element, "lower"),
            drop(element, "upper"),
        )
    if "looks like degrees" not in problem.message:
        return None
    changes = [
        put(element, name, _radians([value]))
        for name, value in (("lower", limit.lower), ("upper", limit.upper))
        if value
    ]
    return unsafe("write them in radians", *changes)


def prismatic_in_millimetres(problem: Problem, around: Around) -> Proposal | None:
    """The thousandth, of what is too far for metres and not for a number that means none."""
    found = attribute_at(problem)
    joint = around.joint(problem)
    if found is None:
        return None
    element, name = found
    if name == "xyz":
        values = [float(word) / 1000 for word in (element.get("xyz") or "").split()]
        if not _FAR / 1000 <= max(map(abs, values)) <= _FARTHEST / 1000:
            return None
        text = figures(values, 12)
        return unsafe(f'write xyz="{text}"', put(element, "xyz", text))
    if joint.limit is None:
        return None
    if not _FAR <= max(abs(joint.limit.lower or 0.0), abs(joint.limit.upper or 0.0)) <= _FARTHEST:
        return None
    changes = [
        put(element, bound, figures([value / 1000], 12))
        for bound, value in (("lower", joint.limit.lower), ("upper", joint.limit.upper))
        if value
    ]
    return unsafe("write them in metres", *changes)


def limit_rounded_outward(problem: Problem, around: Around) -> Proposal | None:
    """Rounded towards zero."""
    found = attribute_at(problem)
    if found is None:
        return None
    element, name = found
    value = number(element.get(name))
    if value is None:
        return None
    turns = math.floor(abs(value) / (math.pi / 2))
    inside = math.copysign(math.floor(turns * math.pi / 2 * 1e4) / 1e4, value)
    return unsafe(f'write {name}="{inside:g}"', put(element, name, f"{inside:.9g}"))


def negative_limit(problem: Problem, around: Around) -> Proposal | None:
    """Without its sign."""
    found = attribute_at(problem)
    if found is None:
        return None
    element, name = found
    text = (element.get(name) or "").strip().removeprefix("-")
    return unsafe(f'write {name}="{text}"', put(element, name, text))


def negative_dynamics(problem: Problem, around: Around) -> Proposal | None:
    """Without its sign."""
    return negative_limit(problem, around)


def empty_dynamics(problem: Problem, around: Around) -> Proposal | None:
    """None at all."""
    dynamics = around.joint(problem).dynamics
    if dynamics is None or dynamics.element.attributes:
        return None
    return safe("take the empty <dynamics> out", remove(dynamics.element))


def dynamics_as_child_elements(problem: Problem, around: Around) -> Proposal | None:
    """Write attributes; MuJoCo loads the joint without damping and friction until then."""
    dynamics = around.joint(problem).dynamics
    if dynamics is None:
        return None
    element = dynamics.element
    written = {child.tag: " ".join(child.text.split()) for child in element.children}
    if not written or len(written) < len(element.children) or element.attributes:
        return None
    known = {"damping", "friction"}
    if not written.keys() <= known or any(number(text) is None for text in written.values()):
        return None
    line = "<dynamics " + " ".join(f'{k}="{v}"' for k, v in written.items()) + "/>"
    return unsafe(f"write {line}", replace(element, (line,)))


def mimic_unknown_joint(problem: Problem, around: Around) -> Proposal | None:
    """The joint that was meant."""
    joint = around.joint(problem)
    if joint.mimic is None:
        return None
    name = meant(problem, joint.mimic.joint)
    if not name or name == joint.name:
        return None
    return unsafe(f"mimic '{name}'", put(joint.mimic.element, "joint", name))


def mimic_chain(problem: Problem, around: Around) -> Proposal | None:
    """Follow the first leader, with the multipliers multiplied.

    It is the same motion, and another constraint in MuJoCo, which ties the joint to another one.
    """
    joint = around.joint(problem)
    mimic = joint.mimic
    leader = around.robot.joint.get(mimic.joint) if mimic is not None else None
    if mimic is None or leader is None or leader.mimic is None:
        return None
    multiplier = mimic.multiplier * leader.mimic.multiplier
    offset = mimic.multiplier * leader.mimic.offset + mimic.offset
    changes = [put(mimic.element, "joint", leader.mimic.joint)]
    for name, value, default in (("multiplier", multiplier, 1.0), ("offset", offset, 0.0)):
        if value != default or name in mimic.element.attributes:
            changes.append(put(mimic.element, name, figures([value], 15)))
    return unsafe(f"mimic '{leader.mimic.joint}'", *changes)


def mimic_limits_inconsistent(problem: Problem, around: Around) -> Proposal | None:
    """Lower the limits of the leader to what its follower can do.

    The limits of the follower are those of the hardware, and are not raised.
    """
    joint = around.joint(problem)
    mimic = joint.mimic
    leader = around.robot.joint.get(mimic.joint) if mimic is not None else None
    if mimic is None or leader is None or not mimic.multiplier:
        return None
    own, other = _bounds(joint), _bounds(leader)
    if own is None or other is None:
        return None
    ends = sorted((value - mimic.offset) / mimic.multiplier for value in own[1:])
    low, high = max(ends[0], other[1]), min(ends[1], other[2])
    if low >= high:
        return None
    changes = []
    if low > other[1]:
        changes.append(put(other[0].element, "lower", figures([low])))
    if high < other[2]:
        changes.append(put(other[0].element, "upper", figures([high])))
    return unsafe(f"limit '{leader.name}' to {low:g} … {high:g}", *changes)


def soft_limits_lock_joint(problem: Problem, around: Around) -> Proposal | None:
    """The hard limits."""
    joint = around.joint(problem)
    found, safety = _bounds(joint), joint.safety_controller
    if found is None or safety is None or found[1] >= found[2]:
        return None
    element = found[0].element
    return unsafe(
        "write the limits of the joint",
        put(safety.element, "soft_lower_limit", (element.get("lower") or "").strip()),
        put(safety.element, "soft_upper_limit", (element.get("upper") or "").strip()),
    )


def soft_limits_outside_hard(problem: Problem, around: Around) -> Proposal | None:
    """The hard limits, where the soft ones are beyond."""
    joint = around.joint(problem)
    found, safety = _bounds(joint), joint.safety_controller
    if found is None or safety is None:
        return None
    element, changes = found[0].element, []
    if safety.soft_lower_limit < found[1]:
        lower = (element.get("lower") or "").strip()
        changes.append(put(safety.element, "soft_lower_limit", lower))
    if safety.soft_upper_limit > found[2]:
        upper = (element.get("upper") or "").strip()
        changes.append(put(safety.element, "soft_upper_limit", upper))
    return unsafe("write the limits of the joint", *changes)
