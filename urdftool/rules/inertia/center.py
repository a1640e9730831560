"""Compare centers of mass with the geometry of the links."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from ...mechanics.mass_bounds import MARGIN, Misfit, check_com, name_shapes
from ...model.bounds import Bounds
from ...model.elements import Inertial, Link, Robot
from ...model.gltf_axes import is_gltf
from ...model.pose import compute_norm, make_pose
from ..fix import (
    FixContext,
    Proposal,
    depends_on_arguments,
    format_numbers,
    prepend_child,
    set_attribute,
    unsafe,
)
from ..mesh.link_extents import get_extents
from ..rule import ANY_FORMAT, INFO, UNSAFE, WARNING, Problem, rule
from .bodies import LIGHT, find_negligible_links, is_only_sliding
from .corrections import MASS_IN_DOUBT, write_tensor
from .frame import compute_tensor_about_center, has_mesh
from .identified import is_identified
from .proposals import format_tensor
from .size import SIZE_IN_DOUBT, is_placeholder
from .solids import compute_box, compute_solid_center
from .tensors import is_zero


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, mujoco, pinocchio, drake": "take it as written",
    },
    of_motion=True,
    group="robot",
    caused_by=(*SIZE_IN_DOUBT, "placeholder-inertia", "zero-inertia"),
    formats=ANY_FORMAT,
    infos=True,
    pedantic="published parameters of an arm, and meshes of less than 5 g or up to 3 mm away",
)
def com_outside_geometry(
    robot: Robot,
    *,
    margin: float = MARGIN,
    together: float = 6,
    light: float = LIGHT,
    far: float = 1.0,
) -> Iterator[Problem]:
    """A link's center of mass is outside the bounding box of its geometry.

    A center of mass lies inside the convex hull of the body. Usual causes of other values are
    millimeters in place of meters, or a position in another frame. In simulation the link then
    tips over to the wrong side.

    ``margin`` is the tolerated distance as a part of the bounding box's diagonal; twice that for
    a mesh. A mesh often shows the cover without the motor, so it is a warning only beyond half a
    diagonal, and an info before that. More than ``together`` infos are reported as one finding.
    The geometry of attached links without a mass of their own counts too. Links with less than
    ``light`` of the robot's mass, or ten times that part of the mass of their rigid body, hardly
    influence it, and are skipped; those that a joint moves, up to ``far`` times the diagonal. So
    are links that only slide relative to the world. The published parameters of Franka's arms are
    right together, not for each link, and off by default.
    """
    remarks: list[tuple[Link, Misfit, list[str]]] = []
    reach = get_extents(robot)
    skipped = find_negligible_links(robot, light)
    for link in robot.links:
        inertial = link.inertial
        if inertial is None or not inertial.mass or _has_gltf(link):
            continue
        if is_only_sliding(robot, link):
            continue
        box = reach.get_link_box(link)
        if box is None:
            continue
        com, of_mesh = make_pose(inertial.origin).translation, has_mesh(link)
        if link.name in skipped and not (
            _is_moved(robot, link) and box.measure_distance(com) > far * compute_norm(box.size)
        ):
            continue
        if check_com(box, com, of_mesh, margin=margin) is None:
            continue
        box = reach.get_inertial_box(link, box)
        if box is None:
            continue
        attached = [other.name for other, _ in reach.get_counted(link)]
        shapes = name_shapes(attached)
        found = check_com(box, com, of_mesh, margin=margin, shapes=shapes)
        if found is None:
            continue
        if found.certain:
            yield _report_outside(link, found, attached)
        else:
            remarks.append((link, found, attached))
    also = ""
    if len(remarks) > together:
        others = (
            f"'{link.name}' by {found.amount:.3g} m along {'xyz'[found.axis]}"
            for link, found, _ in remarks[1:]
        )
        also = f"; also outside: {', '.join(others)}"
        del remarks[1:]
    yield from (_report_outside(*one, also) for one in remarks)


_OF_GRAMS = 0.005
"""Mass [kg] of a body whose center of mass matters little. Chosen, no source."""

_NEAR = 0.003
"""Distance [m] from a mesh, which may lack a motor, that matters little. Chosen, no source."""


def _is_moved(robot: Robot, link: Link) -> bool:
    joint = robot.tree.get_parent_joint(link.name)
    return joint is not None and not joint.is_fixed


def _report_outside(link: Link, found: Misfit, attached: Sequence[str], also: str = "") -> Problem:
    return Problem(
        link,
        f"center of mass of link '{link.name}' {found.sentence}{also}",
        at=(link.inertial and link.inertial.origin) or link.inertial,
        severity=None if found.certain else INFO,
        alike=(bool(attached), bool(also)),
        pedantic=is_identified(link)
        or (not found.certain and (link.mass < _OF_GRAMS or found.amount < _NEAR)),
        data={"distance": found.amount, "axis": "xyz"[found.axis]},
    )


@rule(
    INFO,
    effects={
        "gz, gazebo-classic, mujoco, pinocchio, drake": (
            "put the center of mass of the link at its origin"
        ),
    },
    of_motion=True,
    group="robot",
    caused_by=("incomplete-inertial",),
)
def inertial_not_at_com_suspect(
    robot: Robot, *, far: float = 0.2, light: float = LIGHT
) -> Iterator[Problem]:
    """An ``<inertial>`` has no origin, but the link's geometry is offset to one side.

    The mass is then at the origin of the link frame, often on the joint axis, so that gravity
    exerts no torque on the joint. Usually the ``<origin>`` was forgotten. If the inertia fits the
    geometry only about the link frame, it was computed about that frame: write the ``<origin>``
    together with the inertia about the center of mass. With the ``<origin>`` alone, simulators
    add mass × distance² a second time. Links with less than ``light`` of the robot's mass, or ten
    times that part of the mass of their rigid body, are skipped because they hardly influence it.
    """
    reach = get_extents(robot)
    skipped = find_negligible_links(robot, light)
    for link in robot.links:
        inertial = link.inertial
        if inertial is None or not inertial.mass or link.name in skipped or _has_gltf(link):
            continue
        if inertial.origin is not None and any(inertial.origin.xyz):
            continue
        if inertial.inertia is not None and is_placeholder(link, inertial.inertia.six):
            continue  # placeholder-inertia reports it
        box = reach.get_link_box(link)
        if box is None or not _is_off_center(link, box, far):
            continue
        around = reach.get_inertial_box(link, box)
        if around is None or not _is_off_center(link, around, far):
            continue
        noise = 1e-3 * math.dist(*box)
        digits = 1 - math.floor(math.log10(noise))
        center = [0.0 if abs(value) < noise else round(value, digits) for value in box.center]
        shown = " ".join(f"{value:g}" for value in center)
        remedy, of_inertia = _describe_remedy(link, inertial, box)
        yield Problem(
            link,
            f"mass of link '{link.name}' is at the origin of its frame, but its geometry is "
            f"centered at {shown} m; {remedy}",
            at=inertial.origin if inertial.origin is not None else inertial,
            alike=of_inertia,
            data={"center": center},
        )


def _describe_remedy(link: Link, inertial: Inertial, box: Bounds) -> tuple[str, str]:
    """Describe what to write, depending on the point that the inertia is about.

    Returns:
        The remedy, and which inertia it names: ``""``, ``"unknown"`` or ``"known"``.
    """
    remedy = "write its center of mass as the <origin> of its <inertial>"
    if inertial.inertia is None or is_zero(inertial.inertia.six, link.mass):
        return remedy, ""
    right = compute_tensor_about_center(link, inertial, box.center, box)
    if right is None:
        return f"{remedy}, and the inertia about that point", "unknown"
    if right == inertial.inertia.six:
        return remedy, ""
    return (
        f"{remedy}, and the inertia about that point, because the written one fits only about "
        f"the link frame: {format_tensor(right)}",
        "known",
    )


@inertial_not_at_com_suspect.fix(UNSAFE, rests_on=MASS_IN_DOUBT)
def write_center_of_mass(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the center of the geometry, and the inertia about it if it is about the frame."""
    link = context.get_link(problem)
    box, inertial = compute_box(link), link.inertial
    if box is None or inertial is None or inertial.inertia is None:
        return None
    if depends_on_arguments(link.element):
        return None
    right = compute_tensor_about_center(link, inertial, box.center, box)
    if right is None:
        return None
    if right != inertial.inertia.six:
        return write_tensor(link, right, center=box.center)
    center = format_numbers(box.center, 6)
    if inertial.origin is None:
        change = prepend_child(inertial.element, f'<origin xyz="{center}"/>')
    else:
        change = set_attribute(inertial.origin.element, "xyz", center)
    return unsafe(f"move the center of mass to the center of the geometry, {center}", change)


def _has_gltf(link: Link) -> bool:
    """Tell whether a mesh of a link is glTF, which only some readers rotate from Y-up to Z-up."""
    return any(map(is_gltf, link.visuals)) or any(map(is_gltf, link.collisions))


def _is_off_center(link: Link, box: Bounds, far: float) -> bool:
    """Tell whether the origin of a link is inside its bounding box, far from the center."""
    lower, upper = box
    slack = 0.02 * math.dist(lower, upper)
    if max(lower) - slack > 0 or min(upper) + slack < 0:
        return False  # com-outside-geometry reports it
    solid = compute_solid_center(link)
    if solid is not None and math.hypot(*solid) <= far * math.dist(lower, upper):
        return False  # the part to one side is thin
    return math.hypot(*box.center) > far * math.dist(lower, upper)
