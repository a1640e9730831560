"""Making of a bundle in memory."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from ..diagnostic import Severity
from ..errors import ConfigError
from ..finding import Finding
from ..model.elements import Mesh, Robot
from ..refusal import refuse
from ..source.document import STDIN
from ..source.location import SourceFile
from ..storage import cache_folder
from .author_paths import drop_paths_in_comments, shorten_absolute_uri
from .collect import Collection, collect
from .description import format_comment, make_urdf, rewrite
from .layout import make_portable
from .limits import Limits
from .manifest import MANIFEST, Manifest, compute_digest
from .origin import (
    find_licenses,
    find_repositories,
    list_declared_licenses,
    name_source,
    report_licenses,
)
from .presets import PRESETS, Uri
from .ros_package import make_package_files
from .source_folders import list_source_folders, replace_folders
from .store import Content, Conversion, Stored, store_assets

if TYPE_CHECKING:
    from .mesh_formats import MeshFormat

_OF_ORIGIN = ("sources", "before", "missing")
"""Fields of a file in ``bundle.json`` in addition to its digest and size."""

PACKAGE_NAME = re.compile(r"[a-z][a-z0-9_]*")


@dataclass(frozen=True)
class BundleOptions:
    """Options of a bundle.

    Attributes:
        uri: Form of mesh URIs: relative to the description, ``package://`` or ``file://``;
            empty for that of the preset.
        package: Name of the ROS package of ``package://`` URIs; empty for that of the robot.
        folder: Absolute path of the bundle, for ``file://`` URIs.
        force: Whether to leave out visuals and collisions without a mesh file.
        meshes: Format of all meshes; ``keep`` keeps the format of each.
        preset: Name of the reader in ``PRESETS`` whose options apply; empty for none.
        limits: Limits of visual meshes and textures.
    """

    uri: Uri | Literal[""] = ""
    package: str = ""
    folder: Path = Path()
    force: bool = False
    meshes: MeshFormat | Literal["keep"] = "keep"
    preset: str = ""
    limits: Limits = field(default_factory=Limits)

    @property
    def uri_form(self) -> Uri:
        """Return the form of URIs; that of the preset if none is set."""
        if self.uri:
            return self.uri
        return PRESETS[self.preset].uri if self.preset else "relative"


@dataclass
class Bundle:
    """A bundle in memory.

    Attributes:
        description: Path of the URDF in the bundle.
        files: Content by path: bytes, or the path of a file to copy.
        manifest: Content of ``bundle.json``.
        notes: References that the bundle does not contain, and changes.
        sources: Source files, which must not be replaced.
        size_before: Size of the meshes and images of the source [bytes].
        size_after: Size of the meshes and images of the bundle [bytes].
    """

    description: str
    files: dict[str, Content]
    manifest: Manifest
    notes: list[Finding] = field(default_factory=list)
    sources: list[Path] = field(default_factory=list)
    size_before: int = 0
    size_after: int = 0


def make_bundle(
    robot: Robot,
    options: BundleOptions | None = None,
    original: Robot | None = None,
    progress: Callable[[int, int, str], None] | None = None,
) -> Bundle:
    """Make a bundle of a robot.

    ``original`` is the robot in another format of which it was made, if there is one.

    Raises:
        Refused: A mesh is missing or is not a mesh.
        ModelError: The robot was read from another format.
        ConfigError: The name of the package is invalid.
    """
    options = options or BundleOptions()
    name = make_portable(robot.name, "robot")
    folder = "urdf/" if options.uri_form == "package" else ""
    description = f"{folder}{name}.urdf"
    file, changes = _change_for_reader(make_urdf(robot, description), robot, options)
    package = _choose_package_name(options, name)
    found = collect(robot)
    refuse(found.defects, force=options.force, fatal=frozenset())
    stored = store_assets(found, _choose_conversion(robot, options), options.limits, progress)
    uris = {uri: _format_uri(stored.places[a], options, package) for uri, a in found.assets.items()}
    visual_uris = {
        uri: _format_uri(stored.visual_places[asset], options, package)
        for uri, asset in found.assets.items()
        if asset in stored.visual_places
    }
    source_robot = original or robot
    manifest = _make_manifest(robot.name, source_robot, description, options)
    bundle = Bundle(description, dict(stored.contents), manifest)
    source = Path(bundle.manifest.source).name
    own_folders = list_source_folders(robot) | list_source_folders(source_robot)
    relative = options.uri_form == "relative" and any(
        a.kind == "mesh" for a in found.assets.values()
    )
    text = rewrite(
        file,
        uris,
        found.missing,
        visual_uris=visual_uris,
        comment=format_comment(source),
        strippath=relative,
        folders=own_folders,
    )
    bundle.files[description] = drop_paths_in_comments(text)
    if relative:
        bundle.manifest.changes.append('<compiler strippath="false"/> in <mujoco>')
    bundle.manifest.missing = sorted(
        {shorten_absolute_uri(replace_folders(uri, own_folders)) for uri in found.missing}
    )
    bundle.manifest.arguments = {
        name: replace_folders(value, own_folders) for name, value in manifest.arguments.items()
    }
    found_in_meshes = _report_conversions(robot, found, stored, options.limits.max_triangles)
    bundle.notes = [*found.notes, *found.defects, *found_in_meshes]
    bundle.notes += _report_images(robot, stored, options.limits.max_texture)
    bundle.notes += changes
    bundle.manifest.changes += [change.message for change in changes]
    _add_origin(bundle, source_robot, stored)
    if options.uri_form == "package":
        licenses = [text for texts in bundle.manifest.licenses.values() for text in texts]
        folders = {path.partition("/")[0] for path in bundle.files if "/" in path}
        bundle.files |= make_package_files(package, robot, description, licenses, folders)
    add_manifest(bundle)
    return bundle


def _change_for_reader(
    file: SourceFile, robot: Robot, options: BundleOptions
) -> tuple[SourceFile, list[Finding]]:
    """Return a URDF with the changes that the preset requires, and a finding for each."""
    change = PRESETS[options.preset].change if options.preset else None
    if change is None:
        return file, []
    assert robot.source is not None
    is_plain = robot.source.expansion is None
    path = robot.source.document.file.path if is_plain else file.path
    return change(SourceFile(path, file.data))


def add_manifest(bundle: Bundle) -> None:
    """Write the digest and size of every file to the manifest, and add ``bundle.json``."""
    bundle.files.pop(MANIFEST, None)
    files = bundle.manifest.files
    for path, content in bundle.files.items():
        known = files.get(path, {})
        digest = known.get("sha256", "") if isinstance(content, Path) else ""
        facts = {"sha256": digest or compute_digest(content), "bytes": get_size(content)}
        files[path] = {**facts, **{k: known[k] for k in _OF_ORIGIN if k in known}}
    bundle.files[MANIFEST] = bundle.manifest.to_json()


def get_size(content: Content) -> int:
    """Return the size of a content [bytes]."""
    return len(content) if isinstance(content, bytes) else content.stat().st_size


def _choose_conversion(robot: Robot, options: BundleOptions) -> Conversion | None:
    """Return the conversion of meshes; None keeps them."""
    gltf_up = "y" if robot.source is None else robot.source.gltf_up
    if options.meshes != "keep":
        suffix = f".{options.meshes}"
        return Conversion(options.meshes, lambda path: path.suffix.lower() == suffix, gltf_up)
    if options.preset:
        preset = PRESETS[options.preset]
        return Conversion(preset.meshes, preset.is_accepted, gltf_up)
    return None


def _report_conversions(
    robot: Robot, found: Collection, stored: Stored, limit: int | None
) -> Iterator[Finding]:
    """Yield what converted and reduced meshes lost, and which meshes are not converted."""
    seen: set[str] = set()
    for link, shape in robot.shapes:
        mesh = shape.geometry
        if not isinstance(mesh, Mesh) or mesh.filename in seen:
            continue
        seen.add(mesh.filename)
        asset = found.assets.get(mesh.filename)
        if asset is None:
            continue
        place = mesh.locate_attribute("filename")
        for loss in stored.losses.get(asset, ()):
            text = f"mesh '{mesh.filename}' of link '{link.name}' was converted: {loss}"
            yield Finding("lossy-mesh", Severity.WARNING, text, place, "link", link.name)
        if count := stored.unreached.get(asset):
            file = stored.visual_places.get(asset) or stored.places[asset]
            text = (
                f"mesh '{mesh.filename}' of link '{link.name}' has {count:,} triangles, more than "
                f"{limit:,}; fewer would change its shape too much ('{file}' in the bundle)"
            )
            data = {"file": file, "triangles": count}
            yield Finding("large-mesh", Severity.WARNING, text, place, "link", link.name, data=data)
        if asset in stored.failed:
            why = stored.failed[asset]
            text = f"mesh '{mesh.filename}' of link '{link.name}' is not converted: {why}"
            yield Finding("unconverted-mesh", Severity.WARNING, text, place, "link", link.name)


def _report_images(robot: Robot, stored: Stored, limit: int | None) -> Iterator[Finding]:
    """Yield the images that are kept, and are larger than the limit or cannot be read."""
    for asset, why in stored.large_images.items():
        text = f"image '{stored.places[asset]}' is kept, though --max-texture is {limit}: {why}"
        yield Finding("large-image", Severity.WARNING, text, robot.place, "robot", robot.name)


def _format_uri(place: str, options: BundleOptions, package: str) -> str:
    if options.uri_form == "package":
        return f"package://{package}/{place}"
    if options.uri_form == "file":
        return (options.folder / place).as_uri()
    return place


def _choose_package_name(options: BundleOptions, robot: str) -> str:
    name = options.package or f"{robot.lower()}_description"
    if options.uri_form == "package" and not PACKAGE_NAME.fullmatch(name):
        raise ConfigError(
            f"'{name}' is not a name of a ROS package: use lower-case letters, digits and "
            "underscores, a letter first"
        )
    return name


def _make_manifest(name: str, robot: Robot, description: str, options: BundleOptions) -> Manifest:
    assert robot.source is not None
    own = robot.source.path
    is_file = own not in ("-", STDIN)
    source = name_source(own, Path(own).absolute()) if is_file else "standard input"
    changed: dict[str, Any] = {"uri": options.uri_form}
    if options.preset:
        changed["for"] = options.preset
    if options.meshes != "keep":
        changed["meshes"] = options.meshes
    if options.force:
        changed["force"] = True
    changed |= {name: value for name, value in asdict(options.limits).items() if value is not None}
    arguments: Mapping[str, str] = robot.source.arguments
    return Manifest(name, description, source, dict(sorted(arguments.items())), changed)


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
    generated = cache_folder(".")  # has the meshes that are written inside an MJCF or a stage
    manifest.files[bundle.description] = {"sources": list(dict.fromkeys(names.values()))}
    for place, paths in stored.sources.items():
        for path in paths:
            is_generated = path.is_relative_to(generated)
            names[path] = manifest.source if is_generated else name_source(path, description)
        found = list(dict.fromkeys(names[path] for path in paths))
        manifest.files[place] = {"sources": found, "sha256": stored.digests[place]}
        if missing := stored.missing.get(place):
            manifest.files[place]["missing"] = missing
        if place in stored.reductions:  # without the fields that do not apply
            change = asdict(stored.reductions[place])
            manifest.files[place]["before"] = {k: v for k, v in change.items() if v is not None}
    bundle.sources = list(names)
    bundle.size_before = sum(
        path.stat().st_size for path in {p for paths in stored.sources.values() for p in paths}
    )
    bundle.size_after = sum(map(get_size, stored.contents.values()))
    licenses = find_licenses(names)
    bundle.files |= licenses
    for place, path in licenses.items():
        manifest.files[place] = {"sources": [name_source(path, description)]}
    manifest.licenses = list_declared_licenses(names)
    bundle.notes += report_licenses(names, licenses.values(), manifest.licenses)
    manifest.repositories = find_repositories(names)
