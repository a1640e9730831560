"""Read a robot from MJCF.

MuJoCo resolves defaults, classes and settings, and infers what is not written: inertia from
geoms, sizes from ``fromto``, frames of meshes. It runs in a process of its own, because some files
crash it. Everything else is computed here from the specification of the format.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from itertools import product
from pathlib import Path
from typing import Any

from ...diagnostic import Severity
from ...errors import AccessError, ModelError, SourceError
from ...extras import is_installed, make_missing_error
from ...limited import Limits, call_with_limits
from ...model.elements import Robot
from ...model.provenance import Written
from ...mujoco_library import import_mujoco
from ...source.access import FileAccess
from ...source.description import Description
from ...source.document import STDIN, Document, Element
from ...source.location import SourceFile
from ...source.packages import Packages
from ...workspace import Workspace
from ..reading import LARGEST, Losses, Reading, choose_limits, open_description, report_limits
from .read_compile import FOR_FILES, LIMITS, MOST_MEMORY, Compiled, compile_text
from .read_context import Context
from .read_extras import add_extras
from .read_native import add_native
from .read_shapes import add_shapes
from .read_text import Expanded, expand
from .read_tree import add_tree


def read(
    path: str | Path,
    *,
    file: SourceFile | None = None,
    packages: Packages | None = None,
    workspace: Workspace | None = None,
    limits: Limits = LIMITS,
    **_: Any,
) -> Reading:
    """Read a robot.

    ``limits`` are those of MuJoCo; of trusted input only the time is limited.

    Raises:
        MissingDependency: MuJoCo is not installed.
        SourceError: A file cannot be read, or includes itself.
        ModelError: MuJoCo does not compile the model.
    """
    if not is_installed("mujoco"):
        raise make_missing_error("mujoco", "an MJCF file")
    file, finder, workspace = open_description(path, file, packages, workspace)
    expanded = expand(file, workspace)
    check_files(expanded, finder.access)
    compiled = _compile(expanded, workspace, limits)
    losses = Losses()
    context = Context(expanded, compiled, losses)
    written = Written(expanded.root.place)
    robot = Robot(written, expanded.root.get("model") or compiled.name, format="mjcf")
    document = Document(file, expanded.root, [])
    robot.source = Description(str(path), document, expanded.files, finder)
    _check_magnitudes(context)
    add_tree(context, robot)
    add_shapes(context, robot)
    add_extras(context, robot)
    add_native(context, robot)
    for warning in compiled.warnings:
        losses.add("warning", f"MuJoCo warns: {warning}", "", written.place, Severity.INFO)
    for place in expanded.surplus:
        text = "end tags after the root element are ignored, as by MuJoCo"
        losses.add("end-tag", text, "", place)
    for error in expanded.tolerated:
        assert error.at is not None
        text = "XML that MuJoCo accepts and other readers reject"
        losses.add("not-well-formed", text, error.message, error.at, Severity.INFO)
    found = losses.make_findings()
    robot.unread = found
    return Reading(robot, found)


_MEASURED = {
    "body": ("pos", "ipos", "mass", "inertia"),
    "joint": ("pos",),
    "geom": ("pos", "size"),
}


def _check_magnitudes(context: Context) -> None:
    """Check that masses, sizes and positions are not too large to compute with.

    Raises:
        ModelError: One is.
    """
    for kind, names in _MEASURED.items():
        for row in context.list_rows(kind):
            for name in names:
                values = row[name] if isinstance(row[name], list) else [row[name]]
                if not all(abs(value) <= LARGEST for value in values):
                    text = f"{name} of {kind} '{row['name']}' is above {LARGEST:g}"
                    at = context.get_place(row).place
                    raise ModelError(f"{text}; write a plausible number", at=at)


def _compile(expanded: Expanded, workspace: Workspace, limits: Limits) -> Compiled:
    """Compile a model in another process.

    Raises:
        SourceError: A file that it names cannot be read.
        ModelError: MuJoCo does not compile it, crashes or exceeds its limits.
    """
    path = expanded.files[0].path
    folder = os.path.dirname(os.path.abspath(path)) if path != STDIN else os.getcwd()
    paths = {name: asset.path for name, asset in expanded.assets.items()}
    arguments = (expanded.text, expanded.models, paths, folder, workspace)
    with report_limits("MuJoCo", "model", expanded.root.place):
        compiled, read = call_with_limits(
            compile_text,
            *arguments,
            limits=choose_limits(_add_memory(limits, folder, paths, workspace), workspace),
            prepare=import_mujoco,
        )
    if workspace.dependencies is not None:
        workspace.dependencies.include(read)
    if compiled.error_file:
        word = _PLACEHOLDER.search(compiled.error)
        raise SourceError(
            compiled.error,
            at=expanded.assets[compiled.error_file].element.place,
            data={"placeholder": word[0]} if word else _find_missing(compiled.error),
        )
    if compiled.error:
        at = expanded.get_element_at(compiled.error_line).place
        raise ModelError(
            f"MuJoCo does not compile the model: {compiled.error}",
            at=at,
            data={"lost_name": True} if _LOST_NAME.search(compiled.error) else None,
        )
    return compiled


def _find_missing(error: str) -> dict[str, str]:
    """Return the file of an error of a missing one, as data."""
    found = _MISSING.match(error)
    return {"missing": found[1]} if found else {}


_MISSING = re.compile(r"^file '(.+)' does not exist$")
_LOST_NAME = re.compile(r"XML Error: unknown default (?:class|childclass)|Error: unknown element '")
"""Messages of MuJoCo about a name that a model into which it is merged may define."""

_PLACEHOLDER = re.compile("__[A-Z][A-Z0-9_]*__")
"""A word in a path that a program replaces."""


def _add_memory(limits: Limits, folder: str, paths: dict[str, str], workspace: Workspace) -> Limits:
    """Return limits with memory for the files of a model."""
    if limits.memory is None:
        return limits
    files = {os.path.join(folder, path) for path in paths.values()}
    size = sum(workspace.get_size(path) or 0 for path in files)
    return limits._replace(
        memory=max(limits.memory, min(MOST_MEMORY, limits.memory + FOR_FILES * size))
    )


_FOLDERS = ("assetdir", "meshdir", "texturedir")


def check_files(expanded: Expanded, access: FileAccess) -> None:
    """Check every file that MuJoCo may open for a model, with any of its compiler settings.

    Raises:
        AccessError: The model may not read a file.
    """
    elements = list(expanded.lines.values())
    folders = sorted({folder for element in elements for folder in _list_folders(element)})
    main = expanded.files[0].path
    for element in elements:
        sources = {os.path.dirname(path) for path in (main, element.file.path) if path != STDIN}
        for name in _list_names(element):
            for path in _list_paths(name, sources or {""}, folders):
                reason = access.explain_refusal(path) if os.path.lexists(path) else ""
                if reason:
                    raise AccessError(f"file '{name}' {reason}", at=element.place)


def _list_folders(element: Element) -> list[str]:
    return ["", *filter(None, (element.get(name) for name in _FOLDERS))]


def _list_names(element: Element) -> Iterator[str]:
    """Yield the files of an element: ``file``, and ``fileup`` and others of a cube map."""
    for name, value in element.attributes.items():
        if name.startswith("file") and value and "\0" not in value:
            yield value


def _list_paths(name: str, sources: Iterable[str], folders: Iterable[str]) -> set[Path]:
    """Return the paths that a name may mean; MuJoCo may strip its folders."""
    written = {name, os.path.basename(name.replace("\\", "/"))}
    return {Path(source, *parts) for source, *parts in product(sources, folders, written)}
