"""Up axis of glTF meshes, on which readers differ.

The glTF standard has Y up. RViz rotates it to Z since 2025, as Drake and Blender do; Gazebo, SAPIEN
and older releases of RViz keep the axes of the file, and some robots are made for those.
"""

from __future__ import annotations

from collections.abc import Iterable

from .elements import Collision, Mesh, Robot, Visual


def is_gltf(shape: Visual | Collision) -> bool:
    """Tell whether the geometry is a glTF file."""
    mesh = shape.geometry
    return isinstance(mesh, Mesh) and mesh.filename.lower().endswith((".glb", ".gltf"))


def describe_gltf_axes(robot: Robot) -> str:
    """Return a note on how the glTF meshes of a robot are read; empty if none is rotated."""
    if robot.source is not None and robot.source.gltf_up == "z":
        return ""
    shapes: Iterable[Visual | Collision] = (shape for _, shape in robot.shapes)
    files = {s.geometry.filename for s in shapes if isinstance(s.geometry, Mesh) and is_gltf(s)}
    if not files:
        return ""
    which = f"'{files.pop()}' is" if len(files) == 1 else f"{len(files)} meshes are"
    return (
        f"{which} glTF and read with Y up, as in the glTF standard and RViz since 2025; if the "
        "robot was made for Gazebo, SAPIEN or older RViz, which keep the file's axes, use "
        "--gltf-up z"
    )
