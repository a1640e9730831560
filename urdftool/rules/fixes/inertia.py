"""Fixes of mass and inertia."""

from __future__ import annotations

import math
import re

from ...model.elements import Inertia, Inertial, Link, Vector
from ...model.inertia_slips import is_possible
from ...model.pose import pose_of, transpose
from ...model.tensor3 import Six, eigenvalues, turned
from ..cross_file_references import check_not_included
from ..inertia.frame import about_center, about_com
from ..inertia.presence import is_needless
from ..inertia.proposals import proposal_of
from ..inertia.size import has_own_size, may_be_kg_mm2
from ..inertia.slips import repeats_twin, slip_of
from ..inertia.solids import _only_shape, box_of, is_dummy, solid_tensor, solid_volume
from ..inertia.tensors import SIX, is_zero, six_of
from ..mesh.outlines import reaches
from ..rule import INFO, Problem
from .proposal import (
    Around,
    Change,
    Proposal,
    attribute_at,
    depends_on_a_call,
    drop,
    figures,
    first,
    is_computed,
    put,
    quote,
    remove,
    safe,
    unsafe,
)

DENSITY = 1000.0
"""What a link is taken to weigh whose mass is not written: water [kg/m³]."""

LIGHTEST = 1e-5
"""Mass [kg] below which a shape marks a place, and has no mass that is worth writing."""

_SMALL = (0.01, 1e-6)
"""Mass [kg] and moments [kg·m²] of a frame that a simulator wants to weigh something."""


def _inertial(mass: float, centre: str, six: Six, rpy: str = "") -> tuple[str, ...]:
    turn = f' rpy="{rpy}"' if rpy else ""
    return (
        "<inertial>",
        *([f'\t<origin xyz="{centre}"{turn}/>'] if centre != "0 0 0" or turn else []),
        f'\t<mass value="{mass:.6g}"/>',
        f"\t<inertia {_six_text(six)}/>",
        "</inertial>",
    )


def _six_text(six: Six) -> str:
    return " ".join(f'{n}="{v + 0.0:.6g}"' for n, v in zip(SIX, six, strict=True))


def missing_inertial(problem: Problem, around: Around) -> Proposal | None:
    """What its shapes have at the density of water."""
    link = around.link(problem)
    if problem.severity is INFO:
        return None  # the body has a mass, or needs none
    lines = _of_shapes(link, around)
    mass = re.search(r'<mass value="([^"]*)"', " ".join(lines or ()))
    if lines is None or mass is None or float(mass[1]) < LIGHTEST:
        return None
    return unsafe(
        f"add the <inertial> of its shapes at {DENSITY:g} kg/m³", first(link.element, *lines)
    )


def _of_shapes(link: Link, around: Around) -> tuple[str, ...] | None:
    """The inertial of a link's shapes at the density of water; None where they do not tell."""
    if depends_on_a_call(link.element, "visual", "collision"):
        return None
    shape = _only_shape(link)
    volume = solid_volume(shape.geometry) if shape is not None else 0.0
    if shape is not None and volume > 0:
        pose = pose_of(shape.origin)
        made = Link(link.element, link.name, visuals=link.visuals, collisions=link.collisions)
        made.inertial = Inertial(link.element, shape.origin, DENSITY * volume)
        six = solid_tensor(made)
        if six is None:
            return None
        rpy = figures(shape.origin.rpy) if shape.origin is not None else ""
        turned_at_all = shape.origin is not None and any(shape.origin.rpy)
        same = max(six[0], six[3], six[5]) == min(six[0], six[3], six[5])
        rpy = rpy if turned_at_all and not same else ""
        return _inertial(DENSITY * volume, figures(pose.translation), six, rpy)
    found = _weighed(link, around)
    if found is None:
        return None
    mass, centre, six = found
    return _inertial(mass, figures(centre, 6), six)


def _weighed(link: Link, around: Around) -> tuple[float, tuple[float, float, float], Six] | None:
    """Mass, centre and tensor of a link in its frame, as its meshes have them."""
    if around.compute_inertia is None:
        return None
    return around.compute_inertia(around.robot, [link.name]).get(link.name)


def massless_moving_body(problem: Problem, around: Around) -> Proposal | None:
    """A few grams for the frame."""
    return _give_a_little(around.link(problem))


def preserved_joint_massless(problem: Problem, around: Around) -> Proposal | None:
    """The same for each side of the joint that weighs nothing."""
    child = around.robot.link.get(around.joint(problem).child)
    if child is None or f"link '{child.name}' has no mass" not in problem.message:
        return None
    return _give_a_little(child)


def _give_a_little(link: Link) -> Proposal | None:
    if link.inertial is not None or not link.is_frame:
        return None
    mass, moment = _SMALL
    lines = _inertial(mass, "0 0 0", (moment, 0.0, 0.0, moment, 0.0, moment))
    return unsafe(f"give it {mass * 1000:g} g", first(link.element, *lines))


def incomplete_inertial(problem: Problem, around: Around) -> Proposal | None:
    """Products that are not written are 0."""
    inertial = around.link(problem).inertial
    inertia = inertial.element.child("inertia") if inertial is not None else None
    if inertial is None or inertia is None or inertial.element.child("mass") is None:
        return None
    missing = [name for name in SIX if name not in inertia.attributes]
    if not missing or not set(missing) <= {"ixy", "ixz", "iyz"}:
        return None
    zeros = " ".join(f'{name}="0"' for name in missing)
    return unsafe(f"write {zeros}", *(put(inertia, name, "0") for name in missing))


def negative_mass(problem: Problem, around: Around) -> Proposal | None:
    """Without its sign."""
    found = attribute_at(problem)
    if found is None:
        return None
    text = (found[0].get(found[1]) or "").strip().removeprefix("-")
    return unsafe(f'write value="{text}"', put(*found, text))


def _rewritten(link: Link, six: Six, why: str, centre: Vector | None = None) -> Proposal | None:
    """The six numbers written anew, as far as they differ, and where the mass is.

    Args:
        link: The link.
        six: The tensor about the centre of mass, along the axes of the inertial.
        why: What is done, in words.
        centre: Where the centre of mass belongs in the frame of the link; None if it stays.
    """
    inertial = link.inertial
    if inertial is None or inertial.inertia is None or not is_possible(six):
        return None
    element = inertial.inertia.element
    least = 1e-12 * max(map(abs, six))
    changes = [
        put(element, name, f"{new + 0.0 if abs(new) > least else 0:.9g}")
        for name, old, new in zip(SIX, six_of(inertial.inertia), six, strict=True)
        if f"{new:.9g}" != f"{old:.9g}" and max(abs(new), abs(old)) > least
    ]
    if centre is not None:
        moved = _moved(link, centre)
        if moved is None:
            return None
        if moved:
            why += f", centred at {figures(centre, 6)}"
        changes += moved
    return unsafe(why, *changes) if changes else None


def _moved(link: Link, centre: Vector) -> list[Change] | None:
    """Changes that put a centre of mass which nobody wrote, or is outside, where it belongs.

    Returns:
        None where it comes from an expression.
    """
    inertial = link.inertial
    if inertial is None:
        return None
    now = pose_of(inertial.origin).translation
    box = box_of(link)
    inside = box is not None and all(
        low <= value <= high for low, value, high in zip(box.low, now, box.high, strict=True)
    )
    written = inertial.origin is not None and any(inertial.origin.xyz)
    if (written and (inside or box is None)) or math.dist(now, centre) <= 1e-6:
        return []
    text = figures((round(value, 9) for value in centre), 6)
    if inertial.origin is None:
        return [first(inertial.element, f'<origin xyz="{text}"/>')]
    if is_computed(inertial.origin.element, "xyz"):
        return None
    return [put(inertial.origin.element, "xyz", text)]


def _meant(problem: Problem, around: Around) -> Proposal | None:
    """What was probably meant; else what the link's shapes have at its mass."""
    link = around.link(problem)
    inertial = link.inertial
    if inertial is None or inertial.inertia is None:
        return None
    return _of_proposal(link, inertial, inertial.inertia) or _recomputed(problem, around)


def _of_proposal(link: Link, inertial: Inertial, inertia: Inertia) -> Proposal | None:
    """Write the tensor that one slip explains."""
    proposal = proposal_of(link, inertial, inertia.six)
    if proposal is None:
        return None
    return _rewritten(link, proposal.tensor, f"write {_six_text(proposal.tensor)}")


def _recomputed(problem: Problem, around: Around) -> Proposal | None:
    """What the link's shapes have at its mass, and where, if nobody wrote where."""
    link = around.link(problem)
    inertial = link.inertial
    if inertial is None or not inertial.mass or inertial.mass <= 0 or inertial.inertia is None:
        return None
    if any(is_computed(inertial.inertia.element, name) for name in SIX):
        return None  # before meshes are read for nothing
    if depends_on_a_call(link.element):
        return None
    shape = _only_shape(link)
    six = solid_tensor(link)
    if six is not None and shape is not None and shape.geometry is not None:
        what = f"of a solid {shape.geometry.element.tag}"
        why = f"write the inertia {what} of {inertial.mass:g} kg"
        return _rewritten(link, six, why, pose_of(shape.origin).translation)
    found = _weighed(link, around)
    if found is None:
        return None
    mass, centre, tensor = found
    scale = inertial.mass / mass
    here = turned(
        tuple(value * scale for value in tensor),  # type: ignore[arg-type]
        transpose(pose_of(inertial.origin).rotation),
    )
    return _rewritten(
        link, here, f"write the inertia of its shapes at {inertial.mass:g} kg", centre
    )


def inertia_not_positive_definite(problem: Problem, around: Around) -> Proposal | None:
    """What was meant, or what its shapes have."""
    return _meant(problem, around)


def inertia_triangle_inequality(problem: Problem, around: Around) -> Proposal | None:
    """What was meant, or what its shapes have."""
    return _meant(problem, around)


def inertia_exceeds_geometry(problem: Problem, around: Around) -> Proposal | None:
    """What was meant, or what its shapes have, where these are certain to be the body."""
    link, certain = around.link(problem), problem.severity is not INFO
    inertial = link.inertial
    if not has_own_size(around.robot, link, certain):
        return None
    if not certain and inertial is not None and inertial.inertia is not None:
        return _of_proposal(link, inertial, inertial.inertia)
    return _meant(problem, around)


def zero_inertia(problem: Problem, around: Around) -> Proposal | None:
    """What its shapes have."""
    return _recomputed(problem, around)


def singular_inertia(problem: Problem, around: Around) -> Proposal | None:
    """What its shapes have."""
    return _recomputed(problem, around)


def placeholder_inertia(problem: Problem, around: Around) -> Proposal | None:
    """What its shapes have, unless they are those of a dummy, which have next to nothing."""
    return None if is_dummy(around.link(problem)) else _recomputed(problem, around)


def inertia_triangle_inequality_rounding(problem: Problem, around: Around) -> Proposal | None:
    """Add the excess to each moment, which keeps the principal axes.

    However small it is, PyBullet reads a tensor that breaks the inequality as zero.
    """
    link = around.link(problem)
    inertial = link.inertial
    if inertial is None or inertial.inertia is None:
        return None
    six = list(six_of(inertial.inertia))
    low, middle, high = eigenvalues(six_of(inertial.inertia))
    excess = high - low - middle
    for factor in (1.0, 1.5, 2.0, 4.0):
        new = [
            v + factor * (excess + 1e-9 * high) if i in (0, 3, 5) else v for i, v in enumerate(six)
        ]
        shown = [float(f"{value:.10g}") for value in new]
        a, b, c = eigenvalues((shown[0], shown[1], shown[2], shown[3], shown[4], shown[5]))
        if c <= a + b:
            break
    else:
        return None
    element = inertial.inertia.element
    changes = [put(element, SIX[i], f"{new[i]:.10g}") for i in (0, 3, 5)]
    return unsafe(f"make each moment {factor * excess:.1g} larger", *changes)


def inertia_component_slip(problem: Problem, around: Around) -> Proposal | None:
    """In the order that URDF has."""
    return _of_slip(problem, around)


def inertia_off_by_power_of_ten(problem: Problem, around: Around) -> Proposal | None:
    """With the decimal point where it belongs."""
    return _of_slip(problem, around)


def _of_slip(problem: Problem, around: Around) -> Proposal | None:
    link = around.link(problem)
    inertial = link.inertial
    if inertial is None or inertial.inertia is None:
        return None
    slip = slip_of(link, inertial, six_of(inertial.inertia), around.robot)
    if slip is None:
        return None
    return _rewritten(link, slip.tensor, f"write {_six_text(slip.tensor)}")


def redundant_inertia_attributes(problem: Problem, around: Around) -> Proposal | None:
    """Without what is not read and says the same."""
    found = attribute_at(problem)
    if found is None or not repeats_twin(*found):
        return None
    return safe(f"take {found[1]} out", drop(*found))


def radius_of_gyration(problem: Problem, around: Around) -> Proposal | None:
    """In kg·m², where it is in kg·mm²."""
    link = around.link(problem)
    inertial = link.inertial
    if inertial is None or inertial.inertia is None or link.mass <= 0:
        return None
    six = six_of(inertial.inertia)
    if not may_be_kg_mm2(math.sqrt(max(eigenvalues(six)[2], 0.0) / link.mass)):
        return None
    x, y, z, a, b, c = (value * 1e-6 for value in six)
    if is_zero((x, y, z, a, b, c), link.mass):
        return None
    return _rewritten(link, (x, y, z, a, b, c), "divide it by 1e6")


def inertial_not_at_com_suspect(problem: Problem, around: Around) -> Proposal | None:
    """Write the center of its shapes, and the inertia about it where it is about the frame."""
    link = around.link(problem)
    box, inertial = box_of(link), link.inertial
    if box is None or inertial is None or inertial.inertia is None:
        return None
    if depends_on_a_call(link.element):
        return None
    right = about_center(link, inertial, box.centre, box)
    if right is None:
        return None
    centre = figures(box.centre, 6)
    if right != inertial.inertia.six:
        why = f"write {_six_text(right)}"
        return _rewritten(link, right, why, box.centre)
    if inertial.origin is None:
        change = first(inertial.element, f'<origin xyz="{centre}"/>')
    else:
        change = put(inertial.origin.element, "xyz", centre)
    return unsafe(f"put it at the center of its shapes, {centre}", change)


def root_link_has_inertia(problem: Problem, around: Around) -> Proposal | None:
    """A link without <inertial> above it, on a fixed joint; or remove what is not needed."""
    robot, link = around.robot, around.link(problem)
    if link.element.parent is not robot.element or link.inertial is None:
        return None
    if link.name == "world" or (is_needless(robot, link) and "pybullet" not in around.targets):
        return unsafe("remove its <inertial>", remove(link.inertial.element))
    name, joint = f"{link.name}_root", f"{link.name}_root_joint"
    taken = {*robot.link, *robot.joint}
    if name in taken or joint in taken or is_computed(link.element):
        return None
    if around.targets & {"moveit", "pybullet"}:
        return None  # the SRDF names the root, and PyBullet gives a new one 1 kg
    check_not_included(around)
    changes: tuple[Change, ...] = (
        Change(
            "first",
            robot.element,
            blocks=(
                (f'<link name="{quote(name)}"/>',),
                (
                    f'<joint name="{quote(joint)}" type="fixed">',
                    f'\t<parent link="{quote(name)}"/>',
                    f'\t<child link="{quote(link.name)}"/>',
                    "</joint>",
                ),
            ),
        ),
    )
    what = f"put a link '{name}' without <inertial> above it, on a fixed joint"
    return unsafe(f"{what}; PyBullet gives it 1 kg", *changes)


def com_not_mirrored(problem: Problem, around: Around) -> Proposal | None:
    """The mirror image of the center of mass of the other side."""
    inertial = around.link(problem).inertial
    found = re.search(r'write xyz="([^"]*)"', problem.message)
    if inertial is None or inertial.origin is None or found is None:
        return None
    return unsafe(f'write xyz="{found[1]}"', put(inertial.origin.element, "xyz", found[1]))


def inertia_about_link_frame(problem: Problem, around: Around) -> Proposal | None:
    """The tensor about the center of mass."""
    link = around.link(problem)
    inertial = link.inertial
    if inertial is None or inertial.inertia is None:
        return None
    box = reaches(around.robot).link(link)
    right = about_com(link, inertial, six_of(inertial.inertia), box)
    return None if right is None else _rewritten(link, right, f"write {_six_text(right)}")
