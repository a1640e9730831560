"""What Newton reads of a stage, as plain numbers; runs in a process of its own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...model.pose import rotation_from_quaternion
from ...model.settings import RESISTANCE


def read_stage(path: str, configurations: Sequence[dict[str, float]]) -> dict[str, Any]:
    """Import a stage, at joint positions [rad or m] by the paths of their prims.

    Returns:
        Bodies and joints by path of their prims, shapes, and the poses of the bodies in each
        configuration as position [m] and quaternion ``(x, y, z, w)``. An ``error`` instead if
        Newton rejects the stage.
    """
    import newton

    builder = newton.ModelBuilder()
    try:
        builder.add_usd(path)
        raw = _list_bodies(builder)
        model = builder.finalize(device="cpu")
    except Exception as error:
        return {"error": f"{type(error).__name__}: {error}"}
    masses, tensors = model.body_mass.numpy(), model.body_inertia.numpy()
    for index, label in enumerate(builder.body_label):
        raw[label]["final_mass"] = float(masses[index])
        raw[label]["final_inertia"] = tensors[index].tolist()
    return {
        "version": newton.__version__,
        "bodies": raw,
        "joints": _list_joints(newton, builder),
        "shapes": _list_shapes(builder),
        "poses": [_compute_poses(newton, builder, model, q) for q in configurations],
    }


def _list_bodies(builder: Any) -> dict[str, dict[str, Any]]:
    return {
        label: {
            "mass": float(builder.body_mass[index]),
            "com": [float(part) for part in builder.body_com[index]],
            "inertia": [
                [float(builder.body_inertia[index][i, j]) for j in range(3)] for i in range(3)
            ],
        }
        for index, label in enumerate(builder.body_label)
    }


def _list_joints(newton: Any, builder: Any) -> dict[str, dict[str, Any]]:
    found: dict[str, dict[str, Any]] = {}
    for index, label in enumerate(builder.joint_label):
        first = builder.joint_qd_start[index]
        last = [*builder.joint_qd_start, builder.joint_dof_count][index + 1]
        joint: dict[str, Any] = {
            "type": newton.JointType(builder.joint_type[index]).name,
            "freedoms": last - first,
            "mimic": None,
        }
        if last - first == 1:
            for name in (
                *("limit_lower", "limit_upper", "effort_limit", "velocity_limit"),
                *("target_ke", "target_kd", *(row.name for row in RESISTANCE)),
            ):
                joint[name] = float(getattr(builder, f"joint_{name}")[first])
        leader = builder.joint_mimic_joint[index]
        if leader >= 0:
            offset, factor = builder.joint_mimic_coeffs[index]
            joint["mimic"] = (builder.joint_label[leader], float(factor), float(offset))
        found[label] = joint
    return found


def _list_shapes(builder: Any) -> list[dict[str, Any]]:
    return [
        {
            "label": label,
            "body": builder.body_label[body] if body >= 0 else "",
            "type": str(getattr(builder.shape_type[index], "name", builder.shape_type[index])),
            "scale": [float(part) for part in builder.shape_scale[index]],
            "pose": [float(part) for part in builder.shape_transform[index]],
            "friction": float(builder.shape_material_mu[index]),
            "bounds": _compute_bounds(builder, index),
            "collides": bool(builder.shape_flags[index] & 2),
        }
        for index, (label, body) in enumerate(
            zip(builder.shape_label, builder.shape_body, strict=True)
        )
    ]


def _compute_bounds(builder: Any, index: int) -> list[list[float]] | None:
    """Return the corners [m] of the bounding box of a shape along the axes of its body."""
    import numpy as np

    kind = getattr(builder.shape_type[index], "name", str(builder.shape_type[index]))
    a, b, c = (float(part) for part in builder.shape_scale[index])
    pose = np.array([float(part) for part in builder.shape_transform[index]])
    x, y, z, w = pose[3:].tolist()
    turn = np.array(rotation_from_quaternion((w, x, y, z)))
    mesh = builder.shape_source[index]
    if kind in ("MESH", "CONVEX_MESH") and mesh is not None:
        points = np.asarray(mesh.vertices, dtype=np.float64) * (a, b, c) @ turn.T
        return [(points.min(0) + pose[:3]).tolist(), (points.max(0) + pose[:3]).tolist()]
    along, across = np.abs(turn[:, 2]), np.hypot(turn[:, 0], turn[:, 1])
    reach = {
        "BOX": np.abs(turn) @ (a, b, c),
        "SPHERE": np.full(3, a),
        "ELLIPSOID": np.linalg.norm(turn * (a, b, c), axis=1),
        "CYLINDER": a * across + b * along,
        "CAPSULE": a + b * along,
    }.get(kind)
    return None if reach is None else [(pose[:3] - reach).tolist(), (pose[:3] + reach).tolist()]


def _compute_poses(
    newton: Any, builder: Any, model: Any, positions: dict[str, float]
) -> dict[str, list[float]]:
    state = model.state()
    values = model.joint_q.numpy()
    for index, label in enumerate(builder.joint_label):
        if label in positions:
            values[builder.joint_q_start[index]] = positions[label]
    model.joint_q.assign(values)
    newton.eval_fk(model, model.joint_q, model.joint_qd, state)
    rows = [] if state.body_q is None else state.body_q.numpy().tolist()
    return dict(zip(builder.body_label, rows, strict=True))
