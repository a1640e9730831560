"""Where a command keeps what it computed, for the next time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

F = TypeVar("F", bound=Callable[..., Any])

CACHE_OPTIONS = (
    click.option("--cache-dir", metavar="DIR", help="Where results are kept for the next time."),
    click.option("--no-cache", is_flag=True, help="Compute all anew, and keep nothing."),
)


def cache_options(function: F) -> F:
    """``--cache-dir`` and ``--no-cache``."""
    for option in reversed(CACHE_OPTIONS):
        function = option(function)
    return function


def cache_place(room: str, cache_dir: str | None, no_cache: bool) -> str | None:
    """The folder that the two options say; None keeps nothing.

    Args:
        room: The command's own folder in the user's cache, where none is said.
        cache_dir: A folder.
        no_cache: Nothing is to be kept.

    Raises:
        click.UsageError: They contradict each other.
    """
    from ..storage import cache_folder

    if no_cache:
        if cache_dir:
            raise click.UsageError("--cache-dir and --no-cache exclude each other")
        return None
    return cache_dir or str(cache_folder(room))
