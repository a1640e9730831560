"""Settings of a collision geometry."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

from ..suggestions import require_positive, require_word

SOURCES = ("visual", "collision")
"""Geometry of a link whose meshes are simplified."""

URIS = ("auto", "package", "relative", "file")
"""Forms of the URIs of new meshes; ``auto`` is that of the meshes of the robot."""

PER = ("link", "mesh")
"""What a result is for, with the methods ``auto`` and ``cuts``."""

MESH_FORMATS = ("stl", "obj")

COVERING = 12
"""Number of spheres that cover a link by default. Source: the most in cuRobo's own files."""

METHODS = ("auto", "primitive", "hull", "cuts", "coacd", "spheres", "simplify")


@dataclass(frozen=True)
class Effort:
    """Preset of limits, and how long their best result is searched for.

    Attributes:
        max_error: Error limit, relative to the diagonal of the visual's bounding box.
        max_hulls: Largest number of convex pieces.
        cell: Edge of a cell of the flood, relative to the same diagonal.
        surplus: Ratio of the parts that are cut to those that remain after joins.
        rounds: Cuts of the worst part, each followed by a join, after that.
        retries: Repetitions with the points that the estimate missed.
    """

    max_error: float
    max_hulls: int
    cell: float
    surplus: float
    rounds: int
    retries: int


QUALITIES = {
    "fast": Effort(0.08, 4, 0.0075, 1.5, 4, 0),
    "balanced": Effort(0.05, 16, 0.0075, 1.5, 20, 2),
    "tight": Effort(0.03, 32, 0.005, 2.0, 40, 3),
}
"""Presets by name; ``balanced`` is the default."""


@dataclass(frozen=True)
class Settings:
    """Settings for one mesh, which together with its content determine the result.

    Attributes:
        method: One of ``METHODS``.
        max_error: Largest distance between visual and collision, relative to the diagonal of the
            visual's bounding box: a limit for ``auto``, ``cuts`` and ``spheres``, a criterion for
            other methods.
        max_hulls: Largest number of pieces; None for that of the quality with ``auto`` and
            ``cuts``, and no limit with ``coacd`` and ``spheres``.
        max_vertices: Largest number of vertices of a convex piece.
        max_triangles: Largest total number of triangles from ``simplify`` and ``coacd``.
        threshold: CoACD's concavity threshold for ``coacd``: a distance relative to half the
            longest side.
        time_limit: Processor time limit [s] of all CoACD runs on a mesh.
        count: Number of spheres of ``spheres``, with the least error; None for ``COVERING`` with
            ``cover``, else for as many as ``max_error`` needs.
        cover: Whether ``count`` spheres leave no point of the surface outside.
        quality: One of ``QUALITIES``: how finely to measure, and how long to search. It does not
            set ``max_error``; :meth:`from_quality` does.
    """

    method: str = "auto"
    max_error: float = QUALITIES["balanced"].max_error
    max_hulls: int | None = None
    max_vertices: int = 64
    max_triangles: int = 1000
    threshold: float = 0.06
    time_limit: float = 120.0
    count: int | None = None
    cover: bool = False
    quality: str = "balanced"

    def __post_init__(self) -> None:
        """Raise ConfigError if a value is not allowed."""
        require_word("method", self.method, METHODS)
        require_word("quality", self.quality, QUALITIES)
        for name in ("max_error", "max_vertices", "max_triangles", "threshold", "time_limit"):
            require_positive(name, getattr(self, name))
        for name in ("max_hulls", "count"):
            if getattr(self, name) is not None:
                require_positive(name, getattr(self, name))

    @classmethod
    def from_quality(cls, quality: str, **changes: Any) -> Settings:
        """Return the settings of one of ``QUALITIES``, with its limits, and some replaced."""
        return cls().replace_some({"quality": quality, **changes})

    @property
    def effort(self) -> Effort:
        """Return the preset of the quality."""
        return QUALITIES[self.quality]

    @property
    def spheres(self) -> int | None:
        """Return the number of spheres; None for as many as ``max_error`` needs."""
        if self.count is None and self.cover and self.max_hulls is None:
            return COVERING
        return self.count

    @property
    def most(self) -> int:
        """Return the largest number of convex pieces of ``auto`` and ``cuts``."""
        return self.max_hulls or self.effort.max_hulls

    def replace_some(self, table: Mapping[str, Any]) -> Settings:
        """Return a copy with some fields replaced; a quality also sets its limit of the error."""
        quality = table.get("quality")
        limit = {} if quality is None else {"max_error": QUALITIES[quality].max_error}
        return replace(self, **{**limit, **table})

    def as_dict(self) -> dict[str, Any]:
        """Return the settings by name, for keys and messages between processes."""
        return asdict(self)
