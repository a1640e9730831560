"""Comparison of what an export never writes: MuJoCo's compiled model has defaults there."""

from __future__ import annotations

import math
from collections.abc import Collection

import numpy as np

from ...compare.check import Check
from ...model.settings import RESISTANCE
from .compiled import Compiled

EXACT = 1e-9
"""Tolerance of values that are copied. Chosen, no source."""

STIFF = (0.005, 1.0, 0.95, 0.99, 0.001, 0.5, 2.0)
"""``solref`` and ``solimp`` of every equality, as in MuJoCo Menagerie for coupled fingers."""

SOFT = (0.02, 1.0, 0.9, 0.95, 0.001, 0.5, 2.0)
"""MuJoCo's default of the same, which those of an MJCF have."""

FIELDS = {
    "jnt": ("stiffnesspoly", "springyield"),
    "dof": ("dampingpoly",),
    "geom": ("fluid", "adhesion", "surfacevel"),
    "mat": ("emission", "specular", "shininess", "reflectance", "texrepeat"),
    "sensor": ("noise", "cutoff", "delay", "interval"),
    "cam": ("mode",),
}
"""Fields of MuJoCo's model by its kind; some versions of MuJoCo do not have all of them."""

NONE = ("tendon", "flex", "plugin", "mocap", "pair")
"""Kinds of objects that an export never has."""


def check_defaults(
    compiled: Compiled, copied: Collection[str] = (), softness: tuple[float, ...] = STIFF
) -> Check:
    """Compare the fields that an export does not write with those of a plain model.

    Args:
        compiled: The model.
        copied: Kinds of elements, or of their attributes, that are copied from the source.
        softness: ``solref`` and ``solimp`` of the equalities, if they are not copied.
    """
    check = Check("defaults", "materials, sensors and equalities, where nothing is written", EXACT)
    model, plain = compiled.model, compiled.get_reference()
    for kind, names in FIELDS.items():
        for name in names:
            values = getattr(model, f"{kind}_{name}", None)
            usual = getattr(plain, f"{kind}_{name}", None)
            if kind in copied or values is None or usual is None or not len(values):
                continue
            default = usual[0] if len(usual) else np.zeros_like(values[0])
            off = float(np.max(abs(np.subtract(values, default))))
            check.compare(off, f"{name} of a {KINDS[kind]}")
    for kind in NONE:
        if kind not in copied and getattr(model, f"n{kind}", None):
            check.compare(math.inf, f"a {kind}")
    for number in range(model.neq) if "eq" not in copied else ():
        soft = *model.eq_solref[number], *model.eq_solimp[number]
        check.compare(
            float(abs(np.subtract(soft, softness)).max()), f"softness of equality {number}"
        )
    _compare_free_joints(compiled, check)
    return check


KINDS = {
    "jnt": "joint", "dof": "joint", "geom": "geom", "mat": "material", "sensor": "sensor",
    "cam": "camera",
}  # fmt: skip


def _compare_free_joints(compiled: Compiled, check: Check) -> None:
    """Compare the dynamics of free joints, which URDF does not have."""
    model = compiled.model
    for joint in range(model.njnt):
        if int(model.jnt_type[joint]) == int(compiled.mujoco.mjtJoint.mjJNT_FREE):
            dofs = slice(int(model.jnt_dofadr[joint]), int(model.jnt_dofadr[joint]) + 6)
            for name in (row.mjcf_attribute for row in RESISTANCE):
                off = float(np.max(abs(getattr(model, f"dof_{name}")[dofs])))
                check.compare(off, f"{name} of free joint '{compiled.name('JOINT', joint)}'")
