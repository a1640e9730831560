"""Temporary names next to an output, and recovery from a process that was killed while writing.

``.NAME.PID.tmp`` is the new state of an output while it is written, ``.NAME.PID.old`` its previous
state while it is replaced. Both are removed at the end; they remain only after a kill. The next
process that writes the same output restores or removes them.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path

_TEMPORARY = re.compile(r"\.(.+)\.([1-9][0-9]{0,9})\.(tmp|old)", re.DOTALL)


def make_temporary_path(place: Path, kind: str) -> Path:
    """Return a temporary name of this process next to an output.

    Args:
        place: The output.
        kind: ``"tmp"`` for its new state, ``"old"`` for its previous state.
    """
    return place.with_name(f".{place.name}.{os.getpid()}.{kind}")


def restore_folder(target: str | Path) -> bool:
    """Restore a folder that a killed process had renamed in order to replace it.

    Returns:
        Whether it was missing and is restored.
    """
    place = Path(os.path.realpath(target))
    if os.path.lexists(place):
        return False
    found = [path for path in _find_leftovers([place]) if path.suffix == ".old"]
    folders = [path for path in found if path.is_dir() and not path.is_symlink()]
    if not folders:
        return False
    with suppress(OSError):
        os.rename(max(folders, key=lambda path: path.stat().st_ctime_ns), place)
        return True
    return False


def remove_leftovers(places: Iterable[Path]) -> None:
    """Remove the temporary files of outputs that processes left which no longer run."""
    for path in _find_leftovers(places, same_process=True):
        with suppress(OSError):
            remove(path)


def remove(path: Path) -> None:
    """Remove a file, link or folder if it exists.

    Raises:
        OSError: It cannot be removed.
    """
    try:
        os.unlink(path)
    except FileNotFoundError:
        return
    except OSError:
        if path.is_symlink() or not path.is_dir():
            raise
        import shutil

        shutil.rmtree(path)


def ensure(action: Callable[[], None]) -> None:
    """Run an action that may be repeated; repeat it once if it fails or Ctrl-C interrupts it.

    An action that fails twice is given up without an error.
    """
    try:
        action()
    except BaseException as error:
        with suppress(OSError):
            action()
        if not isinstance(error, OSError):
            raise


def _find_leftovers(places: Iterable[Path], *, same_process: bool = False) -> list[Path]:
    """Return the temporary paths of outputs whose process no longer runs.

    Args:
        places: The outputs.
        same_process: Whether to return all temporary paths of these processes in the folders of the
            outputs.
    """
    chosen = set(places)
    found: dict[int, list[tuple[Path, bool]]] = {}
    for folder in {place.parent for place in chosen}:
        try:
            entries = os.listdir(folder)
        except OSError:
            continue
        for entry in entries:
            match = _TEMPORARY.fullmatch(entry) if entry.startswith(".") else None
            if match:
                is_wanted = folder / match[1] in chosen
                found.setdefault(int(match[2]), []).append((folder / entry, is_wanted))
    return [
        path
        for process, paths in found.items()
        if any(is_wanted for _, is_wanted in paths) and not _is_running(process)
        for path, is_wanted in paths
        if is_wanted or same_process
    ]


def _is_running(process: int) -> bool:
    """Tell whether another process with this number runs."""
    if process == os.getpid():
        return False
    if sys.platform == "win32":
        import ctypes

        query, still_active, access_denied = 0x1000, 259, 5
        handle = ctypes.windll.kernel32.OpenProcess(query, False, process)
        if not handle:
            return ctypes.windll.kernel32.GetLastError() == access_denied
        code = ctypes.c_ulong()
        known = ctypes.windll.kernel32.GetExitCodeProcess(handle, ctypes.byref(code))
        ctypes.windll.kernel32.CloseHandle(handle)
        return not known or code.value == still_active
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        return True
    return True
