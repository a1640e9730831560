"""Making of a bundle in memory."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from ..errors import ConfigError
from ..finding import Finding
from ..formats.defects import refuse
from ..model.elements import Robot
from ..source.document import STDIN
from .collect import Asset, Collection, collect
from .description import format_comment, make_urdf, rewrite
from .layout import Layout, make_portable
from .manifest import MANIFEST, Manifest, compute_digest
from .origin import find_licenses, find_repositories, list_declared_licenses, name_source
from .references import rewrite_references
from .ros_package import make_package_files

Uri = Literal["relative", "package", "file"]
Content = bytes | Path

PACKAGE_NAME = re.compile(r"[a-z][a-z0-9_]*")


@dataclass(frozen=True)
class BundleOptions:
    """Options of a bundle.

    Attributes:
        uri: Form of mesh URIs: relative to the description, ``package://`` or ``file://``.
        package: Name of the ROS package of ``package://`` URIs; empty for that of the robot.
        folder: Absolute path of the bundle, for ``file://`` URIs.
        force: Whether to leave out visuals and collisions without a mesh file.
    """

    uri: Uri = "relative"
    package: str = ""
    folder: Path = Path()
    force: bool = False


@dataclass
class Bundle:
    """A bundle in memory.

    Attributes:
        description: Path of the URDF in the bundle.
        files: Content by path: bytes, or the path of a file to copy.
        manifest: Content of ``bundle.json``.
        notes: References that the bundle does not contain, and changes.
        sources: Source files, which must not be replaced.
    """

    description: str
    files: dict[str, Content]
    manifest: Manifest
    notes: list[Finding] = field(default_factory=list)
    sources: list[Path] = field(default_factory=list)


def make_bundle(robot: Robot, options: BundleOptions | None = None) -> Bundle:
    """Make a bundle of a robot.

    Args:
        robot: A robot that was read from URDF or xacro.
        options: Options; None for the defaults.

    Raises:
        Refused: A mesh is missing or is not a mesh.
        ModelError: The robot was read from another format.
        ConfigError: The name of the package is invalid.
    """
    options = options or BundleOptions()
    name = make_portable(robot.name, "robot")
    folder = "urdf/" if options.uri == "package" else ""
    description = f"{folder}{name}.urdf"
    file = make_urdf(robot, description)
    package = _choose_package_name(options, name)
    found = collect(robot)
    refuse(found.defects, force=options.force, fatal=frozenset())
    stored = store_assets(found)
    uris = {uri: _format_uri(stored.places[a], options, package) for uri, a in found.assets.items()}
    bundle = Bundle(description, dict(stored.contents), _make_manifest(robot, description, options))
    source = Path(bundle.manifest.source).name
    relative = options.uri == "relative" and any(a.kind == "mesh" for a in found.assets.values())
    bundle.files[description] = rewrite(
        file, uris, found.missing, comment=format_comment(source), strippath=relative
    )
    if relative:
        bundle.manifest.changes.append('<compiler strippath="false"/> in <mujoco>')
    bundle.manifest.missing = sorted(found.missing)
    bundle.notes = [*found.notes, *found.defects]
    _add_origin(bundle, robot, stored)
    if options.uri == "package":
        licenses = [text for texts in bundle.manifest.licenses.values() for text in texts]
        folders = {path.partition("/")[0] for path in bundle.files if "/" in path}
        bundle.files |= make_package_files(package, robot.name, description, licenses, folders)
    add_manifest(bundle)
    return bundle


def add_manifest(bundle: Bundle) -> None:
    """Write the digest and size of every file to the manifest, and add ``bundle.json``."""
    bundle.files.pop(MANIFEST, None)
    files = bundle.manifest.files
    for path, content in bundle.files.items():
        size = len(content) if isinstance(content, bytes) else content.stat().st_size
        facts = {"sha256": compute_digest(content), "bytes": size}
        files[path] = {**facts, **{k: v for k, v in files.get(path, {}).items() if k == "sources"}}
    bundle.files[MANIFEST] = bundle.manifest.to_json()


@dataclass
class Stored:
    """Files of a bundle, each content once.

    Attributes:
        places: Path in the bundle by asset.
        contents: Content by path.
        sources: Source files by path.
    """

    places: dict[Asset, str] = field(default_factory=dict)
    contents: dict[str, Content] = field(default_factory=dict)
    sources: dict[str, list[Path]] = field(default_factory=dict)


def store_assets(found: Collection, layout: Layout | None = None) -> Stored:
    """Assign a path to each file and rewrite references between files.

    Args:
        found: The files.
        layout: Names that are taken.
    """
    layout = layout or Layout()
    stored = Stored()
    by_content: dict[tuple[str, str, str], str] = {}
    for asset in found.assets.values():
        _store(asset, layout, stored, by_content)
    return stored


def _store(
    asset: Asset, layout: Layout, stored: Stored, by_content: dict[tuple[str, str, str], str]
) -> str:
    if asset in stored.places:
        return stored.places[asset]
    names = {}
    for written, other in asset.references.items():
        if other is not None:
            names[written] = Path(_store(other, layout, stored, by_content)).name
        else:
            names[written] = _remove_folders(written)
    content: Content = asset.path
    if any(old != new for old, new in names.items()):
        content = rewrite_references(asset.suffix, asset.path.read_bytes(), names)
    key = (asset.kind, asset.suffix, compute_digest(content))
    place = by_content.get(key)
    if place is None:
        place = by_content[key] = layout.place(asset)
        stored.contents[place] = content
    stored.places[asset] = place
    stored.sources.setdefault(place, []).append(asset.path)
    return place


def _remove_folders(written: str) -> str:
    """Return the reference to a missing file without the folders, so that it stays inside."""
    name = re.split(r"[/\\]", written.rstrip("/\\"))[-1]
    return written if name == written else name or "missing"


def _format_uri(place: str, options: BundleOptions, package: str) -> str:
    if options.uri == "package":
        return f"package://{package}/{place}"
    if options.uri == "file":
        return (options.folder / place).as_uri()
    return place


def _choose_package_name(options: BundleOptions, robot: str) -> str:
    name = options.package or f"{robot.lower()}_description"
    if options.uri == "package" and not PACKAGE_NAME.fullmatch(name):
        raise ConfigError(
            f"'{name}' is not a name of a ROS package: use lower-case letters, digits and "
            "underscores, a letter first"
        )
    return name


def _make_manifest(robot: Robot, description: str, options: BundleOptions) -> Manifest:
    assert robot.source is not None
    own = robot.source.path
    is_file = own not in ("-", STDIN)
    source = name_source(own, Path(own).absolute()) if is_file else "standard input"
    changed: dict[str, Any] = {"uri": options.uri}
    if options.force:
        changed["force"] = True
    arguments: Mapping[str, str] = robot.source.arguments
    return Manifest(robot.name, description, source, dict(sorted(arguments.items())), changed)


def _add_origin(bundle: Bundle, robot: Robot, stored: Stored) -> None:
    """Add the sources of each file, licenses and commits."""
    assert robot.source is not None
    texts = [file.path for file in robot.source.files if file.path not in ("-", STDIN)]
    if robot.source.expansion is not None:
        texts += robot.source.expansion.dependencies
    description = Path(robot.source.path).absolute()
    names: dict[Path, str] = {}
    for text in dict.fromkeys(texts):
        names[Path(text).absolute()] = name_source(text, description)
    manifest = bundle.manifest
    manifest.files[bundle.description] = {"sources": list(dict.fromkeys(names.values()))}
    for place, paths in stored.sources.items():
        for path in paths:
            names[path] = name_source(path, description)
        manifest.files[place] = {"sources": list(dict.fromkeys(names[path] for path in paths))}
    bundle.sources = list(names)
    licenses = find_licenses(names)
    bundle.files |= licenses
    for place, path in licenses.items():
        manifest.files[place] = {"sources": [name_source(path, description)]}
    manifest.licenses = list_declared_licenses(names)
    manifest.repositories = find_repositories(names)
