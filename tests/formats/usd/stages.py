"""Robots of a few links, and their stages as plain values."""

import re

import urdftool
from urdftool.formats.registry import format_named

INERTIA = '<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>'
BOX = '<collision><geometry><box size="0.1 0.2 0.3"/></geometry></collision>'


def link(name, mass=1.0, shapes="", inertia=INERTIA, origin=""):
    """Return a ``<link>``; without ``<inertial>`` if the mass is None."""
    body = "" if mass is None else f'<inertial>{origin}<mass value="{mass}"/>{inertia}</inertial>'
    return f'<link name="{name}">{body}{shapes}</link>'


def joint(name, parent, child, kind="fixed", more=""):
    """Return a ``<joint>``."""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f"{more}</joint>"
    )


def robot(*parts, name="r"):
    """Return a ``<robot>``."""
    return f'<robot name="{name}">' + "\n".join(parts) + "</robot>"


def export(path, **options):
    """Convert a robot; return the export."""
    from urdftool.formats.usd.options import Options

    return format_named("usd").write(urdftool.load(path), Options(**options))


def stage_of(written, folder):
    """Write an export to a folder and open its stage."""
    from pxr import Usd

    from urdftool.formats.common.directory import write_export

    write_export(folder, written, single=False)
    return Usd.Stage.Open(str(folder / written.main))


def codes(written):
    """Return the codes of the losses with their names."""
    return {(loss.code, loss.name) for loss in written.losses}


HEAD = '#usda 1.0\n(\n    defaultPrim = "r"\n    metersPerUnit = {}\n    upAxis = "{}"\n)\n'

BODY = """    def Xform "{name}" (
        prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"]
    )
    {{
        float physics:mass = {mass}
        point3f physics:centerOfMass = (0, 0, 0)
        float3 physics:diagonalInertia = (1, 2, 2.5)
        double3 xformOp:translate = {at}
        uniform token[] xformOpOrder = ["xformOp:translate"]
{more}
    }}
"""


def body(name, mass=1, at="(0, 0, 0)", more=""):
    """Return a body of a stage."""
    return BODY.format(name=name, mass=mass, at=at, more=more)


def stage(*parts, unit=1, up="Z"):
    """Return a stage."""
    return HEAD.format(unit, up) + 'def Xform "r"\n{\n' + "".join(parts) + "}\n"


def turning(name, first, second, more=""):
    """Return a revolute joint of a stage, with the schema of a drive whose attributes it has."""
    axis = re.search(r"drive:(\w+):", more)
    applied = f' (prepend apiSchemas = ["PhysicsDriveAPI:{axis[1]}"])' if axis else ""
    return f"""    def PhysicsRevoluteJoint "{name}"{applied}
    {{
        rel physics:body0 = </r/{first}>
        rel physics:body1 = </r/{second}>
        uniform token physics:axis = "Z"
{more}
    }}
"""
