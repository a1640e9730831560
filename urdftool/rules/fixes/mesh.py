"""Fixes of how mesh files are named."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path

from ...model.elements import Mesh
from ...source.document import Element
from ...source.packages import own_package
from ..mesh.uris import folder_of, malformation
from ..mesh.uses import MeshUse, actual_case, mesh_uses
from ..rule import Problem
from .proposal import Around, Change, Proposal, attribute_at, first, put, safe, sub, unsafe


def uses_of(around: Around, uri: str | None) -> list[MeshUse]:
    """The uses of a mesh by what names it; of all meshes where that is None."""
    found = mesh_uses(around.robot, around.description)
    return [use for use in found if uri is None or use.uri == uri]


def _everywhere(
    problem: Problem, around: Around, change: Callable[[MeshUse], Change | None]
) -> list[Change] | None:
    """A change wherever the mesh that is spoken of is used; None where one of them cannot be."""
    found = attribute_at(problem)
    if found is None:
        return None
    changes = [change(use) for use in uses_of(around, found[0].get(found[1]))]
    whole = [one for one in changes if one is not None]
    return whole if len(whole) == len(changes) else None


def _tail(old: str, new: str) -> tuple[str, str]:
    """What differs of two names of one length: the end of the old as a pattern, and of the new."""
    differs = next((i for i, (a, b) in enumerate(zip(old, new, strict=False)) if a != b), 0)
    same = old.rfind("/", 0, differs) + 1
    return re.escape(old[same:]) + "$", new[same:].replace("\\", r"\\")


def mesh_case_mismatch(problem: Problem, around: Around) -> Proposal | None:
    """As the file is called on disk."""

    def change(use: MeshUse) -> Change | None:
        actual = actual_case(use.path) if use.path is not None else None
        if actual is None or use.path is None:
            return None
        new = use.uri
        for wanted, there in zip(use.path.parts, actual.parts, strict=True):
            if wanted != there:
                head, found, tail = new.rpartition(wanted)
                if not found:
                    return None
                new = head + there + tail
        pattern, text = _tail(use.uri, new)
        return sub(use.mesh.element, "filename", pattern, text)

    changes = _everywhere(problem, around, change)
    return safe("write it as the file is called", *changes) if changes else None


def malformed_uri(problem: Problem, around: Around) -> Proposal | None:
    """Slashes as they should be."""

    def change(use: MeshUse) -> Change | None:
        element, uri = use.mesh.element, use.uri
        if re.match(r"(package|model|file):/?(?!/)", uri) and "lacks a slash" in malformation(use):
            return sub(element, "filename", r"^(package|model|file):/*", r"\1://")
        if "backslashes" in malformation(use):
            return sub(element, "filename", r"\\+", "/")
        if "doubled slash" in malformation(use):
            return sub(element, "filename", r"(?<!:)/{2,}", "/")
        if "ends with a blank" in malformation(use):
            return sub(element, "filename", r"^\s+|\s+$", "")
        return None

    changes = _everywhere(problem, around, change)
    return safe("write it as a URI is written", *changes) if changes else None


def _in_package(path: Path | None, own: tuple[str, Path] | None) -> str | None:
    """The URI of a file in a package; None where it is outside."""
    if path is None or own is None or not os.path.isfile(path):
        return None
    inside = os.path.relpath(os.path.realpath(path), os.path.realpath(own[1])).replace(os.sep, "/")
    return None if inside.startswith("..") else f"package://{own[0]}/{inside}"


def relative_uri_in_ros(problem: Problem, around: Around) -> Proposal | None:
    """By its package, all of them."""
    own = own_package(around.description.packages.file)
    changes = []
    for use in uses_of(around, None):
        if not use.uri.strip() or "://" in use.uri or use.is_absolute or malformation(use):
            continue
        uri = _in_package(use.path, own)
        if uri is None:
            return None
        changes.append(put(use.mesh.element, "filename", uri))
    return unsafe(f"write package://{own[0] if own else ''}/…", *changes) if changes else None


def absolute_path(problem: Problem, around: Around) -> Proposal | None:
    """By its package, where the file is in it or one of that name is."""
    own = own_package(around.description.packages.file)

    def change(use: MeshUse) -> Change | None:
        uri = _in_package(use.path, own)
        if uri is None and own is not None:
            parts = use.uri.replace("\\", "/").split("/")
            if own[0] in parts[:-1]:
                rest = parts[len(parts) - parts[::-1].index(own[0]) :]
                if os.path.isfile(own[1].joinpath(*rest)):
                    uri = f"package://{own[0]}/{'/'.join(rest)}"
        return None if uri is None else put(use.mesh.element, "filename", uri)

    changes = _everywhere(problem, around, change)
    if " more are wanted from " in problem.message:
        folder = problem.message.rpartition(" more are wanted from ")[2]
        uses = [use for use in uses_of(around, None) if use.is_absolute and not use.exists]
        changes = list(filter(None, [change(use) for use in uses if folder_of(use) == folder]))
    return unsafe("write it as a package:// URI", *changes) if changes else None


def wrong_package_in_uri(problem: Problem, around: Around) -> Proposal | None:
    """This package's, where the file is in it."""
    found = attribute_at(problem)
    own = own_package(around.description.packages.file)
    if found is None or own is None:
        return None
    wrong = (found[0].get("filename") or "").partition("://")[2].partition("/")[0]
    changes = []
    for _, shape in around.robot.shapes:
        mesh = shape.geometry
        if isinstance(mesh, Mesh) and mesh.filename.startswith(f"package://{wrong}/"):
            rest = mesh.filename.partition("://")[2].partition("/")[2]
            if not os.path.isfile(own[1] / rest):
                return None
            changes.append(
                sub(mesh.element, "filename", "^package://[^/]*/", f"package://{own[0]}/")
            )
    return unsafe(f"write package://{own[0]}/…", *changes) if changes else None


def package_uri_unresolvable(problem: Problem, around: Around) -> Proposal | None:
    """MuJoCo's own settings, with the folder of the meshes."""
    return _compiler(around)


def mujoco_missing_compiler(problem: Problem, around: Around) -> Proposal | None:
    """The same."""
    return _compiler(around)


def _compiler(around: Around) -> Proposal | None:
    root: Element = around.robot.element
    if root.child("mujoco") is not None:
        return None
    folders = {
        os.path.dirname(os.path.realpath(use.path))
        for use in uses_of(around, None)
        if use.path is not None and use.exists
    }
    if len(folders) != 1 or around.description.path == "-":
        return None
    here = os.path.dirname(os.path.realpath(around.description.files[0].path))
    folder = os.path.relpath(folders.pop(), here).replace(os.sep, "/")
    line = f'\t<compiler meshdir="{folder}" discardvisual="false" strippath="true"/>'
    return unsafe(
        "add <mujoco> with the folder of the meshes", first(root, "<mujoco>", line, "</mujoco>")
    )
