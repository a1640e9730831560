"""Anchors and relative poses of copied equalities, in the frames of links.

An export has the frames of bodies at their joints, where MJCF may have them elsewhere.
"""

from __future__ import annotations

from collections.abc import Iterable

from ...model.mechanism import NativeElement
from ...model.pose import IDENTITY, Pose
from .read_compile import Row
from .read_context import Context


def move_anchors(context: Context, elements: Iterable[NativeElement]) -> None:
    """Write what ``<connect>`` and ``<weld>`` have in frames of bodies in those of links.

    Args:
        context: The compiled model, with the pose of each body in the frame of its link.
        elements: The elements of ``<equality>``, whose attributes are changed.
    """
    rows = {context.get_place(row).place: row for row in context.list_rows("equality")}
    for element in elements:
        row = rows.get(element.place)
        if row is None or row["objtype"] != "body" or row["type"] not in ("connect", "weld"):
            continue
        first, second = context.shifts[row["obj1id"]], context.shifts[row["obj2id"]]
        if first != IDENTITY or second != IDENTITY:
            element.attributes.update(_move(row, element, first, second))


def _move(row: Row, element: NativeElement, first: Pose, second: Pose) -> dict[str, str]:
    """Return the changed attributes.

    The position of ``relpose`` is that of the anchor of a weld, which its second body has.
    """
    x, y, z = row["data"][:3]
    if row["type"] == "connect":
        return {"anchor": _format(first.transform((x, y, z)))}
    moved = {"anchor": _format(second.transform((x, y, z)))}
    written = [float(word) for word in element.attributes.get("relpose", "").split()]
    if any(written[3:]):  # otherwise MuJoCo computes it from the start
        u, v, w, q0, q1, q2, q3 = row["data"][3:10]
        place = first.transform((u, v, w))  # frames of links have the axes of the bodies
        moved["relpose"] = f"{_format(place)} {_format((q0, q1, q2, q3))}"
    return moved


def _format(values: Iterable[float]) -> str:
    return " ".join(repr(value + 0.0) for value in values)
