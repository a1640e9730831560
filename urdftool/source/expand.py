"""Xacro to plain URDF, with where each element came from."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from ..errors import UrdftoolError, XacroError
from .expansion import Expansion
from .location import SourceFile
from .packages import Packages
from .xacro_hooks import Run

MAX_SECONDS = 8.0

_lock = threading.RLock()


def expand_xacro(
    file: SourceFile,
    arguments: Mapping[str, str],
    packages: Packages,
) -> Expansion:
    """Expand a xacro file.

    Args:
        file: The file, read.
        arguments: Values for its ``<xacro:arg>`` elements, as ``name:=value`` gives them.
        packages: Where ``$(find NAME)`` looks.

    Raises:
        XmlError: A file of it is not well-formed.
        XacroError: The expansion failed; the message has the place that caused it.
        PackageNotFound: ``$(find NAME)`` names no package that could be found.
    """
    with _lock:
        run = Run(Expansion(file, arguments), packages)
        with run.hooks(), _time_limit(run):
            try:
                run.expand()
            except UrdftoolError:
                raise
            except Exception as error:
                raise run.explain(error) from error
        return run.result


@contextmanager
def _time_limit(run: Run) -> Iterator[None]:
    """Stop an expansion that takes too long; only where signals can be had.

    A timer that somebody else has set is left alone.
    """
    usable = hasattr(signal, "setitimer") and threading.current_thread() is threading.main_thread()
    if not usable or signal.getitimer(signal.ITIMER_REAL)[0]:
        yield
        return

    def stop(*_: object) -> None:
        raise XacroError(
            f"the expansion takes longer than {MAX_SECONDS:g} s, and was stopped",
            at=run.place,
            path=run.result.file.path,
            rule="endless-expansion",
        )

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, MAX_SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
