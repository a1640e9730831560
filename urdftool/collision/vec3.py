"""Operations on vectors in rows of three, computed column by column.

numpy's functions for rows of three take ten times as long as the column sums and products they
consist of. The order of the sums is fixed, so that results are the same on every machine.
"""

from __future__ import annotations

import numpy as np

from ..geometry.mesh import Points


def compute_cross(one: Points, other: Points) -> Points:
    """Compute the cross products of rows, shape (n, 3)."""
    ax, ay, az = one[:, 0], one[:, 1], one[:, 2]
    bx, by, bz = other[:, 0], other[:, 1], other[:, 2]
    made = np.empty((len(one), 3))
    made[:, 0] = ay * bz - az * by
    made[:, 1] = az * bx - ax * bz
    made[:, 2] = ax * by - ay * bx
    return made


def compute_dot(one: Points, other: Points) -> Points:
    """Compute the dot products of rows, shape (n, 3)."""
    made = one[:, 0] * other[:, 0]
    made += one[:, 2] * other[:, 2]
    made += one[:, 1] * other[:, 1]
    return made


def compute_lengths(rows: Points) -> Points:
    """Compute the length of each row, shape (n, 3)."""
    x, y, z = rows[:, 0], rows[:, 1], rows[:, 2]
    made = x * x
    made += y * y
    made += z * z
    return np.asarray(np.sqrt(made, out=made))


def compute_normals(corners: Points) -> Points:
    """Compute the normals of triangles, shape (n, 3, 3), with twice the area as length."""
    first = corners[:, 0]
    return compute_cross(corners[:, 1] - first, corners[:, 2] - first)


def compute_bounds(rows: Points) -> Points:
    """Compute the minimum and maximum of each column, shape (2, 3), of at least one row."""
    columns = [rows[:, axis] for axis in range(3)]
    return np.array([[column.min() for column in columns], [column.max() for column in columns]])
