"""Table of the sizes of a bundle, and its report as JSON (``docs/schemas/bundle.json``)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from ..bundle.defect import Defect
from ..finding import Finding
from ..formats.common.loss_report import merge_instances
from .findings_json import build_finding_record
from .json_text import format_json
from .tables import render_table

_HEAD = ("file", "triangles", "pixels", "MB", "distance")


def format_sizes(
    files: Mapping[str, Mapping[str, Any]], size_before: int, size_after: int
) -> list[str]:
    """Format the sizes of meshes and images as the lines of a table.

    Sizes are in bytes.
    """
    rows = [_HEAD]
    for path in sorted(files):
        before = files[path].get("before")
        if before is None:
            continue
        size = f"{before['bytes'] / 1e6:.2f} → {files[path]['bytes'] / 1e6:.2f}"
        counts = before.get("triangles")
        triangles = "" if counts is None else f"{counts[0]:,} → {counts[1]:,}"
        pixels = " → ".join(f"{w} x {h}" for w, h in before.get("pixels", ()))
        error = before.get("error")
        distance = f"{100 * error:.2g} %" if error else ""
        rows.append((path, triangles, pixels, size, distance))
    rows.append(("all meshes and images", "", "", _format_total(size_before, size_after), ""))
    shown = [number for number in range(len(_HEAD)) if any(row[number] for row in rows[1:])]
    return render_table([[row[number] for number in shown] for row in rows]).splitlines()


def to_json(
    output: str | None,
    files: Mapping[str, Mapping[str, Any]],
    findings: Iterable[Finding],
    defects: Iterable[Defect] | None,
) -> str:
    """Format the report of a bundle as one object."""
    found = None if defects is None else list(defects)
    report = {
        "version": 1,
        "output": output,
        "files": [{"path": path, "bytes": files[path]["bytes"]} for path in sorted(files)],
        "findings": [build_finding_record(finding) for finding in merge_instances(findings)],
        "defects": None if found is None else [_build_defect_record(defect) for defect in found],
        "complete": None if found is None else all(defect.is_of_source for defect in found),
    }
    return format_json(report, 1) + "\n"


def _build_defect_record(defect: Defect) -> dict[str, Any]:
    message = defect.message
    return {"code": defect.code, "path": defect.path, "message": message}


def _format_total(before: int, after: int) -> str:
    return f"{before / 1e6:.2f} → {after / 1e6:.2f}"
