"""Exact repair of tensors within a rigid body: another link takes what is too much of one."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from typing import NamedTuple

from ...diagnostic import Severity
from ...mechanics.spatial_inertia import SpatialInertia
from ...mechanics.tensor import (
    ROUNDING,
    ZERO_TENSOR,
    SymmetricTensor,
    add_tensors,
    format_moments_text,
    get_excess,
    rotate_tensor,
    scale_tensor,
)
from ...model.pose import Rotation, transpose
from ...source.location import Place
from ..written import Written


class Move(NamedTuple):
    """Surplus of a tensor that moved between links of one rigid body.

    Attributes:
        link: Link whose tensor was inconsistent.
        taker: Link that took the surplus.
        before: The inconsistent tensor [kg·m²].
    """

    link: str
    taker: str
    before: SymmetricTensor


def move_surplus(
    group: dict[str, SpatialInertia],
    rotations: Mapping[str, Rotation],
    wrong: Collection[str],
    top: str,
    lift: Callable[[SymmetricTensor], SymmetricTensor],
) -> list[Move]:
    """Repair tensors of a rigid body whose total stays as it is; ``group`` gets the new ones.

    ``top`` takes a surplus before the others; rotations are in a common frame.

    Returns:
        The tensors that were repaired; none of a link whose surplus no other link can take.
    """
    moves = []
    for name in wrong:
        source = group[name]
        kept = lift(source.tensor) if source.mass > 0 else ZERO_TENSOR
        surplus = rotate_tensor(add_tensors(source.tensor, scale_tensor(kept, -1.0)),
                                rotations[name])  # fmt: skip
        for other in sorted(set(group) - {name}, key=lambda n: (n != top, -group[n].mass, n)):
            taker = group[other]
            turned = rotate_tensor(surplus, transpose(rotations[other]))
            tensor = add_tensors(taker.tensor, turned)
            if is_consistent(taker) and is_consistent(replace(taker, tensor=tensor)):
                group[other] = replace(taker, tensor=tensor)
                group[name] = replace(source, tensor=kept)
                moves.append(Move(name, other, source.tensor))
                break
    return moves


def is_consistent(body: SpatialInertia) -> bool:
    """Tell whether a body has mass and a physically consistent tensor, up to rounding."""
    return body.mass > 0 and get_excess(body.tensor, body.mass) <= ROUNDING


def report_move(written: Written, move: Move, place: Place) -> None:
    """Report that a surplus moved; the robot behaves the same."""
    written.report_loss(
        "inertia-moved",
        f"inertia of link '{move.link}' is physically inconsistent (principal moments "
        f"{format_moments_text(move.before)} kg·m²); the excess is "
        f"moved to link '{move.taker}', which is welded to it; the total is unchanged",
        place,
        kind="link",
        name=move.link,
        severity=Severity.INFO,
    )
