"""A run of ``urdftool lint`` whose files, options and code are those of an earlier one."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from ..console import Console
from .cache_options import choose_cache_folder
from .options import ASSIGN

if TYPE_CHECKING:
    from ..lint.printed import Transcript

_OPTIONS = (
    *("words", "select", "extend_select", "ignore", "target", "style", "whole", "statistics"),
    *("exit_zero", "fail_on", "package", "package_path"),
)
"""Options of runs that are stored, which are a part of the key."""

_WITHOUT_EFFECT = ("jobs", "cache_dir")
"""Options that do not change what is printed."""


def print_run(
    console: Console, given: Mapping[str, Any], run: Callable[[Transcript | None], int]
) -> int:
    """Print what a run prints, and return its exit code.

    A run of named files, without other outputs, is not repeated while nothing changes.
    """
    if not _is_stored(given):
        return run(None)
    from ..lint.installed_code import hash_code
    from ..lint.printed import Transcript, get_key, read_printed, write_printed
    from ..lint.queries import Queries
    from ..storage import DiskCache

    queries = Queries(DiskCache(choose_cache_folder("lint", given["cache_dir"], no_cache=False)))
    key = get_key(hash_code(), _list_facts(console, given))
    known = read_printed(queries, key, _list_paths(given))
    if known is not None:
        code, texts = known
        _print(console, texts)
        return code
    console.transcript = transcript = Transcript()
    code = run(transcript)
    write_printed(Queries(queries.store), key, code, transcript)
    return code


def _is_stored(given: Mapping[str, Any]) -> bool:
    """Tell whether a run may be stored: it reads named files and prints its findings."""
    names = _OPTIONS + _WITHOUT_EFFECT
    paths = _list_paths(given)
    return (
        not any(value for name, value in given.items() if name not in names)
        and given["style"] != "html"
        and bool(paths)
        and all(map(os.path.isfile, paths))
    )


def _list_paths(given: Mapping[str, Any]) -> list[str]:
    return [word for word in given["words"] if ASSIGN not in word]


def _list_facts(console: Console, given: Mapping[str, Any]) -> list[object]:
    """Return what the output depends on in addition to files."""
    options = [given[name] for name in _OPTIONS if name not in ("package", "package_path")]
    return [
        *(options, sorted((name, str(folder)) for name, folder in given["package"].items())),
        *([str(folder) for folder in given["package_path"]], console.config, console.gltf_up),
        *(console.verbosity, console.has_colors(), sys.stdout.isatty()),
    ]


def _print(console: Console, texts: list[tuple[str, str]]) -> None:
    from ..standard_output import write_stdout

    for stream, text in texts:
        if stream == "stdout":
            write_stdout(text)
        else:
            console.print_line(text)
