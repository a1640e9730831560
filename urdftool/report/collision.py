"""Results of collision mesh simplification as a table and JSON."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..collision.compute import Result, Task, format_scale
from ..collision.notes import CLOSED_GAP, MORE_PIECES, SHOWN
from ..collision.rewrite import format_geometry_tag
from ..collision.robot import Written
from .json_text import format_json
from .tables import render_table

_HEAD = (
    "method",
    "pieces",
    "vertices",
    "triangles",
    "error",
    "reach",
    "excess",
    "volume",
    "outside",
    "seconds",
)


@dataclass(frozen=True, eq=False)
class Row:
    """The result for a mesh or the meshes of a link, or for a single mesh file."""

    name: str
    mesh: str
    scale: tuple[float, ...]
    result: Result
    max_error: float
    files: tuple[str, ...] = ()
    source: str = ""
    requested: str = "auto"
    others: tuple[str, ...] = ()

    @property
    def within(self) -> bool:
        """Tell whether the error is within the limit."""
        return self.result.error <= self.max_error

    def as_dict(self) -> dict[str, Any]:
        """Return the JSON form."""
        result = self.result
        record: dict[str, Any] = {"link": self.name, "source": self.source} if self.source else {}
        return {
            **record,
            "mesh": self.mesh,
            "others": list(self.others),
            "scale": list(self.scale),
            "method": result.method,
            "max_error": self.max_error,
            "within": self.within,
            "before": result.before,
            "measures": result.measures,
            "pieces": [
                _build_piece(result, index, self.files[index] if self.files else "")
                for index in range(len(result.pieces))
            ],
            "notes": list(result.notes),
        }

    def build_timings(self) -> dict[str, Any]:
        """Return the values that differ between runs: elapsed seconds, and use of the cache."""
        return {"seconds": round(self.result.seconds, 3), "cached": self.result.cached}


@dataclass(frozen=True)
class Report:
    """All rows of a robot or of a mesh."""

    path: str
    output: str
    rows: Sequence[Row]
    left: Sequence[str] = field(default_factory=list)

    def as_dict(self, *, timings: bool = False) -> dict[str, Any]:
        """Return the JSON form; ``timings`` adds values that differ between runs."""
        return {
            "input": self.path,
            "output": self.output,
            "parts": [
                row.as_dict() | (row.build_timings() if timings else {}) for row in self.rows
            ],
            "left": list(self.left),
        }


def get_rows(written: Written, results: Mapping[Task, Result]) -> list[Row]:
    """Return a row for each mesh of a robot."""
    return [
        Row(
            item.link.name,
            str(use.task.path),
            use.task.scale,
            results[use.task],
            use.task.settings.max_error,
            tuple(written.layout.names[id(results[use.task])]),
            item.source,
            use.task.settings.method,
            tuple(str(other.path) for other in use.task.others),
        )
        for item in written.plans
        for use in item.uses
        if use.task is not None
    ]


def as_json(reports: Sequence[Report], *, timings: bool = False) -> str:
    """Format all reports as one object; ``timings`` as in :meth:`Report.as_dict`."""
    records = [report.as_dict(timings=timings) for report in reports]
    return format_json({"version": 1, "results": records}, 2) + "\n"


def format_table(rows: Sequence[Row]) -> str:
    """Format the sizes before and after, and the errors, one line for each mesh."""
    if not rows:
        return ""
    lines: list[Sequence[str]] = [("", *_HEAD)]
    lines += [(_label(row), *_format_cells(row)) for row in rows]
    return render_table(lines, left=(0, 1))


def format_millimeters(length: float) -> str:
    """Format a length [m] in millimeters, with three digits or all digits before the point."""
    millimeters = length * 1000
    return f"{millimeters:.3g}" if millimeters < 999.5 else f"{millimeters:.0f}"


def format_remarks(rows: Iterable[Row]) -> Iterable[str]:
    """Yield a line with advice for each mesh whose error exceeds the limit."""
    for row in rows:
        if not row.within:
            exceeds = f"{_format_sizes(row)} exceeds {row.max_error:.1%}"
            yield f"{_label(row)}: {exceeds}; {_format_advice(row)}"


def _format_sizes(row: Row) -> str:
    """Format what exceeds the limit."""
    measures = row.result.measures
    name = "reach" if measures["reach"] >= measures["excess"] else "excess"
    count = len(row.result.pieces)
    return f"{name} {row.result.error:.1%} with {count} piece{'s' * (count != 1)}"


def _format_advice(row: Row) -> str:
    """Return options that may reduce the error."""
    for note in row.result.diagnostics:
        if note.code == MORE_PIECES:
            pieces, error = note.data["pieces"], note.data["error"]
            return f"--max-hulls {pieces} would give about {error:.1%}"
        if note.code == CLOSED_GAP:
            width = format_millimeters(note.data["width"])
            return (
                f"the pieces close a gap of this depth that is over {width} mm wide; more pieces "
                "do not open it"
            )
    if row.result.method == "simplify":
        return "try more --max-triangles"
    if row.requested == "coacd":
        return "try a smaller --threshold with more --max-triangles"
    if row.requested == "spheres":
        return "try more spheres: a larger --count or --max-hulls, or a smaller --max-error"
    if row.requested in ("auto", "cuts"):
        return "more pieces help little; allow a larger --max-error or try --method simplify"
    return "try --method auto"


def format_notes(rows: Iterable[Row]) -> Iterable[str]:
    """Yield the notes on repaired meshes and failed methods."""
    for row in rows:
        for note in row.result.diagnostics:
            yield f"{_label(row)}: {note.message}"


def format_failures(rows: Iterable[Row]) -> Iterable[str]:
    """Yield the notes on failures, substitutes, and convex hulls that engines use."""
    for row in rows:
        for note in row.result.diagnostics:
            if note.code in SHOWN:
                yield f"{_label(row)}: {note.message}"


def summarize(report: Report) -> str:
    """Summarize a report in one line."""
    rows = report.rows
    pieces = sum(len(row.result.pieces) for row in rows)
    missed = sum(not row.within for row in rows)
    meshes = sum(1 + len(row.others) for row in rows)
    cached = sum((1 + len(row.others)) * row.result.cached for row in rows)
    words = [f"{meshes} mesh{'es' * (meshes != 1)} to {pieces} piece{'s' * (pieces != 1)}"]
    if report.output and not rows:
        words.append("no link has a mesh to work on; the robot is as it was")
    if missed:
        what = f"link{'s' * (missed != 1)} " if meshes > len(rows) else ""
        words.append(f"{missed} {what}not within the error")
    if cached:
        words.append(f"{cached} from the cache")
    where = f" -> {report.output}" if report.output else ""
    return f"{report.path}{where}: {', '.join(words)}"


def _label(row: Row) -> str:
    if not row.source:
        return row.name
    if row.others:
        return f"{row.name} ({1 + len(row.others)} meshes)"
    scale = format_scale(row.scale)
    return f"{row.name} {Path(row.mesh).name}{' ' + scale if scale else ''}"


def _format_cells(row: Row) -> tuple[str, ...]:
    result, measures = row.result, row.result.measures
    kinds = {piece.kind for piece in result.pieces}
    what = "+".join(sorted(kinds)) if result.method == "primitive" else result.method
    seconds = "cached" if result.cached else f"{result.seconds:.1f}"
    return (
        what,
        str(len(result.pieces)),
        f"{result.before['vertices']} → {measures['vertices']}",
        f"{result.before['triangles']} → {measures['triangles']}",
        f"{format_millimeters(measures['hausdorff'])} mm {result.error:.2%}",
        f"{measures['reach']:.2%}",
        f"{measures['excess']:.2%}",
        f"{measures['volume_ratio']:.3f}",
        f"{measures['outside']:.1%}",
        seconds,
    )


def _build_piece(result: Result, index: int, file: str) -> dict[str, Any]:
    piece = result.pieces[index]
    if not piece.is_primitive:
        return {
            "kind": piece.kind,
            "file": file or None,
            "vertices": len(piece.vertices),
            "triangles": len(piece.faces),
        }
    return {
        "kind": piece.kind,
        "size": list(piece.size),
        "center": piece.center.tolist(),
        "centre": piece.center.tolist(),  # the old name
        "rotation": piece.rotation.tolist(),
        "urdf": format_geometry_tag(piece),
    }
