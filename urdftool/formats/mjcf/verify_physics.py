"""Comparison of gravity, springs, joint dynamics and physics options."""

from __future__ import annotations

import math
from xml.sax.saxutils import quoteattr

import numpy as np

from ...compare.check import Check
from ...model.elements import Joint
from ..common.losses import DeclaredLosses
from .compiled import Compiled
from .verify_source import Source

EXACT = 1e-9

STOPS = ("solref", "solimp", "margin", "actgravcomp", "stiffnesspoly", "springyield")
LOSSES = ("solref", "solimp", "dampingpoly")

LEAF_ARMATURE = 1e-4
"""Armature [kg·m² or kg] of the joint of a massless leaf link."""


def check_gravity_flag(source: Source, compiled: Compiled) -> Check:
    """Compare which links gravity acts on."""
    check = Check("gravity flags", "on which links gravity acts", EXACT)
    for link in source.robot.links:
        body = compiled.get_body(link.name)
        off = float(link.is_weightless)
        if body > 0:
            found = float(compiled.model.body_gravcomp[body])
            check.compare(abs(found - off), f"gravity of link '{link.name}'")
    return check


def check_joint_physics(source: Source, compiled: Compiled, declared: DeclaredLosses) -> Check:
    """Compare springs, armature, limit softness, and the dynamics of each degree of freedom."""
    check = Check("joint physics", "springs, armature, stiffness of limits, lower effort", EXACT)
    model, plain = compiled.model, compiled.get_reference()
    for joint in source.robot.joints:
        light = _is_weightless(source, joint)
        for number in _get_numbers(joint, compiled):
            name = f"joint '{joint.name}'"
            single = joint.type in ("revolute", "continuous", "prismatic", "planar")
            stiffness, reference = joint.spring or (0.0, 0.0)
            stiffness = 0.0 if joint.type == "floating" else stiffness
            found = float(np.ravel(model.jnt_stiffness[number])[0])
            check.compare(_compute_apart(found, stiffness), f"spring of {name}")
            if single:
                rest = float(model.qpos_spring[model.jnt_qposadr[number]])
                check.compare(
                    _compute_apart(rest, reference if stiffness else 0.0),
                    f"spring reference of {name}",
                )
            _compare_dofs(source, joint, number, light, compiled, check)
            for field in STOPS:
                _compare_same_default(
                    model, plain, f"jnt_{field}", number, f"{field} of {name}", check
                )
    root = compiled.get_id("JOINT", f"{source.root}_freejoint")
    for dof in range(6 if root >= 0 else 0):
        found = float(model.dof_armature[model.jnt_dofadr[root] + dof])
        found += float(np.ravel(model.dof_damping[model.jnt_dofadr[root] + dof])[0])
        check.compare(abs(found), "armature or damping of the free base")
    return check


def _get_numbers(joint: Joint, compiled: Compiled) -> list[int]:
    """Return the indices of the MuJoCo joints of a joint."""
    names = [joint.name + end for end in ("_TX", "_TY", "_RZ")]
    names = names if joint.type == "planar" else [joint.name]
    return [number for name in names if (number := compiled.get_id("JOINT", name)) >= 0]


def _compare_dofs(
    source: Source, joint: Joint, number: int, light: bool, compiled: Compiled, check: Check
) -> None:
    """Compare armature, damping and friction of each degree of freedom of a joint."""
    model, plain = compiled.model, compiled.get_reference()
    first = int(model.jnt_dofadr[number])
    count = {0: 6, 1: 3}.get(int(model.jnt_type[number]), 1)
    dynamics = joint.dynamics if joint.type != "floating" else None
    wanted = {
        "armature": (dynamics.armature if dynamics else None) or 0.0,
        "damping": (dynamics.damping if dynamics else None) or 0.0,
        "frictionloss": (dynamics.friction if dynamics else None) or 0.0,
    }
    if light and joint.type != "floating":
        wanted["armature"] = LEAF_ARMATURE
    settings = source.settings.get(joint.name)
    if settings is not None:
        rotor = source.options.armature if settings.armature is None else settings.armature
        asked = {"armature": rotor, "damping": settings.damping, "frictionloss": settings.friction}
        wanted |= {field: value for field, value in asked.items() if value is not None}
    for dof in range(first, first + count):
        for field, value in wanted.items():
            found = float(np.ravel(getattr(model, f"dof_{field}")[dof])[0])
            check.compare(_compute_apart(found, value), f"{field} of joint '{joint.name}'")
        for field in LOSSES:
            text = f"{field} of joint '{joint.name}'"
            _compare_same_default(model, plain, f"dof_{field}", dof, text, check)


def _compare_same_default(
    model: object, plain: object, field: str, number: int, text: str, check: Check
) -> None:
    """Compare a field with MuJoCo's default, if this version of MuJoCo has it."""
    array = getattr(model, field, None)
    if array is not None:
        same = np.array_equal(array[number], getattr(plain, field)[0])
        check.compare(0 if same else math.inf, text)


def _is_weightless(source: Source, joint: Joint) -> bool:
    """Tell whether none of the links that a joint moves has mass."""
    below = [joint.child, *source.robot.tree.list_descendants(joint.child)]
    return sum(max(source.robot.link[name].mass, 0.0) for name in below) <= 1e-14


def _compute_apart(found: float, expected: float) -> float:
    return abs(found - expected) / max(1.0, abs(expected))


def check_option(source: Source, compiled: Compiled, declared: DeclaredLosses) -> Check:
    """Compare gravity and the other physics options with those that ``<mujoco>`` requires."""
    check = Check("options", "gravity, medium, solver, flags, as <mujoco> says", EXACT)
    written = dict(compiled.written_options)
    asked = compiled.get_options(_get_required_option(source))
    known = declared.has_any("lossy-mujoco", "bad-extension-number")
    for name, value in asked.items():
        off = float(np.max(abs(np.subtract(written[name], value))))
        check.compare(off, f"{name} is {written[name]}, not {value}", known=known)
    return check


def _get_required_option(source: Source) -> str:
    """Return the ``<option>`` element that the description requires."""
    values = {"integrator": "implicitfast"}
    if source.is_free or any(joint.type == "floating" for joint in source.robot.joints):
        values["cone"] = "elliptic"
    flags: dict[str, str] = {}
    root = source.robot.xml
    for extension in () if root is None else root.list_children("mujoco"):
        for option in extension.list_children("option"):
            values.update(option.attributes)
            for flag in option.list_children("flag"):
                flags.update(flag.attributes)
    return f"<option {_format_text(values)}><flag {_format_text(flags)}/></option>"


def _format_text(values: dict[str, str]) -> str:
    return " ".join(f"{name}={quoteattr(value)}" for name, value in values.items())
