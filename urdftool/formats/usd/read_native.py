"""Attributes and schemas of physics as a stage has them, for a comparison of two stages.

They are those that the robot does not hold as values, and those that say again, for another
simulator, what it holds: an attribute that contradicts its counterpart is one of the former.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from pxr import Gf, Sdf, Usd, UsdGeom, UsdPhysics, UsdShade

from ...model.elements import Robot
from ...model.mechanism import Base, NativeElement
from .read_joints import NamedJoint
from .read_roles import BODY, COLLIDER, MATERIAL, Roles, is_physical, list_joint_roles
from .read_stage import Context, convert_float, get_targets

_HELD_SCHEMAS = frozenset(
    (
        *("PhysicsRigidBodyAPI", "PhysicsMassAPI", "PhysicsCollisionAPI", "MaterialBindingAPI"),
        *("PhysicsMeshCollisionAPI", "PhysicsFilteredPairsAPI"),
    )
)
"""Schemas without which the reader makes no part, or which do nothing by themselves."""

_WITH_DEFAULTS = (
    *("PhysicsDriveAPI", "PhysicsLimitAPI", "PhysicsRigidBodyAPI", "PhysicsCollisionAPI"),
    *("PhysicsMeshCollisionAPI", "PhysicsMaterialAPI", "PhysicsMassAPI"),
)
"""Schemas whose defaults count, applied or not, so that applying one is a single difference."""

_HELD_RELATIONS = frozenset(
    (
        *("physics:body0", "physics:body1", "physics:filteredPairs", "physics:simulationOwner"),
        *("physics:filteredGroups", "newton:mimicJoint", "mjc:target"),
    )
)
"""Relations that the reader follows, and the scene of a body, of which there is one."""

_NO_ROLES = Roles()


def add_native(context: Context, robot: Robot, joints: Iterable[NamedJoint]) -> None:
    """Add what the stage says about physics and the robot does not hold, prim by prim."""
    seen: set[str] = set()
    robot.native = [_make_stage(context, robot.base)]
    for joint in joints:
        seen.add(str(joint.prim.GetPath()))
        robot.native.append(_make_joint(context, joint))
    for section, tag, prim, roles in _list_parts(context):
        seen.add(str(prim.GetPath()))
        robot.native.append(_make_element(context, section, tag, prim, roles))
    robot.native += _list_others(context, seen)


def _make_stage(context: Context, base: Base | None) -> NativeElement:
    """Return the up axis and the units of the stage, and the pose of the base in it."""
    up = str(UsdGeom.GetStageUpAxis(context.stage))
    attributes = {"upAxis": up, "units": f"{context.length:g} m, {context.mass:g} kg"}
    origin = base.origin if base is not None else None
    pose = (0.0,) * 6 if origin is None else (*origin.xyz, *origin.rpy)
    written = context.get_written(context.stage.GetPseudoRoot())
    return NativeElement(written, "stage", "stage", attributes, values={"pose": pose}, is_xml=False)


def _make_joint(context: Context, joint: NamedJoint) -> NativeElement:
    roles = list_joint_roles(context, joint.prim, joint.kind)
    element = _make_element(context, f"joint {joint.name}", "joint", joint.prim, roles)
    if joint.start:
        element.attributes["child moved in the frame of the joint"] = joint.start
    return element


def _list_parts(context: Context) -> Iterator[tuple[str, str, Usd.Prim, Roles]]:
    """Yield section, tag, prim and roles of attributes of bodies and colliders."""
    for path, prim in context.bodies.items():
        yield f"link {context.names[path]}", "rigid body", prim, BODY
    for prim in context.iterate_prims():
        body = context.find_body(prim)
        if body and prim.HasAPI(UsdPhysics.CollisionAPI) and str(prim.GetPath()) != body:
            yield f"link {context.names[body]}", "collider", prim, COLLIDER


def _list_others(context: Context, seen: set[str]) -> Iterator[NativeElement]:
    """Yield the other prims with physics, such as the articulation, scenes and tendons."""
    for prim in context.stage.TraverseAll():
        path = str(prim.GetPath())
        if path in seen or not prim.IsActive() or _is_of_another_robot(context, prim):
            continue
        element = _make_element(context, "stage", prim.GetTypeName() or "prim", prim, _NO_ROLES)
        if prim.HasAPI(UsdPhysics.MaterialAPI) and not prim.HasAPI(UsdPhysics.CollisionAPI):
            continue  # in the colliders to which it is bound
        if element.attributes or prim.GetTypeName().startswith(("Physics", "Physx", "Mjc")):
            element.attributes["name"] = _shorten(context, path)
            element.held = None
            yield element


def _is_of_another_robot(context: Context, prim: Usd.Prim) -> bool:
    """Tell whether a prim is of another robot, or joins only bodies that are not read."""
    if prim.IsA(UsdPhysics.Joint):
        ends = [end for n in (0, 1) for end in get_targets(prim, f"physics:body{n}")]
        prims = [context.stage.GetPrimAtPath(end) for end in ends]
        return bool(ends) and not any(one and context.find_body(one) for one in prims)
    return context.is_of_other(prim)


def _shorten(context: Context, path: str) -> str:
    """Return a path in the robot, without the name of its root, which may be another."""
    top = str(context.top.GetPath())
    return path.removeprefix(top).lstrip("/") or "robot" if top != "/" else path


def _make_element(
    context: Context, section: str, tag: str, prim: Usd.Prim, roles: Roles
) -> NativeElement:
    attributes = _format_attributes(prim, roles)
    attributes.update(_list_relations(prim))
    attributes.update((schema, "applied") for schema in _list_schemas(prim))
    if tag == "collider":
        bound, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial("physics")
        attributes.update(_format_attributes(bound.GetPrim(), MATERIAL) if bound else {})
    held, written = roles.list_agreeing(context, prim), context.get_written(prim)
    return NativeElement(written, section, tag, attributes, held=held, is_xml=False)


def _format_attributes(prim: Usd.Prim, roles: Roles) -> dict[str, str]:
    """Return the values of attributes of physics that the robot does not hold.

    Those with the value that they have without being written are left out.
    """
    found = {}
    for attribute in prim.GetAuthoredAttributes():
        name = attribute.GetName()
        if is_physical(name) and not roles.held.fullmatch(name) and not has_default(prim, name):
            found[name] = format_value(attribute)
    return found


def has_default(prim: Usd.Prim, name: str) -> bool:
    """Tell whether an attribute has the value that it has without being set."""
    own = name.replace(f":{name.split(':')[1]}:", ":__INSTANCE_NAME__:", 1)
    registry = Usd.SchemaRegistry()
    applicable = (registry.FindAppliedAPIPrimDefinition(schema) for schema in _WITH_DEFAULTS)
    for names in (prim.GetPrimDefinition(), name), *((one, own) for one in applicable):
        definition = names[0].GetAttributeDefinition(names[1])
        if definition:
            return bool(definition.GetFallbackValue() == prim.GetAttribute(name).Get())
    return False


def _list_relations(prim: Usd.Prim) -> Iterator[tuple[str, str]]:
    for relation in prim.GetAuthoredRelationships():
        name = relation.GetName()
        is_reference = name.endswith(":referenceJoint")
        if is_physical(name) and name not in _HELD_RELATIONS and not is_reference:
            yield name, " ".join(str(path).rpartition("/")[2] for path in relation.GetTargets())


def _list_schemas(prim: Usd.Prim) -> list[str]:
    """Return the applied schemas of physics without which a simulator ignores attributes."""
    listed = prim.GetMetadata("apiSchemas")
    names = listed.GetAddedOrExplicitItems() if listed is not None else ()
    starts = ("Physics", "Physx", "Newton", "Mjc", "Omni", "Isaac")
    return sorted(n for n in names if n.startswith(starts) and n not in _HELD_SCHEMAS)


def format_value(attribute: Usd.Attribute) -> str:
    """Return the value of an attribute as text, numbers separated by spaces; with its samples."""
    times = attribute.GetTimeSamples()
    if not times:
        return _format(attribute.Get())
    return "; ".join(f"{time:g}: {_format(attribute.Get(time))}" for time in times)


def _format(value: object) -> str:
    if isinstance(value, bool) or value is None:
        return str(value).lower()
    if isinstance(value, float):
        return f"{convert_float(value):.9g}"
    if isinstance(value, (str, int)):
        return str(value)
    if isinstance(value, (Gf.Quatf, Gf.Quatd, Gf.Quath)):
        return _join((value.GetReal(), *value.GetImaginary()))
    if isinstance(value, Sdf.AssetPath):
        return str(value.path)
    return _join(value) if isinstance(value, Iterable) else str(value)


def _join(values: Iterable[object]) -> str:
    return " ".join(_format(value) for value in values)
