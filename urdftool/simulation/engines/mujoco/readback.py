"""Compare the values that MuJoCo loaded with those of the robot."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ....mechanics.spatial_inertia import SpatialInertia, combine
from ....mechanics.tensor import compute_principal_moments
from ....model.pose import rotation_from_quaternion
from ....model.settings import RESISTANCE
from ...recording import ReadBack
from ...rigid_bodies import TENSOR_ROUNDING, RigidBody, RigidBodyModel

_CLOSE = 1e-5
"""Relative difference of a value from what was written that rounding explains. Chosen, no source.
"""


def read_back(
    model: Any, bodies: RigidBodyModel, number_of: Mapping[str, int], joints: Sequence[int]
) -> list[ReadBack]:
    """List the differences in mass, center of mass, principal moments, joint and shapes."""
    found: list[ReadBack] = []
    number = 0
    for row, body in enumerate(bodies.bodies):
        if row or not bodies.fixed_base:
            found += _list_mass(model, body, number_of)
        if body.joint is not None:
            found += _list_joint(model, body, joints[number])
            number += 1
        numbers = [number_of[link] for link in body.links if number_of[link]]
        solid = np.isin(model.geom_bodyid, numbers) & (model.geom_contype != 0)
        if numbers and bool(solid.any()) != bool(body.shapes):
            specified, loaded = str(len(body.shapes)), str(int(solid.sum()))
            found.append(ReadBack("link", body.name, "collision shapes", specified, loaded))
    return found


def _list_mass(model: Any, body: RigidBody, number_of: Mapping[str, int]) -> Iterator[ReadBack]:
    parts = []
    for link, pose in body.places.items():
        number = number_of[link]
        if number and (model.body_mass[number] or model.body_inertia[number].any()):
            w, x, y, z = (float(part) for part in model.body_iquat[number])
            turn = np.array(rotation_from_quaternion((w, x, y, z)))
            tensor = turn @ np.diag(model.body_inertia[number]) @ turn.T
            own = SpatialInertia.from_arrays(
                float(model.body_mass[number]), np.array(model.body_ipos[number]), tensor
            )
            parts.append(own.transform(pose))
    got = combine(parts)
    if not math.isclose(got.mass, body.mass, rel_tol=_CLOSE, abs_tol=1e-12):
        yield ReadBack("link", body.name, "mass", f"{body.mass:g} kg", f"{got.mass:g} kg")
    given = body.properties
    if given is None or not body.mass:
        return
    scale = max(map(abs, given.tensor))
    least, middle, most = compute_principal_moments(given.tensor)
    close = 1e-4 if most <= least + middle else TENSOR_ROUNDING
    if not np.allclose(got.tensor, given.tensor, rtol=1e-4, atol=close * scale + 1e-12):
        one, two = (
            " ".join(f"{value:.4g}" for value in compute_principal_moments(part.tensor))
            for part in (given, got)
        )
        yield ReadBack("link", body.name, "principal moments", f"{one} kg·m²", f"{two} kg·m²")
    if not np.allclose(got.com, given.com, atol=1e-6):
        one, two = (" ".join(f"{value:.4g}" for value in part.com) for part in (given, got))
        yield ReadBack("link", body.name, "center of mass", f"{one} m", f"{two} m")


_KINDS = {0: "floating", 1: "spherical", 2: "prismatic", 3: "revolute"}


def _list_joint(model: Any, body: RigidBody, number: int) -> Iterator[ReadBack]:
    joint = body.joint
    assert joint is not None
    if number < 0:
        yield ReadBack("joint", joint.name, "type", joint.kind, "fixed")
        return
    expected = 2 if joint.kind == "prismatic" else 3
    if model.jnt_type[number] != expected:
        got = _KINDS.get(int(model.jnt_type[number]), "another")
        yield ReadBack("joint", joint.name, "type", joint.kind, got)
        return
    limits = (joint.lower, joint.upper)
    if math.isfinite(joint.lower) and math.isfinite(joint.upper) and joint.lower < joint.upper:
        taken = model.jnt_range[number] if model.jnt_limited[number] else (-math.inf, math.inf)
        if not np.allclose(taken, limits, rtol=_CLOSE, atol=1e-6):
            one, two = (f"{part[0]:g} to {part[1]:g}" for part in (limits, taken))
            yield ReadBack("joint", joint.name, "limits", one, two)
    dof = int(model.jnt_dofadr[number])
    for row in RESISTANCE:
        if (value := joint.resistance.get(row.name)) is not None:
            loaded = float(np.ravel(getattr(model, f"dof_{row.mjcf_attribute}")[dof])[0])
            if not math.isclose(value, loaded, rel_tol=_CLOSE, abs_tol=1e-12):
                yield ReadBack("joint", joint.name, row.name, f"{value:g}", f"{loaded:g}")
    if not np.allclose(model.jnt_axis[number], joint.axis, atol=1e-5):
        one, two = (
            " ".join(f"{value:.4g}" for value in part)
            for part in (joint.axis, model.jnt_axis[number])
        )
        yield ReadBack("joint", joint.name, "axis", one, two)
