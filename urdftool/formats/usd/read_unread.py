"""Attributes of a stage that the model does not hold."""

from __future__ import annotations

import re

from pxr import Sdf, Usd, UsdPhysics

from ...diagnostic import Severity
from ...model.drives import GAINS
from ...model.settings import RESISTANCE
from .read_native import has_default
from .read_stage import Context

_NAMESPACES = re.compile(r"(physics|physx\w*|newton|mjc|drive|limit|state|urdf|omniphysics)$")

_READ = re.compile(
    r"physics:(mass|centerOfMass|diagonalInertia|principalAxes|rigidBodyEnabled|collisionEnabled|"
    r"approximation|axis|(lower|upper)Limit|local(Pos|Rot)[01]|jointEnabled|excludeFromArticulation)"
    r"|newton:(inertia|velocityLimit|mimic(Coef[01]|Enabled)|maxHullVertices)"
    rf"|drive:\w+:physics:(maxForce|{'|'.join(GAINS)})|limit:\w+:physics:(low|high)"
    r"|physxJointAxis:\w+:maxJointVelocity|physxJoint:maxJointVelocity|physxMimicJoint:\w+:(gearing|offset)"
    r"|physics:((static|dynamic)Friction|restitution|gravity(Magnitude|Direction))"
    r"|mjc:(coef[01]|actuatorfrc(range:(min|max)|limited))|"
    + "|".join(
        name.replace("*", r"\w+")
        for row in RESISTANCE
        for name in (row.usd, *row.physx, f"mjc:{row.mjcf_attribute}")
    )
)
"""Names of the attributes that the reader uses."""

_HARMLESS = re.compile(
    r"urdf:.*|state:.*|drive:\w+:physics:(targetPosition|targetVelocity|type)"
    r"|physics:(startsAsleep|velocity|angularVelocity|simulationOwner|collisionEnabled)"
    r"|.*([sS]olver|[sS]leep|[sS]tabilization|[iI]teration|[hH]ull|report).*"
)
"""Names of settings, of states at the start, and of what drives are set to at the start."""

_SELF = re.compile(r"newton:selfCollisionEnabled|physxArticulation:enabledSelfCollisions")
"""Names of the settings of collisions of a robot with itself."""


def report_unread(context: Context) -> None:
    """Report each attribute of physics that is not read once, with the first prim that has it."""
    found: dict[str, list[Usd.Prim]] = {}
    for prim in context.iterate_prims():
        for attribute in prim.GetAuthoredAttributes():
            name = attribute.GetName()
            space, colon, _ = name.partition(":")
            if colon and _NAMESPACES.match(space) and not _READ.fullmatch(name):
                found.setdefault(name, []).append(prim)
    without: dict[str, Usd.Prim] = {}
    for name, having in found.items():
        prims = [one for one in having if not has_default(one, name)]
        if not prims:
            continue
        prim = prims[0]
        if _SELF.fullmatch(name):
            if prim.GetAttribute(name).Get() is False and not context.is_ours:
                without.setdefault(str(prim.GetPath()), prim)
            continue
        place = context.get_place(prim, name)
        if _HARMLESS.fullmatch(name):
            text = "settings, and states and targets at the start, are not read"
            context.losses.add("setting", text, name, place, Severity.INFO)
        else:
            values = [f"{one.GetPath()} {one.GetAttribute(name).Get()}" for one in prims]
            content = "; ".join(values)
            context.losses.add("attribute", "attributes are not read", name, place, content=content)
    for prim in without.values():
        text = "that parts of the robot do not collide with each other is not read"
        context.report_loss("self-collision", text, prim, Severity.INFO)
    for prim in context.bodies.values():
        if UsdPhysics.RigidBodyAPI(prim).GetKinematicEnabledAttr().Get():
            context.report_loss("kinematic", "kinematic bodies are read as dynamic ones", prim)
    _report_variants(context)
    _report_units(context)


def _report_variants(context: Context) -> None:
    """Report the variants of the robot that are not selected."""
    sets = context.top.GetVariantSets()
    for name in sets.GetNames():
        selected = sets.GetVariantSelection(name) or "none"
        others = [one for one in sets.GetVariantSet(name).GetVariantNames() if one != selected]
        if others:
            text = "variant sets are read as selected"
            shown = f"{name}: {selected}, not {', '.join(others)}"
            place = context.get_place(context.top)
            context.losses.add("variant", text, shown, place, Severity.INFO)


_UNITS = {"upAxis": "Y", "metersPerUnit": 0.01, "kilogramsPerUnit": 1.0}
"""Metadata of a layer that OpenUSD takes from the root layer only, with their defaults."""


def _report_units(context: Context) -> None:
    """Report an up axis that does not exist, and layers whose units are not those of the stage."""
    root = context.stage.GetRootLayer()
    own = {name: _get_metadata(root, name, default) for name, default in _UNITS.items()}
    place = context.get_place(context.stage.GetPseudoRoot())
    if own["upAxis"] not in ("Y", "Z"):
        text = "an up axis other than Y and Z is read as Z"
        context.losses.add("up-axis", text, f"upAxis '{own['upAxis']}'", place)
    for layer in context.stage.GetUsedLayers():
        for name, value in own.items():
            other = _get_metadata(layer, name, value)
            if other != value:
                text = "layers have other units than the stage, and OpenUSD does not convert them"
                shown = f"{layer.GetDisplayName()}: {name} {other}, not {value}"
                context.losses.add("units", text, shown, place)


def _get_metadata(layer: Sdf.Layer, name: str, default: object) -> object:
    """Return a value of the metadata of a layer; the default without one."""
    return layer.pseudoRoot.GetInfo(name) if layer.pseudoRoot.HasInfo(name) else default
