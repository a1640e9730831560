"""Conversion of a URDF robot to a mechanism with one body for each link."""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from ....errors import UrdftoolError
from ....model.elements import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Geometry,
    Joint,
    Link,
    Material,
    Mesh,
    Origin,
    Robot,
    Sphere,
    Visual,
)
from ....model.gltf_axes import is_gltf
from ...common.actuator_config import JointSettings, read_actuator_config
from .mechanism import (
    Array,
    Body,
    Hinge,
    Mechanism,
    Shape,
    make_pose,
    rotate_by_angles,
    rotate_by_quaternion,
)

KINDS = {
    "revolute": "revolute",
    "continuous": "revolute",
    "prismatic": "prismatic",
    "fixed": "fixed",
    "floating": "free",
    "planar": "planar",
    "spherical": "ball",
    "ball": "ball",
}


def convert_mechanism(robot: Robot, actuator_config: Path | None = None) -> Mechanism:
    """Convert a robot of one or several trees; a root named ``world`` is the world.

    Args:
        robot: The robot.
        actuator_config: File that sets damping, friction and force range of joints.
    """
    made = Mechanism()
    anchored = get_base(robot) is None
    for link in robot.links:
        if not (anchored and link.name == "world"):
            made.bodies[link.name] = _make_body(link)
        made.frames[link.name] = (link.name, np.eye(4))
        for kind, shapes in (("visuals", link.visuals), ("collisions", link.collisions)):
            for shape in shapes:
                getattr(made, kind).append(_make_shape(robot, link, shape))
    made.joints = [_make_hinge(joint) for joint in robot.joints]
    if actuator_config is not None:
        kinds = ("revolute", "prismatic", "continuous")
        movable = [joint.name for joint in robot.joints if joint.type in kinds]
        settings = read_actuator_config(actuator_config).match_joints(movable)
        for hinge in made.joints:
            _set(hinge.limits, settings.get(hinge.name))
    return made


def _set(limits: dict[str, float], settings: JointSettings | None) -> None:
    """Replace values of the description by those of the user."""
    if settings is None:
        return
    if settings.damping is not None:
        limits["damping"] = settings.damping
    if settings.friction is not None:
        limits["friction"] = settings.friction
    if settings.force_range is not None:
        limits["effort"] = max(abs(bound) for bound in settings.force_range)


def get_base(robot: Robot) -> str | None:
    """Return the link at the model's origin, the first root; None if a root is the world."""
    names = [root.name for root in robot.tree.roots]
    return names[0] if names and "world" not in names else None


def get_pose(origin: Origin | None) -> Array:
    """Return the 4 × 4 pose of an ``<origin>``."""
    if origin is None:
        return np.eye(4)
    if origin.quaternion is not None:
        return make_pose(rotate_by_quaternion(*origin.quaternion), origin.xyz)
    return make_pose(rotate_by_angles(origin.rpy), origin.xyz)


def _make_body(link: Link) -> Body:
    inertial = link.inertial
    if inertial is None:
        return Body(link.name)
    frame = get_pose(inertial.origin)
    tensor = np.zeros((3, 3))
    if inertial.inertia is not None:
        i = inertial.inertia
        tensor = np.array([[i.ixx, i.ixy, i.ixz], [i.ixy, i.iyy, i.iyz], [i.ixz, i.iyz, i.izz]])
    turn = frame[:3, :3]
    return Body(link.name, inertial.mass or 0.0, frame[:3, 3], turn @ tensor @ turn.T)


def _make_hinge(joint: Joint) -> Hinge:
    axis = np.array(joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0))
    axis /= np.abs(axis).max() or 1.0  # avoids underflow and overflow of the squares
    length = np.linalg.norm(axis)
    mimic = joint.mimic and (joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset)
    return Hinge(
        joint.name,
        KINDS.get(joint.type, "fixed"),
        joint.parent,
        joint.child,
        get_pose(joint.origin),
        np.eye(4),
        axis / length if length else axis,
        _get_limits(joint),
        mimic or None,
    )


def _get_limits(joint: Joint) -> dict[str, float]:
    """Return limits as URDF readers do: 0 for a missing bound, infinite without ``<limit>``."""
    limit, dynamics = joint.limit, joint.dynamics
    bounds = dict.fromkeys(("lower", "upper", "effort", "velocity"), np.inf)
    bounds["lower"] = -np.inf
    if limit is not None:
        if joint.type in ("revolute", "prismatic"):
            bounds["lower"], bounds["upper"] = limit.lower or 0.0, limit.upper or 0.0
        for name, value in (("effort", limit.effort), ("velocity", limit.velocity)):
            if value is not None:
                bounds[name] = abs(value)
    bounds["damping"] = (dynamics.damping if dynamics else None) or 0.0
    bounds["friction"] = (dynamics.friction if dynamics else None) or 0.0
    return bounds


def _make_shape(robot: Robot, link: Link, shape: Visual | Collision) -> Shape:
    made = Shape(link.name, link.name, get_pose(shape.origin), _collect_what(robot, shape.geometry))
    made.part = shape
    if is_gltf(shape) and robot.source is not None and robot.source.gltf_up == "y":
        made.pose = made.pose @ make_pose(rotate_by_angles((np.pi / 2, 0.0, 0.0)), (0.0, 0.0, 0.0))
        kind, digested, x, y, z = made.what
        made.what = kind, digested, x, z, y  # Gazebo keeps the axes of the file
    if (
        isinstance(shape, Visual)
        and shape.material is not None
        and not _sets_appearance(robot, link)
    ):
        made.rgba, made.picture = _get_looks(robot, shape.material)
    return made


def _collect_what(robot: Robot, geometry: Geometry | None) -> tuple[Any, ...]:
    if isinstance(geometry, Box):
        return ("box", *geometry.size)
    if isinstance(geometry, Sphere):
        return ("sphere", geometry.radius)
    if isinstance(geometry, Cylinder):
        return ("cylinder", geometry.radius, geometry.length)
    if isinstance(geometry, Capsule):
        return ("capsule", geometry.radius, geometry.length)
    if isinstance(geometry, Mesh):
        return ("mesh", _format_digest(robot, geometry.filename), *geometry.scale)
    return ("unknown",)


def _format_digest(robot: Robot, filename: str) -> str:
    scheme, separator, rest = filename.partition("://")
    if separator and scheme == "package":
        filename = f"package://{rest.lstrip('/')}"
    try:
        return get_digest(robot.source.resolve(filename)) if robot.source is not None else filename
    except UrdftoolError:
        return "missing"


def get_digest(path: Path) -> str:
    """Return a digest of a file, or ``missing``."""
    try:
        return sha256(path.read_bytes()).hexdigest()
    except OSError:
        return "missing"


def _sets_appearance(robot: Robot, link: Link) -> bool:
    """Tell whether ``<gazebo>`` sets the appearance of a link."""
    blocks = (block.element for block in robot.extensions.get(link.name, []))
    return any(element.find_child(tag) for element in blocks for tag in ("material", "visual"))


def _get_looks(robot: Robot, own: Material) -> tuple[tuple[float, ...] | None, str | None]:
    """Return the color and texture of a material: its own, else of the first so named."""
    every = [own, *robot.materials, *(v.material for k in robot.links for v in k.visuals)]
    for one in every:
        if one is not None and one.name == own.name and (one.color or one.texture):
            return one.color, _format_digest(robot, one.texture) if one.texture else None
    return None, None
