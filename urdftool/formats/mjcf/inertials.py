"""Mass and inertia of every body: as written if MuJoCo accepts them, otherwise repaired.

Welded links form one rigid body, so an inconsistent tensor can be repaired exactly if a neighbor in
the same rigid body can absorb the difference. Only the remaining defects change the robot, by the
method that the user chose. A rule cannot find them: whether MuJoCo accepts a tensor depends on the
links that are welded together in this export, and on whether the body moves.
"""

from __future__ import annotations

from collections.abc import Iterator

from ...diagnostic import Severity
from ...finding import Finding
from ...geometry.link_extent import compute_box_size
from ...mechanics.repair import compute_box_tensor
from ...mechanics.spatial_inertia import SpatialInertia, combine
from ...mechanics.tensor import (
    WRITTEN_ROUNDING,
    SymmetricTensor,
    add_tensors,
    format_moments_text,
    get_excess,
    make_diagonal_tensor,
)
from ...model.elements import ZERO
from ...model.pose import IDENTITY
from ..common.inertia_repair import repair_tensor
from ..common.inertia_surplus import move_surplus, report_move
from ..common.option import FixInertia
from ..defects import make_defect
from ..written import Written
from . import inertia as tensors
from .link_inertia import LinkInertia, read_inertia
from .structure import Structure

TINY = 1e-12
"""Mass [kg] and moment [kg·m²] of a moving body without mass; MuJoCo requires more than 1e-15."""

LEAST = 2e-15
"""The same for bodies where armature keeps the mass matrix regular. Chosen, no source."""

ENOUGH = 1e-14
"""Mass [kg] or moment [kg·m²] that MuJoCo accepts as positive, with a margin."""

NEGLIGIBLE = 1e-8
"""Fraction of a joint's inertia that is negligible. Chosen, no source."""

LEAF_ARMATURE = 1e-4
"""Armature [kg·m² or kg] of the joint of a massless leaf link, so that it can be simulated."""


def compute_inertials(
    structure: Structure, fix: FixInertia, written: Written, *, force: bool = False
) -> tuple[dict[str, LinkInertia], list[Finding]]:
    """Compute the mass properties by link to write, and the defects that prevent an export.

    Links without mass are omitted.
    """
    found: dict[str, LinkInertia] = {}
    wrong: list[Finding] = []
    for link in structure.robot.links:
        read = read_inertia(link)
        if read is not None:
            found[link.name] = read
    is_extended = _is_base_point(structure, found)
    for top, members in structure.members.items():
        group = {link.name: found[link.name] for link in members if link.name in found}
        bad = [name for name, read in group.items() if not read.is_possible]
        if bad and not _compose(structure, top, group, bad, written):
            for name in bad:
                if not group[name].is_possible:
                    wrong.extend(_repair(structure, name, group, fix, force, written))
        is_joined = structure.robot.format == "mjcf" and structure.robot.link[top].is_virtual
        if (top != structure.root.name or structure.free) and not is_joined:
            if not (is_extended and _replace_point(structure, top, group, written)):
                _give_weight(structure, top, group, written)
        for name in [link.name for link in members]:
            found.pop(name, None)
        found.update(group)
    return found, wrong


def get_massless_leaves(structure: Structure) -> set[str]:
    """Return the topmost links of moving bodies without mass and without mass below them."""
    weight = {
        top: sum(max(link.mass, 0.0) for link in links) for top, links in structure.members.items()
    }
    heavy: set[str] = set()
    for top in reversed(structure.members):
        if weight[top] > ENOUGH or top in heavy:
            heavy.add(top)
            joint = structure.robot.tree.get_parent_joint(top)
            if joint is not None:
                heavy.add(structure.group[joint.parent])
    return set(structure.members) - heavy - {structure.root.name}


def _compose(
    structure: Structure, top: str, group: dict[str, LinkInertia], bad: list[str], written: Written
) -> bool:
    """Repair tensors exactly inside a rigid body; return whether all of them are repaired."""
    bodies = {name: read.body for name, read in group.items()}
    rotations = {name: structure.get_pose_in_group(name).rotation for name in group}
    places = {name: group[name].place for name in bad}
    for move in move_surplus(bodies, rotations, bad, top, tensors.lift):
        for name in (move.taker, move.link):
            group[name] = group[name].get_changed(bodies[name].tensor)
        report_move(written, move, places[move.link])
    if all(group[name].is_possible for name in bad):
        return True
    return _unite(structure, top, group, bad, written)


def _unite(
    structure: Structure, top: str, group: dict[str, LinkInertia], bad: list[str], written: Written
) -> bool:
    """Write the combined mass properties to the topmost link, if they are consistent."""
    if len(group) < 2 and top in group:
        return False
    whole = combine(
        read.body.transform(structure.get_pose_in_group(name)) for name, read in group.items()
    )
    if whole.mass <= 0 or not tensors.is_possible(whole.tensor):
        return False
    places = {name: group[name].place for name in bad}
    names = list(group)
    group.clear()
    group[top] = LinkInertia(whole, next(iter(places.values())))
    for name in bad:
        written.report_loss(
            "inertia-moved",
            f"inertia of link '{name}' is physically inconsistent; the mass properties of it and "
            "the "
            f"links welded to it ({', '.join(n for n in names if n != name)}) are combined in "
            f"link '{top}'; the total is unchanged",
            places[name],
            kind="link",
            name=name,
            severity=Severity.INFO,
        )
    return True


def _repair(
    structure: Structure,
    name: str,
    group: dict[str, LinkInertia],
    fix: FixInertia,
    force: bool,
    written: Written,
) -> Iterator[Finding]:
    """Repair a tensor as the user chose; always repair static links."""
    read = group[name]
    before = format_moments_text(read.tensor)
    static = structure.is_static(name)
    excess = {"excess": get_excess(read.tensor, read.mass)}
    is_tensor_possible = tensors.is_possible(read.tensor)
    is_rounded = read.mass > 0 and excess["excess"] <= WRITTEN_ROUNDING
    if fix == "none" and not (static or force or is_rounded):
        reason = "none may be negative or above the sum of the other two"
        yield make_defect(
            "inertia-triangle-inequality",
            f"inertia of link '{name}' is physically inconsistent: principal moments {before} "
            f"kg·m² ({'but no mass' if is_tensor_possible else reason}); MuJoCo rejects it. "
            "Correct it, or use --fix-inertia lift, balance or box",
            read.place,
            "link",
            name,
            data=excess,
        )
        return
    if read.mass <= 0:
        del group[name]
        what = "it has no mass, and is written without inertia"
    else:
        tensor, how = _collect_repaired(structure, name, read, fix)
        group[name] = read.get_changed(tensor)
        what = f"{how} to {format_moments_text(tensor)} kg·m²"
    held = "; it is fixed to the world and does not move" if static else ""
    text = f"physically inconsistent (principal moments {before} kg·m²): {what}"
    if is_rounded:
        text = "inconsistent only by rounding (the largest moment exceeds the sum of the others by "
        text += f"{excess['excess']:.2g} of itself); the nearest consistent one is written"
    written.report_loss(
        "inertia",
        f"inertia of link '{name}' is {text}{held}",
        read.place,
        kind="link",
        name=name,
        data=excess,
    )


def _collect_repaired(
    structure: Structure, name: str, read: LinkInertia, fix: FixInertia
) -> tuple[SymmetricTensor, str]:
    robot = structure.robot
    return repair_tensor(
        fix,
        read.body,
        lambda: compute_box_size(robot, [(robot.link[name], IDENTITY)]),
        lift=tensors.lift,
    )


def _get_part_of_tiny(structure: Structure, top: str, group: dict[str, LinkInertia]) -> float:
    """Return the inertia added to a point mass, relative to that about its joint's axis.

    Return zero if the joint does not rotate it, or moves other bodies too.
    """
    joint = structure.robot.tree.get_parent_joint(top)
    below = set(structure.robot.tree.list_descendants(top)) - group.keys()
    if joint is None or structure.get_kind(joint) != "hinge":
        return 0.0
    if any(structure.robot.link[name].mass > 0 for name in below):
        return 0.0
    axis = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    about = sum(
        read.body.transform(structure.get_pose_in_group(name)).compute_moment_about(ZERO, axis)
        for name, read in group.items()
    )
    return TINY / about if about > 0 else 1.0


def _is_base_point(structure: Structure, found: dict[str, LinkInertia]) -> bool:
    """Tell whether a robot has a free base with a mass and no rotational inertia.

    Nothing resists its rotation, so the contacts of such a robot never come to rest.
    """
    reads = [found[link.name] for link in structure.members[structure.root.name]
             if link.name in found]  # fmt: skip
    if not structure.free or sum(read.mass for read in reads) <= ENOUGH:
        return False
    return not any(read.is_heavy(ENOUGH) for read in reads)


def _replace_point(
    structure: Structure, top: str, group: dict[str, LinkInertia], written: Written
) -> bool:
    """Give a point mass the tensor of a solid box around its geometry; return whether it has one.

    Bullet computes tensors from the collision geometry, too, unless it is asked not to.
    """
    if any(read.is_heavy(ENOUGH) for read in group.values()) or not group:
        return False
    name = max(group, key=lambda name: group[name].mass)
    point, robot = group[name], structure.robot
    size = compute_box_size(robot, [(robot.link[name], IDENTITY)])
    if size is None or point.mass <= ENOUGH or min(sorted(size)[1:]) <= 0:
        return False
    tensor = compute_box_tensor(point.mass, size)
    group[name] = point.get_changed(tensor)
    written.report_loss(
        "point-mass",
        f"link '{name}' is a point mass, as the free base is: nothing resists its rotation; it has "
        f"the tensor of a box around its geometry, {format_moments_text(tensor)} kg·m²",
        point.place,
        kind="link",
        name=name,
        hint="write its <inertia>",
    )
    return True


def _give_weight(
    structure: Structure, top: str, group: dict[str, LinkInertia], written: Written
) -> None:
    """Give a moving body without mass or inertia the minimum that MuJoCo requires."""
    if any(read.is_heavy(ENOUGH) for read in group.values()):
        return
    link = structure.robot.link[top]
    mass = sum(read.mass for read in group.values())
    if mass > ENOUGH:
        heaviest = max(group, key=lambda name: group[name].mass)
        part = _get_part_of_tiny(structure, top, group)
        group[heaviest] = group[heaviest].get_changed(
            add_tensors(group[heaviest].tensor, make_diagonal_tensor(TINY, TINY, TINY))
        )
        written.report_loss(
            "point-mass",
            f"link '{heaviest}' is a point mass; MuJoCo requires inertia, so it has {TINY:g} kg·m²"
            + (f", {part:.1g} of what its joint moves" if part > NEGLIGIBLE else ""),
            group[heaviest].place,
            kind="link",
            name=heaviest,
            severity=Severity.WARNING if part > NEGLIGIBLE else Severity.INFO,
            hint="write its <inertia>" if part > NEGLIGIBLE else "",
        )
        return
    group.clear()
    leaf = top in get_massless_leaves(structure)
    root = top == structure.root.name
    least = LEAST if leaf else TINY
    point = SpatialInertia(least, tensor=make_diagonal_tensor(least, least, least))
    group[top] = LinkInertia(point, link.place)
    written.report_loss(
        "massless",
        f"link '{top}' moves and has no mass; MuJoCo requires mass, so it gets {least:g} kg"
        + (f", and its joint an armature of {LEAF_ARMATURE:g}" if leaf else ""),
        link.place,
        kind="link",
        name=top,
        severity=Severity.WARNING if leaf or root else Severity.INFO,
        hint="write an <inertial> with its true mass" if leaf or root else "",
    )
