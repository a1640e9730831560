"""Read the compiler settings of a robot for MuJoCo."""

from __future__ import annotations

from ..model.elements import Mesh, Robot
from ..model.mesh_formats import READ_BY, get_suffix


def keeps_visuals(robot: Robot) -> bool:
    """Tell whether MuJoCo keeps the visuals; from a URDF it discards them by default."""
    if robot.xml is None:
        return True
    return any(
        (compiler.get("discardvisual") or "").strip() == "false"
        for mujoco in robot.xml.list_children("mujoco")
        for compiler in mujoco.list_children("compiler")
    )


def reads_collisions(robot: Robot) -> bool:
    """Tell whether MuJoCo has a decoder for every collision mesh, by file suffix."""
    return all(
        get_suffix(shape.geometry.filename) in READ_BY["mujoco"]
        for link in robot.links
        for shape in link.collisions
        if isinstance(shape.geometry, Mesh)
    )
