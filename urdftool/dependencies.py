"""Dependencies of a result on files and environment variables, and their change detection.

A dependency is a query with the stamp that its path had at the first query. The kinds:

``file``  the target of a path, with the contents of a file
``is``    whether a path leads to a file, a folder or another type
``there`` whether an entry exists at a path; a broken symbolic link counts
``real``  the path without symbolic links
``list``  the names in a folder, and which of them are folders
``code``  the files of Python code and the folders in a folder, as :func:`list_code` lists them on
          disk
``env``   the value of an environment variable
"""

from __future__ import annotations

import os
import re
import stat
import time
from collections.abc import Callable, Iterable, Set

Question = tuple[str, str]
"""Kind and path of a query; for ``env`` kind and variable name."""

Stamp = tuple[int, ...]
"""Mode, device, inode, size and times [ns] of a file or folder; its type for other kinds."""

ABSENT = "-"
_FRESH_NS = 2_000_000_000  # a newer file may change again without a change of its times; chosen
_SHARED = 50  # larger sets are referenced by their users, not copied; chosen
_WITHOUT_STAMP = ("env", "real")
_NOT_SOURCE = frozenset(
    ("__pycache__", "build", "dist", "node_modules", "install", "devel", "log", "site-packages")
)
"""Folders of what tools make or install."""


class Dependencies:
    """Set of the queries on which a result depends.

    Attributes:
        stamps: Stamp at the first query, by query.
        shared: Large sets that several results use, such as that of the list of all packages.
    """

    __slots__ = ("_real", "shared", "stamps")

    def __init__(self) -> None:
        """Create an empty set."""
        self.stamps: dict[Question, Stamp | None] = {}
        self.shared: dict[Dependencies, None] = {}
        self._real: tuple[int, set[str], set[str]] | None = None

    def add(self, kind: str, path: str) -> None:
        """Add a query.

        Args:
            kind: A kind of the module's docstring.
            path: Path, made absolute; for ``env`` the name of a variable.
        """
        if kind != "env" and not os.path.isabs(path):
            path = os.path.join(os.getcwd(), path)
        question = kind, path
        if question not in self.stamps:
            self.stamps[question] = read_stamp(question)

    def include(self, other: Dependencies) -> None:
        """Add the dependencies of a result that this result uses."""
        if len(other.stamps) > _SHARED:
            self.shared[other] = None
        else:
            for question, stamp in other.stamps.items():
                self.stamps.setdefault(question, stamp)
        self.shared.update(other.shared)

    def is_affected_by(self, paths: Set[str], folders: Set[str]) -> bool:
        """Tell whether any query concerns one of the files or lists one of the folders.

        Args:
            paths: Paths of files, without symbolic links.
            folders: Paths of folders, without symbolic links.
        """
        for part in (self, *self.shared):
            files, listed = part._get_real_paths()
            if not files.isdisjoint(paths) or not listed.isdisjoint(folders):
                return True
        return False

    def _get_real_paths(self) -> tuple[set[str], set[str]]:
        """Return the queried paths and the listed folders, both without symbolic links."""
        if self._real is None or self._real[0] != len(self.stamps):
            real = resolve_all(path for kind, path in self.stamps if kind != "env")
            files = set(real.values())
            listed = {real[path] for kind, path in self.stamps if kind == "list"}
            self._real = len(self.stamps), files, listed
        return self._real[1:]


def resolve_all(paths: Iterable[str]) -> dict[str, str]:
    """Return ``os.path.realpath`` of each path; links of a folder are resolved once."""
    folders: dict[str, str] = {}
    found = {}
    for path in paths:
        folder, name = os.path.split(path)
        if name in ("", os.curdir, os.pardir) or os.path.islink(path):
            found[path] = os.path.realpath(path)
            continue
        if folder not in folders:
            folders[folder] = os.path.realpath(folder)
        found[path] = os.path.join(folders[folder], name)
    return found


def compute_answer(question: Question) -> str:
    """Return the present answer to a query: a digest of the content, or a word."""
    kind, path = question
    try:
        return _ANSWERS[kind](path)
    except FileNotFoundError:
        return ABSENT
    except (OSError, ValueError) as error:
        return f"error {getattr(error, 'errno', None)}"


def read_stamp(question: Question) -> Stamp | None:
    """Return the present stamp of a query; None if the path is absent or the kind has no stamp."""
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
    """Tell whether a stamp is so old that any further change would change it.

    Args:
        stamp: A stamp; None counts as settled.
        now_ns: Present time [ns]; None reads the clock.
    """
    if stamp is None:
        return True
    return max(stamp[-2:]) < (time.time_ns() if now_ns is None else now_ns) - _FRESH_NS


def _digest_content(path: str) -> str:
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


def _read_kind(path: str) -> str:
    return f"type {stat.S_IFMT(os.stat(path).st_mode)}"


def _read_existence(path: str) -> str:
    return f"type {stat.S_IFMT(os.lstat(path).st_mode)}"


def _digest_listing(path: str) -> str:
    from hashlib import sha256

    with os.scandir(path) as entries:
        lines = sorted(f"{e.name}{'/' if is_folder(e) else ''}\0" for e in entries)
    return sha256("".join(lines).encode("utf-8", "surrogateescape")).hexdigest()


_CODE = re.compile(r".*\.(?:py|ipynb)|[^.]+|pyproject\.toml|setup\.cfg|.*require.*\.txt")
"""Names of the files that can import or require a library."""


def list_code(path: str) -> tuple[list[str], list[str]]:
    """Return the sorted names of the files of Python code and of the folders in a folder.

    Notebooks, scripts without a suffix and files of requirements are among the files. Hidden names,
    folders of what tools make or install, and virtual environments are left out: what a test or
    a compiler writes there does not change which code a project has.

    Raises:
        OSError: The folder cannot be listed.
    """
    files, folders = [], []
    with os.scandir(path) as entries:
        for entry in entries:
            if entry.name == "pyvenv.cfg":
                return [], []
            if _CODE.fullmatch(entry.name) and not entry.is_dir():
                files.append(entry.name)
            elif (
                not entry.name.startswith(".")
                and entry.name not in _NOT_SOURCE
                and entry.is_dir(follow_symlinks=False)
            ):
                folders.append(entry.name)
    return sorted(files), sorted(folders)


def _digest_code(path: str) -> str:
    from hashlib import sha256

    files, folders = list_code(path)
    lines = "".join([f"{name}\0" for name in files] + [f"{name}/\0" for name in folders])
    return sha256(lines.encode("utf-8", "surrogateescape")).hexdigest()


def _digest_variable(name: str) -> str:
    return f"={os.environ[name]}" if name in os.environ else ABSENT


def is_folder(entry: os.DirEntry[str]) -> bool:
    """Tell whether an entry is a folder, or a link to one."""
    try:
        return entry.is_dir()
    except OSError:
        return False


_ANSWERS: dict[str, Callable[[str], str]] = {
    "file": _digest_content,
    "is": _read_kind,
    "there": _read_existence,
    "real": os.path.realpath,
    "list": _digest_listing,
    "code": _digest_code,
    "env": _digest_variable,
}
KINDS = frozenset(_ANSWERS)
"""Kinds of queries."""
