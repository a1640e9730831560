"""Mass matrices of MJCF models in MuJoCo, and of the URDF made of them in Pinocchio."""

import os
from pathlib import Path

import numpy as np
import pytest

import urdftool
from tests.conftest import ROOT
from urdftool.errors import UrdftoolError

pytestmark = pytest.mark.slow
mujoco = pytest.importorskip("mujoco")
pinocchio = pytest.importorskip("pinocchio")

WHEELS = Path(os.environ.get("URDFTOOL_MJCF", ROOT / ".venv-mjcf"))


def compile_chain(path):
    """The model, if it has nothing but joints that URDF has."""
    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        pytest.skip(str(error))
    kinds = {int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE)}
    if not model.njnt or model.ntendon or not {int(kind) for kind in model.jnt_type} <= kinds:
        pytest.skip("no joints, tendons, or joints of three or more axes")
    return model


def compute_both(model, other, shift):
    """The mass matrix without armature, in both, at a configuration [rad, m]."""
    data = mujoco.MjData(model)
    data.qpos[:] = model.qpos0 + shift
    mujoco.mj_forward(model, data)
    full = np.zeros((model.nv, model.nv))
    try:
        mujoco.mj_fullM(model, data, full)
    except TypeError:  # before version 4
        mujoco.mj_fullM(model, full, data.qM)
    joints = [other.joints[other.getJointId(model.joint(j).name)] for j in range(model.njnt)]
    position = pinocchio.neutral(other)
    for joint, value in zip(joints, data.qpos, strict=True):
        circle = joint.nq == 2  # continuous
        position[joint.idx_q : joint.idx_q + joint.nq] = (
            (np.cos(value), np.sin(value)) if circle else value
        )
    found = pinocchio.crba(other, other.createData(), position)
    found = np.triu(found) + np.triu(found, 1).T
    order = [joint.idx_v for joint in joints]
    return full - np.diag(model.dof_armature), found[np.ix_(order, order)]


@pytest.mark.parametrize("path", sorted(WHEELS.rglob("*.xml")), ids=lambda path: path.stem)
def test_the_mass_matrix_is_that_of_mujoco(path, tmp_path):
    model = compile_chain(path)
    out = tmp_path / "robot.urdf"
    try:
        urdftool.export_urdf(urdftool.load(path), out)
    except UrdftoolError as error:
        pytest.skip(str(error))
    other = pinocchio.buildModelFromUrdf(str(out))
    random = np.random.default_rng(0)
    for number in range(5):
        shift = random.uniform(-0.5, 0.5, model.nq) if number else np.zeros(model.nq)
        expected, found = compute_both(model, other, shift)
        np.testing.assert_allclose(found, expected, atol=1e-12 * np.abs(expected).max())
