"""Separate process in which xacro expands a description.

The process has no access to files, programs and the network: it requests each file of this process,
which decides. Time and memory are limited by the system. Its answers are JSON, read by type.

On Linux the process is a fork, which starts in milliseconds, or one that an ``ExpansionServer``
prepared; where other threads run, and on other systems, it is a new interpreter.
"""

from __future__ import annotations

import codecs
import os
import re
import signal
import sys
from collections.abc import Iterable
from contextlib import suppress
from importlib import import_module
from typing import Any

from ..errors import UrdftoolError, XacroError
from ..parallel import can_fork, hold_signals, ignore_interrupts
from . import limits
from .expansion import Expansion
from .expansion_channel import Channel, Ended
from .expansion_child import close_files, expand_job, import_modules, restrict_process
from .expansion_files import ExpansionFiles
from .expansion_handle import ExpansionHandle, make_place
from .expansion_json import Reader
from .expansion_requests import PLACE
from .last_expansion import LastExpansion, Prepared, get_last_expansion
from .location import Place, SourceFile
from .packages import Packages
from .well_formed import WIDE
from .xml_text import check_writable

MAX_ANSWER = 64 << 20
"""Maximum size of an expanded description [bytes]; chosen, the limit of a file is 32 MiB."""

PATIENCE = 20 * limits.TOTAL_SECONDS
"""Time [s] without an answer after which the process is ended; chosen, for a machine that is busy
with twenty others."""

_MAX_PATH = 4096  # characters; the limit of Linux
_MAX_STARTS = 4  # an expansion starts again for each encoding of its files, and for YAML; chosen
_ON_DEMAND = frozenset(("yaml",))
"""Modules that an expansion may ask for."""
_ALWAYS = ("urdftool.source.tags", "difflib", "resource", "unicodedata")
"""Modules that an expansion may import when it cannot open files any more."""

_ENCODING = re.compile(rb"<\?xml[^>]*?encoding\s*=\s*[\"']([\w.:-]+)")
_START = (
    "import sys; sys.path[:] = sys.argv[1:]; "
    f"from {__package__}.expansion_child import serve; serve()"
)


class _RequiresModules(Exception):  # noqa: N818
    """Signal that the expansion must start again with further modules imported."""


def expand(result: Expansion, packages: Packages) -> None:
    """Expand a description in a separate process.

    Raises:
        SourceError: The expansion failed, or exceeded a limit.
    """
    modules = {*_ALWAYS, *_list_modules(result.file)}
    for _ in range(_MAX_STARTS):
        files = ExpansionFiles(result.file, packages)
        try:
            _run(result, files, modules)
        except _RequiresModules:
            files.messages.clear()
            continue
        finally:
            files.print_messages()
        return
    raise XacroError(
        "the included files have too many different encodings; save them as UTF-8",
        at=Place(result.file, 0, 0),
        rule="expansion-failed",
    )


def _list_modules(file: SourceFile) -> Iterable[str]:
    """Yield the modules that the expansion of a file imports."""
    if b"yaml" in file.data:
        yield "yaml"
    head = _ENCODING.match(file.data.removeprefix(codecs.BOM_UTF8)[:200])
    names = [head[1].decode("ascii").lower()] if head else []
    names += [encoding for start, encoding in WIDE if file.data.startswith(start)]
    for name in names:
        with suppress(LookupError):
            yield "encodings." + codecs.lookup(name).name.replace("-", "_")


def _run(result: Expansion, files: ExpansionFiles, modules: set[str]) -> None:
    last = get_last_expansion(files, result.file, result.given)
    server = files.expansion_server
    prepared = last.prepare(files, only_answers=server is not None) if can_fork() else Prepared()
    for file in files.files[1:]:
        modules.update(_list_modules(file))
    job = {
        "path": result.file.path,
        "encoding": result.file.encoding,
        "given": result.given,
        "trusted": files.trusted,
        "record": result.lookups is not None,
        "modules": sorted(modules),
    }
    process = _start(job, result.file.data, files, prepared)
    try:
        (answer, *remembered), data = _serve_requests(process.channel, files, modules, last)
        if "bug" in answer:
            raise RuntimeError(f"the expansion failed: {answer['bug']}")
        reader = Reader(answer, files.files, last.pieces)
        if "error" in answer:
            raise reader.read_error()
        result.dependencies = files.finish(reader.read_result(result, data))
        last.finish(prepared, *remembered)
        check_writable(reader.new)
        if server is not None:
            last.pieces = reader.pieces
            server.keep(files.files[1:], last.texts, trusted=files.trusted)
    except _INVALID as error:
        code = process.end()
        at = process.find_place(files.files) or Place(result.file, 0, 0)
        raise _make_death_error(code, error, at) from None
    finally:
        process.end()


def _start(
    job: dict[str, Any], data: bytes, files: ExpansionFiles, prepared: Prepared
) -> ExpansionHandle:
    """Start the process of an expansion, or take one that is prepared."""
    server = files.expansion_server
    if server is not None:
        server.patience = PATIENCE
        served = server.start_expansion(job, data, files.files, prepared.answers)
        if served is not None:
            return served
    return (_Fork if can_fork() else _Interpreter)(job, data, files.files, prepared)


def _serve_requests(
    channel: Channel, files: ExpansionFiles, modules: set[str], last: LastExpansion
) -> tuple[list[Any], bytes]:
    """Serve the requests of the process until it sends its result; return that.

    Returns:
        The result, the indices of the prepared answers that it used, and its expressions; and the
        nodes of the result.
    """
    known = len(files.files)
    while True:
        request, nodes = channel.receive(MAX_ANSWER)
        name = str(request[0])
        if name == "result":
            return list(request[1:]), nodes
        arguments = [str(word) for word in request[1:]]
        if name == "import":
            modules.update(_ON_DEMAND.intersection(arguments))
            raise _RequiresModules
        data = b""
        value: Any
        try:
            if name != "message" and max(map(len, arguments), default=0) > _MAX_PATH:
                raise XacroError(
                    f"a path or name is longer than {_MAX_PATH} characters",
                    rule="expansion-failed",
                )
            value = files.requests[name](*arguments)
        except UrdftoolError as error:
            keys = ("notes", "rule", "path", "line", "column", "data")
            facts: dict[str, Any] = {key: getattr(error, key) for key in keys}
            channel.send({"error": type(error).__name__, "message": error.message, **facts})
            continue
        except ValueError as error:  # a name that the system cannot represent
            channel.send({"error": "XacroError", "message": str(error), **_NO_FACTS})
            continue
        except OSError as error:
            reason, path = error.strerror or str(error), error.filename
            channel.send({"error": "OSError", "message": reason, "path": path})
            continue
        last.add_request(name, arguments)
        if name == "include":
            index, file = value
            value = [index, file.path]
            if index >= known:
                known, data = index + 1, file.data
                modules_before = len(modules)
                modules.update(_list_modules(file))
                if len(modules) > modules_before:
                    raise _RequiresModules
        elif name == "yaml":
            value, data = None, value
        channel.send({"value": value}, data)


_NO_FACTS: dict[str, Any] = {
    "notes": [],
    "rule": "expansion-failed",
    "path": None,
    "line": None,
    "column": None,
}

_INVALID = (
    *(Ended, OSError, ValueError, TypeError, LookupError, AttributeError, OverflowError),
    RecursionError,
)
"""Errors while an answer is read: the process has ended, or its answer is not as expected."""


def _make_death_error(exit_code: int, error: Exception, at: Place) -> XacroError:
    """Return the error for a process that ended without a valid result."""
    if -exit_code == getattr(signal, "SIGXCPU", 0):
        return limits.make_time_error(at)
    message = f"the expansion returned an invalid result ({type(error).__name__}: {error})"
    if isinstance(error, (Ended, OSError)):
        message = (
            "the expansion was ended, because it exceeds a limit of the system or "
            f"{limits.TOTAL_SECONDS:g} s of CPU time, {limits.MEMORY >> 20} MiB of memory or "
            f"{MAX_ANSWER >> 20} MiB of expanded text"
        )
    return XacroError(message, at=at, rule="endless-expansion")


class _Fork(ExpansionHandle):
    """Fork of this process."""

    def __init__(
        self, job: dict[str, Any], data: bytes, files: list[SourceFile], prepared: Prepared
    ) -> None:
        import gc
        import mmap

        import_module("ctypes")
        import_modules(job["modules"])
        import_module(".xacro_hooks", __package__)
        self._code: int | None = None
        self._place = mmap.mmap(-1, PLACE.size)
        requests, answers = os.pipe(), os.pipe()
        hold_signals(hold=True)
        try:
            self._pid = os.fork()
        except BaseException:
            hold_signals(hold=False)
            raise
        if self._pid:
            hold_signals(hold=False)
            self.channel = Channel(requests[0], answers[1], PATIENCE)
            os.close(requests[1])
            os.close(answers[0])
            return
        code = 1
        try:
            gc.freeze()  # what exists is not copied by a collection
            for number in (signal.SIGTERM, signal.SIGHUP):
                signal.signal(number, signal.SIG_DFL)
            ignore_interrupts()
            hold_signals(hold=False)
            close_files(keep=(answers[0], requests[1]))
            channel = Channel(answers[0], requests[1])
            restrict_process()
            expand_job(job, data, channel, self._place, files[1:], prepared)
            code = 0
        finally:
            os._exit(code)

    def find_place(self, files: list[SourceFile]) -> Place | None:
        return make_place(files, *PLACE.unpack_from(self._place))

    def end(self) -> int:
        if self._code is None:
            self.channel.close()
            with suppress(ProcessLookupError):
                os.kill(self._pid, signal.SIGKILL)
            status = os.waitpid(self._pid, 0)[1]
            self._code = os.waitstatus_to_exitcode(status)
        return self._code


class _Interpreter(ExpansionHandle):
    """New interpreter, without the environment of this process."""

    def __init__(
        self, job: dict[str, Any], data: bytes, files: list[SourceFile], prepared: Prepared
    ) -> None:
        import subprocess

        variables = ("LANG", "LC_ALL", "LC_CTYPE", "SYSTEMROOT", "LD_LIBRARY_PATH")
        self._process = subprocess.Popen(
            [sys.executable, "-c", _START, *sys.path],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={name: os.environ[name] for name in variables if name in os.environ},
        )
        stdin, stdout = self._process.stdin, self._process.stdout
        assert stdin is not None
        assert stdout is not None
        self.channel = Channel(stdout.fileno(), stdin.fileno(), PATIENCE)
        with suppress(OSError):  # reported at the next answer
            self.channel.send(job, data)

    def end(self) -> int:
        if self._process.poll() is None:
            self._process.kill()
        for pipe in (self._process.stdin, self._process.stdout):
            with suppress(OSError):
                pipe.close()  # type: ignore[union-attr]
        return self._process.wait()
