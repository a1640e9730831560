"""The robots that changed files of a git repository concern."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence, Set
from pathlib import Path

from ..configuration import NAMES
from ..errors import SourceError, UrdftoolError
from ..git_command import run_git
from ..source.document import read_file
from ..source.packages import find_own_package
from ..workspace import Workspace
from .repository import Repository

_DESCRIPTIONS = (".urdf", ".xacro")
_FINDING = ("package.xml", "model.config")  # make a folder a package, which any robot may use


def list_changed_files(folder: str, revision: str) -> set[str]:
    """Return the resolved paths of files that differ from a revision, new and removed ones, too.

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
        commit = os.fsdecode(known.stdout.strip())
        changed = run_git(
            root, "diff", "--name-only", "--no-renames", "-z", "--no-ext-diff", commit, "--"
        )
        added = run_git(root, "ls-files", "--others", "--exclude-standard", "-z")
    except OSError:
        raise SourceError("git is not installed, which --changed-since requires") from None
    names = [name for name in (changed.stdout + added.stdout).split(b"\0") if name]
    return {os.path.realpath(os.path.join(root, os.fsdecode(name))) for name in names}


def select_concerned(
    files: Sequence[str],
    found: Repository,
    changed: Set[str],
    workspace: Workspace,
    config: str | None = None,
) -> list[str]:
    """Return the robots that changed files concern.

    A description concerns the robots that include it; a configuration those below its folder; a
    ``package.xml`` all, because any may find the package; another file, such as a mesh, those of
    its package, those whose files contain its name, and those to which it passes arguments.
    """
    if any(os.path.basename(path) in _FINDING for path in changed):
        return list(files)
    if config is not None and os.path.realpath(config) in changed:
        return list(files)
    configured = tuple(
        os.path.join(os.path.dirname(path), "")
        for path in changed
        if os.path.basename(path) in NAMES
    )
    others = [path for path in changed if not path.endswith(_DESCRIPTIONS)]
    packages = {find_own_package(Path(path)) for path in others} - {None}
    names = [os.fsencode(os.path.basename(path)) for path in others]
    including = set(found.select(changed))
    kept = []
    for path in files:
        real = os.path.realpath(path)
        parts = found.list_files(real)
        if (
            real in including
            or not parts.isdisjoint(changed)
            or real.startswith(configured)
            or find_own_package(Path(real)) in packages
            or not changed.isdisjoint(_list_launches(found, real))
            or _contains_any(parts, names, workspace)
        ):
            kept.append(path)
    return kept


def _list_launches(found: Repository, robot: str) -> Iterator[str]:
    """Yield the resolved paths of the files that pass arguments to a robot."""
    if robot in found.robots:
        for place in found.robots[robot].places:
            yield os.path.realpath(place.rpartition(":")[0])


def _contains_any(paths: Iterable[str], names: Sequence[bytes], workspace: Workspace) -> bool:
    """Tell whether one of the files contains one of the names."""
    if not names:
        return False
    for path in paths:
        try:
            data = read_file(path, workspace).data
        except UrdftoolError:
            continue
        if any(name in data for name in names):
            return True
    return False
