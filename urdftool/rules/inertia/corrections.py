"""Changes that write an ``<inertial>``: the probably intended one, or that of the geometry."""

from __future__ import annotations

import math
import re

from ...mechanics.tensor import SymmetricTensor, rotate_tensor
from ...mechanics.typo_detection import is_consistent
from ...model.elements import Inertia, Inertial, Link, Vector
from ...model.link import COMPONENTS
from ...model.pose import make_pose, transpose
from ..fix import (
    Change,
    FixContext,
    Lines,
    Proposal,
    depends_on_arguments,
    format_numbers,
    is_computed,
    prepend_child,
    set_attribute,
    unsafe,
)
from ..rule import Problem
from .proposals import find_proposal, format_tensor
from .solids import DENSITY, compute_box, compute_solid_tensor, compute_volume, get_only_shape

_SMALL = (0.01, 1e-6)
"""Mass [kg] and moments [kg·m²] for a frame to which a simulator requires a mass."""

MASS_IN_DOUBT = (
    *("zero-mass", "negative-mass", "implausible-mass", "implausible-density", "mass-outlier"),
    *("immense-number", "not-a-number"),
)
"""Rules that doubt a mass: no inertia is computed from it before."""


def make_inertial(link: Link, context: FixContext) -> tuple[float, Lines] | None:
    """Compute the ``<inertial>`` of a link from its geometry, at the density of water.

    Returns:
        Its mass [kg] and its lines; None if the geometry does not determine them.
    """
    if depends_on_arguments(link.element, "visual", "collision"):
        return None
    shape = get_only_shape(link)
    volume = compute_volume(shape.geometry) if shape is not None else 0.0
    if shape is not None and volume > 0:
        mass, pose = DENSITY * volume, make_pose(shape.origin)
        made = Link(link.element, link.name, visuals=link.visuals, collisions=link.collisions)
        made.inertial = Inertial(link.element, shape.origin, mass)
        six = compute_solid_tensor(made)
        if six is None:
            return None
        rpy = format_numbers(shape.origin.rpy) if shape.origin is not None else ""
        is_turned = shape.origin is not None and any(shape.origin.rpy)
        is_alike = max(six[0], six[3], six[5]) == min(six[0], six[3], six[5])
        rpy = rpy if is_turned and not is_alike else ""
        return mass, _format_inertial(mass, format_numbers(pose.translation), six, rpy)
    found = _compute_mass_properties(link, context)
    if found is None:
        return None
    mass, center, six = found
    return mass, _format_inertial(mass, format_numbers(center, 6), six)


def give_small_inertial(link: Link) -> Proposal | None:
    """Propose an ``<inertial>`` of a few grams for a frame without one."""
    if link.inertial is not None or not link.is_frame:
        return None
    mass, moment = _SMALL
    lines = _format_inertial(mass, "0 0 0", (moment, 0.0, 0.0, moment, 0.0, moment))
    what = f"add a mass of {mass * 1000:g} g with moments of inertia of {moment:g} kg·m²"
    return unsafe(what, prepend_child(link.element, *lines))


def _format_inertial(mass: float, center: str, six: SymmetricTensor, rpy: str = "") -> Lines:
    turn = f' rpy="{rpy}"' if rpy else ""
    return (
        "<inertial>",
        *([f'\t<origin xyz="{center}"{turn}/>'] if center != "0 0 0" or turn else []),
        f'\t<mass value="{mass:.6g}"/>',
        f"\t<inertia {format_tensor(six)}/>",
        "</inertial>",
    )


def _compute_mass_properties(
    link: Link, context: FixContext
) -> tuple[float, Vector, SymmetricTensor] | None:
    """Compute mass [kg], center of mass [m] and tensor [kg·m²] of a link from its meshes."""
    if context.compute_inertia is None:
        return None
    return context.compute_inertia(context.robot, [link.name]).get(link.name)


def write_meant_inertia(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the probably intended inertia; otherwise that of the geometry at the link's mass."""
    link = context.get_link(problem)
    inertial = link.inertial
    if inertial is None or inertial.inertia is None:
        return None
    return correct_slip(link, inertial, inertial.inertia) or write_inertia_of_shapes(
        problem, context
    )


def correct_slip(link: Link, inertial: Inertial, inertia: Inertia) -> Proposal | None:
    """Write the tensor that a single mistake explains."""
    slip = find_proposal(link, inertial, inertia.six)
    return None if slip is None else write_tensor(link, slip.tensor)


def write_inertia_of_shapes(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the inertia of the geometry at the link's mass, and the center if none is written."""
    link = context.get_link(problem)
    inertial = link.inertial
    if inertial is None or not inertial.mass or inertial.mass <= 0 or inertial.inertia is None:
        return None
    if any(is_computed(inertial.inertia.element, name) for name in COMPONENTS):
        return None  # avoids reading meshes in vain
    if depends_on_arguments(link.element):
        return None
    shape = get_only_shape(link)
    six = compute_solid_tensor(link)
    if six is not None and shape is not None and shape.geometry is not None:
        what = f"of a solid {shape.geometry.element.tag}"
        why = f"write the inertia {what} of {inertial.mass:g} kg"
        return write_tensor(link, six, why, make_pose(shape.origin).translation)
    found = _compute_mass_properties(link, context)
    if found is None:
        return None
    mass, center, tensor = found
    scale = inertial.mass / mass
    here = rotate_tensor(
        tuple(value * scale for value in tensor),  # type: ignore[arg-type]
        transpose(make_pose(inertial.origin).rotation),
    )
    return write_tensor(
        link, here, f"write the inertia of its geometry at {inertial.mass:g} kg", center
    )


def write_proposed_inertia(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the inertia that the rule proposes, ``data["inertia"]``."""
    xx, xy, xz, yy, yz, zz = problem.data["inertia"]
    return write_tensor(context.get_link(problem), (xx, xy, xz, yy, yz, zz))


def write_tensor(
    link: Link, six: SymmetricTensor, why: str = "", center: Vector | None = None
) -> Proposal | None:
    """Write the components of a tensor that differ, and the center of mass.

    Args:
        link: The link.
        six: The tensor about the center of mass, along the axes of the inertial [kg·m²].
        why: Description of the change; the components if empty.
        center: Center of mass in the link frame [m]; None to keep it.
    """
    inertial = link.inertial
    if inertial is None or inertial.inertia is None or not is_consistent(six):
        return None
    why = f"{why}: {format_tensor(six)}" if why else f"write {format_tensor(six)}"
    element = inertial.inertia.element
    least = 1e-12 * max(map(abs, six))
    changes = [
        set_attribute(element, name, f"{new + 0.0 if abs(new) > least else 0:.9g}")
        for name, old, new in zip(COMPONENTS, inertial.inertia.six, six, strict=True)
        if f"{new:.9g}" != f"{old:.9g}" and max(abs(new), abs(old)) > least
    ]
    if center is not None:
        moved = _move_center(link, inertial, center)
        if moved is None:
            return None
        if moved:
            why += f", centered at {format_numbers(center, 6)}"
        changes += moved
    return unsafe(why, *changes) if changes else None


def _move_center(link: Link, inertial: Inertial, center: Vector) -> list[Change] | None:
    """Write a center of mass that is missing or outside the bounding box.

    Returns:
        None if the current one comes from an expression.
    """
    now = make_pose(inertial.origin).translation
    box = compute_box(link)
    inside = box is not None and all(
        low <= value <= high for low, value, high in zip(box.low, now, box.high, strict=True)
    )
    written = inertial.origin is not None and any(inertial.origin.xyz)
    if (written and (inside or box is None)) or math.dist(now, center) <= 1e-6:
        return []
    text = format_numbers((round(value, 9) for value in center), 6)
    if inertial.origin is None:
        return [prepend_child(inertial.element, f'<origin xyz="{text}"/>')]
    if is_computed(inertial.origin.element, "xyz"):
        return None
    return [set_attribute(inertial.origin.element, "xyz", text)]


_COMMENT = re.compile(rb"<!--((?:(?!-->).)*)-->", re.DOTALL)
_REASON = re.compile(rb"stab|dummy|simulat|gazebo|fake|arbitrar", re.IGNORECASE)


def has_comment(link: Link) -> bool:
    """Tell whether a comment in or before the ``<inertial>`` of a link says why it is so."""
    inertial = link.inertial
    if inertial is None:
        return False
    element = inertial.element
    data, before = element.file.data, link.element.start if link.element is not None else 0
    for child in link.element.children:
        if child.start < element.start:
            before = child.start
    end = data.find(b"</inertial", element.start)
    return any(
        _REASON.search(comment[1]) is not None
        for comment in _COMMENT.finditer(data, before, end if end > 0 else element.start)
    )
