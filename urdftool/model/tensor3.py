"""Symmetric 3 × 3 tensors in plain Python, as six numbers ``xx, xy, xz, yy, yz, zz``."""

from __future__ import annotations

import math
from functools import lru_cache

from .elements import Vector
from .pose import UPRIGHT, Rotation, matrix_product, transpose

Six = tuple[float, float, float, float, float, float]

SMALLEST_RADIUS = 1e-5
"""The smallest radius of gyration [m] that is told from none: below it moments are noise."""

_CLOSE = 1e-6
_SMALL = 1e-60


@lru_cache(maxsize=4096)
def eigenvalues(tensor: Six) -> Vector:
    """The eigenvalues, ascending.

    In closed form, which is good to half the digits where two are equal; where one is near zero, or
    near the sum or difference of the others, by Jacobi's rotations, which are good to all of them.
    """
    xx, xy, xz, yy, yz, zz = tensor
    off = xy * xy + xz * xz + yz * yz
    if off == 0.0:
        low, middle, high = sorted((xx, yy, zz))
        return low, middle, high
    size = max(map(abs, tensor))
    if 0.0 < size <= _SMALL or 1 / _SMALL <= size < math.inf:  # its cube would leave the range
        low, middle, high = eigenvalues(tuple([part / size for part in tensor]))
        return low * size, middle * size, high * size
    mean = (xx + yy + zz) / 3
    a, b, c = xx - mean, yy - mean, zz - mean
    spread = math.sqrt((a * a + b * b + c * c + 2 * off) / 6)
    determinant = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)
    angle = math.acos(max(-1.0, min(1.0, determinant / (2 * spread**3)))) / 3
    high = mean + 2 * spread * math.cos(angle)
    low = mean + 2 * spread * math.cos(angle + 2 * math.pi / 3)
    middle = 3 * mean - high - low
    size = max(abs(low), abs(high))
    if min(abs(low), abs(low + middle - high)) <= _CLOSE * size:
        return _jacobi(tensor)
    return low, middle, high


def _jacobi(tensor: Six) -> Vector:
    xx, xy, xz, yy, yz, zz = tensor
    matrix = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    for _ in range(12):
        off = abs(matrix[0][1]) + abs(matrix[0][2]) + abs(matrix[1][2])
        if off <= 1e-17 * max(abs(matrix[i][i]) for i in range(3)):
            break
        for p, q, r in ((0, 1, 2), (0, 2, 1), (1, 2, 0)):
            apq = matrix[p][q]
            if apq == 0.0:
                continue
            theta = (matrix[q][q] - matrix[p][p]) / (2 * apq)
            t = math.copysign(1.0, theta) / (abs(theta) + math.hypot(theta, 1.0))
            cosine = 1 / math.hypot(t, 1.0)
            sine = t * cosine
            apr, aqr = matrix[p][r], matrix[q][r]
            matrix[p][p] -= t * apq
            matrix[q][q] += t * apq
            matrix[p][q] = matrix[q][p] = 0.0
            matrix[p][r] = matrix[r][p] = cosine * apr - sine * aqr
            matrix[q][r] = matrix[r][q] = sine * apr + cosine * aqr
    low, middle, high = sorted(matrix[i][i] for i in range(3))
    return low, middle, high


def turned(tensor: Six, rotation: Rotation) -> Six:
    """The tensor ``R T Rᵀ``: given along a turned frame's axes, along the parent's."""
    if rotation is UPRIGHT:
        return tensor
    xx, xy, xz, yy, yz, zz = tensor
    matrix = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
    (a, b, c), (_, d, e), (_, _, f) = matrix_product(
        matrix_product(rotation, matrix), transpose(rotation)
    )
    return a, b, c, d, e, f
