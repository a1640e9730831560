"""What a result depends on in the file system and the environment, and whether that changed.

A dependency is a question with the stamp that its path had when it was asked. The kinds:

``file``  what a path leads to, with the contents of a file
``is``    whether a path leads to a file, a folder or something else
``there`` whether there is anything at a path, be it a link that leads nowhere
``real``  where a path leads without symbolic links
``list``  the names in a folder, and which of them are folders
``env``   the value of an environment variable
"""

from __future__ import annotations

import os
import stat
import time
from collections.abc import Callable, Set

Question = tuple[str, str]
"""A kind and a path; for ``env`` a name."""

Stamp = tuple[int, ...]
"""What changes with a file or folder: its number, size and times [ns]; of others, its type."""

ABSENT = "-"
_FRESH_NS = 2_000_000_000  # so young, a file may change again without its times telling
_SHARED = 50  # results with more dependencies share them with all that include them
_WITHOUT_STAMP = ("env", "real")


class Dependencies:
    """The questions that were asked for a result.

    Attributes:
        asked: Each question with the stamp of its path when it was asked first.
        shared: Dependencies of results that others use as well, such as a list of all packages.
    """

    __slots__ = ("_real", "asked", "shared")

    def __init__(self) -> None:
        """Start with none."""
        self.asked: dict[Question, Stamp | None] = {}
        self.shared: dict[Dependencies, None] = {}
        self._real: tuple[int, set[str], set[str]] | None = None

    def add(self, kind: str, path: str) -> None:
        """Add a question that is being asked."""
        if kind != "env" and not os.path.isabs(path):
            path = os.path.join(os.getcwd(), path)
        question = kind, path
        if question not in self.asked:
            self.asked[question] = stamp_of(question)

    def include(self, other: Dependencies) -> None:
        """Add what a result depends on that this one uses."""
        if len(other.asked) > _SHARED:
            self.shared[other] = None
        else:
            for question, stamp in other.asked.items():
                self.asked.setdefault(question, stamp)
        self.shared.update(other.shared)

    def touches(self, paths: Set[str], folders: Set[str]) -> bool:
        """Tell whether any question is of one of some files, or lists one of some folders.

        Args:
            paths: Files, without symbolic links.
            folders: Folders, without symbolic links.
        """
        for part in (self, *self.shared):
            files, listed = part._real_paths()
            if not files.isdisjoint(paths) or not listed.isdisjoint(folders):
                return True
        return False

    def _real_paths(self) -> tuple[set[str], set[str]]:
        """Return what was looked at and which folders were listed, without symbolic links."""
        if self._real is None or self._real[0] != len(self.asked):
            files = {os.path.realpath(path) for kind, path in self.asked if kind != "env"}
            listed = {os.path.realpath(path) for kind, path in self.asked if kind == "list"}
            self._real = len(self.asked), files, listed
        return self._real[1:]


def answer(question: Question) -> str:
    """Return what the file system says now: a digest of the content, or a word."""
    kind, path = question
    try:
        return _ANSWERS[kind](path)
    except FileNotFoundError:
        return ABSENT
    except (OSError, ValueError) as error:
        return f"error {getattr(error, 'errno', None)}"


def stamp_of(question: Question) -> Stamp | None:
    """Return what is different when the answer differs; None where there is nothing."""
    kind, path = question
    if kind in _WITHOUT_STAMP:
        return None
    try:
        status = os.lstat(path) if kind == "there" else os.stat(path)
    except FileNotFoundError:
        return None
    except OSError as error:
        return (error.errno or 0, 0)
    except ValueError:
        return (0, 0)
    if kind in ("is", "there"):
        return (stat.S_IFMT(status.st_mode), 0)
    return (
        *(status.st_mode, status.st_dev, status.st_ino, status.st_size),
        *(status.st_mtime_ns, status.st_ctime_ns),
    )


def has_stamp(question: Question) -> bool:
    """Tell whether an unchanged stamp means an unchanged answer."""
    return question[0] not in _WITHOUT_STAMP


def is_settled(stamp: Stamp | None, now_ns: int | None = None) -> bool:
    """Tell whether something is so old that any further change would change its stamp."""
    if stamp is None:
        return True
    return max(stamp[-2:]) < (time.time_ns() if now_ns is None else now_ns) - _FRESH_NS


def _content(path: str) -> str:
    from hashlib import sha256

    mode = os.stat(path).st_mode
    if stat.S_ISDIR(mode):
        return "folder"
    if not stat.S_ISREG(mode):
        return "device"
    digest = sha256()
    with open(path, "rb", buffering=0) as stream:
        while block := stream.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def _kind(path: str) -> str:
    return f"type {stat.S_IFMT(os.stat(path).st_mode)}"


def _there(path: str) -> str:
    return f"type {stat.S_IFMT(os.lstat(path).st_mode)}"


def _listing(path: str) -> str:
    from hashlib import sha256

    with os.scandir(path) as entries:
        lines = sorted(f"{e.name}{'/' if _is_folder(e) else ''}\0" for e in entries)
    return sha256("".join(lines).encode("utf-8", "surrogateescape")).hexdigest()


def _variable(name: str) -> str:
    return f"={os.environ[name]}" if name in os.environ else ABSENT


def _is_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:
        return False


_ANSWERS: dict[str, Callable[[str], str]] = {
    "file": _content,
    "is": _kind,
    "there": _there,
    "real": os.path.realpath,
    "list": _listing,
    "env": _variable,
}
