"""Table of the sizes of a bundle, before and after its limits."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .tables import render_table

_HEAD = ("file", "triangles", "pixels", "MB", "distance")


def format_sizes(
    files: Mapping[str, Mapping[str, Any]], size_before: int, size_after: int
) -> list[str]:
    """Format the sizes of meshes and images as the lines of a table.

    Args:
        files: The files of ``bundle.json``, by path.
        size_before: Size of all meshes and images of the source [bytes].
        size_after: Size of those of the bundle [bytes].
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


def _format_total(before: int, after: int) -> str:
    return f"{before / 1e6:.2f} → {after / 1e6:.2f}"
