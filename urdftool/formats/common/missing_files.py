"""Causes of missing files; files with the same cause share one explanation."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

from ...errors import AccessError, SourceError
from ...finding import Finding
from ...model.elements import Link, Mesh, Robot
from ..defects import make_defect


class MissingFile(NamedTuple):
    """Why a file is missing.

    Attributes:
        message: Predicate of a sentence about the file: ``does not exist``.
        hint: A remedy, or the path that was tried; may be empty.
        cause: The missing package, folder or file, equal for all files that are missing for the
            same cause; may be empty.
    """

    message: str
    hint: str = ""
    cause: str = ""


def explain_missing_file(robot: Robot, filename: str) -> MissingFile:
    """Determine why a file cannot be read."""
    if not filename or robot.source is None:
        return MissingFile("names no file")
    try:
        path = Path(robot.source.resolve(filename))
    except AccessError as error:
        return MissingFile("is not read", error.message, error.data.get("reason", error.message))
    except SourceError as error:
        scheme, separator, rest = filename.partition("://")
        package = scheme + separator + rest.lstrip("/").partition("/")[0]
        return MissingFile("is not found", error.message, package)
    except ValueError:
        return MissingFile("is not found")
    if not os.path.isdir(path.parent):
        return MissingFile(
            "does not exist", (f"folder {path.parent} does not exist"), str(path.parent)
        )
    return MissingFile("does not exist", f"file {path} does not exist", str(path))


def create_missing_mesh(robot: Robot, link: Link, mesh: Mesh) -> Finding:
    """Create the finding for a mesh file that does not exist."""
    missing = explain_missing_file(robot, mesh.filename)
    return make_defect(
        "mesh-not-found",
        f"mesh '{mesh.filename}' of link '{link.name}' {missing.message}",
        mesh.locate_attribute("filename"),
        "link",
        link.name,
        missing.hint,
        {"not_found_because": missing.cause},
    )
