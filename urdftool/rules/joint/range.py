"""Rules on the range of a joint."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Iterator

from ...model.angles import format_angles
from ...model.elements import Joint, Limit, Link, Robot
from ...model.kinematics import MOVABLE
from ...model.numbers import format_numbers_text, number_text
from ...model.references import has_block
from ..cross_file_references import check_alone
from ..fix import FixContext, Proposal, find_attribute, remove_attribute, set_attribute, unsafe
from ..mesh.link_extents import get_extents
from ..renaming import list_names_in_blocks
from ..rule import ANY_FORMAT, ERROR, INFO, UNSAFE, URDF_AND_SDF, WARNING, Problem, rule
from .idle import is_dummy, is_round_number


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": "swap them with a warning (sdformat 12.3)",
        "mujoco, pybullet": "load the joint without limits",
        "pinocchio": "keeps the empty range",
        "moveit": "keeps the empty range: no state is within bounds",
        "drake": "aborts",
    },
    formats=ANY_FORMAT,
)
def lower_above_upper(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """The lower limit of a joint is above its upper limit.

    Readers treat such limits differently: PyBullet and MuJoCo load the joint without limits, Gazebo
    swaps the limits, Drake aborts, MoveIt cannot plan. In the models of PyBullet ``lower="1"
    upper="-1"`` means no limits; if PyBullet and MuJoCo are the only targets, the finding is an
    info. Such limits are not swapped: a revolute joint without limits is ``continuous``.
    """
    for joint, limit, lower, upper in _iterate_bounded(robot):
        if lower > upper:
            only_these = targets and targets <= {"pybullet", "mujoco"}
            meant = is_pybullet_unlimited(lower, upper) and only_these
            yield Problem(
                joint,
                _describe_inverted_limit(joint, lower, upper),
                at=limit.locate_attribute("lower"),
                severity=INFO if meant else None,
                data={"lower": lower, "upper": upper},
            )


@lower_above_upper.full
def report_inverted_limits(robot: Robot) -> Iterator[Problem]:
    """Report each inverted limit at its element, with 0 for a missing bound."""
    for joint in robot.joints:
        limit = joint.limit
        if joint.is_limited and limit is not None:
            lower, upper = limit.lower or 0.0, limit.upper or 0.0
            if lower > upper:
                message = _describe_inverted_limit(joint, lower, upper)
                yield Problem(joint, message, at=limit, data={"lower": lower, "upper": upper})


def _describe_inverted_limit(joint: Joint, lower: float, upper: float) -> str:
    if joint.xml is None:
        so = "swap them"
    elif is_pybullet_unlimited(lower, upper):
        so = "PyBullet and MuJoCo take the joint as unlimited, other readers do not; "
        so += (
            "make it continuous, or write lower below upper"
            if joint.type == "revolute"
            else "write the range of the joint"
        )
    else:
        so = "PyBullet and MuJoCo ignore such limits; swap them"
    return f"lower limit {lower:g} of joint '{joint.name}' is above its upper limit {upper:g}; {so}"


def is_pybullet_unlimited(lower: float, upper: float) -> bool:
    """Tell whether limits mean no limits in models of PyBullet, such as 1 and -1."""
    return lower in (0.0, 1.0) and upper in (-1.0, 0.0) and lower > upper


@lower_above_upper.fix(UNSAFE)
def swap_bounds(problem: Problem, context: FixContext) -> Proposal | None:
    """Swap the limits, or make a revolute joint continuous if they mean no limits."""
    joint = context.get_joint(problem)
    found = get_bounds(joint)
    if found is None:
        return None
    if is_pybullet_unlimited(*found[1:]):
        return _make_continuous(joint) if joint.type == "revolute" else None
    element = found[0].element
    lower, upper = element.get("lower") or "", element.get("upper") or ""
    changes = set_attribute(element, "lower", upper), set_attribute(element, "upper", lower)
    return unsafe("swap lower and upper", *changes)


def _make_continuous(joint: Joint) -> Proposal | None:
    """Make a joint with two bounds continuous."""
    if joint.limit is None:
        return None
    return unsafe(
        "make it continuous",
        set_attribute(joint.element, "type", "continuous"),
        remove_attribute(joint.limit.element, "lower"),
        remove_attribute(joint.limit.element, "upper"),
    )


def is_locked(joint: Joint) -> bool:
    """Tell whether a joint's lower and upper limit are written and equal."""
    limit = joint.limit
    if limit is None or limit.lower is None:
        return False
    return joint.is_limited and limit.lower == limit.upper


@rule(
    WARNING,
    raised={"mujoco": ERROR},
    effects={
        "mujoco": "ignores the limit: the joint turns freely",
        "pybullet": "holds it in place",
        "gz, gazebo-classic, pinocchio, drake": "keep the two equal limits",
    },
    group="robot",
    formats=ANY_FORMAT,
    pedantic="joints whose velocity limit is 0 too",
)
def locked_by_limits(robot: Robot) -> Iterator[Problem]:
    """The lower and upper limit of a joint are equal.

    MuJoCo ignores such limits, so the joint turns freely, and planners have a variable without
    effect. Make such a joint ``fixed``. A velocity limit of 0 too is intended, and off by default.
    Joints named as a dummy, which move no geometry and at most 1 g, are not reported.
    """
    for joint, limit, lower, upper in _iterate_bounded(robot):
        if lower == upper and not is_dummy(robot, joint):
            named = list_names_in_blocks(robot, joint)
            yield Problem(
                joint,
                f"limits of joint '{joint.name}' are both {lower:g}, so it cannot move; "
                f"{_explain_names(named, joint)}",
                at=limit.locate_attribute("upper"),
                alike=bool(named),
                severity=INFO if limit.velocity == 0.0 else None,
                pedantic=limit.velocity == 0.0,
                data={"position": lower, "named_by": [name for name, _ in named]},
            )


def _explain_names(named: list[tuple[str, str]], joint: Joint) -> str:
    if not named:
        return "make it fixed, or write its range"
    name, where = named[0]
    kind = "it" if name == joint.name else f"link '{name}'"
    return f"write its range; if it is made fixed, <{where}> names {kind}, which Gazebo lumps away"


@locked_by_limits.fix(UNSAFE)
def make_fixed(problem: Problem, context: FixContext) -> Proposal | None:
    """Make a joint fixed if its only position is 0 and nothing drives it."""
    joint = context.get_joint(problem)
    if problem.data["position"] != 0.0 or joint.mimic is not None:
        return None
    robot = context.robot
    driven = {part.name for t in robot.transmissions for part in t.joints}
    driven |= {part.name for control in robot.ros2_controls for part in control.joints}
    driven |= {other.mimic.joint for other in robot.joints if other.mimic is not None}
    if joint.name in driven or has_block(robot, joint.name) or problem.data["named_by"]:
        return None
    check_alone(context, joint.name, robots=False)
    return unsafe("make it fixed", set_attribute(joint.element, "type", "fixed"))


@rule(
    WARNING,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": (
            "take radians: 90 rad is more than 14 turns"
        ),
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake (none)": (
            "keep it as a limit that is never reached"
        ),
    },
    formats=ANY_FORMAT,
    infos=True,
)
def limit_in_degrees(robot: Robot, *, largest: float = 4 * math.pi) -> Iterator[Problem]:
    """A limit of a revolute joint is larger than two turns.

    Angles are in radians. A limit of 90 allows 14 turns, and planners find many solutions for one
    pose. A very large number usually means no limit; the joint should then be ``continuous``. So do
    -100 and 100 where the effort or the velocity is 100, 1000 or 10,000 too. A joint that only
    moves a frame without mass and geometry, such as one of six that give a free robot its pose, is
    not reported. ``largest`` [rad] is the largest limit that is not reported.
    """
    for joint in robot.joints:
        limit = joint.limit
        if joint.type != "revolute" or limit is None or _is_part_of_free_base(robot, joint):
            continue
        lower, upper = limit.lower or 0.0, limit.upper or 0.0
        if max(abs(lower), abs(upper)) <= largest:
            continue
        name = "upper" if abs(upper) > largest else "lower"
        value = upper if name == "upper" else lower
        at = limit.locate_attribute(name)
        what = f"{name} limit {value:g} of joint '{joint.name}'"
        if abs(value) >= 1e3 or is_round_number(joint, value):
            yield Problem(
                joint,
                f"{what} is in effect no limit; make the joint continuous",
                at=at,
                severity=INFO,
                effects=("urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake (none)",),
                data={"limit": value, "unlimited": True},
            )
        elif _is_in_degrees(lower) and _is_in_degrees(upper):
            low, high = math.radians(lower), math.radians(upper)
            yield Problem(
                joint,
                f"{what} looks like degrees; write {low:.5g} to {high:.5g} in radians",
                at=at,
                data={"limit": value, "degrees": True},
            )
        else:
            turns = abs(value) / (2 * math.pi)
            yield Problem(
                joint,
                f"{what} is {turns:.3g} turns; write radians",
                at=at,
                data={"limit": value},
            )


def _is_in_degrees(value: float) -> bool:
    return abs(value) <= 720 and (value * 2).is_integer()


@limit_in_degrees.fix(UNSAFE)
def write_limits_in_radians(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the same range in radians, or make the joint continuous if it has no limits."""
    joint = context.get_joint(problem)
    limit = joint.limit
    if limit is None:
        return None
    if "unlimited" in problem.data:
        bounds = [value for value in (limit.lower, limit.upper) if value is not None]
        return None if len(bounds) < 2 or min(map(abs, bounds)) < 1e3 else _make_continuous(joint)
    if "degrees" not in problem.data:
        return None
    changes = [
        set_attribute(limit.element, name, format_angles([math.radians(value)]))
        for name, value in (("lower", limit.lower), ("upper", limit.upper))
        if value
    ]
    return unsafe("write them in radians", *changes)


@rule(
    INFO,
    default=False,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": "take meters",
    },
    formats=URDF_AND_SDF,
)
def prismatic_in_millimeters(robot: Robot, *, largest: float = 10.0) -> Iterator[Problem]:
    """A limit of a prismatic joint, or the distance of a joint from its parent, is above 10 m.

    Lengths are in meters. Numbers in millimeters make the robot a thousand times too large. A joint
    that only moves a frame without mass and geometry, such as one of six that give a free robot its
    pose, is not reported. A range about as long as a shape of the robot, such as a gantry, is not
    reported either. ``largest`` [m] is the largest length that is not reported.
    """
    for joint, limit, lower, upper in _iterate_bounded(robot):
        if joint.type == "prismatic" and largest < max(abs(lower), abs(upper)) < math.inf:
            if _is_frame_joint(robot, joint) or _has_shape_as_long(robot, upper - lower):
                continue
            name = "upper" if abs(upper) > largest else "lower"
            value = upper if name == "upper" else lower
            yield Problem(
                joint,
                f"{name} limit of joint '{joint.name}' is {value:g} m; "
                f"if it is in millimeters, write {value / 1000:g}",
                at=limit.locate_attribute(name),
                data={"limit": value},
            )
    for joint in robot.joints:
        if joint.origin is None:
            continue
        far = max(joint.origin.xyz, key=abs)
        if abs(far) <= largest:
            continue
        is_gantry = abs(far) < _FAR and _has_shape_as_long(robot, 2 * abs(far))
        if not is_gantry:
            yield Problem(
                joint,
                f"joint '{joint.name}' is {abs(far):g} m from its parent; "
                f"if it is in millimeters, write {far / 1000:g}",
                at=joint.origin.locate_attribute("xyz"),
                data={"distance": abs(far)},
            )


_FAR, _FARTHEST = 100.0, 1e4
"""Numbers between these are lengths in millimeters, and no placeholders for no limit. Chosen, no
source.
"""


@prismatic_in_millimeters.fix(UNSAFE)
def write_limits_in_meters(problem: Problem, context: FixContext) -> Proposal | None:
    """Divide the lengths by 1000."""
    found = find_attribute(problem)
    joint = context.get_joint(problem)
    if found is None:
        return None
    element, name = found
    if name == "xyz":
        values = [float(word) / 1000 for word in (element.get("xyz") or "").split()]
        if not _FAR / 1000 <= max(map(abs, values)) <= _FARTHEST / 1000:
            return None
        text = format_numbers_text(values)
        return unsafe(f'write xyz="{text}"', set_attribute(element, "xyz", text))
    if joint.limit is None:
        return None
    if not _FAR <= max(abs(joint.limit.lower or 0.0), abs(joint.limit.upper or 0.0)) <= _FARTHEST:
        return None
    changes = [
        set_attribute(element, bound, number_text(value / 1000))
        for bound, value in (("lower", joint.limit.lower), ("upper", joint.limit.upper))
        if value
    ]
    return unsafe("write them in meters", *changes)


@rule(
    INFO,
    raised={"moveit": WARNING},
    effects={
        "moveit": "takes the limit as written for the bound of the joint",
    },
    group="robot",
    default=False,
)
def limit_rounded_outward(
    robot: Robot, *, smallest: float = 1e-7, largest: float = 1e-3
) -> Iterator[Problem]:
    """A limit of a revolute joint is slightly beyond a multiple of 90°, because it was rounded up.

    ``3.1416`` is 7e-6 rad beyond a half turn. Planners use this range, but drives may stop there.
    Round limits toward zero: ``3.1415``. A difference between ``smallest`` and ``largest`` [rad] is
    reported.
    """
    for joint, limit, lower, upper in _iterate_bounded(robot):
        if joint.type != "revolute":
            continue
        for name, value in (("lower", lower), ("upper", upper)):
            quarter = math.pi / 2
            turns = math.floor(abs(value) / quarter)
            beyond = abs(value) - turns * quarter
            if turns and smallest < beyond < largest:
                inside = math.copysign(math.floor(turns * quarter * 1e4) / 1e4, value)
                yield Problem(
                    joint,
                    f"{name} limit {value:g} of joint '{joint.name}' exceeds {turns * 90}° "
                    f"by {beyond:.1g} rad; write {inside:g}",
                    at=limit.locate_attribute(name),
                    alike=name,
                    data={"write": f"{inside:.9g}", "beyond": beyond},
                )


@limit_rounded_outward.fix(UNSAFE)
def round_limit_toward_zero(problem: Problem, _context: FixContext) -> Proposal | None:
    """Write the limit rounded toward zero."""
    found = find_attribute(problem)
    if found is None:
        return None
    text = problem.data["write"]
    return unsafe(f'write {found[1]}="{float(text):g}"', set_attribute(*found, text))


@rule(
    INFO,
    default=False,
    on=("moveit",),
    effects={
        "moveit": "takes the whole range: several joint positions give one pose",
    },
    formats=ANY_FORMAT,
)
def range_above_full_turn(robot: Robot) -> Iterator[Problem]:
    """The range of a revolute joint is more than one turn.

    Several joint positions then give the same pose, and a planner may take the longer way.
    """
    for joint, limit, lower, upper in _iterate_bounded(robot):
        if joint.type == "revolute" and 2 * math.pi + 1e-3 < upper - lower < 1e3:
            turns = (upper - lower) / (2 * math.pi)
            yield Problem(
                joint,
                f"range of joint '{joint.name}' is {turns:.3g} turns; "
                "one turn is enough to reach every pose",
                at=limit,
                data={"turns": turns},
            )


@rule(
    INFO,
    default=False,
    effects={
        "gz, gazebo-classic": "spawn the joint at 0, outside its limits",
        "moveit": "reports that a start state at 0 is outside its bounds",
    },
    group="robot",
)
def zero_outside_limits(robot: Robot, *, tolerance: float = 1e-6) -> Iterator[Problem]:
    """The range of a joint does not contain 0.

    Simulators start every joint at 0: the first step pushes the joint back into its range, and a
    planner rejects the start state. Set an ``initial_value`` in ros2_control. The range itself can
    be correct, as of an elbow that cannot be straight. ``tolerance`` [rad or m] is the distance of
    0 from the range that is ignored.
    """
    for joint, limit, lower, upper in _iterate_bounded(robot):
        if joint.mimic is not None or lower > upper:
            continue
        if lower > tolerance or upper < -tolerance:
            name = "lower" if lower > 0 else "upper"
            yield Problem(
                joint,
                f"joint '{joint.name}' cannot be at 0, where simulators start it: "
                f"its range is {lower:g} to {upper:g}",
                at=limit.locate_attribute(name),
                group="{count} joints cannot be at 0, where simulators start them: {names}",
                data={"lower": lower, "upper": upper},
            )


def _is_frame_joint(robot: Robot, joint: Joint) -> bool:
    """Tell whether a joint only positions the next one, as several joints at a free root do."""
    if not robot.memo.get("has bodies", lambda: any(map(_is_body, robot.links))):
        return False  # the robot has only frames
    while joint.child in robot.link and not _is_body(robot.link[joint.child]):
        above = robot.tree.get_parent_joint(joint.parent)
        if above is None or above.type not in MOVABLE:
            return True
        joint = above
    return False


def _is_part_of_free_base(robot: Robot, joint: Joint) -> bool:
    """Tell whether a joint is one of several that give a free robot its pose, or their last."""
    above = robot.tree.get_parent_joint(joint.parent)
    if _is_frame_joint(robot, joint):
        return True
    return above is not None and not above.is_fixed and _is_frame_joint(robot, above)


def _has_shape_as_long(robot: Robot, length: float) -> bool:
    """Tell whether a shape has between half and twice a length [m], as the rail of a slide has."""

    def measure() -> list[float]:
        boxes = map(get_extents(robot).get_shape_box, (shape for _, shape in robot.shapes))
        return sorted(filter(math.isfinite, (max(box.size) for box in boxes if box is not None)))

    lengths = robot.memo.get("lengths of shapes", measure)
    first = bisect_left(lengths, length / 2)
    return length > 0 and first < len(lengths) and lengths[first] <= 2 * length


def _is_body(link: Link) -> bool:
    return bool(link.visuals or link.collisions or link.mass > 0)


def _iterate_bounded(robot: Robot) -> Iterator[tuple[Joint, Limit, float, float]]:
    """Yield revolute and prismatic joints with two valid bounds, their limit and the bounds."""
    for joint in robot.joints:
        found = get_bounds(joint)
        if joint.is_limited and found is not None:
            yield joint, *found


def get_bounds(joint: Joint) -> tuple[Limit, float, float] | None:
    """Get the limit of a joint with its bounds [rad or m], if both are valid numbers."""
    limit = joint.limit
    if limit is None or limit.lower is None or limit.upper is None:
        return None
    return limit, limit.lower, limit.upper
