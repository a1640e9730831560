"""Surfaces of known shape, made here without a mesh library, and files of them."""

import struct

import numpy as np

from urdftool.collision.piece import make_primitive

SIZES = {
    "box": (0.3, 0.2, 0.1),
    "cylinder": (0.05, 0.2),
    "capsule": (0.05, 0.2),
    "sphere": (0.15,),
}


def turned(rng):
    """A random rotation."""
    q = rng.normal(size=4)
    w, x, y, z = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def finer(vertices, faces):
    """Each triangle as four."""
    pairs = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    unique, inverse = np.unique(pairs, axis=0, return_inverse=True)
    middle = vertices[unique].mean(axis=1)
    ab, bc, ca = (inverse.reshape(-1, 3) + len(vertices)).T
    a, b, c = faces.T
    rows = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.concatenate([vertices, middle]), np.concatenate([np.stack(r, 1) for r in rows])


def noisy(kind, size, *, noise=0.0, seed=0, rotation=None, center=(0, 0, 0)):
    """A primitive as a fine mesh whose points are off by some part of its size."""
    rng = np.random.default_rng(seed)
    piece = make_primitive(kind, size, np.eye(3) if rotation is None else rotation, center)
    vertices, faces = piece.vertices, piece.faces
    while len(faces) < 3000:
        vertices, faces = finer(vertices, faces)
    scale = np.linalg.norm(np.ptp(vertices, axis=0))
    return vertices + noise * scale * rng.normal(size=vertices.shape), faces


def stl(vertices, faces):
    """A binary STL file."""
    corners = vertices[faces].astype("<f4")
    rows = b"".join(struct.pack("<3f", 0, 0, 0) + c.tobytes() + b"\0\0" for c in corners)
    return bytes(80) + struct.pack("<I", len(corners)) + rows


def l_profile():
    """A closed L-shaped bracket, 0.2 m along its legs, 0.05 m thick."""
    outline = [(0, 0), (0.2, 0), (0.2, 0.05), (0.05, 0.05), (0.05, 0.2), (0, 0.2)]
    low = np.array([(x, y, 0.0) for x, y in outline])
    vertices = np.concatenate([low, low + np.array([0, 0, 0.1])])
    top = [(6, 7, 8), (6, 8, 9), (6, 9, 10), (6, 10, 11)]
    bottom = [(c - 6, b - 6, a - 6) for a, b, c in top]
    sides = [
        face
        for i in range(6)
        for face in ((i, (i + 1) % 6, (i + 1) % 6 + 6), (i, (i + 1) % 6 + 6, i + 6))
    ]
    return vertices, np.array(top + bottom + sides)
