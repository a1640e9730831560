"""One ruler for meshes that others made: MeshLab's, run by the Python of the others.

    python ruler.py ORIGINAL MADE

Prints ``TRIANGLES n``, ``PIECES n`` and ``ERROR e``: the largest distance from a point of either
surface to the other, relative to the diagonal of the original's box.
"""

import sys

SAMPLES = 100_000


def main(original, made):
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(original)
    diagonal = meshes.current_mesh().bounding_box().diagonal()
    meshes.load_new_mesh(made)
    triangles = meshes.current_mesh().face_number()
    far = pymeshlab.PercentageValue(100)
    worst = 0.0
    for one, other in ((0, 1), (1, 0)):
        found = meshes.get_hausdorff_distance(
            sampledmesh=one, targetmesh=other, samplevert=True, sampleface=True,
            samplenum=SAMPLES, maxdist=far,
        )  # fmt: skip
        worst = max(worst, found["max"])
    meshes.set_current_mesh(1)
    meshes.meshing_merge_close_vertices()
    pieces = meshes.get_topological_measures()["connected_components_number"]
    print(f"TRIANGLES {triangles}\nPIECES {pieces}\nERROR {worst / diagonal:.6f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
