"""Files of a robot that a bundle contains: meshes, images, and the files that meshes refer to.

A description may be untrusted, and a bundle is passed on. Only files whose content is a mesh, an
image, an OBJ material or a glTF buffer of the declared size are collected.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from ..diagnostic import Severity
from ..errors import UrdftoolError
from ..finding import Finding
from ..formats.common.asset_filter import explain_invalid_mesh, is_companion, is_image
from ..formats.common.assets import find_file
from ..formats.common.missing_files import create_missing_mesh, explain_missing_file
from ..model.elements import Link, Material, Mesh, Part, Robot
from ..model.references import list_blocks
from ..refusal import make_defect
from ..source.document import Element
from ..source.location import Place
from ..workspace import Workspace
from .references import Reference, find_references, has_references, list_readings

LARGEST_FILE = 1 << 30
"""Size of a file [bytes] above which it is not bundled; a mesh of 20 million triangles has 1 GB.
Chosen, no source.
"""

AssetKind = Literal["mesh", "image", "material", "buffer"]


@dataclass(eq=False)
class Asset:
    """File that a bundle contains.

    Attributes:
        path: The file.
        kind: Kind of its content.
        references: Files that it refers to, by the reference as written; None for a missing file.
        collides: Whether collision geometry uses it.
        is_visual: Whether visual geometry uses it.
    """

    path: Path
    kind: AssetKind
    references: dict[str, Asset | None] = field(default_factory=dict)
    collides: bool = False
    is_visual: bool = False

    @property
    def suffix(self) -> str:
        """Return the suffix in lower case, with its dot."""
        return self.path.suffix.lower()

    def list_companions(self) -> set[Path]:
        """Return the real paths of the files that it refers to, directly or by its materials."""
        companions = set()
        for other in filter(None, self.references.values()):
            companions |= {other.path.resolve(), *other.list_companions()}
        return companions


@dataclass
class Collection:
    """Files of a robot.

    Attributes:
        assets: Files by the URI in the description, in its order.
        missing: URIs of geometry without a file.
        defects: Files that are missing or are not meshes or images.
        notes: References that the bundle does not contain.
    """

    assets: dict[str, Asset] = field(default_factory=dict)
    missing: set[str] = field(default_factory=set)
    defects: list[Finding] = field(default_factory=list)
    notes: list[Finding] = field(default_factory=list)


def collect(robot: Robot) -> Collection:
    """Find the files of a robot."""
    found = Collection()
    known: dict[Path, Asset] = {}
    for link, shape in robot.shapes:
        mesh = shape.geometry
        if isinstance(mesh, Mesh):
            asset = _add_mesh(robot, mesh, link, found, known)
            if asset is not None:
                is_visual = shape in link.visuals
                asset.is_visual |= is_visual
                asset.collides |= not is_visual
    for material in _list_materials(robot):
        _add_texture(robot, material, found, known)
    for _, block in list_blocks(robot):
        _add_gazebo_files(robot, block, found, known)
    return found


def _add_mesh(
    robot: Robot, mesh: Mesh, link: Link, found: Collection, known: dict[Path, Asset]
) -> Asset | None:
    uri = mesh.filename
    if uri in found.assets:
        return found.assets[uri]
    path = find_file(robot, uri)
    if path is None:
        found.missing.add(uri)
        found.defects.append(create_missing_mesh(robot, link, mesh))
        return None
    why = _explain_size(path) or explain_invalid_mesh(path)
    if why:
        found.missing.add(uri)
        message = f"mesh '{uri}' of link '{link.name}' cannot be bundled: {why}"
        place = mesh.locate_attribute("filename")
        found.defects.append(make_defect("invalid-mesh-file", message, place, "link", link.name))
        return None
    found.assets[uri] = asset = _get_asset(path, "mesh", known)
    _follow(robot, asset, mesh, found, known)
    return asset


def _add_texture(
    robot: Robot, material: Material, found: Collection, known: dict[Path, Asset]
) -> None:
    uri = material.texture
    if not uri or uri in found.assets or uri in found.missing:
        return
    place = _locate_texture(material)
    path = find_file(robot, uri)
    large = "" if path is None else _explain_size(path)
    if path is not None and not large and is_image(path):
        found.assets[uri] = _get_asset(path, "image", known)
        return
    found.missing.add(uri)
    if path is not None:
        why, hint = large or "is not an image", ""
    else:
        why, hint, _ = explain_missing_file(robot, uri)
    found.notes.append(_make_note("missing-texture", f"texture '{uri}' {why}", place, hint))


def _locate_texture(material: Material) -> Place:
    element = material.find_child_xml("texture")
    return material.place if element is None else element.locate_attribute("filename")


def _list_materials(robot: Robot) -> Iterator[Material]:
    yield from robot.materials
    for link in robot.links:
        yield from (visual.material for visual in link.visuals if visual.material is not None)


def _get_asset(path: Path, kind: AssetKind, known: dict[Path, Asset]) -> Asset:
    real = Path(os.path.realpath(path))
    return known.setdefault(real, Asset(real if ".." in path.parts else path, kind))


def _follow(
    robot: Robot, asset: Asset, part: Part, found: Collection, known: dict[Path, Asset]
) -> None:
    """Add the files that an asset refers to."""
    if asset.references or not has_references(asset.suffix):
        return
    try:
        data = _get_workspace(robot).read_bytes(asset.path)
    except OSError:
        return
    for reference in find_references(asset.suffix, data):
        path = _find_referenced(robot, asset.path, reference)
        if path is None:
            asset.references[reference.written] = None
            severity = Severity.INFO if reference.kind == "material" else Severity.WARNING
            message = f"{reference.kind} '{reference.written}' of {asset.path.name} is not found"
            found.notes.append(_make_note("missing-companion", message, part.place, "", severity))
            continue
        other = _get_asset(path, reference.kind, known)
        asset.references[reference.written] = other
        if other.kind == "material":
            _follow(robot, other, part, found, known)


def _find_referenced(robot: Robot, mesh: Path, reference: Reference) -> Path | None:
    """Return the file of a reference; None if it is missing or of another kind."""
    for name in list_readings(reference.written):
        if not name or "\0" in name:
            continue
        try:
            if "://" in name:
                path = robot.source.resolve(name) if robot.source is not None else mesh / name
            else:
                path = Path(os.path.normpath(mesh.parent / name))
            is_there = _get_workspace(robot).get_size(path) is not None
            if is_there and _is_expected(path, reference):
                return path
        except (OSError, ValueError, UrdftoolError):
            continue
    return None


def _get_workspace(robot: Robot) -> Workspace:
    """Return the workspace that opens only what the description may read."""
    assert robot.source is not None
    return robot.source.workspace


def _explain_size(path: Path) -> str:
    """Explain why a file is too large; return "" if it is not."""
    size = path.stat().st_size
    if size <= LARGEST_FILE:
        return ""
    return f"it has {size / 1e9:.1f} GB, more than the limit of {LARGEST_FILE / 1e9:.1f} GB"


def _is_expected(path: Path, reference: Reference) -> bool:
    if _explain_size(path):
        return False
    if reference.kind == "buffer":  # has no signature, so its name and size must match
        size = path.stat().st_size
        return is_companion(path) and reference.size is not None and 0 <= size - reference.size < 4
    if reference.kind == "material":
        return path.suffix.lower() == ".mtl" and is_companion(path)
    return is_image(path)


def _add_gazebo_files(
    robot: Robot, block: Element, found: Collection, known: dict[Path, Asset]
) -> None:
    """Add meshes and images that a ``<gazebo>`` block names by URI; report other files."""
    for element in block.walk():
        values = [(v, element.locate_attribute(k)) for k, v in element.attributes.items()]
        for value, place in (*values, (element.text, element.place)):
            uri = value.strip()
            if uri in found.assets or uri in found.missing:
                continue
            if is_parameter_file(uri):
                found.missing.add(uri)
                message = f"'{uri}' is not bundled: files of parameters are not"
                found.notes.append(_make_note("external-file", message, place))
                continue
            path = find_file(robot, uri) if is_outside(uri) else None
            if path is None:
                continue
            if not (_explain_size(path) or explain_invalid_mesh(path)):
                found.assets[uri] = asset = _get_asset(path, "mesh", known)
                asset.is_visual = True
                _follow(robot, asset, Part(element), found, known)
            elif not _explain_size(path) and is_image(path):
                found.assets[uri] = _get_asset(path, "image", known)
            else:
                found.missing.add(uri)
                message = f"'{uri}' is not bundled, because it is not a mesh or an image"
                found.notes.append(_make_note("external-file", message, place))


def is_outside(value: str) -> bool:
    """Tell whether a value is a URI of a file or an absolute path."""
    return value.startswith(("package://", "model://", "file://", "/")) and "\n" not in value


def is_parameter_file(value: str) -> bool:
    """Tell whether a value is a relative path, or one of a package, of a file of parameters."""
    path = value.lower()
    is_one = "$(" in path or not set(" \n") & set(path)
    return path.endswith((".yaml", ".yml")) and is_one and not is_outside(value)


def _make_note(
    code: str,
    message: str,
    place: Place,
    hint: str = "",
    severity: Severity = Severity.WARNING,
) -> Finding:
    return Finding(code, severity, message, place, "file", hint=hint)
