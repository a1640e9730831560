"""What is read from a stage of another tool equals what Newton imports."""

import re

import numpy as np
import pytest

from tests.formats.usd.stages import body, stage, turning
from urdftool.model.kinematics import link_poses

pytestmark = [pytest.mark.slow, pytest.mark.library("pxr"), pytest.mark.library("newton")]

MIMIC = (
    "        rel newton:mimicJoint = </r/one>\n        float newton:mimicCoef1 = -0.5\n"
    "        float newton:mimicCoef0 = 30\n"
)
LIMITS = (
    "        float physics:lowerLimit = -90\n        float physics:upperLimit = 45\n"
    "        float drive:angular:physics:stiffness = 2\n"
    "        float drive:angular:physics:damping = 0.1\n"
    "        float drive:angular:physics:maxForce = 5\n"
    "        float newton:velocityLimit = 180\n        float newton:damping = 0.2\n"
    "        float newton:friction = 0.3\n        float newton:armature = 0.01\n"
    "        point3f physics:localPos0 = (0.25, 0, 0.5)\n"
    "        point3f physics:localPos1 = (-0.25, 0, 0.5)\n"
    "        quatf physics:localRot0 = (0.8, 0.6, 0, 0)\n"
    "        quatf physics:localRot1 = (0.8, 0.6, 0, 0)\n"
)
HOLD = '    def PhysicsFixedJoint "hold"\n    {\n        rel physics:body1 = </r/a>\n    }\n'
TURNED = (
    "        quatd xformOp:orient = (0.8, 0, 0.6, 0)\n        double3 xformOp:scale = (2, 2, 2)\n"
)


def apply(text, *schemas):
    """Apply schemas to a joint."""
    listed = ", ".join(f'"{schema}"' for schema in schemas)
    text = re.sub(r" \(prepend apiSchemas.*\)\n", "\n", text, count=1)
    return text.replace('"\n', f'" (\n        prepend apiSchemas = [{listed}]\n    )\n', 1)


def test_newton_imports_what_is_read(write, tmp_path):
    import newton

    from urdftool.formats.usd.read import read

    drive = ("PhysicsDriveAPI:angular", "NewtonJointAPI")
    bodies = [
        body(name, mass, at, TURNED).replace(
            '["xformOp:translate"]', '["xformOp:translate", "xformOp:orient", "xformOp:scale"]'
        )
        for name, mass, at in (("a", 3, "(0, 0, 0)"), ("b", 2, "(1, 0, 0)"), ("c", 1, "(2, 0, 1)"))
    ]
    text = stage(
        *bodies, HOLD,
        apply(turning("one", "a", "b", LIMITS), *drive),
        apply(turning("two", "b", "c", MIMIC), *drive, "NewtonMimicAPI"),
    ).replace('def Xform "r"', 'def Xform "r" (\n    prepend apiSchemas = '
              '["PhysicsArticulationRootAPI"]\n)').replace(
        "centerOfMass = (0, 0, 0)", "centerOfMass = (0.1, 0.2, 0.3)")  # fmt: skip
    path = write("r.usda", text)
    robot = read(path, mesh_folder=tmp_path).robot
    builder = newton.ModelBuilder()
    builder.add_usd(str(path))
    numbers = {label.rpartition("/")[2]: n for n, label in enumerate(builder.body_label)}
    assert numbers.keys() == robot.link.keys()
    for name, number in numbers.items():
        inertial = robot.link[name].inertial
        assert inertial.mass == pytest.approx(float(builder.body_mass[number]), rel=1e-6)
    model = builder.finalize(device="cpu")
    state = model.state()
    newton.eval_fk(model, model.joint_q, model.joint_qd, state)
    frames = state.body_q.numpy()
    poses = link_poses(robot)
    read_centers, imported = [], []
    for name, number in numbers.items():
        pose, origin = poses[name], robot.link[name].inertial.origin
        read_centers.append(np.array(pose.rotation) @ origin.xyz + pose.translation)
        turn = turn_of(frames[number][3:])
        imported.append(turn @ np.array(list(builder.body_com[number])) + frames[number][:3])
    moved = np.array(read_centers) - read_centers[0], np.array(imported) - imported[0]
    base = np.array(turn_of(frames[numbers["a"]][3:]))
    assert moved[0] @ base.T == pytest.approx(moved[1], abs=1e-5)
    joints = {label.rpartition("/")[2]: n for n, label in enumerate(builder.joint_label)}
    joint, actuator = robot.joint["one"], robot.joint_actuators[0]
    at = builder.joint_qd_start[joints["one"]]
    for name, value in (
        *(("limit_lower", joint.limit.lower), ("limit_upper", joint.limit.upper)),
        *(("effort_limit", joint.limit.effort), ("velocity_limit", joint.limit.velocity)),
        *(("friction", joint.dynamics.friction), ("damping", joint.dynamics.damping)),
        *(("armature", joint.dynamics.armature), ("target_ke", -actuator.bias[1])),
        ("target_kd", -actuator.bias[2]),
    ):
        assert float(getattr(builder, f"joint_{name}")[at]) == pytest.approx(value, rel=1e-6), name
    offset, factor = builder.joint_mimic_coeffs[joints["two"]]
    mimic = robot.joint["two"].mimic
    assert (float(factor), float(offset)) == pytest.approx((mimic.multiplier, mimic.offset))


def turn_of(quaternion):
    """Return the rotation of a quaternion ``(x, y, z, w)``."""
    from urdftool.model.pose import rotation_from_quaternion

    x, y, z, w = (float(part) for part in quaternion)
    return np.array(rotation_from_quaternion((w, x, y, z)))
