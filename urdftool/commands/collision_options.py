"""What ``urdftool collision`` and ``urdftool collision mesh`` have in common."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import click

from .cache_options import CACHE_OPTIONS, cache_place

if TYPE_CHECKING:
    from ..collision.settings import Settings
    from ..storage import DiskCache

F = TypeVar("F", bound=Callable[..., Any])

METHODS = ("auto", "primitive", "hull", "coacd", "simplify")
_PATIENCE = 1.0  # seconds
_NAMES = (
    "method",
    "max_error",
    "max_hulls",
    "max_vertices",
    "max_triangles",
    "threshold",
    "time_limit",
)


def _positive(ctx: click.Context, parameter: click.Parameter, value: float) -> float:
    if not 0 < value < float("inf"):
        raise click.BadParameter(f"{value:g} is not above zero", ctx, parameter)
    return value


def settings_options(function: F) -> F:
    """The choices of ``Settings``, and those about speed and reports."""
    for option in reversed(_OPTIONS):
        function = option(function)
    return function


_OPTIONS = (
    click.option(
        "--method",
        type=click.Choice(METHODS),
        default="auto",
        show_default=True,
        help="How meshes are simplified; auto takes the cheapest within --max-error.",
    ),
    click.option(
        "--max-error",
        type=float,
        default=0.01,
        show_default=True,
        callback=_positive,
        metavar="E",
        help="Largest distance of mesh and collision, relative to the diagonal of the part's box.",
    ),
    click.option(
        "--max-hulls",
        type=click.IntRange(1),
        metavar="N",
        help="Convex pieces a mesh may become; without it 32 for auto, any number for coacd.",
    ),
    click.option(
        "--max-vertices",
        type=click.IntRange(4),
        default=64,
        show_default=True,
        metavar="N",
        help="Vertices a convex piece may have.",
    ),
    click.option(
        "--max-triangles",
        type=click.IntRange(4),
        default=1000,
        show_default=True,
        metavar="N",
        help="Triangles that simplify and coacd leave of a mesh.",
    ),
    click.option(
        "--threshold",
        type=click.FloatRange(0.01, 1.0),
        default=0.06,
        show_default=True,
        metavar="T",
        help="CoACD's concavity at which --method coacd stops to cut.",
    ),
    click.option(
        "--time-limit",
        type=float,
        default=120.0,
        show_default=True,
        callback=_positive,
        metavar="S",
        help="Processor time of CoACD for one mesh, in all [s].",
    ),
    *CACHE_OPTIONS,
    click.option(
        "--picture", metavar="FILE.png", help="Draw what was there beside what there is now."
    ),
    click.option(
        "--format",
        "style",
        type=click.Choice(["table", "json"]),
        default="table",
        help="How the result is told.",
    ),
    click.option("--overwrite", is_flag=True, help="Replace mesh files that are not ours."),
)


def settings_of(values: dict[str, Any]) -> Settings:
    """The settings that the options say."""
    from ..collision.settings import Settings

    return Settings(**{name: values[name] for name in _NAMES})


def given_names(ctx: click.Context) -> tuple[str, ...]:
    """The settings that stand on the command line."""
    source = click.core.ParameterSource.COMMANDLINE
    return tuple(name for name in _NAMES if ctx.get_parameter_source(name) == source)


def cache_of(values: dict[str, Any]) -> DiskCache:
    """The cache that the options say.

    Raises:
        click.UsageError: Two options contradict each other.
    """
    from ..storage import DiskCache

    return DiskCache(cache_place("collision", values["cache_dir"], values["no_cache"]))


def require_libraries(method: str, *, check: bool = False) -> None:
    """Check that the libraries of a method are installed, before anything is read.

    Raises:
        MissingDependency: One of them is not.
    """
    from ..extras import require

    decomposes = method in ("auto", "coacd") and not check
    libraries = ("scipy", "manifold3d", *(("coacd",) if decomposes else ()))
    require("'urdftool collision'", *libraries)


def one_thread_each() -> None:
    """Keep the numerical libraries from starting threads of their own beside our processes."""
    for name in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")
