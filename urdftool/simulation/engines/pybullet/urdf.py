"""Write a robot as URDF for PyBullet: one link per rigid body, plain names, meshes as OBJ."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ....mechanics.tensor import compute_principal_axes
from ....model.pose import Pose, rpy_from_rotation
from ...rigid_bodies import TENSOR_ROUNDING, RigidBody, RigidBodyJoint, RigidBodyModel
from ...shapes import Shape

NAME = "robot.urdf"


def write_folder(robot: RigidBodyModel, folder: Path) -> Path:
    """Write a robot and its meshes, and return the path of the URDF.

    Body i is link ``b{i}`` on joint ``j{i}``, so that names of the file cannot be too long,
    repeated or invalid for the engine.
    """
    lines = ['<?xml version="1.0"?>', '<robot name="robot">']
    for number, body in enumerate(robot.bodies):
        lines += _link(number, body, folder)
        if body.joint is not None:
            lines += _list_joint(number, body, body.joint)
    path = folder / NAME
    path.write_text("\n".join([*lines, "</robot>", ""]), "ascii")
    return path


def _link(number: int, body: RigidBody, folder: Path) -> Iterator[str]:
    yield f'<link name="b{number}">'
    yield from _list_inertial(body)
    for index, shape in enumerate(body.shapes):
        yield f"<collision>{_format_origin(shape.pose)}"
        geometry = _format_geometry(shape, folder, f"b{number}_{index}")
        yield f"<geometry>{geometry}</geometry></collision>"
    yield "</link>"


def compute_principal_frame(body: RigidBody) -> tuple[Pose, tuple[float, float, float]]:
    """Compute the frame of a body's center of mass and principal axes, and its moments [kg·m²]."""
    if body.properties is None:
        return Pose(), (0.0, 0.0, 0.0)
    moments, axes = compute_principal_axes(body.properties.tensor)
    most = float(moments[0] + moments[1])
    if most < moments[2] <= most * (1 + TENSOR_ROUNDING):
        moments = np.array([moments[0], moments[1], most * (1 - 1e-6)])
    rows = tuple(tuple(float(value) for value in row) for row in axes)
    a, b, c = (float(value) for value in moments)
    return Pose(rows, body.properties.com), (a, b, c)  # type: ignore[arg-type]


def _list_inertial(body: RigidBody) -> Iterator[str]:
    pose, (ixx, iyy, izz) = compute_principal_frame(body)
    yield f'<inertial>{_format_origin(pose)}<mass value="{body.mass:.17g}"/>'
    yield (
        f'<inertia ixx="{ixx:.17g}" ixy="0" ixz="0" iyy="{iyy:.17g}" iyz="0" izz="{izz:.17g}"/>'
        "</inertial>"
    )


def _list_joint(number: int, body: RigidBody, joint: RigidBodyJoint) -> Iterator[str]:
    limited = math.isfinite(joint.lower) and math.isfinite(joint.upper)
    kind = joint.kind if limited or joint.kind == "prismatic" else "continuous"
    yield f'<joint name="j{number}" type="{kind}">{_format_origin(body.origin)}'
    yield f'<parent link="b{body.parent}"/><child link="b{number}"/>'
    yield f'<axis xyz="{" ".join(f"{part:.17g}" for part in joint.axis)}"/>'
    lower, upper = (joint.lower, joint.upper) if limited else (0.0, -1.0)  # read as no limit
    if limited or joint.kind == "prismatic":
        yield f'<limit lower="{lower:.17g}" upper="{upper:.17g}" effort="0" velocity="0"/>'
    yield "</joint>"


def _format_origin(pose: Pose) -> str:
    parts = (pose.translation, rpy_from_rotation(pose.rotation))
    xyz, rpy = (" ".join(f"{value:.17g}" for value in part) for part in parts)
    return f'<origin xyz="{xyz}" rpy="{rpy}"/>'


def _format_geometry(shape: Shape, folder: Path, name: str) -> str:
    if shape.kind == "box":
        return f'<box size="{" ".join(f"{edge:.17g}" for edge in shape.size)}"/>'
    if shape.kind == "sphere":
        return f'<sphere radius="{shape.size[0]:.17g}"/>'
    if shape.kind in ("cylinder", "capsule"):
        radius, length = shape.size
        return f'<{shape.kind} radius="{radius:.17g}" length="{length:.17g}"/>'
    (folder / f"{name}.obj").write_text("\n".join(_list_obj(shape)), "ascii")
    return f'<mesh filename="{name}.obj"/>'


def _list_obj(shape: Shape) -> Iterator[str]:
    first = 1
    for number, (points, faces) in enumerate(zip(shape.pieces, shape.faces, strict=True)):
        yield f"o piece{number}"
        yield from (f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in np.asarray(points).tolist())
        yield from (f"f {a} {b} {c}" for a, b, c in (np.asarray(faces) + first).tolist())
        first += len(points)
    yield ""
