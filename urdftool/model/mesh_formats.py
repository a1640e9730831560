"""Mesh formats that each target reads, by file suffix, best supported first."""

from __future__ import annotations

READ_BY = {
    "mujoco": ("stl", "obj", "msh"),
    "pybullet": ("obj", "stl", "dae", "cdf", "vtk"),
    "gazebo-classic": ("dae", "stl", "obj"),
    "gz": ("dae", "stl", "obj", "gltf", "glb", "fbx"),
    "ros1": ("dae", "stl", "mesh", "obj", "ply", "3ds", "fbx", "gltf", "glb", "stlb"),
    "ros2": ("dae", "stl", "mesh", "obj", "ply", "3ds", "fbx", "gltf", "glb", "stlb"),
    "isaac": ("obj", "stl", "dae"),
}

COLLISIONS_READ_BY = {
    "mujoco": READ_BY["mujoco"],
    "drake": ("obj", "vtk", "gltf"),
}
"""Who rejects a robot for the format of a collision mesh, with the suffixes that it accepts.

MuJoCo discards visuals. Drake is meant with a SceneGraph, where it makes a convex hull of each
collision mesh.
"""


def get_suffix(uri: str) -> str:
    """Return the suffix of a file name in lower case, without the dot; empty where it has none."""
    return uri.rpartition("/")[2].rpartition(".")[2].lower() if "." in uri else ""


def is_odd(ending: str) -> bool:
    """Tell whether a suffix is none of a file: too long, or not of letters and digits."""
    return len(ending) > 5 or not ending.isalnum()


def find_rejecting_readers(ending: str, collides: bool) -> frozenset[str]:
    """Name the readers that reject a robot with a mesh of a suffix: mujoco, pybullet and drake.

    Args:
        ending: The suffix of the mesh file; of an odd one nothing is known.
        collides: Whether the mesh is a collision.
    """
    if is_odd(ending):
        return frozenset()
    rejecting_readers = {"pybullet"} if ending not in READ_BY["pybullet"] else set()
    if collides:
        rejecting_readers |= {
            reader for reader, known in COLLISIONS_READ_BY.items() if ending not in known
        }
    return frozenset(rejecting_readers)
