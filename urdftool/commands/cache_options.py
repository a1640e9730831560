"""Options of the result cache."""

from __future__ import annotations

import click

from .options import make_decorator

CACHE_OPTIONS = (
    click.option(
        "--cache-dir",
        metavar="DIR",
        help="Folder of the result cache.  [default: in the user's cache folder]",
    ),
    click.option("--no-cache", is_flag=True, help="Neither read nor write the result cache."),
)

add_cache_options = make_decorator(CACHE_OPTIONS)


def choose_cache_folder(name: str, cache_dir: str | None, no_cache: bool) -> str | None:
    """Return the folder of the result cache, or None for no cache.

    Raises:
        click.UsageError: Both options are given.
    """
    from ..storage import cache_folder

    if no_cache:
        if cache_dir:
            raise click.UsageError("--cache-dir and --no-cache exclude each other")
        return None
    return cache_dir or str(cache_folder(name))
