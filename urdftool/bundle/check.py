"""Verification that a bundle is complete: nothing is missing, points out, or was changed."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory
from typing import Any
from urllib.parse import unquote

from ..errors import SourceError, UrdftoolError
from ..model.elements import Robot
from ..source.document import Element, parse, read_file
from ..source.packages import find_own_package
from .collect import is_outside, is_parameter_file
from .defect import OF_SOURCE, Defect
from .manifest import MANIFEST, compute_digest, list_known_missing, parse_manifest, read_digests
from .output import is_zip
from .references import find_references, has_references, list_readings
from .zip_file import open_zip

_NAMES_A_FILE = {
    "mesh": ("filename", "file"),
    "texture": ("filename", "file"),
    "hfield": ("file",),
    "include": ("file",),
}


def is_bundle(path: str | Path) -> bool:
    """Tell whether a path is a folder with a ``bundle.json``, or a zip file."""
    return (Path(path) / MANIFEST).is_file() or (is_zip(path) and os.path.isfile(path))


def check_bundle(path: str | Path, source: Robot | None = None) -> list[Defect]:
    """Find the defects of a bundle, and what differs from its source if that is given.

    Raises:
        SourceError: It is not a bundle, or the zip file cannot be read.
        MissingDependency: yourdfpy is not installed.
    """
    with open_bundle(path) as folder:
        found = list(_find_defects(folder))
        document = parse_manifest((folder / MANIFEST).read_bytes())
        if source is not None and document is not None:
            from .yourdfpy_reader import compare_with_source

            inner = document["description"]
            found += compare_with_source(source, folder / inner, inner, _list_errors(document))
        return found


@contextmanager
def open_bundle(path: str | Path) -> Iterator[Path]:
    """Provide the folder of a bundle; a zip file is extracted to a temporary folder.

    Raises:
        SourceError: It is not a bundle, or the zip file is damaged or has unsafe entries.
    """
    if not is_zip(path):
        folder = Path(os.path.realpath(path))
        if not (folder / MANIFEST).is_file():
            raise SourceError(f"is not a bundle: it has no {MANIFEST}", path=path)
        yield folder
        return
    with TemporaryDirectory(prefix="urdftool-") as name:
        place = Path(os.path.realpath(name))
        with open_zip(path) as archive:
            archive.extractall(place)
        manifests = sorted(place.glob(f"*/{MANIFEST}"))
        others = [entry for entry in place.iterdir() if not (entry / MANIFEST).is_file()]
        if len(manifests) != 1 or others:
            raise SourceError(
                f"is not a bundle: it requires one folder with a {MANIFEST}", path=path
            )
        yield manifests[0].parent


def _list_errors(document: Mapping[str, Any]) -> dict[str, float]:
    """Return the declared error of each reduced mesh, by its file name."""
    errors = {}
    for entry in document["files"]:
        error = (entry.get("before") or {}).get("error")
        if isinstance(error, (int, float)):
            errors[PurePosixPath(entry["path"]).name] = float(error)
    return errors


def _find_defects(folder: Path) -> Iterator[Defect]:
    data = (folder / MANIFEST).read_bytes()
    document, digests = parse_manifest(data), read_digests(data)
    if document is None or digests is None:
        yield Defect("invalid-manifest", MANIFEST, "is not a manifest that urdftool wrote")
        return
    sizes = {entry["path"]: entry.get("bytes") for entry in document["files"]}
    present = {}
    for where, folders, names in os.walk(folder):
        for name in (*folders, *names):
            path = Path(where, name)
            inner = path.relative_to(folder).as_posix()
            if path.is_symlink():
                yield Defect("link", inner, "is a symbolic link; a bundle contains files only")
            elif not path.is_dir():
                present[inner] = path
    for inner in sorted(digests.keys() - present.keys()):
        yield Defect("missing-file", inner, f"is listed in {MANIFEST}, but does not exist")
    for inner, path in sorted(present.items()):
        if inner == MANIFEST:
            continue
        if inner not in digests:
            yield Defect("unlisted-file", inner, f"is not listed in {MANIFEST}")
        elif not path.is_file() or compute_digest(path) != digests[inner]:
            yield Defect("changed-file", inner, "was changed since it was bundled")
        elif sizes[inner] not in (None, path.stat().st_size):
            text = f"has {path.stat().st_size} bytes, but {MANIFEST} says {sizes[inner]!r}"
            yield Defect("invalid-manifest", inner, text)
        else:
            known = list_known_missing(document).get(inner, set())
            yield from (
                _mark_known(defect, known) for defect in _check_references(folder, inner, path)
            )
    if document["description"] not in present:
        yield Defect("missing-file", document["description"], "the description does not exist")


def _mark_known(defect: Defect, known: set[str]) -> Defect:
    """Return a defect as one of the source if its reference had no file there either."""
    if defect.code != "missing-reference" or defect.written not in known:
        return defect
    return replace(defect, code=OF_SOURCE, message=f"'{defect.written}' is missing in the source")


def _check_references(folder: Path, inner: str, path: Path) -> Iterator[Defect]:
    """Yield the references of a file that are missing or point out."""
    suffix = path.suffix.lower()
    if suffix in (".urdf", ".sdf") or (suffix == ".xml" and path.name != "package.xml"):
        yield from _check_description(folder, inner, path)
    elif has_references(suffix):
        for reference in find_references(suffix, path.read_bytes()):
            yield from _check_reference(folder, inner, path.parent, reference.written, is_url=True)


def _check_description(folder: Path, inner: str, path: Path) -> Iterator[Defect]:
    """Yield the references of a description that are missing or point out."""
    try:
        root = parse(read_file(path)).root
    except UrdftoolError as error:
        yield Defect("malformed-xml", inner, error.message)
        return
    folders = _find_asset_folders(root) if path.suffix.lower() == ".xml" else {}
    for element in root.walk():
        base = path.parent / folders.get(element.tag, "")
        names = _NAMES_A_FILE.get(element.tag, ())
        for name, value in element.attributes.items():
            if name in names or is_name_of_file(value):
                yield from _check_reference(folder, inner, base, value)
        text = element.text.strip()
        is_uri = element.tag == "uri" and "://" not in text and "/" in text
        if is_uri or is_name_of_file(text) or is_parameter_file(text):
            yield from _check_reference(folder, inner, base, text)


_SUFFIXES = frozenset(
    (
        *("bmp", "bvh", "conf", "config", "csv", "dae", "dds", "exr", "fbx", "gif", "glb", "gltf"),
        *("hdr", "ini", "jpeg", "jpg", "json", "ktx", "ktx2", "launch", "material", "md", "mtl"),
        *("obj", "onnx", "pcd", "pgm", "png", "ply", "pt", "py", "rviz", "sdf", "sh", "so", "srdf"),
        *("stl", "svg", "tga", "tif", "tiff", "toml", "txt", "urdf", "usd", "usda", "usdc", "usdz"),
        *("webp", "world", "xacro", "xml", "yaml", "yml"),
    )
)
"""Suffixes of files that descriptions name: without one, ``/base_link`` is a link or a topic."""


def is_name_of_file(value: str) -> bool:
    """Tell whether a value outside of attributes of files names a file.

    It is a URI of a file, or an absolute path that exists or has a suffix of files. Names of links
    and topics of ROS begin with ``/``, too.
    """
    if not is_outside(value):
        return False
    if not value.startswith("/"):
        return True
    suffix = PurePosixPath(value).suffix.lower().removeprefix(".")
    return suffix in _SUFFIXES or os.path.exists(value)


def _find_asset_folders(root: Element) -> dict[str, str]:
    """Return the folders of meshes and textures of an MJCF, by the tag of the reference."""
    asset_folders: dict[str, str] = {}
    for compiler in root.list_children("compiler"):
        both = compiler.get("assetdir") or ""
        meshes = compiler.get("meshdir") or both
        textures = compiler.get("texturedir") or both
        asset_folders |= {"mesh": meshes, "hfield": meshes, "texture": textures}
    return asset_folders


def _check_reference(
    folder: Path, inner: str, base: Path, written: str, *, is_url: bool = False
) -> Iterator[Defect]:
    where = [
        _resolve(folder, base, name)
        for name in (list_readings(written) if is_url else [written.strip()])
    ]
    if any(path is not None and path.is_file() for path in where):
        return
    if all(path is None for path in where):
        message = f"'{written}' points out of the bundle"
        yield Defect("points-out", inner, message)
    else:
        message = f"'{written}' does not exist in the bundle"
        yield Defect("missing-reference", inner, message, written)


def _resolve(folder: Path, base: Path, name: str) -> Path | None:
    """Return the file of a reference; None if it is outside of the bundle."""
    scheme, separator, rest = name.partition("://")
    if separator:
        own = find_own_package(folder / "-")
        if scheme == "package" and own is not None and own[1] == folder:
            package, _, inner = rest.partition("/")
            path = folder / inner
            if package != own[0]:
                return None
        elif scheme == "file":
            path = Path(unquote(rest))
        else:
            return None
    else:
        path = base / name
    path = Path(os.path.normpath(path))
    return path if path.is_relative_to(folder) else None
