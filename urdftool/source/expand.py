"""Expansion of xacro to plain URDF, with the origin of each element."""

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
        file: The file.
        arguments: Values of its ``<xacro:arg>`` elements, as given by ``name:=value``.
        packages: Finder for ``$(find NAME)``.

    Raises:
        XmlError: A file is not well-formed.
        XacroError: The expansion failed; the error has the location of the cause.
        PackageNotFound: The package of ``$(find NAME)`` was not found.
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
    """Stop an expansion after ``MAX_SECONDS``, if signals are available.

    A timer set by other code is not changed; the expansion then has no limit.
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
