"""The robots that changed files of a git repository concern."""

from __future__ import annotations

import html
import os
import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from urllib.parse import quote

from ..configuration import NAMES
from ..errors import SourceError
from ..git_changes import Changes, list_changes
from ..git_command import run_git
from ..source.packages import find_own_package
from ..storage import read_regular_file
from .repository import Repository

_FINDING = ("package.xml", "model.config")  # make a folder a package, which any robot may use
_TEXT = re.compile(
    r".*\.(xml|urdf|xacro|srdf|sdf|world|model|config|ya?ml|json|launch|py|toml|txt|usda"
    r"|dae|obj|mtl|gltf)"
)
"""Files that can name other files."""

_MOST_BYTES = 1 << 28
"""Size of a file [bytes] above which it may name any file. Chosen, no source."""

_COMPUTED = re.compile(
    rb"(?:[^\s\"'<>/\\${]|\$\{[^{}]*\}|\$\([^()]*\)|\{[^{}\"']*\})*\.\w{2,6}\b", re.ASCII
)
"""Last part of a path, which may have expressions of xacro, launch files or Python."""

_EXPRESSION = re.compile(rb"\$\{[^{}]*\}|\$\([^()]*\)|\{[^{}]*\}|%[sd]")
_ADDED = re.compile(rb"\+\s*[\"']([^\"'/]*\.\w{2,6})[\"']", re.ASCII)
"""End of a path that is added to a computed text."""


def list_changed_files(folder: str, revision: str) -> Changes:
    """Return the files of a repository, and which differ from a revision, new ones, too.

    Raises:
        SourceError: The folder is in no repository, or there is no such revision.
    """
    if revision.startswith("-"):
        raise SourceError(f"'{revision}' is not a revision of git")
    try:
        top = run_git(folder, "rev-parse", "--show-toplevel")
        if top.returncode:
            raise SourceError(
                "is in no git repository, which --changed-since requires", path=folder
            )
        root = os.fsdecode(top.stdout.rstrip(b"\n"))
        known = run_git(root, "rev-parse", "--verify", "--quiet", f"{revision}^{{commit}}")
        if known.returncode:
            raise SourceError(f"git knows no revision '{revision}'", path=root)
        return list_changes(os.path.realpath(root), os.fsdecode(known.stdout.strip()))
    except OSError:
        raise SourceError("git is not installed, which --changed-since requires") from None


def select_concerned(
    files: Sequence[str], found: Repository, changes: Changes, config: str | None = None
) -> list[str]:
    """Return the robots that changed files concern; a doubt counts as a change.

    A file concerns those that contain its name, or can compute it, and these again others: so a
    mesh concerns what includes the description that names it. A file also concerns the
    robots of its package and folder, a configuration those below its folder, a launch file those
    to which it passes arguments, and a ``package.xml``, an SRDF or a link to a folder all.
    """
    changed = _add_links(changes)
    if config is not None and os.path.realpath(config) in changed:
        return list(files)
    if any(os.path.basename(path) in _FINDING or path.endswith(".srdf") for path in changed):
        return list(files)
    if any(os.path.isdir(path) for path in changed):
        return list(files)
    configured = tuple(
        os.path.join(os.path.dirname(path), "")
        for path in changed
        if os.path.basename(path) in NAMES
    )
    others = [path for path in changed if not path.endswith((".urdf", ".xacro"))]
    packages = {find_own_package(Path(path)) for path in others} - {None}
    folders = {os.path.dirname(path) for path in others}
    named = _list_naming(changed, changes.files | found.paths.keys())
    including = set(found.select(named))
    kept = []
    for path in files:
        real = os.path.realpath(path)
        if (
            real in including
            or not found.list_files(real).isdisjoint(named)
            or real.startswith(configured)
            or find_own_package(Path(real)) in packages
            or os.path.dirname(real) in folders
            or not named.isdisjoint(_list_launches(found, real))
        ):
            kept.append(path)
    return kept


def _add_links(changes: Changes) -> set[str]:
    """Return the changed files, where links to them are, and what changed links lead to."""
    changed = changes.changed | {os.path.realpath(path) for path in changes.changed}
    links = (path for path in changes.files if os.path.islink(path))
    return changed | {path for path in links if os.path.realpath(path) in changed}


def _list_naming(changed: Iterable[str], files: Iterable[str]) -> set[str]:
    """Return the changed files, and those that name one of them, directly or through others."""
    texts: dict[str, bytes | None] = {}
    for path in files:
        if _TEXT.fullmatch(os.path.basename(path).lower()):
            try:
                texts[os.path.realpath(path)] = read_regular_file(path, _MOST_BYTES)
            except OSError:
                texts[os.path.realpath(path)] = None
    computed = {path: _read_computed(data) for path, data in texts.items() if data is not None}
    named, new = set(changed), set(changed)
    while new:
        names = {os.path.basename(path) for path in new}
        pattern = _match_names(new)
        new = {
            path
            for path, data in texts.items()
            if path not in named
            and (
                data is None
                or pattern.search(data)
                or any(map(computed[path].fullmatch, map(os.fsencode, names)))
            )
        }
        named |= new
    return named


def _match_names(paths: Iterable[str]) -> re.Pattern[bytes]:
    """Return a pattern of the names of files as a text can contain them.

    A model of SDF is also named by its folder.
    """
    names = {os.path.basename(path) for path in paths}
    forms = {form for name in names for form in (name, quote(name), html.escape(name))}
    folders = {os.path.basename(os.path.dirname(p)) for p in paths if p.endswith((".sdf", ".xml"))}
    whole = "|".join(re.escape(form) for form in sorted(forms, key=len, reverse=True))
    model = "|".join(re.escape(name) for name in folders) or "(?!)"
    text = rf"(?<![\w.-])(?:{whole})(?![\w-])|(?:model|package)://(?:{model})(?![\w.-])"
    return re.compile(text.encode("utf-8", "surrogateescape"), re.IGNORECASE)


def _read_computed(data: bytes) -> re.Pattern[bytes]:
    """Return a pattern of the names of files that a text computes."""
    forms = {
        b".+".join(re.escape(part) for part in _EXPRESSION.split(name))
        for name in _COMPUTED.findall(data)
        if _EXPRESSION.search(name)
    }
    forms |= {b".*" + re.escape(end) for end in _ADDED.findall(data)}
    return re.compile(b"|".join(sorted(forms)) or b"(?!)")


def _list_launches(found: Repository, robot: str) -> Iterator[str]:
    """Yield the resolved paths of the files that pass arguments to a robot."""
    if robot in found.robots:
        for place in found.robots[robot].places:
            yield os.path.realpath(place.rpartition(":")[0])
