"""The side of an expansion that has no access to files, programs and the network."""

from __future__ import annotations

import os
from collections.abc import Iterable
from contextlib import suppress
from importlib import import_module
from typing import Any, NoReturn

from ..errors import UrdftoolError
from ..landlock import disable_files_and_network
from ..parallel import ignore_interrupts, limit_resources, measure_memory
from . import limits
from .expansion import Expansion
from .expansion_channel import Channel
from .expansion_json import Writer
from .expansion_requests import RequestedFiles
from .last_expansion import MAX_TEXT, Prepared
from .location import SourceFile

_NOT_INTERRUPTIBLE = 1.0  # s: after TOTAL_SECONDS, until the system ends the process


def serve() -> NoReturn:
    """Expand one description; the main function of a new interpreter."""
    channel = take_standard_streams()
    job, data = channel.receive()
    import_module(".xacro_hooks", __package__)
    import_modules(job["modules"])
    restrict_process()
    expand_job(job, data, channel, None, [], Prepared())
    os._exit(0)


def take_standard_streams() -> Channel:
    """Return a channel of the standard streams, and replace them by the null device."""
    channel = Channel(os.dup(0), os.dup(1))
    os.dup2(2, 0)  # the null device
    os.dup2(2, 1)
    return channel


def import_modules(names: Iterable[str]) -> None:
    """Import modules; those that do not exist are ignored."""
    for name in names:
        with suppress(ImportError):
            import_module(name)


def close_files(keep: tuple[int, int]) -> None:
    """Close all files but two, and replace the standard streams by the null device."""
    null = os.open(os.devnull, os.O_RDWR)
    for stream in range(3):
        os.dup2(null, stream)
    first, second = sorted(keep)
    for start, stop in ((3, first), (first + 1, second), (second + 1, os.sysconf("SC_OPEN_MAX"))):
        os.closerange(start, stop)


def restrict_process() -> None:
    """Take files, programs, network and environment from this process; limit time and memory."""
    ignore_interrupts()
    os.environ.clear()
    used = measure_memory()
    disable_files_and_network()
    processor = limits.TOTAL_SECONDS + _NOT_INTERRUPTIBLE
    memory = None if used is None else used[0] + limits.MEMORY
    limit_resources(processor=processor, memory=memory, files=0, processes=0)


def expand_job(
    job: dict[str, Any],
    data: bytes,
    channel: Channel,
    mark: Any,
    included: list[SourceFile],
    prepared: Prepared,
) -> None:
    """Expand a description in this process, which is restricted, and send the result."""
    from .xacro_hooks import Run

    file = SourceFile(str(job["path"]), data, str(job["encoding"]))
    result = Expansion(file, job["given"], record=job["record"])
    files = RequestedFiles([file, *included], prepared.answers, channel, mark)
    run = Run(result, files, trusted=job["trusted"], codes=prepared.codes)
    pieces: list[bytes] = []
    try:
        names = run.expand()
        value, pieces = Writer(files.files).write_result(result, names)
    except UrdftoolError as error:
        value = Writer(files.files).write_error(error)
    except Exception as error:
        value = {"bug": f"{type(error).__name__}: {error}, at {_format_traceback(error)}"}
    with suppress(OSError):  # the other side has ended
        texts = [text for text in run.codes.keys() - prepared.codes if len(text) <= MAX_TEXT]
        channel.send(["result", value, files.list_used(), texts], b"".join(pieces))


def _format_traceback(error: Exception) -> str:
    """Return the locations that led to an error; the module ``traceback`` would read files."""
    places = []
    trace = error.__traceback__
    while trace is not None:
        places.append(f"{trace.tb_frame.f_code.co_filename}:{trace.tb_lineno}")
        trace = trace.tb_next
    return ", ".join(places[-5:])
