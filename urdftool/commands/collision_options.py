"""Options that ``urdftool collision`` and ``urdftool collision mesh`` share."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import click

from ..collision.settings import COVERING
from .cache_options import CACHE_OPTIONS, choose_cache_folder
from .options import FiniteRange, make_decorator, make_format_option

if TYPE_CHECKING:
    from ..collision.settings import Settings
    from ..storage import DiskCache


METHODS = ("auto", "primitive", "hull", "cuts", "coacd", "spheres", "simplify")
SPHERE_SUFFIXES = (".yml", ".yaml", ".json")
QUALITIES = ("fast", "balanced", "tight")
_NAMES = (
    "method",
    "quality",
    "max_error",
    "max_hulls",
    "max_vertices",
    "max_triangles",
    "threshold",
    "time_limit",
    "count",
    "cover",
)


def _parse_positive(
    ctx: click.Context, parameter: click.Parameter, value: float | None
) -> float | None:
    if value is not None and not 0 < value < float("inf"):
        raise click.BadParameter(f"{value:g} is not greater than zero", ctx, parameter)
    return value


_OPTIONS = (
    click.option(
        "--method",
        type=click.Choice(METHODS),
        default="auto",
        show_default=True,
        metavar="METHOD",
        help="Method: primitive, hull, cuts, coacd, spheres, simplify, or auto (cheapest within "
        "--max-error).",
    ),
    click.option(
        "--quality",
        type=click.Choice(QUALITIES),
        default="balanced",
        show_default=True,
        help="Preset of --max-error and --max-hulls, and of the time that a result may take.",
    ),
    click.option(
        "--max-error",
        type=float,
        callback=_parse_positive,
        metavar="E",
        help="Maximum distance between the meshes of a link, or a mesh, and the collision, as a "
        "fraction of the diagonal of their bounding box.  [default: 0.05; fast 0.08, tight 0.03]",
    ),
    click.option(
        "--max-hulls",
        type=click.IntRange(1),
        metavar="N",
        help="Maximum number of pieces per link or mesh.  [default: 16 for auto and cuts (fast 4, "
        "tight 32), unlimited for coacd and spheres]",
    ),
    click.option(
        "--max-vertices",
        type=click.IntRange(4),
        default=64,
        show_default=True,
        metavar="N",
        help="Maximum number of vertices per convex piece.",
    ),
    click.option(
        "--max-triangles",
        type=click.IntRange(4),
        default=1000,
        show_default=True,
        metavar="N",
        help="Maximum number of triangles of a mesh after simplify or coacd.",
    ),
    click.option(
        "--threshold",
        type=FiniteRange(0.01, 1.0),
        default=0.06,
        show_default=True,
        metavar="T",
        help="Concavity below which --method coacd stops cutting (CoACD threshold).",
    ),
    click.option(
        "--time-limit",
        type=float,
        default=120.0,
        show_default=True,
        callback=_parse_positive,
        metavar="S",
        help="Maximum total CPU time of CoACD per mesh [s].",
    ),
    click.option(
        "--count",
        type=click.IntRange(1),
        metavar="N",
        help="Number of spheres per link of --method spheres, with the least error: half of it "
        f"protrudes, half is outside of the spheres.  [default: {COVERING} with --cover, else as "
        "--max-error requires]",
    ),
    click.option(
        "--cover",
        is_flag=True,
        help="No point of the surface is outside of the spheres of --count, which protrude the "
        "least for that.",
    ),
    *CACHE_OPTIONS,
    click.option(
        "--picture", metavar="FILE.png", help="Write a picture of the geometry before and after."
    ),
    make_format_option("table", "json"),
    click.option("--overwrite", is_flag=True, help="Overwrite mesh files not written by urdftool."),
)

add_settings_options = make_decorator(_OPTIONS)
"""Adds the options of :class:`Settings`, of the cache and of the output."""


def make_settings(values: dict[str, Any]) -> Settings:
    """Make the settings from the values of the options, by parameter name."""
    from ..collision.settings import Settings

    return Settings().replace_some({k: v for k in _NAMES if (v := values[k]) is not None})


def list_given(ctx: click.Context) -> tuple[str, ...]:
    """Return the names of the settings that are given on the command line."""
    source = click.core.ParameterSource.COMMANDLINE
    return tuple(name for name in _NAMES if ctx.get_parameter_source(name) == source)


def open_cache(values: dict[str, Any]) -> DiskCache:
    """Open the result cache that the options choose.

    Raises:
        click.UsageError: ``--cache-dir`` and ``--no-cache`` are both given.
    """
    from ..storage import DiskCache

    return DiskCache(choose_cache_folder("collision", values["cache_dir"], values["no_cache"]))


def check_sphere_options(values: Mapping[str, Any]) -> None:
    """Refuse options of spheres that the method does not have.

    Raises:
        click.UsageError: The method makes no spheres.
    """
    given = [name for name in ("count", "cover") if values[name]]
    if given and values["method"] != "spheres":
        raise click.UsageError(f"--{given[0]} requires --method spheres")
    if values["count"] and values["max_hulls"]:
        raise click.UsageError("--count and --max-hulls exclude each other")


def check_spheres_file(path: str | None, method: str) -> None:
    """Refuse a file of spheres that is not possible.

    Raises:
        click.UsageError: Its suffix is unknown, or the method makes no spheres.
    """
    if path is None:
        return
    if method != "spheres":
        raise click.UsageError("--spheres-file requires --method spheres")
    if not path.lower().endswith(SPHERE_SUFFIXES):
        raise click.UsageError(f"--spheres-file: '{path}' does not end in .yml, .yaml or .json")


def require_libraries(method: str, *, check: bool = False) -> None:
    """Check that the libraries of a method are installed, before anything is read.

    Raises:
        MissingDependency: A library is missing.
    """
    from ..extras import require

    decomposes = method == "coacd" and not check
    libraries = ("scipy", "manifold3d", *(("coacd",) if decomposes else ()))
    require("'urdftool collision'", *libraries)


def limit_threads() -> None:
    """Limit the numerical libraries to one thread per worker process."""
    for name in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")
