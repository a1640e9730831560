"""Origin of a bundle: path of each source in its package, licenses, and git commits."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ..diagnostic import Severity
from ..finding import Finding
from ..git_changes import is_blob_of
from ..git_command import run_git
from ..projects import find_repository
from ..source.location import Place, SourceFile
from ..source.packages import find_own_package
from ..storage import read_regular_file
from ..workspace import Workspace
from .layout import make_portable

_LICENSE = re.compile(r"(?i)(licen[cs]es?|copying|notice|copyright|unlicense)([-._].*)?")
_LICENSE_TAG = re.compile(rb"<license\b[^<>]*>([^<]*)</license\s*>")
_MOST_BYTES = 1 << 20
"""Size of a license or manifest [bytes] up to which it is read. Chosen, no source."""

_MAX_CLIMB = 8
"""Number of folders above a file in which its license is searched. Chosen, no source."""


@dataclass(frozen=True)
class Repository:
    """Commit of a git repository that contains sources of a bundle."""

    commit: str
    packages: list[str] = field(default_factory=list)
    modified: list[str] = field(default_factory=list)


def name_source(path: str | Path, description: Path) -> str:
    """Return a path without absolute folders: as a package URI, or relative to the description."""
    full = Path(os.path.abspath(path))
    own = find_own_package(full)
    if own is not None:
        return f"package://{own[0]}/{full.relative_to(own[1]).as_posix()}"
    return Path(os.path.relpath(full, description.parent)).as_posix()


def find_licenses(sources: Iterable[Path]) -> dict[str, Path]:
    """Find the license files of the sources: in their folders, packages and repositories.

    Returns:
        License files by their path in the bundle.
    """
    licenses: dict[str, Path] = {}
    seen: set[str] = set()
    for folder in dict.fromkeys(path.parent for path in sources):
        for place in _list_folders(folder):
            if str(place) in seen:
                continue
            seen.add(str(place))
            own = find_own_package(place / "-")
            group = make_portable(own[0]) if own is not None else "repository"
            for path in _list_licenses(place):
                name = f"licenses/{group}/{_make_file_name(path.name)}"
                number = 1
                while name in licenses:
                    number += 1
                    name = f"licenses/{group}/{number}_{_make_file_name(path.name)}"
                licenses[name] = path
    return licenses


def list_declared_licenses(sources: Iterable[Path]) -> dict[str, list[str]]:
    """Return the ``<license>`` values of the packages of the sources, by package."""
    found: dict[str, list[str]] = {}
    for folder in dict.fromkeys(path.parent for path in sources):
        own = find_own_package(folder / "-")
        if own is None or own[0] in found:
            continue
        try:
            data = read_regular_file(own[1] / "package.xml", _MOST_BYTES)
        except OSError:
            continue
        names = [
            match[1].decode("utf-8", "replace").strip() for match in _LICENSE_TAG.finditer(data)
        ]
        found[own[0]] = [name for name in names if name]
    return dict(sorted(found.items()))


def report_licenses(
    sources: Iterable[Path], files: Iterable[Path], declared: Mapping[str, list[str]]
) -> list[Finding]:
    """Return a finding for each package without a license, and each license that is to be done."""
    folders = {os.path.realpath(path.parent) for path in files}
    found: dict[str, Finding] = {}
    for path in sources:
        own = find_own_package(path)
        name, root = own or ("", path.parent)
        texts = declared.get(name, [])
        to_do = _find_to_do(texts)
        if name in found or (texts and not to_do):
            continue
        if to_do:
            text = f"package '{name}' declares the license '{to_do}', which grants nothing"
        elif _has_license(Path(os.path.realpath(root)), folders):
            continue
        else:
            what = f"package '{name}'" if name else "the description"
            text = f"{what} has no license: the receiver of the bundle may not know what is allowed"
        found[name] = _make_license_finding(root / "package.xml" if name else path, text)
    return list(found.values())


def _has_license(folder: Path, folders: set[str]) -> bool:
    """Tell whether a license file is in a folder, above or below it."""
    above = {str(folder), *map(str, folder.parents)}
    return any(place in above or Path(place).is_relative_to(folder) for place in folders)


def _find_to_do(licenses: Iterable[str]) -> str:
    """Return the license that is a placeholder, as ``ros2 pkg create`` writes; empty if none is."""
    return next((text for text in licenses if text.upper().startswith("TODO")), "")


def _make_license_finding(path: Path, text: str) -> Finding:
    place = Place(SourceFile(os.path.relpath(path), b""), 0, 0)
    return Finding("no-license", Severity.WARNING, text, place, "file")


def find_repositories(sources: Mapping[Path, str]) -> list[Repository]:
    """Return the git commits of the sources.

    The comparison with the commit reads objects only: no filter, hook or program that the
    repository configures is started.
    """
    by_root: dict[Path, dict[Path, str]] = {}
    for path, name in sources.items():
        real = Path(os.path.realpath(path))
        root = find_repository(real.parent, Workspace())
        if root is not None:
            by_root.setdefault(root, {})[real] = name
    repositories = []
    for root, files in sorted(by_root.items()):
        commit = _run_git(root, "rev-parse", "--verify", "--quiet", "HEAD")
        if not commit:
            continue
        repository = Repository(commit.decode().strip())
        repository.modified.extend(sorted(_find_modified(root, files)))
        owners = (find_own_package(path) for path in files)
        repository.packages.extend(sorted({own[0] for own in owners if own is not None}))
        repositories.append(repository)
    return repositories


def _list_folders(folder: Path) -> Iterator[Path]:
    """Yield a folder and those above it up to its repository, or else its package."""
    root = find_repository(folder, Workspace())
    own = find_own_package(folder / "-")
    top = root or (own[1] if own is not None else folder)
    for _ in range(_MAX_CLIMB):
        yield folder
        if folder in (top, folder.parent):
            return
        folder = folder.parent


def _list_licenses(folder: Path) -> Iterator[Path]:
    """Yield the license files of a folder: text files that are not links to other folders."""
    try:
        names = sorted(os.listdir(folder))
    except OSError:
        return
    for name in names:
        path = folder / name
        if not _LICENSE.fullmatch(name) or not path.is_file():
            continue
        real = os.path.realpath(path)
        if os.path.dirname(real) != os.path.realpath(folder):
            continue
        if not _LICENSE.fullmatch(os.path.basename(real)):
            continue
        with open(path, "rb") as stream:
            data = stream.read(_MOST_BYTES + 1)
        if 0 < len(data) <= _MOST_BYTES and b"\0" not in data:
            yield path


def _make_file_name(name: str) -> str:
    stem, dot, suffix = name.rpartition(".")
    if not dot:
        return make_portable(name)
    return f"{make_portable(stem)}.{make_portable(suffix)}"


def _find_modified(root: Path, files: Mapping[Path, str]) -> Iterator[str]:
    relative = {path.relative_to(root).as_posix(): path for path in files}
    listing = _run_git(root, "ls-tree", "-r", "-z", "HEAD", "--", *relative) or b""
    blobs = {}
    for line in listing.split(b"\0"):
        facts, tab, entry = line.partition(b"\t")
        if tab:
            blobs[os.fsdecode(entry)] = facts.split()[2].decode()
    for name, path in relative.items():
        if name not in blobs or not is_blob_of(path.read_bytes(), blobs[name]):
            yield files[path]


def _run_git(folder: Path, *words: str) -> bytes | None:
    """Return the output of git; None if it fails or is not installed."""
    try:
        done = run_git(folder, "--literal-pathspecs", *words)
    except OSError:
        return None
    return done.stdout if done.returncode == 0 else None
