"""Schemas of Isaac Sim: which prims are the robot, its links and its joints."""

from __future__ import annotations

from pxr import Usd

from .joints import JointWriter
from .links import LinkWriter
from .stage import ISAAC, apply, set_targets, set_value


def write_isaac(links: LinkWriter, joints: JointWriter) -> None:
    """Apply the schemas of Isaac Sim; the first link is the base."""
    builder, bodies = links.builder, links.bodies
    order = sorted(bodies.links, key=lambda link: link.name != bodies.base)
    with builder.edit_layer(ISAAC):
        for link in order:
            _name(builder.stage.GetPrimAtPath(links.get_path(link.name)), "Link", link.name)
        written = [joint for joint in bodies.joints if joint.type != "floating"]
        for joint in written:
            _name(builder.stage.GetPrimAtPath(joints.get_path(joint.name)), "Joint", joint.name)
        apply(builder.prim, "IsaacRobotAPI")
        paths = [links.get_path(link.name) for link in order]
        set_targets(builder.prim, "isaac:physics:robotLinks", paths)
        root = builder.root.AppendPath("joints/root_joint")
        own = [root] if builder.stage.GetPrimAtPath(root) else []
        paths = [*own, *(joints.get_path(joint.name) for joint in written)]
        set_targets(builder.prim, "isaac:physics:robotJoints", paths)


def _name(prim: Usd.Prim, kind: str, name: str) -> None:
    apply(prim, f"Isaac{kind}API")
    if prim.GetName() != name:
        set_value(prim, "isaac:nameOverride", "string", name)
