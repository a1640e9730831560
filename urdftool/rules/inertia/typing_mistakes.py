"""Detect typing mistakes that make a tensor physically inconsistent, and the intended values."""

from __future__ import annotations

from collections.abc import Iterator

from ...mechanics.tensor import SymmetricTensor
from ...mechanics.typo_detection import Proposal as Slip
from ...mechanics.typo_detection import infer_intended_moment, is_consistent
from ...model.bounds import Bounds
from ...model.elements import Inertial, Link, Robot
from ...model.pose import make_pose
from ...model.read import number
from ...source.document import Element
from ..fix import FixContext, Proposal, find_attribute, remove_attribute, safe
from ..mesh.link_extents import get_extents
from ..rule import ERROR, INFO, SAFE, UNSAFE, URDF_AND_SDF, WARNING, Problem, rule
from .corrections import write_proposed_inertia
from .proposals import find_proposal, format_tensor
from .solids import compute_solid_tensor
from .tensors import SIX, get_tensors, is_rejected_by_gazebo, is_zero

APPLIES_TO = ("inertia",)

_GAZEBO = "gz, gazebo-classic"


@rule(
    ERROR,
    effects={
        _GAZEBO: "reject the model (sdformat 12.3: Error 18)",
        "mujoco": "rejects the file",
    },
    of_motion=True,
    formats=URDF_AND_SDF,
)
def inertia_component_typo(robot: Robot) -> Iterator[Problem]:
    """The six components of an inertia are in the wrong order.

    URDF lists the tensor row by row: ixx ixy ixz iyy iyz izz. Other programs write the three
    moments first, or all nine components. Pasted in that order the tensor is physically
    inconsistent; in the right order it is valid.
    """
    for link, inertial, six in get_tensors(robot):
        slip = find_slip(link, inertial, six, robot)
        if slip is not None and slip.kind == "order":
            yield Problem(
                link,
                f"components of the inertia of link '{link.name}' are in the wrong order; "
                f"write {format_tensor(slip.tensor)}",
                at=inertial.inertia,
                data={"inertia": list(slip.tensor)},
                effects=["mujoco", *[_GAZEBO] * is_rejected_by_gazebo(robot, link)],
            )


@rule(
    ERROR,
    effects={
        _GAZEBO: "reject the model (sdformat 12.3: Error 18)",
        "mujoco": "rejects the file",
    },
    of_motion=True,
    formats=URDF_AND_SDF,
)
def inertia_off_by_power_of_ten(robot: Robot) -> Iterator[Problem]:
    """One component of an inertia is off by a power of ten.

    The tensor as written is physically inconsistent, and moving the decimal point of a single
    component, in one way only, gives the tensor of a body of the link's size. For a mesh or
    several shapes, a moment is compared with those about the other two axes, in the proportions
    of the bounding box.
    """
    for link, inertial, six in get_tensors(robot):
        slip = find_slip(link, inertial, six, robot)
        if slip is not None and slip.kind == "decimal" and inertial.inertia is not None:
            value = slip.tensor[SIX.index(slip.name)]
            yield Problem(
                link,
                f"{slip.name} of link '{link.name}' is off by a power of ten, which makes the "
                f"inertia physically inconsistent; write {value:.12g}",
                at=inertial.inertia.locate_attribute(slip.name),
                data={"inertia": list(slip.tensor)},
                effects=["mujoco", *[_GAZEBO] * is_rejected_by_gazebo(robot, link)],
            )


inertia_component_typo.fix(UNSAFE)(write_proposed_inertia)
inertia_off_by_power_of_ten.fix(UNSAFE)(write_proposed_inertia)


def find_slip(link: Link, inertial: Inertial, six: SymmetricTensor, robot: Robot) -> Slip | None:
    """Find the mistake that explains a physically inconsistent tensor."""
    if is_zero(six, link.mass) or is_consistent(six):
        return None
    proposal = find_proposal(link, inertial, six)
    if proposal is None:
        proposal = _find_moment_by_box(link, inertial, six, get_extents(robot).get_link_box(link))
    if proposal is None or proposal.kind not in ("order", "decimal"):
        return None
    return proposal


def _find_moment_by_box(
    link: Link, inertial: Inertial, six: SymmetricTensor, box: Bounds | None
) -> Slip | None:
    """Find the one moment off by a power of ten, by the other two and the bounding box.

    Returns:
        None for a single solid shape, whose tensor is known, for components that xacro computes,
        and if the axes of the inertial are oblique to those of the link.
    """
    if compute_solid_tensor(link) is not None or _is_computed(inertial):
        return None
    rotation = make_pose(inertial.origin).rotation
    if box is None or any(0.1 < abs(entry) < 0.9 for row in rotation for entry in row):
        return None
    x, y, z = (
        sum(abs(part) * length for part, length in zip(column, box.size, strict=True))
        for column in zip(*rotation, strict=True)
    )
    return infer_intended_moment(link.mass, six, (x, y, z))


def _is_computed(inertial: Inertial) -> bool:
    """Tell whether an inertia is written as xacro expressions."""
    if inertial.inertia is None:
        return False
    place = inertial.inertia.place
    return b"${" in place.file.data[place.start : place.end]


@rule(
    WARNING,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": (
            "ignore them and take ixy, ixz, iyz"
        ),
    },
    pedantic="a lower half that repeats the upper one",
)
def redundant_inertia_attributes(robot: Robot) -> Iterator[Problem]:
    """An ``<inertia>`` has ``iyx``, ``izx`` or ``izy``.

    The tensor is symmetric and readers take only the upper half. If the lower half has other
    values, another matrix was intended. If the upper half lacks the component, the attribute has
    the wrong name. A lower half that repeats the upper is an info, and off by default.
    """
    for link in robot.links:
        if link.inertial is None or link.inertial.inertia is None:
            continue
        element = link.inertial.inertia.element
        for name, twin in _TWINS.items():
            if name not in element.attributes:
                continue
            repeats = _repeats_twin(element, name)
            if repeats:
                remedy = "remove it"
            elif twin in element.attributes:
                remedy = f"its value differs from {twin}, which is read; write one of them"
            else:
                remedy = f"rename it to {twin}, which is missing"
            yield Problem(
                link,
                f"readers ignore {name} in the inertia of link '{link.name}'; {remedy}",
                at=element.locate_attribute(name),
                severity=INFO if repeats else None,
                pedantic=repeats,
                effects=None if twin in element.attributes else (),
                data={"twin": twin, "repeats": repeats},
            )


_TWINS = {"iyx": "ixy", "izx": "ixz", "izy": "iyz"}


def _repeats_twin(element: Element, name: str) -> bool:
    """Tell whether ``iyx``, ``izx`` or ``izy`` has the value of its twin in the upper half."""
    mine, its = (number(element.attributes.get(one)) for one in (name, _TWINS[name]))
    return mine is not None and mine == its


@redundant_inertia_attributes.fix(SAFE)
def remove_repeated_product(problem: Problem, _context: FixContext) -> Proposal | None:
    """Remove an attribute that repeats the one that is read."""
    found = find_attribute(problem)
    if found is None or not problem.data["repeats"]:
        return None
    return safe(f"remove {found[1]}", remove_attribute(*found))
