"""Check that inertia tensors are physically consistent and not singular."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...mechanics.tensor import (
    ROUNDING,
    WRITTEN_ROUNDING,
    SymmetricTensor,
    compute_principal_moments,
)
from ...model.attached import find_attached_links, is_fixed_to_world
from ...model.elements import Inertial, Link, Robot, Vector
from ...model.kinematics import MOVABLE, get_limits, get_zero_poses
from ...model.pose import Pose
from ...source.location import Place
from ..fix import FixContext, Proposal, set_attribute, unsafe
from ..rule import ANY_FORMAT, ERROR, INFO, UNSAFE, WARNING, Problem, rule
from ..symmetry import find_twin
from .bodies import compute_body_inertia, compute_mass, find_rigid_bodies
from .corrections import MASS_IN_DOUBT, write_inertia_of_shapes, write_meant_inertia
from .joint_inertia import compute_highest_damping, compute_joint_inertia
from .proposals import describe_remedy, get_recompute_hint
from .solids import describe_solid, get_solid_kind
from .tensors import (
    EXACT,
    SIX,
    compute_rounding,
    get_tensors,
    is_positive,
    is_rejected_by_gazebo,
    is_rejected_by_mujoco,
    is_zero,
)
from .typing_mistakes import find_slip

_GAZEBO = "gz, gazebo-classic"
_PART = "gz, gazebo-classic (part)"
_NOT_GAZEBO = ("mujoco", "pybullet", "urdfdom, KDL, pinocchio", "drake")


@rule(
    ERROR,
    effects={
        _GAZEBO: "reject the model (sdformat 12.3: Error 18)",
        "mujoco": "rejects the file",
        "pybullet": "uses its own inertia instead; with URDF_USE_INERTIA_FROM_FILE, zero",
        "urdfdom, KDL, pinocchio": "accept it without a message",
        "drake": "warns, and uses another inertia",
        "newton": "warns, and raises the moments",
    },
    group="robot",
    formats=ANY_FORMAT,
)
def inertia_not_positive_definite(
    robot: Robot, *, tolerance: float = ROUNDING
) -> Iterator[Problem]:
    """An inertia tensor has a negative principal moment.

    About that axis the body would rotate against the torque. A sign is wrong, or a product of
    inertia is too large for the moments of its axes.
    """
    for link, inertial, six in get_tensors(robot):
        moments = compute_principal_moments(six)
        if is_zero(six, link.mass) or is_positive(six, tolerance):
            continue
        if find_slip(link, inertial, six, robot) is not None:
            continue
        remedy = describe_remedy(link, inertial, six)
        yield Problem(
            link,
            f"inertia of link '{link.name}' has a negative principal moment "
            f"({_format_moments(moments)}); all three must be positive{remedy}",
            at=_find_component(inertial, six, min(six[0], six[3], six[5])),
            effects=[*_NOT_GAZEBO, "newton", *[_GAZEBO] * is_rejected_by_gazebo(robot, link)],
            data={"moments": list(moments)},
        )


@rule(
    ERROR,
    effects={
        _GAZEBO: "reject the model (sdformat 12.3: Error 18)",
        "mujoco": "rejects the file",
        "pybullet": "uses its own inertia instead; with URDF_USE_INERTIA_FROM_FILE, zero",
        "urdfdom, KDL, pinocchio": "accept it without a message",
        "drake": "warns, and uses another inertia",
        "newton": "warns, and raises the moments",
    },
    group="robot",
    formats=ANY_FORMAT,
)
def inertia_triangle_inequality(
    robot: Robot, *, tolerance: float = ROUNDING, rounding: float = WRITTEN_ROUNDING
) -> Iterator[Problem]:
    """The largest principal moment is larger than the sum of the other two.

    Such a tensor is physically inconsistent: a moment sums squared distances from its axis, and
    each distance counts in two of three perpendicular axes. The limit is a flat plate, whose
    largest moment equals the sum. Usually a radius and a length were swapped. An excess of at most
    ``rounding`` (relative) that the written digits explain is reported by
    ``inertia-triangle-inequality-rounding`` instead.
    """
    for link, inertial, six in get_tensors(robot):
        moments = low, middle, high = compute_principal_moments(six)
        excess = high - low - middle
        if excess <= tolerance * high or not is_positive(six, tolerance):
            continue
        if inertial.inertia is None:
            continue
        if excess <= min(rounding * high, compute_rounding(inertial.inertia)):
            continue
        if is_zero(six, link.mass) or find_slip(link, inertial, six, robot) is not None:
            continue
        shown = [f"{value:.4g}" for value in (high, low, middle)]
        if float(shown[0]) <= float(shown[1]) + float(shown[2]):
            shown = [f"{value:.9g}" for value in (high, low, middle)]
        yield Problem(
            link,
            f"inertia of link '{link.name}' is physically inconsistent: principal moment "
            f"{shown[0]} is larger than {shown[1]} + {shown[2]}"
            f"{describe_remedy(link, inertial, six)}",
            at=_find_component(inertial, six, max(six[0], six[3], six[5])),
            effects=[*_NOT_GAZEBO, "newton", *[_GAZEBO] * is_rejected_by_gazebo(robot, link)],
            data={"moments": list(moments)},
        )


inertia_not_positive_definite.fix(UNSAFE, rests_on=MASS_IN_DOUBT)(write_meant_inertia)
inertia_triangle_inequality.fix(UNSAFE, rests_on=MASS_IN_DOUBT)(write_meant_inertia)


@rule(
    INFO,
    raised={"mujoco": ERROR, "gz": ERROR},
    effects={
        "mujoco": "rejects the file",
        _GAZEBO: "reject the model (sdformat 12.3: Error 18)",
        _PART: "accept it: the inertia of the whole rigid body is consistent",
        "pybullet": "takes zero with URDF_USE_INERTIA_FROM_FILE",
        "drake": "warns, and uses another inertia",
        "urdfdom, KDL, pinocchio": "accept it without a message",
    },
    group="robot",
    formats=ANY_FORMAT,
)
def inertia_triangle_inequality_rounding(
    robot: Robot, *, tolerance: float = EXACT, rounding: float = WRITTEN_ROUNDING
) -> Iterator[Problem]:
    """The largest principal moment exceeds the sum of the others by a rounding error.

    For a flat plate the largest moment equals the sum of the others, and too few digits can make
    it larger. Gazebo and MuJoCo have no tolerance for that. The number of written digits decides
    which excess is rounding; a larger one is reported as ``inertia-triangle-inequality``.
    """
    for link, inertial, six in get_tensors(robot):
        moments = low, middle, high = compute_principal_moments(six)
        excess = high - low - middle
        if inertial.inertia is None or low < 0 or excess <= tolerance * high:
            continue
        explained = min(rounding * high, compute_rounding(inertial.inertia))
        if excess <= max(explained, ROUNDING * high):
            yield Problem(
                link,
                f"principal moment {high:.9g} of link '{link.name}' exceeds the sum of the others "
                f"by {excess:.1g}; write the moments with more digits, or lower the largest",
                at=inertial.inertia,
                effects=[*_NOT_GAZEBO, _GAZEBO if is_rejected_by_gazebo(robot, link) else _PART],
                data={"moments": list(moments), "excess": excess},
            )


@inertia_triangle_inequality_rounding.fix(UNSAFE)
def enlarge_moments(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the excess to each moment, which keeps the principal axes.

    PyBullet replaces any tensor that violates the inequality by zero, however small the excess.
    """
    inertial = context.get_link(problem).inertial
    if inertial is None or inertial.inertia is None:
        return None
    xx, xy, xz, yy, yz, zz = inertial.inertia.six
    excess, high = problem.data["excess"], problem.data["moments"][2]
    for factor in (1.0, 1.5, 2.0, 4.0):
        more = factor * (excess + 1e-9 * high)
        moments = [float(f"{value + more:.10g}") for value in (xx, yy, zz)]
        shown = [float(f"{value:.10g}") for value in (xy, xz, yz)]
        a, b, c = compute_principal_moments(
            (moments[0], shown[0], shown[1], moments[1], shown[2], moments[2])
        )
        if c <= a + b:
            break
    else:
        return None
    element = inertial.inertia.element
    changes = [
        set_attribute(element, name, f"{value + more:.10g}")
        for name, value in (("ixx", xx), ("iyy", yy), ("izz", zz))
    ]
    written = " ".join(f'{change.name}="{change.value}"' for change in changes)
    return unsafe(f"increase each moment by {factor * excess:.1g}: write {written}", *changes)


@rule(
    WARNING,
    raised={"mujoco": ERROR},
    effects={
        "gz, gazebo-classic (accepted)": "accept it (sdformat 12.3)",
        "gz, gazebo-classic (noise)": "reject the model (sdformat 12.3: Error 18)",
        "mujoco": "rejects the file",
        "pinocchio": ("keeps the zeros, which can make the mass matrix singular"),
    },
    of_motion=True,
    group="robot",
    formats=ANY_FORMAT,
)
def zero_inertia(
    robot: Robot, targets: frozenset[str], *, part: float = 0.25, first: float = 0.1
) -> Iterator[Problem]:
    """A rigid body has a mass and no inertia: all six components are 0.

    The body is a point, which any torque accelerates infinitely. Only the inertia of the whole
    rigid body counts: a point mass that is fixed to a link with an inertia is added to it, and one
    that is fixed to the world never rotates. A link with at least ``part`` of the mass of such a
    body is an info, because the body's inertia is then too small; the link that the joint moves
    needs ``first`` of the mass, and is a warning, and so is a link whose mirror image has one.

    Values below the mass times (10 µm)² are rounding, and count as 0. MuJoCo reads every link
    before it merges them: it then treats six zeros as no inertia, and rejects nonzero moments below
    1e-14 kg·m².
    """
    zero = [found for found in get_tensors(robot) if is_zero(found[2], found[0].mass)]
    if not zero:
        return
    whole = {link.name: links for links in find_rigid_bodies(robot).values() for link in links}
    for link, inertial, six in zero:
        links = whole.get(link.name, [link])
        is_part = len(links) > 1 and not compute_body_inertia(robot, links).is_thin
        joint = robot.tree.get_parent_joint(links[0].name)
        leads = link is links[0] and joint is not None and not joint.is_fixed
        twin = _find_complete_twin(robot, link)
        least = (first if leads else part) * compute_mass(links)
        if (is_part and twin is None and link.mass < least) or is_fixed_to_world(robot, link):
            continue
        amount = "almost zero" if any(six) else "zero"
        in_gazebo = "noise" if is_rejected_by_gazebo(robot, link) else "accepted"
        moves = not is_part and joint is not None and not joint.is_fixed
        rejected = is_rejected_by_mujoco(six) or (moves and not any(six))
        mild = INFO if is_part and not leads and twin is None else WARNING
        yield Problem(
            link,
            f"inertia of link '{link.name}' is {amount} with a mass of {link.mass:g} kg"
            f"{describe_solid(link)}",
            at=inertial.inertia,
            hint=get_recompute_hint(robot, link),
            severity=None if rejected and "mujoco" in targets else mild,
            effects=[
                f"gz, gazebo-classic ({in_gazebo})",
                *["mujoco"] * rejected,
                *["pinocchio"] * (not is_part and joint is not None),
            ],
            alike=(any(six), get_solid_kind(link)),
        )


def _find_complete_twin(robot: Robot, link: Link) -> Link | None:
    """Find the mirror image of a link, if it has an inertia."""
    twin = find_twin(robot, link)
    inertia = twin.inertial.inertia if twin is not None and twin.inertial is not None else None
    return twin if inertia is not None and twin and not is_zero(inertia.six, twin.mass) else None


@zero_inertia.full
def report_every_zero_inertia(robot: Robot) -> Iterator[Problem]:
    """Report each link with a mass and no inertia, also if that is harmless.

    It is harmless for a link that is fixed to the world, or to links with an inertia.
    """
    for link, inertial, six in get_tensors(robot):
        if is_zero(six, link.mass):
            amount = "almost zero" if any(six) else "zero"
            members = [one for one, _ in find_attached_links(robot, link)]
            is_part = len(members) > 1 and not compute_body_inertia(robot, members).is_thin
            is_held = is_fixed_to_world(robot, link)
            why = f" with a mass of {link.mass:g} kg{describe_solid(link)}"
            if is_part:
                why = ", but the links that it is fixed to have one"
            elif is_held:
                why = ", but the link is fixed to the world and never rotates"
            yield Problem(
                link,
                f"inertia of link '{link.name}' is {amount}{why}",
                at=inertial.inertia,
                hint="" if is_part or is_held else get_recompute_hint(robot, link),
                data={"is_harmless": is_part or is_held},
            )


_SINGULAR = {
    "gz, gazebo-classic, pinocchio, drake": "accept it",
    "gz, gazebo-classic (tilted)": "reject the model if rounding makes the zero negative "
    "(sdformat 12.3: Error 18)",
    "pinocchio, drake (tilted)": "accept it",
    "pybullet": "uses its own inertia instead; with URDF_USE_INERTIA_FROM_FILE, keeps the zero",
    "mujoco": "rejects the file: inertia must have positive eigenvalues",
}


@rule(
    WARNING,
    raised={"mujoco": ERROR},
    effects=_SINGULAR,
    group="robot",
    formats=ANY_FORMAT,
)
def singular_inertia(
    robot: Robot, targets: frozenset[str], *, smallest: float = 1e-9
) -> Iterator[Problem]:
    """A rigid body's inertia tensor is zero about one axis.

    Only an infinitely thin rod has such a tensor: any torque about this axis accelerates the body
    infinitely. Parts that are fixed to a link with an inertia, or to the world, are not reported,
    except for MuJoCo, which rejects the file for any link with a moment below 1e-14 kg·m².
    """
    for link, inertial, six in get_tensors(robot):
        if not _is_singular(six, link.mass, smallest):
            continue
        rejected = is_rejected_by_mujoco(six)
        if _is_harmless(robot, link, smallest) and not (rejected and "mujoco" in targets):
            continue
        yield Problem(
            link,
            _describe_singular(link, six),
            at=inertial.inertia,
            severity=None if rejected else WARNING,
            effects=_list_singular_effects(six, rejected),
            alike=get_solid_kind(link),
            data={"moments": list(compute_principal_moments(six))},
        )


def _list_singular_effects(six: SymmetricTensor, rejected: bool) -> list[str]:
    """List the readers that a rod concerns; it is tilted if it has products of inertia."""
    keys = ["pybullet", "mujoco"] if rejected else ["pybullet"]
    if six[1] or six[2] or six[4]:
        return ["gz, gazebo-classic (tilted)", "pinocchio, drake (tilted)", *keys]
    return ["gz, gazebo-classic, pinocchio, drake", *keys]


@singular_inertia.full
def report_every_singular_inertia(robot: Robot) -> Iterator[Problem]:
    """Report each link whose inertia is zero about one axis, also if that is harmless."""
    smallest = singular_inertia.thresholds["smallest"]
    for link, inertial, six in get_tensors(robot):
        if _is_singular(six, link.mass, smallest):
            yield Problem(
                link,
                _describe_singular(link, six),
                at=inertial.inertia,
                data={"is_harmless": _is_harmless(robot, link, smallest)},
            )


def _is_singular(six: SymmetricTensor, mass: float, smallest: float) -> bool:
    """Tell whether a consistent tensor is almost zero about one axis."""
    low, middle, high = compute_principal_moments(six)
    if is_zero(six, mass) or high <= 0 or low > smallest * high or not is_positive(six):
        return False
    return low + middle >= high * 0.99


def _is_harmless(robot: Robot, link: Link, smallest: float) -> bool:
    """Tell whether a link is fixed to the world, or part of a body with inertia."""
    body = next((links for links in find_rigid_bodies(robot).values() if link in links), [link])
    return _is_fixed_to_more(robot, body, smallest) or is_fixed_to_world(robot, link)


def _describe_singular(link: Link, six: SymmetricTensor) -> str:
    shown = _format_moments(compute_principal_moments(six))
    return f"inertia of link '{link.name}' is zero about one axis ({shown}){describe_solid(link)}"


def _is_fixed_to_more(robot: Robot, links: list[Link], smallest: float) -> bool:
    """Tell whether the body of several links has an inertia about every axis."""
    if len(links) == 1:
        return False
    least, _, most = compute_principal_moments(compute_body_inertia(robot, links).tensor)
    return least > smallest * most


zero_inertia.fix(UNSAFE, rests_on=MASS_IN_DOUBT)(write_inertia_of_shapes)
singular_inertia.fix(UNSAFE, rests_on=MASS_IN_DOUBT)(write_inertia_of_shapes)


@rule(
    WARNING,
    on=("gazebo-classic", "gz", "mujoco", "pybullet"),
    evidence="PyBullet and MuJoCo diverge at the bounds of the page "
    "(`tests/rules/test_tiny_inertia.py`)",
)
def tiny_moving_inertia(
    robot: Robot,
    targets: frozenset[str],
    *,
    smallest: float = 1e-7,
    lightest: float = 1e-3,
    timestep: float = 0.001,
) -> Iterator[Problem]:
    """A joint moves a very small inertia with too much damping or effort for the time step.

    A small inertia alone is harmless: PyBullet and MuJoCo simulated a link of 1e-13 kg·m² for two
    seconds against its limits, at steps of 1 ms and 4 ms, and position motors hold it. Two things
    make it diverge. PyBullet integrates damping explicitly and begins to oscillate at
    I = d·Δt/2 (measured at d = 0.001 to 0.1 and 1 to 5 ms, within 1 %); MuJoCo does so only
    with RK4, at I = 0.36·d·Δt. An effort E moves the joint by E·Δt²/I within a step; a
    controller that updates the effort at each step and reaches E at an error of 0.1 rad settles if
    that is 0.01 rad and oscillates if it is 0.1 rad, in both simulators.

    I is the inertia about the joint axis of everything below the joint, in series with that of
    everything above it; for a prismatic joint the mass. Joints below ``smallest`` [kg·m²] or
    ``lightest`` [kg] are reported if their effort limit moves them over their whole range, or one
    revolution, within one ``timestep`` [s], and with the target pybullet if their damping is too
    large.
    """
    poses: dict[str, Pose] | None = None
    whole: dict[str, list[Link]] = {}
    for joint in robot.joints:
        if joint.type not in MOVABLE or joint.child not in robot.link:
            continue
        slides = joint.type == "prismatic"
        most = lightest if slides else smallest
        if poses is None:
            whole = find_rigid_bodies(robot)
        links = whole.get(joint.child, [])
        if not any(link.mass > 0 for link in links) or not _may_be_below(links, most, slides):
            continue
        poses = poses or get_zero_poses(robot)
        inertia = compute_joint_inertia(robot, joint, poses) if joint.child in poses else 0.0
        if not 0 < inertia < most:
            continue
        damping = joint.get_resistance("damping")
        effort = joint.get_magnitude("effort") or 0.0
        lower, upper = get_limits(joint)
        reach = min(upper - lower, math.inf if slides else 2 * math.pi)
        unit, force, way = ("kg", "N", "m") if slides else ("kg·m²", "N·m", "rad")
        quantity = "mass" if slides else "inertia"
        thrown = effort * timestep**2 / inertia
        if "pybullet" in targets and damping > compute_highest_damping(inertia, timestep):
            least = damping * timestep / 2
            lowered = "damping"
            why = (
                f"its damping {damping:g} makes it oscillate in PyBullet at {timestep * 1e3:g} ms "
                "steps"
            )
        elif 0 < reach < thrown:
            least = effort * timestep**2 / reach
            lowered = "effort limit"
            why = (
                f"its effort limit of {effort:g} {force} moves it by {thrown:.2g} {way} within a "
                f"time step of {timestep * 1e3:g} ms"
            )
        else:
            continue
        link = next(link for link in links if link.mass > 0)
        yield Problem(
            link,
            f"joint '{joint.name}' moves only {inertia:.2g} {unit}, and {why}. Raise the "
            f"{quantity} of link '{link.name}' above {least:.2g} {unit}, or lower the {lowered}",
            at=(link.inertial.inertia or link.inertial) if link.inertial is not None else None,
            data={"joint": joint.name, "inertia": inertia, "least": least},
        )


def _may_be_below(links: list[Link], most: float, slides: bool) -> bool:
    """Tell whether the child body of a joint may have so little inertia, without its axis."""
    if slides:
        return compute_mass(links) < most
    tensors_of = [link.inertial.inertia for link in links if link.inertial is not None]
    lows = [compute_principal_moments(one.six)[0] for one in tensors_of if one is not None]
    return min(lows, default=0.0) < most


def _format_moments(moments: Vector) -> str:
    least = 1e-12 * max(map(abs, moments))  # smaller values are errors of the computation
    return ", ".join(f"{moment if abs(moment) > least else 0.0:.4g}" for moment in moments)


def _find_component(inertial: Inertial, six: SymmetricTensor, moment: float) -> Place | None:
    """Find where a principal moment is written; the whole tensor if the axes are others."""
    if inertial.inertia is None:
        return None
    if six[1] or six[2] or six[4]:
        return inertial.inertia.place
    return inertial.inertia.locate_attribute(SIX[six.index(moment)])
