"""Names of visuals and collisions, which SDF requires to be unique in a link."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ...model.elements import Collision, Link, Visual
from ..common.naming import get_first_free, list_numbered_names
from .names import remove_reserved


def choose_shape_names(members: list[Link]) -> dict[int, str]:
    """Choose the name of each visual and collision, by ``id`` of the shape.

    Shapes without a name become LINK_visual, LINK_visual_1 and so on. A visual with the name of a
    collision becomes NAME_visual, as sensors refer to collisions by name.
    """
    names: dict[int, str] = {}
    used: set[str] = set()
    for kind in ("collision", "visual"):
        for member in members:
            shapes: Sequence[Collision | Visual] = (
                member.collisions if kind == "collision" else member.visuals
            )
            for index, shape in enumerate(shapes):
                own = _format_allowed(shape.name or "")
                candidates = _list_candidates(own, member.name, kind, index)
                names[id(shape)] = get_first_free(candidates, used)
                used.add(names[id(shape)])
    return names


def _format_allowed(name: str) -> str:
    name = remove_reserved(name)
    return "world_shape" if name == "world" else name


def _list_candidates(own: str, link: str, kind: str, index: int) -> Iterator[str]:
    base = own or f"{remove_reserved(link)}_{kind}" + (f"_{index}" if index else "")
    yield base
    if own and kind == "visual":
        base = f"{own}_visual"
        yield base
    yield from list_numbered_names(base, 1)
