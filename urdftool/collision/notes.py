"""Notes on a result: what happened to a mesh, by code; the text is for people only."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..diagnostic import Diagnostic, Severity

COACD_FAILED = "coacd-failed"
COACD_KILLED = "coacd-killed"
"""A process was killed from outside, so that the result is not reproducible."""
HULL_INSTEAD = "hull-instead"
FLAT_MESH = "flat-mesh"
HULL_OF_ENGINES = "hull-of-engines"
MORE_PIECES = "more-pieces"
"""Number of ``pieces`` and ``error`` that a larger limit would give."""
CLOSED_GAP = "closed-gap"
"""``depth`` [m] of a gap that pieces close, which is the error, and its least ``width`` [m]."""
MESH_REPAIRED = "mesh-repaired"
SPHERES = "spheres"
"""How far the surface is ``outside`` of spheres, and their ``protrusion`` [mm]."""

SHOWN = frozenset({COACD_FAILED, COACD_KILLED, HULL_INSTEAD, FLAT_MESH, HULL_OF_ENGINES})
"""Codes of notes that are printed without ``-v``."""


def make_note(code: str, message: str, data: Mapping[str, Any] | None = None) -> Diagnostic:
    """Make a remark on the geometry of a mesh; one that is printed without ``-v`` is a warning.

    Args:
        code: One of the constants of this module.
        message: A complete sentence.
        data: Values by name, of the types that JSON has.
    """
    severity = Severity.WARNING if code in SHOWN else Severity.INFO
    return Diagnostic(code, severity, message, data=data or {})


def pack_note(note: Diagnostic) -> dict[str, Any]:
    """Return the values for :func:`unpack_note`."""
    return {"code": note.code, "message": note.message, "data": dict(note.data)}


def unpack_note(table: Mapping[str, Any]) -> Diagnostic:
    """Restore a note from :func:`pack_note`."""
    return make_note(table["code"], table["message"], table["data"])
