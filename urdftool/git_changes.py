"""Files of a git repository that differ from a commit, found without a program of the repository.

``git diff`` and ``git status`` pass files through the filters that a repository configures, which
are programs. Here git only lists names and blobs; the files are read and hashed by Python.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from dataclasses import dataclass, field
from hashlib import sha1, sha256

from .errors import SourceError
from .git_command import run_git
from .storage import read_regular_file

_LINK, _SUBMODULE = b"120000", b"160000"
"""Modes of a symbolic link and of a submodule in a tree of git."""

_MOST_BYTES = 1 << 30
"""Size of a file [bytes] above which it counts as changed. Chosen, no source."""


@dataclass
class Changes:
    """Files of repositories, as absolute paths without links in the folder of the repository.

    Attributes:
        changed: Files that differ from the commit, those that are new or removed, and folders
            that are repositories of their own.
        files: All files, also those that are removed.
    """

    changed: set[str] = field(default_factory=set)
    files: set[str] = field(default_factory=set)


def is_blob_of(data: bytes, blob: str) -> bool:
    """Tell whether a file is stored as a blob, with line ends of Unix or as a pointer of LFS, too.

    Args:
        data: Content of the file.
        blob: Name of the blob, in hexadecimal digits of SHA-1 or SHA-256.
    """
    pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:%s\nsize %d\n" % (
        sha256(data).hexdigest().encode(),
        len(data),
    )
    forms = data, data.replace(b"\r\n", b"\n"), pointer
    return any(_compute_blob_name(form, len(blob)) == blob for form in forms)


def list_changes(root: str, commit: str) -> Changes:
    """Return the files of a repository and of its submodules that differ from a commit.

    Files that git ignores are in no commit and are left out.

    Raises:
        OSError: Git is not installed.
        SourceError: Git cannot list the files, as in a damaged repository.
    """
    changes = Changes()
    _add_changes(changes, root, commit)
    return changes


def _add_changes(changes: Changes, root: str, commit: str) -> None:
    tree = {name: (mode, blob) for mode, blob, name in _list_tree(root, commit)}
    names = _list_names(root, "ls-files", "--cached", "--others", "--exclude-standard", "-z")
    for raw in tree.keys() | {name for name in names.split(b"\0") if name}:
        path = os.path.join(root, os.fsdecode(raw.rstrip(b"/")))
        mode, blob = tree.get(raw, (b"", ""))
        if mode == _SUBMODULE or (os.path.isdir(path) and not os.path.islink(path)):
            _add_repository(changes, path, blob)
            continue
        changes.files.add(path)
        if not _is_unchanged(path, mode, blob):
            changes.changed.add(path)


def _add_repository(changes: Changes, path: str, commit: str) -> None:
    """Add the changes of a submodule, or of a repository of which the outer one has no commit."""
    if os.path.isdir(path) and not os.listdir(path):
        return  # a submodule that is not checked out
    if commit and os.path.lexists(os.path.join(path, ".git")):
        if not run_git(path, "cat-file", "-e", f"{commit}^{{commit}}").returncode:
            _add_changes(changes, path, commit)
            return
    files = {os.path.join(top, name) for top, _, names in os.walk(path) for name in names}
    changes.changed |= files | {path}
    changes.files |= files


def _list_tree(root: str, commit: str) -> Iterator[tuple[bytes, str, bytes]]:
    """Yield mode, blob and name of each file of a commit."""
    listing = _list_names(root, "ls-tree", "-r", "-z", "--full-tree", commit)
    for line in listing.split(b"\0"):
        facts, tab, name = line.partition(b"\t")
        if tab:
            mode, _, blob = facts.split()
            yield mode, blob.decode(), name


def _list_names(root: str, *words: str) -> bytes:
    done = run_git(root, *words)
    if done.returncode:
        lines = done.stderr.decode("utf-8", "replace").strip().splitlines()
        raise SourceError(f"git cannot list its files: {''.join(lines[-1:])}", path=root)
    return done.stdout


def _is_unchanged(path: str, mode: bytes, blob: str) -> bool:
    """Tell whether a file exists as it is in a tree; a new file, without a mode, does not."""
    try:
        if stat.S_ISLNK(os.lstat(path).st_mode):
            return mode == _LINK and is_blob_of(os.fsencode(os.readlink(path)), blob)
        return mode not in (b"", _LINK) and is_blob_of(read_regular_file(path, _MOST_BYTES), blob)
    except OSError:
        return False


def _compute_blob_name(data: bytes, digits: int) -> str:
    make = sha1 if digits == 40 else sha256
    return make(b"blob %d\0" % len(data) + data, usedforsecurity=False).hexdigest()
