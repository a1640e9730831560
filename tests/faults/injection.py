"""A fault at a chosen event of the file system, in a forked process.

An event is the moment before or after a call that changes files in a folder: ``open`` for writing,
``rename``, ``replace``, ``link``, ``unlink``, ``mkdir``, ``rmdir``, ``fsync``, ``chmod``,
``truncate`` and the exchange of two names.
"""

import builtins
import errno
import io
import json
import os
import shutil  # noqa: F401 -- compares functions of os when it is imported
import signal
import tempfile  # noqa: F401 -- as above

from urdftool import storage
from urdftool.errors import UrdftoolError

KINDS = ("kill", "interrupt", "full")
CALLS = (
    *("rename", "replace", "link", "symlink", "unlink", "remove", "rmdir", "mkdir", "open"),
    *("fsync", "chmod", "truncate", "ftruncate", "utime"),
)
_WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT


class Events:
    """Counter of the events in a folder, one of which may be a fault."""

    def __init__(self, root, kind="", number=0):
        self.root = os.path.realpath(root)
        self.kind = kind
        self.number = number
        self.count = 0
        self.process = 0

    def install(self):
        """Observe this process, not those it starts; nothing takes it back.

        Its files need not survive a crash.
        """
        self.process = os.getpid()
        os.fsync = lambda number: None
        for name in CALLS:
            paths = 2 if name in ("rename", "replace", "link", "symlink") else 1
            setattr(os, name, self._wrap(getattr(os, name), self._is_write, paths))
        builtins.open = io.open = self._wrap(builtins.open, self._is_opened_for_writing)
        storage.exchange_names = self._wrap(storage.exchange_names, lambda *_, **__: True, 2)

    def _wrap(self, function, concerns, paths=1):
        def call(*arguments, **options):
            if not (self._is_inside(arguments, options, paths) and concerns(*arguments, **options)):
                return function(*arguments, **options)
            self._happen(before=True)
            result = function(*arguments, **options)
            self._happen(before=False)
            return result

        return call

    def _is_write(self, *arguments, **options):
        flags = [word for word in arguments[1:2] if isinstance(word, int)]
        return "flags" in options or not flags or bool(flags[0] & _WRITES) or len(arguments) == 1

    def _is_opened_for_writing(self, _, mode="r", *__, **___):
        return bool(set(mode) & set("wax+"))

    def _is_inside(self, arguments, options, paths):
        """Tell whether any path, or the file of a descriptor, is in the folder."""
        for path in arguments[:paths]:
            if isinstance(path, int):
                path = _get_path(path)
            elif isinstance(path, str | bytes | os.PathLike):
                path = os.fsdecode(path)
            else:
                continue
            folder = options.get("dir_fd")
            base = os.getcwd() if folder is None else _get_path(folder)
            if os.path.join(base, path).startswith(self.root + os.sep):
                return True
        return False

    def _happen(self, *, before):
        if os.getpid() != self.process:
            return
        self.count += 1
        if self.count != self.number:
            return
        if self.kind == "kill":
            os.kill(os.getpid(), signal.SIGKILL)
        if self.kind == "interrupt":
            raise KeyboardInterrupt
        if self.kind == "full" and before:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def _get_path(descriptor):
    try:
        return os.readlink(f"/proc/self/fd/{descriptor}")
    except OSError:
        return ""


def run_forked(action, events, seconds=120):
    """Run an action in a forked process.

    Returns:
        The exit code, negative for a signal, and the number of events; None after a kill.
    """
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        code = 3
        try:
            signal.alarm(seconds)
            os.close(reading)
            signal.signal(signal.SIGINT, signal.default_int_handler)
            events.install()
            code = _run(action)
            os.write(writing, json.dumps(events.count).encode())
        finally:
            os._exit(code)
    os.close(writing)
    with open(reading, "rb") as stream:
        said = stream.read()
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), json.loads(said or "null")


def _run(action):
    try:
        return action() or 0
    except KeyboardInterrupt:
        return 130
    except UrdftoolError:
        return 2
