"""Results of a check of collision geometry, as a table and JSON."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ..collision.check import Checked
from .collision import format_millimeters
from .counted import format_count
from .tables import render_table


def as_dict(path: str, found: Sequence[Checked], limit: float) -> dict[str, Any]:
    """Return the JSON form for one robot; ``limit`` is that of links without one of their own."""
    return {
        "input": path,
        "max_error": limit,
        "links": [
            {
                "link": item.link,
                "max_error": item.max_error,
                "within": None if item.is_unmeasured else item.is_good,
                "measures": item.measures,
                "concave_meshes": item.concave,
                "hull_error": item.hull_error,
                "trouble": item.trouble,
            }
            for item in found
        ],
    }


def format_table(found: Sequence[Checked]) -> str:
    """Format the results, one line for each link."""
    if not found:
        return ""
    lines: list[Sequence[str]] = [
        ("", "", "pieces", "triangles", "error", "reach", "excess", "volume", "outside")
    ]
    for item in found:
        verdict = "-" if item.is_unmeasured else "ok" if item.is_good else "BAD"
        m = item.measures
        if m is None:
            lines.append((item.link, verdict, *["-"] * 7))
            continue
        lines.append(
            (
                item.link,
                verdict,
                str(m["pieces"]),
                str(m["triangles"]),
                f"{format_millimeters(m['hausdorff'])} mm {m['error']:.2%}",
                f"{m['reach']:.2%}",
                f"{m['excess']:.2%}",
                f"{m['volume_ratio']:.3f}",
                f"{m['outside']:.1%}",
            )
        )
    return render_table(lines, left=(0, 1))


def format_remarks(found: Sequence[Checked]) -> Iterator[str]:
    """Yield a line for each problem of a link."""
    for item in found:
        if item.trouble:
            yield f"link '{item.link}': {item.trouble}"
        elif item.measures is not None and item.is_above:
            yield (
                f"link '{item.link}': error {item.measures['error']:.2%} of its size, "
                f"not within {item.max_error:.2%}"
            )
        if item.hull_error is not None:
            yield (
                f"link '{item.link}': {item.concave} collision mesh{'es' * (item.concave > 1)} not "
                f"convex; PyBullet and MuJoCo touch the hull, whose error is {item.hull_error:.2%}"
            )


def summarize(found: Sequence[Checked]) -> str:
    """Summarize how many links were measured, and with which result."""
    above = sum(item.is_above for item in found)
    limits = sorted({item.max_error for item in found})
    allowed = f"{limits[0]:.2%}" if len(limits) == 1 else "that of its link"
    lacking = sum(item.lacks_collision for item in found)
    unmeasured = sum(item.is_unmeasured for item in found)
    text = f"{format_count(len(found), 'link')} with visuals, {above} with an error above {allowed}"
    if lacking:
        text += f", {lacking} without collision geometry"
    return text + (f", {unmeasured} not measured" if unmeasured else "")
