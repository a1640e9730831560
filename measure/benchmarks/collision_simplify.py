"""``simplify`` and fast-simplification: ``python -m measure.benchmarks.collision_simplify MESH``.

Each mesh that is named goes through the other first, with its defaults, ``--max-triangles N`` being
what is asked of it, then through ours with as many triangles as the other left. The two-sided
Hausdorff distance is relative to the diagonal; a mesh is closed if each edge has two triangles.
A table, and the median.
"""

from __future__ import annotations

import sys
from pathlib import Path
from statistics import median

import fast_simplification
import numpy as np

from urdftool.collision.decimate import decimate
from urdftool.collision.distance import Surface, spread
from urdftool.collision.surface import read_surface
from urdftool.errors import UrdftoolError
from urdftool.geometry.topology import find_edges


def apart(one: np.ndarray, other: np.ndarray, size: float) -> float:
    """The two-sided Hausdorff distance of triangles, relative to a size."""
    distances = [
        Surface(a, spread(a, 80_000)).measure_distance(spread(b, 20_000).points).max()
        for a, b in ((one, other), (other, one))
    ]
    return float(max(distances)) / size


def closed(vertices: np.ndarray, faces: np.ndarray) -> bool:
    """Whether each edge has two triangles, points in one place being one."""
    _, number = np.unique(np.round(vertices, 12), axis=0, return_inverse=True)
    merged = number.reshape(-1)[faces]
    sound = (merged != np.roll(merged, 1, axis=1)).all(axis=1)
    return bool(find_edges(merged[sound]).cycle)


def main(words: list[str]) -> None:
    """Print the table."""
    most = 1000
    if words and words[0] == "--max-triangles":
        most, words = int(words[1]), words[2:]
    print("| mesh | triangles | → | ours | fast-simplification | closed: mesh, ours, theirs |")
    print("|---|---|---|---|---|---|")
    errors: list[tuple[float, float]] = []
    kept = [0, 0, 0]
    for word in words:
        try:
            surface = read_surface(Path(word))
        except UrdftoolError as error:
            print(f"| {Path(word).name} | {error.message} |")
            continue
        if len(surface.faces) <= most:
            continue
        points, faces = fast_simplification.simplify(
            surface.vertices, surface.faces.astype(np.int32), target_count=most
        )
        faces = np.asarray(faces, dtype=np.int64)
        points = np.asarray(points, dtype=np.float64)
        fewer, triangles = decimate(surface.vertices, surface.faces, len(faces))
        assert len(triangles) <= len(faces)
        ours, theirs = (
            apart(surface.corners, v[f], surface.size)
            for v, f in ((fewer, triangles), (points, faces))
        )
        errors.append((ours, theirs))
        shut = [
            closed(surface.vertices, surface.faces),
            closed(fewer, triangles),
            closed(points, faces),
        ]
        if shut[0]:
            kept = [count + is_shut for count, is_shut in zip(kept, shut, strict=True)]
        said = ", ".join("yes" if is_shut else "no" for is_shut in shut)
        print(
            f"| {Path(word).name} | {len(surface.faces):,} | {len(faces):,} "
            f"| {ours:.2%} ({len(triangles):,}) | {theirs:.2%} | {said} |",
            flush=True,
        )
    print(
        f"\n{len(errors)} meshes; median {median(e for e, _ in errors):.2%} beside "
        f"{median(e for _, e in errors):.2%}; of {kept[0]} closed ones {kept[1]} stay closed, "
        f"{kept[2]} with fast-simplification"
    )


if __name__ == "__main__":
    main(sys.argv[1:])
