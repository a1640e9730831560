"""Meshes to measure on, made of as many triangles as are wanted."""

from __future__ import annotations

from pathlib import Path

import numpy as np


def bumpy_torus(triangles: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices [m] and faces of a torus with waves on it; closed, no two triangles in a plane."""
    across = max(8, round((triangles / 4) ** 0.5))
    along = max(8, round(triangles / 2 / across))
    u, v = np.meshgrid(
        np.linspace(0, 2 * np.pi, along, endpoint=False),
        np.linspace(0, 2 * np.pi, across, endpoint=False),
        indexing="ij",
    )
    tube = 0.03 + 0.002 * np.cos(9 * u) * np.cos(5 * v)
    ring = 0.1 + tube * np.cos(v)
    vertices = np.stack([ring * np.cos(u), ring * np.sin(u), tube * np.sin(v)], axis=-1)
    number = np.arange(along * across).reshape(along, across)
    right, up = np.roll(number, -1, axis=0), np.roll(number, -1, axis=1)
    both = np.roll(right, -1, axis=1)
    one = np.stack([number, right, both], axis=-1).reshape(-1, 3)
    two = np.stack([number, both, up], axis=-1).reshape(-1, 3)
    return vertices.reshape(-1, 3), np.concatenate([one, two])


def write_stl(path: Path, vertices: np.ndarray, faces: np.ndarray) -> Path:
    """A binary STL."""
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    data = np.zeros(len(faces), dtype=record)
    data["corners"] = vertices[faces]
    with open(path, "wb") as file:
        file.write(b"made by the benchmarks".ljust(80))
        file.write(np.uint32(len(faces)).tobytes())
        file.write(data.tobytes())
    return path
