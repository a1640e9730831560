"""Limits of the size of visual meshes and images."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """Limits of visual meshes and textures; None for no limit.

    Attributes:
        max_triangles: Number of triangles of a visual mesh.
        max_error: Distance between a mesh and its reduction, as a fraction of the diagonal of the
            mesh's bounding box.
        max_texture: Width and height of an image [pixels].
    """

    max_triangles: int | None = None
    max_error: float | None = None
    max_texture: int | None = None

    @property
    def reduces_meshes(self) -> bool:
        """Tell whether visual meshes are reduced."""
        return self.max_triangles is not None or self.max_error is not None

    @property
    def is_set(self) -> bool:
        """Tell whether there is any limit."""
        return self.reduces_meshes or self.max_texture is not None
