"""Writing of ``<inertial>`` for every link, as SDF's default mass is 1 kg."""

from __future__ import annotations

from functools import partial

from ...diagnostic import Severity
from ...mechanics.repair import find_nearest_consistent
from ...mechanics.tensor import (
    ROUNDING,
    WRITTEN_ROUNDING,
    SymmetricTensor,
    format_moments_text,
    get_excess,
    get_written_tensor,
    make_diagonal_tensor,
    measure_consistency,
)
from ...model.elements import Link, Part, Vector
from ...model.link import COMPONENTS
from ...model.numbers import number_text
from ...model.pose import Pose
from ..common.inertia_repair import repair_tensor
from .pose import set_origin, set_pose
from .translation import Translation
from .xml import Node, add

_MARGIN = 1e-12
"""Excess of moments, relative to the largest, that remains valid after rounding."""

_DOUBLE_MARGIN = 1e-7
"""The same of a body whose two largest moments are nearly equal, such as a thin rod. gz-math finds
moments as roots of a cubic, and a double root has half the digits: of 100 tilted rods, ign sdf 12.3
rejects 28 with an excess of 1e-8, and none with 5e-8 (run)."""

_DOUBLE = 1e-3
"""Difference of the two largest moments, relative to the largest, up to which they are nearly equal
(same run: from there on, an excess of 1e-12 is accepted)."""

_EPSILON = 2e-15
"""Excess of moments, relative to the largest, that is rounding."""

WEIGHTLESS = 1e-12
"""Mass [kg] of a moving link without mass; its radius of gyration is one millimeter. Chosen, no
source."""


def add_inertial(node: Node, t: Translation, link: Link) -> None:
    """Add the combined inertial of a link and of the links it owns."""
    mass = t.plan.mass[link.name]
    _report_dissolved(t, link)
    if mass.mass <= 0:
        _add_weightless(node, t, link, mass.tensor)
        return
    alone = link.name in t.plan.alone
    own = link.inertial
    about: Part = own or link
    short = get_excess(mass.tensor, mass.mass)
    node = add(node, "inertial")
    if alone and own is not None and short <= WRITTEN_ROUNDING:
        set_origin(node, own.origin, exact=t.options.is_at_least("1.9"))
        tensor = get_written_tensor(own.inertia)
    else:
        set_pose(node, Pose(translation=mass.com))
        tensor = mass.tensor
    add(node, "mass", number_text(mass.mass))
    if short > WRITTEN_ROUNDING:
        tensor, how = repair_inertia(t, link.name)
        t.report_loss(
            "inertia",
            f"inertia of link '{link.name}' is physically inconsistent (principal moments "
            f"{format_moments_text(mass.tensor)} kg·m²): {how} to {format_moments_text(tensor)} "
            "kg·m²",
            about,
            link,
            data={"excess": short},
        )
    elif short > ROUNDING:
        t.report_loss(
            "inertia",
            f"inertia of link '{link.name}' is inconsistent only by rounding (the largest moment "
            f"exceeds the sum of the others by {short:.2g} of itself); the nearest consistent one "
            "is written",
            about,
            link,
        )
        tensor = find_nearest_consistent(tensor, CLEAR)
    margin = _find_margin(tensor)
    if margin == _DOUBLE_MARGIN:
        t.report_note(
            "inertia",
            f"inertia of link '{link.name}' is that of a thin tilted rod, which Gazebo's reader "
            f"rejects by rounding; its moments are moved by {margin:g} of the largest",
            about,
            link,
        )
    _add_tensor(node, find_nearest_consistent(tensor, margin) if margin else tensor)


def _find_margin(tensor: SymmetricTensor) -> float:
    """Find the excess that lets readers accept a tensor although they round its moments.

    Returns:
        The excess, relative to the largest moment; 0 if they accept the tensor as it is.
    """
    consistency = measure_consistency(tensor)
    _, middle, high = consistency.moments
    margin = _DOUBLE_MARGIN if high - middle <= _DOUBLE * high else _MARGIN
    is_diagonal = not (tensor[1] or tensor[2] or tensor[4])
    if consistency.excess < -margin or (is_diagonal and consistency.excess <= _EPSILON):
        return 0.0
    return margin


def _add_tensor(node: Node, tensor: SymmetricTensor) -> None:
    inertia = add(node, "inertia")
    for name, value in zip(COMPONENTS, tensor, strict=True):
        add(inertia, name, number_text(value))


def _add_weightless(node: Node, t: Translation, link: Link, tensor: SymmetricTensor) -> None:
    """Add the inertial of a massless link that moves or is the only link."""
    node = add(node, "inertial")
    add(node, "mass", number_text(WEIGHTLESS))
    tiny = WEIGHTLESS * 1e-6
    if not any(tensor) or measure_consistency(tensor).excess > ROUNDING:
        tensor = make_diagonal_tensor(tiny, tiny, tiny)
    _add_tensor(node, tensor)
    below = any(t.robot.link[name].mass > 0 for name in t.robot.tree.list_descendants(link.name))
    t.report_loss(
        "mass",
        f"link '{link.name}' has no mass{'' if below else ', nor have the links below it'}; a "
        "link of "
        f"SDF needs one, and gets {WEIGHTLESS:g} kg",
        link.inertial or link,
        link,
        severity=Severity.INFO if below else Severity.WARNING,
        hint="" if below else "give it a mass, or make its parent joint fixed",
    )


def _report_dissolved(t: Translation, link: Link) -> None:
    """Report why each member keeps only its frame, unless all links are lumped."""
    if t.options.lump:
        return
    for name in t.plan.members[link.name]:
        member = t.robot.link[name]
        if name == link.name:
            continue
        bad = member.mass > 0 and member.inertial is not None
        why = "has a physically inconsistent inertia" if bad else "has no mass"
        t.report_note(
            "link",
            f"link '{name}' {why} and is joined to '{link.name}' by a fixed joint; it is a "
            "frame of that link, with its shapes and sensors",
            member,
            member,
        )


CLEAR = 1e-6
"""Margin of a repaired tensor, relative to its largest moment, so that every reader accepts it."""


def repair_inertia(t: Translation, name: str) -> tuple[SymmetricTensor, str]:
    """Repair the inertia tensor of a body.

    Returns:
        The tensor about the center of mass, along the axes of the link [kg·m²], and a description
        of the method for a message.
    """
    members = t.plan.members[name]

    def measure_box() -> Vector | None:
        from ...geometry.link_extent import compute_box_size  # numpy, only for bodies that need it

        return compute_box_size(t.robot, ((t.robot.link[m], t.plan.in_owner[m]) for m in members))

    return repair_tensor(
        t.options.fix_inertia,
        t.plan.mass[name],
        measure_box,
        lift=partial(find_nearest_consistent, margin=CLEAR),
    )
