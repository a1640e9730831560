"""Models of an SDF file as libsdformat reads them, by the program ``read_models.cpp``."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from urdftool.mechanics.reference import Array

UNBOUNDED = 1e15
"""Limits above it are none: libsdformat 12 has 1e16 where nothing is written."""


@dataclass
class Model:
    """Links and joints of a model by name, with poses in the frame of the model."""

    name: str
    links: dict[str, Mapping[str, Any]] = field(default_factory=dict)
    joints: dict[str, Mapping[str, Any]] = field(default_factory=dict)


def read_models(reader: Path, path: Path, folders: Sequence[Path]) -> tuple[list[Model], str]:
    """Return the models of a file, and the errors of libsdformat.

    Args:
        reader: The compiled program.
        path: The file.
        folders: Where included models are.
    """
    done = subprocess.run([reader, path, *folders], capture_output=True, text=True)
    models: list[Model] = []
    for line in done.stdout.splitlines():
        row = json.loads(line)
        if row["what"] == "model":
            models.append(Model(row["name"]))
        else:
            parts = models[-1].links if row["what"] == "link" else models[-1].joints
            parts[row["name"]] = row
    return models, done.stderr if done.returncode else ""


def make_matrix(pose: Sequence[float]) -> Array:
    """Return a pose, 4 × 4, of a position [m] and a quaternion (w, x, y, z)."""
    w, x, y, z = pose[3:]
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, 3] = pose[:3]
    return matrix


def make_tensor(six: Sequence[float]) -> Array:
    """Return the tensor, 3 × 3, of ixx, ixy, ixz, iyy, iyz, izz."""
    xx, xy, xz, yy, yz, zz = six
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def bound(value: float | None) -> float | None:
    """Return a limit; None if it does not bound anything."""
    return None if value is None or abs(value) > UNBOUNDED else value
