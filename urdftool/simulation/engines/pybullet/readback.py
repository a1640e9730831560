"""Compare the values that PyBullet loaded with those of the robot."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ...recording import ReadBack
from ...rigid_bodies import RigidBody, RigidBodyModel
from .urdf import compute_principal_frame

_CLOSE = 1e-5
"""Relative difference of a value from what was written that rounding explains. Chosen, no source.
"""


def read_back(
    p: Any, robot: int, bodies: RigidBodyModel, link_of: Mapping[int, int]
) -> list[ReadBack]:
    """List the differences in mass, center of mass, principal moments, joint and shapes."""
    found: list[ReadBack] = []
    for number, body in enumerate(bodies.bodies):
        if number not in link_of:
            found.append(ReadBack("link", body.name, "link", "a body", "nothing"))
            continue
        link = link_of[number]
        found += _list_mass(p.getDynamicsInfo(robot, link), body, bodies.fixed_base and number == 0)
        if body.joint is not None:
            found += _list_joint(p.getJointInfo(robot, link), body)
        count = sum(len(shape.pieces) or 1 for shape in body.shapes)
        shapes = p.getCollisionShapeData(robot, link)
        if bool(shapes) != bool(body.shapes):
            found.append(
                ReadBack("link", body.name, "collision shapes", str(count), str(len(shapes)))
            )
    return found


def _list_mass(info: Any, body: RigidBody, fixed_base: bool) -> Iterator[ReadBack]:
    frame, moments = compute_principal_frame(body)
    if fixed_base:
        return
    if not math.isclose(info[0], body.mass, rel_tol=_CLOSE, abs_tol=1e-12):
        yield ReadBack("link", body.name, "mass", f"{body.mass:g} kg", f"{info[0]:g} kg")
    if not body.mass:
        return
    scale = max(map(abs, moments))
    if not np.allclose(info[2], moments, rtol=_CLOSE, atol=_CLOSE * scale):
        given, got = (" ".join(f"{value:.4g}" for value in part) for part in (moments, info[2]))
        yield ReadBack("link", body.name, "principal moments", f"{given} kg·m²", f"{got} kg·m²")
    if not np.allclose(info[3], frame.translation, atol=1e-6):
        given, got = (" ".join(f"{value:.4g}" for value in p) for p in (frame.translation, info[3]))
        yield ReadBack("link", body.name, "center of mass", f"{given} m", f"{got} m")


def _list_joint(info: Any, body: RigidBody) -> Iterator[ReadBack]:
    joint = body.joint
    assert joint is not None
    kind = 1 if joint.kind == "prismatic" else 0
    if info[2] != kind:
        names = {0: "revolute", 1: "prismatic", 4: "fixed"}
        got = names.get(info[2], str(info[2]))
        yield ReadBack("joint", joint.name, "type", joint.kind, got)
        return
    if math.isfinite(joint.lower) and math.isfinite(joint.upper):
        if not np.allclose(info[8:10], (joint.lower, joint.upper), atol=1e-6):
            yield ReadBack(
                "joint",
                joint.name,
                "limits",
                f"{joint.lower:g} to {joint.upper:g}",
                f"{info[8]:g} to {info[9]:g}",
            )
    frame, _ = compute_principal_frame(body)
    axis = np.array(frame.rotation).T @ np.array(joint.axis)
    if not np.allclose(info[13], axis, atol=1e-5):
        given, got = (" ".join(f"{value:.4g}" for value in part) for part in (axis, info[13]))
        yield ReadBack("joint", joint.name, "axis", given, got)
