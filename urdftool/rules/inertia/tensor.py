"""Inertia tensors that no rigid body has, or hardly any."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Inertial, Robot, Vector
from ...model.tensor3 import Six
from ...source.location import Place
from ..rule import ERROR, INFO, WARNING, Problem, rule
from .bodies import bodies, mass_of
from .proposals import remedy_text
from .slips import slip_of
from .solids import solid_text
from .tensors import SIX, is_positive, is_zero, moments_of, tensors

_REJECTED = {
    "gz, gazebo-classic": "reject the model (Error 18)",
    "mujoco": "rejects the file",
    "pybullet": "takes its own inertia instead; with URDF_USE_INERTIA_FROM_FILE, zero",
    "urdfdom, KDL, pinocchio": "take it silently",
}


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": "reject the model (sdformat 12.3: Error 18)",
        "mujoco": "rejects the file",
        "pybullet": "takes its own inertia instead; with URDF_USE_INERTIA_FROM_FILE, zero",
        "urdfdom, KDL, pinocchio": "accept it without a message",
        "drake": "warns, and takes another inertia",
    },
)
def inertia_not_positive_definite(robot: Robot, *, tolerance: float = 1e-6) -> Iterator[Problem]:
    """An inertia tensor has a negative principal moment.

    About that axis the body would turn against the torque. A sign is wrong, or a product of inertia
    is larger than the moments beside it allow.
    """
    for link, inertial, six in tensors(robot):
        moments = moments_of(six)
        if is_zero(six, link.mass) or is_positive(moments, tolerance):
            continue
        if slip_of(link, inertial, six, robot) is not None:
            continue
        yield Problem(
            link,
            f"inertia of link '{link.name}' has a negative principal moment ({_shown(moments)}); "
            f"all three must be positive{remedy_text(link, inertial, six)}",
            at=_component(inertial, six, min(six[0], six[3], six[5])),
        )


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": "reject the model (sdformat 12.3: Error 18)",
        "mujoco": "rejects the file: inertia must satisfy A + B >= C",
        "pybullet": "takes its own inertia instead; with URDF_USE_INERTIA_FROM_FILE, zero",
        "urdfdom, KDL, pinocchio": "accept it without a message",
        "drake": "warns, and takes another inertia",
    },
)
def inertia_triangle_inequality(
    robot: Robot, *, tolerance: float = 1e-6, rounding: float = 0.01
) -> Iterator[Problem]:
    """The largest principal moment is larger than the sum of the other two.

    No rigid body is like that: a moment sums squared distances from its axis, and of three axes at
    right angles each distance counts in two. At best, for a flat plate, the largest equals the sum.
    A radius and a length that were swapped are the usual cause.
    """
    for link, inertial, six in tensors(robot):
        moments = low, middle, high = moments_of(six)
        if low + middle >= high * (1 - rounding) or not is_positive(moments, tolerance):
            continue
        if is_zero(six, link.mass) or slip_of(link, inertial, six, robot) is not None:
            continue
        yield Problem(
            link,
            f"inertia of link '{link.name}' belongs to no rigid body: principal moment "
            f"{high:.4g} is larger than {low:.4g} + {middle:.4g}{remedy_text(link, inertial, six)}",
            at=_component(inertial, six, max(six[0], six[3], six[5])),
        )


@rule(
    INFO,
    raised={"mujoco": ERROR, "gz": ERROR},
    effects={
        "mujoco": "rejects the file",
        "gz, gazebo-classic": "reject the model (sdformat 12.3: Error 18)",
        "pybullet": "takes zero with URDF_USE_INERTIA_FROM_FILE",
        "drake": "warns, and takes another inertia",
        "urdfdom, pinocchio": "accept it without a message",
    },
    group="robot",
)
def inertia_triangle_inequality_rounding(
    robot: Robot, *, tolerance: float = 1e-12, rounding: float = 0.01
) -> Iterator[Problem]:
    """The largest principal moment is larger than the sum of the others by a rounding error.

    For a flat plate the largest moment equals the sum of the others, and a few digits too few push
    it above. Gazebo and MuJoCo allow nothing for that.
    """
    for link, inertial, six in tensors(robot):
        low, middle, high = moments_of(six)
        excess = high - low - middle
        if low >= 0 and tolerance * high < excess <= rounding * high:
            yield Problem(
                link,
                f"principal moment {high:.9g} of link '{link.name}' is larger than the sum of the "
                f"others by {excess:.1g}; write the moments with more digits, or lower the largest",
                at=inertial.inertia,
            )


@rule(
    WARNING,
    raised={"mujoco": ERROR},
    effects={
        "gz, gazebo-classic": "accept it (sdformat 12.3)",
        "mujoco": "rejects a moving body",
        "pinocchio": (
            "keeps the zeros: the mass matrix is singular where the center of mass is on the axis"
        ),
    },
    of_motion=True,
    group="robot",
)
def zero_inertia(robot: Robot) -> Iterator[Problem]:
    """A link has a mass and no inertia: all six numbers are 0.

    That is a point. The slightest torque turns it infinitely fast, so a joint that turns it shakes
    or blows up. What is below the mass times (10 µm)² is rounding, and counts as 0.
    """
    for link, inertial, six in tensors(robot):
        if is_zero(six, link.mass):
            nothing = "as good as zero" if any(six) else "zero"
            yield Problem(
                link,
                f"inertia of link '{link.name}' is {nothing}, though it weighs {link.mass:g} kg"
                f"{solid_text(link) or '; urdftool inertia computes it'}",
                at=inertial.inertia,
            )


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, pybullet, pinocchio, drake": (
            "accept it: nothing resists a turn about that axis"
        ),
        "mujoco": "rejects the file: inertia must have positive eigenvalues",
    },
    group="robot",
)
def singular_inertia(robot: Robot, *, smallest: float = 1e-9) -> Iterator[Problem]:
    """An inertia tensor is zero about one axis.

    Only an infinitely thin rod is like that. About this axis the slightest torque accelerates the
    link beyond all bounds.
    """
    for link, inertial, six in tensors(robot):
        moments = low, middle, high = moments_of(six)
        if (
            is_zero(six, link.mass)
            or high <= 0
            or low > smallest * high
            or not is_positive(moments)
        ):
            continue
        if low + middle < high * 0.99:
            continue
        yield Problem(
            link,
            f"inertia of link '{link.name}' is zero about one axis ({_shown(moments)})"
            f"{solid_text(link)}",
            at=inertial.inertia,
        )


@rule(
    WARNING,
    on=("gazebo-classic", "gz", "mujoco", "pybullet"),
    effects={
        "pybullet": "a force of 1 N·m makes the joint's state invalid at a step of a millisecond",
    },
)
def tiny_moving_inertia(
    robot: Robot, *, smallest: float = 1e-7, lightest: float = 1e-3
) -> Iterator[Problem]:
    """A joint moves a body with next to no inertia.

    A simulator steps in milliseconds. What the smallest force throws over the stop within one step
    shakes, and shakes the robot with it.
    """
    tensor_of = {link.name: (inertial, six) for link, inertial, six in tensors(robot)}
    for name, links in bodies(robot).items():
        joint = robot.tree.parent_joint(name)
        if joint is None or joint.is_fixed:
            continue
        mass = mass_of(links)
        weighty = [link for link in links if link.mass > 0]
        if len(weighty) != 1 or weighty[0].name not in tensor_of:
            continue
        link = weighty[0]
        inertial, six = tensor_of[link.name]
        low = moments_of(six)[0]
        if mass < lightest:
            what = f"weighs {mass:g} kg"
        elif 0 < low < smallest:
            what = f"has a moment of {low:.2g} kg·m²"
        else:
            continue
        yield Problem(
            link,
            f"link '{link.name}' is moved by joint '{joint.name}' and {what}, too little for a "
            f"simulator; write at least {lightest:g} kg and {smallest:g} kg·m²",
            at=inertial.inertia,
        )


def _shown(moments: Vector) -> str:
    return ", ".join(f"{moment:.4g}" for moment in moments)


def _component(inertial: Inertial, six: Six, moment: float) -> Place | None:
    """Where a moment is written, if the moments are the principal ones; else the whole tensor."""
    if inertial.inertia is None:
        return None
    if six[1] or six[2] or six[4]:
        return inertial.inertia.place
    return inertial.inertia.element.attribute_place(SIX[six.index(moment)])
