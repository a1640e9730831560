"""What a piece of work asks of the file system, and whether it would be told the same again.

Whoever keeps results has to know all that they hang on: not only the files that were opened, but
those that were looked for and are not there, the folders that were listed, the links that were
followed. Nobody can be trusted to keep such a list by hand, least of all a rule that is written
next year. So it is kept here, by listening: Python announces what is opened and listed, to whoever
hooks in; ``os.stat``, its kin and the reading of environment variables are wrapped for the time.

What is remembered within a run (:class:`Remembered`) was not looked at again by who asks next, who
hangs on it nevertheless, and so is told what was looked at for it.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Generic, TypeVar

Question = tuple[str, str]
"""A kind and a path: ``file`` (is it there, what is in it), ``link`` (where does it lead), ``list``
(of a folder); ``env`` and a variable, ``*`` for all; ``many`` and the number of a set of questions
that are asked together."""

Asked = dict[Question, "Stamp | None"]
"""Questions, each with the stamp of its path when it was asked first."""

Stamp = tuple[int, ...]
"""What changes with a file, folder or link: its number, size and times in ns."""

ABSENT = "-"
_FRESH_NS = 2_000_000_000  # so young, a file may change again without its times telling

_K = TypeVar("_K")
_V = TypeVar("_V")

_MANY = 50

_stat, _lstat, _readlink = os.stat, os.lstat, os.readlink
_ASKED_OF_WINDOWS = ("exists", "isdir", "isfile", "islink", "lexists")
_paths = {name: getattr(os.path, name) for name in _ASKED_OF_WINDOWS}
_variable, _variables = os._Environ.__getitem__, os._Environ.__iter__
_heard: list[Asked] = []
_hooked = False
_remembered: list[Remembered[Any, Any]] = []
together: list[Asked] = []
"""The sets of questions that ``many`` means."""


@contextmanager
def listen() -> Iterator[Asked]:
    """All that is asked in the block; whoever listens around it does not hear it."""
    _hook()
    asked: Asked = {}
    _heard.append(asked)
    if len(_heard) == 1:
        _wrap(True)
    try:
        yield asked
    finally:
        _heard.pop()
        if not _heard:
            _wrap(False)


class Remembered(Generic[_K, _V]):
    """A function of one argument that reads files, worked out once for each argument."""

    def __init__(self, function: Callable[[_K], _V]) -> None:
        """Take the function, as a decorator does."""
        self.function = function
        self.__doc__ = function.__doc__
        self._known: dict[_K, tuple[_V, Asked | None]] = {}
        _remembered.append(self)

    def __call__(self, key: _K) -> _V:
        """The result; whoever listens hears what was asked for it."""
        entry = self._known.get(key)
        if entry is None or (_heard and entry[1] is None):
            entry = self._known[key] = self._work_out(key)
        if _heard and entry[1]:
            heard = _heard[-1]
            for question, stamp in entry[1].items():
                heard.setdefault(question, stamp)
        return entry[0]

    def _work_out(self, key: _K) -> tuple[_V, Asked | None]:
        if not _heard:
            return self.function(key), None
        with listen() as asked:
            result = self.function(key)
        if len(asked) > _MANY:
            together.append(asked)
            asked = {("many", str(len(together) - 1)): None}
        return result, asked

    def clear(self) -> None:
        """Forget all."""
        self._known.clear()


def forget() -> None:
    """Forget all that is remembered, as a new process would have."""
    for function in _remembered:
        function.clear()


def answer(question: Question) -> str:
    """What the file system says now: a digest of the content, or a word."""
    kind, path = question
    try:
        if kind == "env":
            return _environment(path)
        if kind == "link":
            return _link(path)
        if kind == "list":
            return _listing(path)
        return _content(path)
    except FileNotFoundError:
        return ABSENT
    except (OSError, ValueError) as error:
        return f"error {getattr(error, 'errno', None)}"


def stamp_of(question: Question) -> Stamp | None:
    """What is to differ when the answer differs; None where there is nothing."""
    if question[0] in ("env", "many"):
        return None
    try:
        status = (_lstat if question[0] == "link" else _stat)(question[1])
    except FileNotFoundError:
        return None
    except OSError as error:
        return (error.errno or 0,)
    except ValueError:
        return (0,)
    return (
        *(status.st_mode, status.st_dev, status.st_ino, status.st_size),
        *(status.st_mtime_ns, status.st_ctime_ns),
    )


def is_settled(stamp: Stamp | None, now_ns: int | None = None) -> bool:
    """Whether something is old enough that no further change could leave its stamp as it is."""
    if stamp is None:
        return True
    return max(stamp[-2:]) < (time.time_ns() if now_ns is None else now_ns) - _FRESH_NS


def _content(path: str) -> str:
    import stat
    from hashlib import sha256

    mode = _stat(path).st_mode
    if stat.S_ISDIR(mode):
        return "folder"
    if not stat.S_ISREG(mode):
        return "device"
    digest = sha256()
    with open(path, "rb", buffering=0) as stream:
        while block := stream.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def _link(path: str) -> str:
    import stat

    mode = _lstat(path).st_mode
    if stat.S_ISLNK(mode):
        return f"to {_readlink(path)}"
    return "folder" if stat.S_ISDIR(mode) else "file"


def _listing(path: str) -> str:
    from hashlib import sha256

    with os.scandir(path) as entries:
        lines = sorted(f"{e.name}{'/' if _is_folder(e) else ''}\0" for e in entries)
    return sha256("".join(lines).encode("utf-8", "surrogateescape")).hexdigest()


def _environment(name: str) -> str:
    from hashlib import sha256

    if name == "*":
        lines = sorted(f"{key}={value}\0" for key, value in os.environ.items())
        return sha256("".join(lines).encode("utf-8", "surrogateescape")).hexdigest()
    return f"={os.environ[name]}" if name in os.environ else ABSENT


def _is_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:
        return False


def _note(kind: str, path: Any) -> None:
    if not isinstance(path, str):
        try:
            path = os.fsdecode(path)
        except TypeError:  # a number of an open file, which was noted when it was opened
            return
    if path.endswith((".py", ".pyc", ".so", ".pyd")):
        return
    if not os.path.isabs(path):
        path = os.path.join(os.getcwd(), path)
    question = kind, path
    heard = _heard[-1]
    if question not in heard:
        heard[question] = stamp_of(question)


def _hook() -> None:
    """Listen to Python's announcements; they cannot be turned off, so once for the process."""
    global _hooked
    if _hooked:
        return
    _hooked = True

    def announced(event: str, arguments: tuple[Any, ...]) -> None:
        if not _heard or event not in ("open", "os.listdir", "os.scandir"):
            return
        if sys._getframe(1).f_code.co_filename.startswith("<frozen importlib"):
            return  # it looks for code, which is known otherwise
        _note("file" if event == "open" else "list", arguments[0] or ".")

    sys.addaudithook(announced)


def _wrap(on: bool) -> None:
    """Put our functions in the place of those of ``os`` that are not announced, or back."""
    os.stat = _heard_stat if on else _stat
    os.lstat = _heard_lstat if on else _lstat
    os.readlink = _heard_readlink if on else _readlink
    environ: Any = os._Environ
    environ.__getitem__ = _heard_variable if on else _variable
    environ.__iter__ = _heard_variables if on else _variables
    if sys.platform == "win32":  # there they do not go through os.stat
        for name, function in _paths.items():
            setattr(os.path, name, _heard_by(name, function) if on else function)
    if sys.version_info < (3, 11):  # its pathlib keeps functions of its own
        import pathlib

        accessor: Any = pathlib._NormalAccessor  # type: ignore[attr-defined]
        accessor.stat = staticmethod(os.stat)
        accessor.readlink = staticmethod(os.readlink)


def _heard_by(name: str, function: Callable[[Any], bool]) -> Callable[[Any], bool]:
    kind = "link" if name in ("islink", "lexists") else "file"

    def heard(path: Any) -> bool:
        _note(kind, path)
        return function(path)

    return heard


def _heard_stat(path: Any, *, dir_fd: Any = None, follow_symlinks: bool = True) -> Any:
    _note("file" if follow_symlinks else "link", path)
    return _stat(path, dir_fd=dir_fd, follow_symlinks=follow_symlinks)


def _heard_lstat(path: Any, *, dir_fd: Any = None) -> Any:
    _note("link", path)
    return _lstat(path, dir_fd=dir_fd)


def _heard_readlink(path: Any, *, dir_fd: Any = None) -> Any:
    _note("link", path)
    return _readlink(path, dir_fd=dir_fd)


def _heard_variable(environ: Any, name: Any) -> Any:
    _heard[-1].setdefault(("env", os.fsdecode(name)), None)
    return _variable(environ, name)


def _heard_variables(environ: Any) -> Any:
    _heard[-1].setdefault(("env", "*"), None)
    return _variables(environ)
