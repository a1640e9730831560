"""Mesh formats that each target reads, by file suffix, best supported first."""

from __future__ import annotations

READ_BY = {
    "mujoco": ("stl", "obj", "msh"),
    "pybullet": ("obj", "stl", "dae", "cdf", "vtk"),
    "gazebo-classic": ("dae", "stl", "obj"),
    "gz": ("dae", "stl", "obj", "gltf", "glb", "fbx"),
    "ros1": ("dae", "stl", "mesh", "obj", "ply", "3ds", "fbx", "gltf", "glb", "stlb"),
    "ros2": ("dae", "stl", "mesh", "obj", "ply", "3ds", "fbx", "gltf", "glb", "stlb"),
}
