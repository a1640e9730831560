"""Comparison of contact: which links can collide with each other and the ground, and friction."""

from __future__ import annotations

import math
from copy import copy
from itertools import combinations

import numpy as np

from ...compare.check import Check
from ...model.elements import Link
from ...model.settings import get_number
from ..common.losses import DeclaredLosses
from .compiled import Compiled
from .declared_losses import CUT, SHAPES
from .verify_shapes import get_loss_names
from .verify_source import Source

GRIP = (1.0, 0.005, 0.0001)
"""MuJoCo's sliding, torsional [m] and rolling [m] friction."""

SOFTNESS = (
    "condim", "priority", "solmix", "solref", "solimp", "margin", "gap", "fluid", "adhesion",
    "surfacevel",
)  # fmt: skip
"""Fields of a geom for which an export keeps MuJoCo's defaults."""

DEEP = 1e-3
"""Penetration depth [m] above which two links overlap at home."""

MANY = 12
"""Maximum number of pairs reported individually."""


def check_contact(source: Source, compiled: Compiled, declared: DeclaredLosses) -> Check:
    """Compare which links can collide with each other and with a ground of default class."""
    check = Check("contact", "which links can make contact with each other and the ground", 0)
    model, flags = compiled.model, compiled.mujoco.mjtDisableBit
    for flag, what in ((flags.mjDSBL_CONTACT, "contact"), (flags.mjDSBL_CONSTRAINT, "constraint")):
        if model.opt.disableflags & flag:
            check.compare(math.inf, f'<flag {what}="disable"/>: contacts are disabled')
    if model.npair:
        check.compare(math.inf, f"{model.npair} <pair> that the description does not require")
    touching = [link for link in source.robot.links if _count(link, compiled, check, declared)]
    _report_foreign(source, compiled, check)
    apart, together = [], []
    excluded = {int(signature) for signature in model.exclude_signature}
    overlapping = _find_overlapping(source, compiled)
    for one, other in combinations(touching, 2):
        expected = _may_touch(source, one.name, other.name)
        if frozenset((compiled.get_body(one.name), compiled.get_body(other.name))) in overlapping:
            expected = False
        if _can_touch(
            compiled, compiled.get_body(one.name), compiled.get_body(other.name), excluded
        ):
            if not expected:
                together.append(f"links '{one.name}' and '{other.name}' can make contact")
        elif expected:
            apart.append(f"links '{one.name}' and '{other.name}' cannot make contact")
    for texts in (apart, together):
        for text in texts[:MANY]:
            check.compare(math.inf, text)
        if len(texts) > MANY:
            check.compare(math.inf, f"{texts[-1]}, and {len(texts) - MANY} more such pairs")
    return check


def _find_overlapping(source: Source, compiled: Compiled) -> set[frozenset[int]]:
    """Find the bodies that overlap at home without exclusions, if the options exclude these."""
    if source.options.exclude != "touching":
        return set()
    mujoco, model = compiled.mujoco, copy(compiled.model)
    model.exclude_signature[:] = 0
    data = mujoco.MjData(model)
    key = compiled.get_id("KEY", "home")
    if key >= 0:
        mujoco.mj_resetDataKeyframe(model, data, key)
    mujoco.mj_forward(model, data)
    return {
        frozenset(int(model.geom_bodyid[geom]) for geom in contact.geom)
        for contact in (data.contact[number] for number in range(data.ncon))
        if contact.dist <= -DEEP
    }


def _count(link: Link, compiled: Compiled, check: Check, declared: DeclaredLosses) -> int:
    """Compare the number of colliding geoms of a link; return the number in the model."""
    model, body = compiled.model, compiled.get_body(link.name)
    solid = [
        g for g in compiled.get_geoms(body) if model.geom_contype[g] or model.geom_conaffinity[g]
    ]
    known = declared.has_for((*SHAPES, *CUT), *get_loss_names(link))
    if len(solid) != len(link.collisions):
        text = (
            f"link '{link.name}': {len(solid)} geoms that make contact, of "
            f"{len(link.collisions)} collisions"
        )
        check.compare(math.inf, text, known=known)
    for geom in solid:
        if not model.geom_contype[geom] == model.geom_conaffinity[geom] == 1:
            check.compare(math.inf, f"link '{link.name}': a geom with contype or conaffinity not 1")
    return len(solid)


def _report_foreign(source: Source, compiled: Compiled, check: Check) -> None:
    """Report colliding geoms on bodies that are not links."""
    model = compiled.model
    links = {compiled.get_body(link.name) for link in source.robot.links}
    for geom in range(model.ngeom):
        solid = model.geom_contype[geom] or model.geom_conaffinity[geom]
        body = int(model.geom_bodyid[geom])
        if solid and body not in links:
            name = compiled.name("BODY", body)
            check.compare(
                math.inf, f"a geom of body '{name}', which is not a link, can make contact"
            )


def _may_touch(source: Source, one: str, other: str) -> bool:
    """Tell whether the description lets two links collide."""
    pair = frozenset((source.rigid.get(one, one), source.rigid.get(other, other)))
    if len(pair) == 1:
        return False
    if source.options.exclude == "none":  # only MuJoCo's own parent filter applies
        return frozenset((one, other)) not in source.disabled and not (
            pair in source.joined and (source.is_free or source.root not in pair)
        )
    if pair in source.joined:
        return False
    return frozenset((one, other)) not in source.separated


def _can_touch(compiled: Compiled, one: int, other: int, excluded: set[int]) -> bool:
    """Tell whether MuJoCo lets the geoms of two bodies collide, by its documented filters."""
    model = compiled.model
    welds = int(model.body_weldid[one]), int(model.body_weldid[other])
    if welds[0] == welds[1] or (min(one, other) << 16) + max(one, other) in excluded:
        return False
    filtered = not model.opt.disableflags & compiled.mujoco.mjtDisableBit.mjDSBL_FILTERPARENT
    if filtered and 0 not in welds:
        above = [int(model.body_weldid[model.body_parentid[weld]]) for weld in welds]
        return not (above[0] == welds[1] or above[1] == welds[0])
    return True


def check_surface(source: Source, compiled: Compiled, declared: DeclaredLosses) -> Check:
    """Compare friction and softness of collision geoms."""
    check = Check("surface", "friction of every collision; MuJoCo's softness, margin, condim", 1e-9)
    plain = compiled.get_reference()
    model = compiled.model
    for link in source.robot.links:
        body = compiled.get_body(link.name)
        values = [get_number(shape.surface, "friction") for shape in link.collisions]
        grips = {GRIP if one is None else (one, *GRIP[1:]) for one in values} or {GRIP}
        for geom in compiled.get_geoms(body):
            if not (model.geom_contype[geom] or model.geom_conaffinity[geom]):
                continue
            found = model.geom_friction[geom]
            off, grip = min((float(abs(found - one).max()), one) for one in grips)
            check.compare(off / max(1.0, grip[0]), f"friction of link '{link.name}'")
            for field in SOFTNESS:
                array = getattr(model, f"geom_{field}", None)
                if array is None:  # this version of MuJoCo does not have the field
                    continue
                usual = getattr(plain, f"geom_{field}")[0]
                if field == "priority":  # without a priority MuJoCo uses the larger friction of two
                    usual = int(grip[0] < GRIP[0])
                same = np.array_equal(array[geom], usual)
                check.compare(0 if same else math.inf, f"{field} of link '{link.name}'")
    return check
