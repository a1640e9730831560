"""Fixes of mesh files themselves: made anew in place, or beside as another file that is named.

A file is changed in place only where every reader sees the same afterwards, or where no other
description of its package names it. Otherwise a new file is made and the old one stays.
"""

from __future__ import annotations

import os
import re
import unicodedata
from collections.abc import Iterable
from pathlib import Path

from ...errors import MeshError
from ...finding import FileRewrite
from ...source.document import copy_of
from ...source.nearby import bytes_of
from ...source.packages import shown_path
from ..cross_file_references import check_alone
from ..file_rewrites import (
    BINARY,
    COPIED,
    HEADED,
    MIRRORED,
    TURNED,
    WITHOUT_COLLAPSED,
    count_collapsed,
    rewritten_bytes,
)
from ..mesh.uses import MeshUse, mesh_uses
from ..rule import Problem
from .proposal import (
    Around,
    Change,
    Proposal,
    attribute_at,
    put,
    safe,
    sub,
    unsafe,
)


def uses_of(around: Around, uri: str | None) -> list[MeshUse]:
    """List the uses of a mesh by what names it; of all meshes where that is None."""
    found = mesh_uses(around.robot, around.description)
    return [use for use in found if uri is None or use.uri == uri]


def _named(problem: Problem, around: Around) -> list[MeshUse]:
    """Every use of the mesh that is spoken of, where its file is there."""
    found = attribute_at(problem)
    uses = uses_of(around, found[0].get(found[1])) if found is not None else []
    return uses if uses and uses[0].path is not None and uses[0].exists else []


def _in_place(uses: Iterable[MeshUse], how: str) -> list[FileRewrite]:
    paths = dict.fromkeys(shown_path(use.path) for use in uses if use.path is not None)
    return [FileRewrite(path, path, how) for path in paths]


def ascii_stl(problem: Problem, around: Around) -> Proposal | None:
    """Write the same triangles in the binary form.

    PyBullet cannot read the text, so what collides has a shape there only afterwards.
    """
    uses = _named(problem, around)
    make = unsafe if any(use.collides for use in uses) else safe
    return make("write it as binary STL", *_in_place(uses[:1], BINARY)) if uses else None


def binary_stl_starts_with_solid(problem: Problem, around: Around) -> Proposal | None:
    """Another word in the head of each."""
    from ..mesh.formats import begins_with_solid

    uses = [use for use in mesh_uses(around.robot, around.description) if begins_with_solid(use)]
    return safe("write another word there", *_in_place(uses, HEADED)) if uses else None


def inverted_mesh(problem: Problem, around: Around) -> Proposal | None:
    """Turned, where it is this robot's alone."""
    uses = [use for use in _named(problem, around) if use.uri.lower().endswith(".stl")]
    if not uses:
        return None
    check_alone(around, str(uses[0].path and uses[0].path.name), robots=True)
    return unsafe("turn its triangles round", *_in_place(uses[:1], TURNED))


def degenerate_triangles(problem: Problem, around: Around) -> Proposal | None:
    """Without those of which two corners are one, which leaves no hole."""
    from ..mesh.surface import with_slivers

    found = with_slivers(around.robot, around.description)
    uses = [use for use, _ in found]
    if not uses or any(not use.uri.lower().endswith(".stl") for use in uses):
        return None
    for use, surface in found:
        try:
            gone = count_collapsed(Path(str(use.path)))
        except (MeshError, OSError):
            return None
        if surface.flat - gone > 0.01 * (surface.faces - gone):
            return None  # corners in a row: without those there would be gaps
        check_alone(around, str(use.path and use.path.name), robots=True)
    return unsafe("take them away", *_in_place(uses, WITHOUT_COLLAPSED))


def dae_as_collision(problem: Problem, around: Around) -> Proposal | None:
    """STL files beside them, where readers agree on their unit and axes."""
    from ..mesh.formats import unit_and_axis

    uses = mesh_uses(around.robot, around.description)
    found = [use for use in uses if use.collides and use.uri.lower().endswith(".dae")]
    if any(not use.exists or unit_and_axis(use) for use in found):
        return None
    return _as_stl(found)


def unsupported_mesh_format(problem: Problem, around: Around) -> Proposal | None:
    """STL files beside them, for what collides and has no colours."""
    ending = os.path.splitext(problem.message.split("'")[1])[1].lower()
    uses = [use for use in uses_of(around, None) if use.uri.lower().endswith(ending)]
    if ending != ".ply" or any(not (use.collides and use.exists) for use in uses):
        return None
    return _as_stl(uses)


def _as_stl(uses: list[MeshUse]) -> Proposal | None:
    changes: list[Change | FileRewrite] = []
    for use in uses:
        if use.path is None:
            return None
        endings = (".stl", "_collision.stl")
        free = [(e, new) for e in endings if (new := _beside(use, use.path.stem + e, BINARY))]
        if not free:
            return None
        ending, new = free[0]
        old = re.escape(os.path.splitext(use.uri)[1]) + r"(?=\s*$)"
        changes.append(sub(use.mesh.element, "filename", old, ending))
        changes += new
    return unsafe("convert it to STL, beside it", *dict.fromkeys(changes)) if changes else None


def mirrored_scale(problem: Problem, around: Around) -> Proposal | None:
    """Files that are mirrored themselves, where they have no colours to lose."""
    changes: list[Change | FileRewrite] = []
    for use in uses_of(around, None):
        x, y, z = use.mesh.scale
        if x * y * z >= 0:
            continue
        if use.path is None or not use.exists or not use.uri.lower().endswith(".stl"):
            return None
        axes = "".join(axis for axis, factor in zip("xyz", (x, y, z), strict=True) if factor < 0)
        new = _beside(use, f"{use.path.stem}_mirrored_{axes}.stl", MIRRORED + axes)
        if not new:
            return None
        element = use.mesh.element
        changes.append(sub(element, "filename", r"\.(?=\w+\s*$)", f"_mirrored_{axes}."))
        changes.append(put(element, "scale", " ".join(f"{abs(v):.12g}" for v in (x, y, z))))
        changes += new
    return unsafe("mirror the file, beside it", *dict.fromkeys(changes)) if changes else None


def unsafe_file_name(problem: Problem, around: Around) -> Proposal | None:
    """A copy under a plain name."""
    uses = _named(problem, around)
    if not uses or uses[0].path is None:
        return None
    plain = unicodedata.normalize("NFKD", uses[0].path.name).encode("ascii", "ignore").decode()
    return _copied(uses, re.sub(r"[^\w.-]+", "_", plain, flags=re.ASCII))


def mesh_stem_collision(problem: Problem, around: Around) -> Proposal | None:
    """A copy of the second under a name of its own."""
    uri = problem.message.split("'")[3]
    uses = [use for use in uses_of(around, uri) if use.exists and use.path is not None]
    if not uses or uses[0].path is None:
        return None
    path = uses[0].path
    word = path.parent.name or "mesh"
    return _copied(uses, f"{path.stem}_{word}{path.suffix}")


def _copied(uses: list[MeshUse], name: str) -> Proposal | None:
    """Its file once more under another name, and every use by that."""
    path = uses[0].path
    if path is None or not name or name == path.name or not uses[0].uri.endswith(path.name):
        return None
    new = _beside(uses[0], name, COPIED)
    if not new:
        return None
    pattern = re.escape(path.name) + "$"
    changes = [sub(use.mesh.element, "filename", pattern, name) for use in uses]
    return unsafe(f"copy it to '{name}' and name that", *changes, *new)


def _beside(use: MeshUse, name: str, how: str) -> list[FileRewrite]:
    """A file beside a mesh that is made of it; none where there is another of that name.

    Robots share meshes: what was made for one serves the next.
    """
    old = Path(str(use.path))
    new = old.with_name(name)
    rewrite = FileRewrite(shown_path(new), shown_path(old), how)
    if os.path.lexists(new) or copy_of(new) is not None:
        try:
            return [rewrite] if bytes_of(new) == rewritten_bytes(rewrite) else []
        except (MeshError, OSError):
            return []
    return [rewrite]
