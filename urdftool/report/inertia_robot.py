"""Written and implied mass properties of the links of a robot."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from ..control_characters import escape_controls
from ..inertia.comparison import Comparison
from ..inertia.link_review import LinkReview
from ..inertia.rounding import round_properties
from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.tensor import SymmetricTensor, get_components, rotate_tensor
from ..mechanics.typo_detection import Proposal
from ..model.elements import Link
from ..model.numbers import number_text
from ..model.pose import make_pose
from ..source.location import Place
from .counted import format_count
from .findings import Painter
from .inertia import build_numbers
from .json_text import format_json
from .tables import Cell, render_table

HEADS = (
    "link",
    "mass",
    "implied",
    "moments, written/implied",
    "axes",
    "com off",
    "density",
    "from",
)
UNITS = ("", "kg", "kg", "", "deg", "mm", "kg/m³", "")
_COLORS = {"wrong": "red", "doubtful": "yellow", "incomplete": "yellow", "missing": "yellow"}
_LONGEST_NAME = 40  # characters of a link's name in a table; chosen


def format_table(reviews: Sequence[LinkReview], *, colors: bool = False) -> str:
    """Format a row for each link, with four digits."""
    rows: list[Sequence[Cell]] = [(*HEADS, ""), (*UNITS, "")]
    rows += [
        (*_format_cells(item), (_format_verdict(item), _COLORS.get(item.status)))
        for item in reviews
    ]
    return render_table(rows, left=(0, 7, 8), colors=colors)


def _format_cells(item: LinkReview) -> tuple[str, ...]:
    name = escape_controls(item.link.name)
    name = name if len(name) <= _LONGEST_NAME else name[: _LONGEST_NAME - 1] + "…"
    inertial = item.link.inertial
    written = "–" if inertial is None or inertial.mass is None else f"{inertial.mass:.4g}"
    implied = f"{item.implied.mass:.4g}" if item.implied is not None else "–"
    source = "–"
    if item.body is not None:
        source = item.body.source
        if not item.body.complete:
            source += " (lacks)"
        elif not item.body.reliable:
            source += " (unsure)"
    return (name, written, implied, *_format_comparison(item.comparison, item), source)


def _format_comparison(
    comparison: Comparison | None, item: LinkReview
) -> tuple[str, str, str, str]:
    if comparison is None:
        density = ""
        if item.implied is not None and item.body is not None:
            density = f"{item.implied.mass / item.body.volume:.4g}"
        return "–", "–", "–", density or "–"
    return (
        " ".join(f"{ratio:.3g}" for ratio in comparison.ratio),
        "–" if comparison.angle is None else f"{math.degrees(comparison.angle):.1f}",
        f"{comparison.distance * 1000:.3g}" if comparison.distance > 1e-8 else "0",
        f"{comparison.density:.4g}",
    )


def _format_verdict(item: LinkReview) -> str:
    status = item.status
    if status == "wrong":
        return "IMPOSSIBLE: " + ", ".join(dict.fromkeys(fault.code for fault in item.faults))
    if status == "doubtful":
        return "doubtful"
    if status == "missing":
        return "no inertial"
    if status == "incomplete":
        return "lacks " + ", ".join(item.missing)
    return "" if status == "ok" else status


def format_remarks(
    reviews: Sequence[LinkReview], *, form: str = "urdf", colors: bool = False
) -> Iterator[str]:
    """Yield faults with proposals, notes, and geometry that cannot be read."""
    paint = Painter(colors)
    links_of_fault: dict[tuple[str, str], list[str]] = {}
    for item in reviews:
        for fault in item.faults:
            links_of_fault.setdefault((str(fault.location), fault.code), []).append(
                escape_controls(item.link.name)
            )
    for item in reviews:
        name = escape_controls(item.link.name)
        for fault in item.faults:
            names = links_of_fault.pop((str(fault.location), fault.code), [])
            if names:
                who = f"link '{names[0]}'" + f" and {len(names) - 1} more" * (len(names) > 1)
                place, message = (
                    escape_controls(str(fault.location)),
                    escape_controls(fault.message),
                )
                yield f"{place}: {paint('error', 'red')}: {who}: {message}"
        if item.proposal is not None:
            at = item.link.inertial.inertia if item.link.inertial else None
            if not item.faults and at is not None:
                place = escape_controls(str(at.place))
                yield (
                    f"{place}: {paint('warning', 'yellow')}: link '{name}': "
                    + _format_distance(item)
                )
            yield f"  intended, probably: {escape_controls(item.proposal.sentence)}"
            yield f"  {_format_tensor(item.proposal.tensor, item.link, form)}"
        elif item.faults and item.implied is not None and item.faults[-1].code != "unreadable":
            yield (
                f"  the geometry implies, at {item.implied.mass:.6g} kg: "
                f"{_format_short(item.implied)}"
            )
        yield from format_geometry_remarks(item)


def format_geometry_remarks(item: LinkReview) -> Iterator[str]:
    """Yield what must be known of numbers that are computed from the geometry of a link."""
    name, at = escape_controls(item.link.name), escape_controls(str(item.link.place))
    for note in item.notes:
        yield f"{at}: link '{name}': {escape_controls(note.message)}"
    if item.body is None:
        return
    for lack in item.body.lacks:
        place, reason = escape_controls(str(lack.shape.place)), escape_controls(lack.reason)
        yield f"{place}: link '{name}': {item.body.source} geometry ignored: {reason}"
    for piece in item.body.pieces:
        place = escape_controls(str(piece.shape.place))
        if not piece.reliable:
            yield (
                f"{place}: link '{name}': {escape_controls(piece.what)} is not closed; "
                f"estimated by {piece.method}, not reliable"
            )
        for message in piece.note_texts:
            yield f"{place}: link '{name}': {escape_controls(message)}"


def _format_tensor(tensor: SymmetricTensor, link: Link, form: str) -> str:
    """Return the tensor of a link in the syntax of a format."""
    if form == "mjcf":
        origin = None if link.inertial is None else link.inertial.origin
        return _format_mjcf(rotate_tensor(tensor, make_pose(origin).rotation))
    six = _round_components(tensor)
    if form == "sdf":
        inner = "".join(f"<{key}>{number_text(value)}</{key}>" for key, value in six.items())
        return f"<inertia>{inner}</inertia>"
    return f"<inertia {' '.join(_format_attribute(*item) for item in six.items())}/>"


def _format_attribute(key: str, value: float) -> str:
    return f'{key}="{number_text(value)}"'


def _format_mjcf(tensor: SymmetricTensor) -> str:
    """Return attributes of ``<inertial>`` for a tensor in the axes of the body."""
    six = _round_components(tensor)
    moments = [number_text(six[key]) for key in ("ixx", "iyy", "izz")]
    products = [number_text(six[key]) for key in ("ixy", "ixz", "iyz")]
    if all(text == "0" for text in products):
        return f'diaginertia="{" ".join(moments)}", without quat'
    return f'fullinertia="{" ".join(moments + products)}", without quat'


def _format_distance(item: LinkReview) -> str:
    ratio = " ".join(f"{value:.3g}" for value in item.comparison.ratio) if item.comparison else ""
    return f"the inertia is possible, but {ratio} times what the geometry implies"


def _round_components(tensor: SymmetricTensor) -> dict[str, float]:
    return get_components(_round_noise(SpatialInertia(1.0, tensor=tensor)).tensor)


def _round_noise(properties: SpatialInertia) -> SpatialInertia:
    try:
        return round_properties(properties)
    except ValueError:
        return properties


def _format_short(properties: SpatialInertia) -> str:
    six = get_components(properties.tensor)
    return ", ".join(f"{name} {value:.6g}" for name, value in six.items())


def summarize(reviews: Sequence[LinkReview]) -> str:
    """Summarize the counts and the total mass in one line."""
    counts = {
        label: sum(item.status == status for item in reviews)
        for status, label in (
            ("wrong", "impossible"),
            ("doubtful", "doubtful"),
            ("missing", "without inertial"),
            ("incomplete", "incomplete"),
            ("frame", "frame"),
        )
    }
    written = math.fsum(item.link.mass for item in reviews)
    parts = [format_count(len(reviews), "link"), f"{written:.6g} kg written"]
    planned = math.fsum(item.mass or 0.0 for item in reviews)
    if not math.isclose(planned, written, rel_tol=1e-9, abs_tol=1e-12):
        parts.append(f"{planned:.6g} kg assigned")
    frames = counts.pop("frame")
    parts += [f"{count} {label}" for label, count in counts.items() if count]
    parts += [format_count(frames, "frame")] if frames else []
    return ", ".join(parts)


def as_dict(reviews: Sequence[LinkReview], name: str, path: str) -> dict[str, Any]:
    """Return the JSON form of a review."""
    return {
        "version": 1,
        "robot": name,
        "path": path,
        "links": [_link(item) for item in reviews],
        "summary": {
            "links": len(reviews),
            "mass": math.fsum(item.link.mass for item in reviews),
            "wanted_mass": math.fsum(item.mass or 0.0 for item in reviews),
            **{
                status: sum(item.status == status for item in reviews)
                for status in ("ok", "wrong", "doubtful", "missing", "incomplete", "frame")
            },
        },
    }


def as_json(found: dict[str, Any]) -> str:
    """Format the JSON form as text."""
    return format_json(found, 1) + "\n"


def place_dict(place: Place) -> dict[str, Any]:
    """Return the JSON form of a location."""
    return {"path": place.path, "line": place.line, "column": place.column}


def _build_proposal(proposal: Proposal | None) -> dict[str, Any] | None:
    """Return the JSON form: kind, sentence and the six numbers [kg·m²]."""
    if proposal is None:
        return None
    return {
        "kind": proposal.kind,
        "sentence": proposal.sentence,
        "inertia": _round_components(proposal.tensor),
    }


def _build_implied(item: LinkReview) -> dict[str, Any] | None:
    """Return the mass properties that the geometry implies; None if they are not finite."""
    if item.implied is None or not all(map(math.isfinite, item.implied.tensor)):
        return None
    return build_numbers(_round_noise(item.implied))


def _link(item: LinkReview) -> dict[str, Any]:
    body = item.body
    return {
        "name": item.link.name,
        **place_dict(item.link.place),
        "status": item.status,
        "source": body.source if body is not None else None,
        "volume": body.volume if body is not None and body.complete else None,
        "reliable": body.reliable if body is not None else None,
        "mass": item.mass,
        "written": item.written.as_dict() if item.written is not None else None,
        "implied": _build_implied(item),
        "comparison": item.comparison.as_dict() if item.comparison is not None else None,
        "missing": list(item.missing),
        "faults": [
            {"kind": fault.code, "message": fault.message, **place_dict(fault.location)}
            for fault in item.faults
        ],
        "proposal": _build_proposal(item.proposal),
        "pieces": [
            {
                "what": piece.what,
                "volume": piece.unit.mass,
                "method": piece.method,
                "reliable": piece.reliable,
                "error": piece.error,
                "notes": list(piece.note_texts),
                **place_dict(piece.shape.place),
            }
            for piece in (body.pieces if body is not None else ())
        ],
        "lacks": [
            {"reason": lack.reason, **place_dict(lack.shape.place)}
            for lack in (body.lacks if body is not None else ())
        ],
        "notes": [note.message for note in item.notes],
    }
