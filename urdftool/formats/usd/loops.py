"""Closed loops and named frames, which SDF and MJCF have and URDF has not."""

from __future__ import annotations

from pxr import Gf, UsdGeom, UsdPhysics

from ...model.elements import Robot
from ...model.numbers import remove_noise
from ...model.pose import Pose, make_pose
from ..common.naming import UniqueNames
from ..written import Written
from .joints import JointWriter
from .links import LinkWriter
from .names import make_identifier
from .stage import PHYSICS, compute_quaternion, set_pose, store_name

_TYPES = {
    "weld": UsdPhysics.FixedJoint,
    "fixed": UsdPhysics.FixedJoint,
    "connect": UsdPhysics.SphericalJoint,
    "ball": UsdPhysics.SphericalJoint,
    "revolute": UsdPhysics.RevoluteJoint,
    "continuous": UsdPhysics.RevoluteJoint,
    "prismatic": UsdPhysics.PrismaticJoint,
}


def write_closures(joints: JointWriter, written: Written) -> None:
    """Write each closed loop as a joint outside of the articulation."""
    bodies, builder = joints.bodies, joints.builder
    names = UniqueNames((*joints.names.joint.values(), "root_joint"))
    for closure in bodies.robot.closures:
        schema = _TYPES.get(closure.type)
        ends = [joints.get_body_path(name) for name in (closure.parent, closure.child)]
        if schema is None or closure.axis is not None or ends[0] == ends[1]:
            written.report_loss(
                "closure",
                f"closed loop '{closure.name}' of type {closure.type} is dropped",
                closure.place,
                kind="joint",
                name=closure.name,
            )
            continue
        with builder.edit_layer(PHYSICS):
            name = names.take(make_identifier(closure.name or "loop"))
            path = builder.root.AppendPath(f"joints/{name}")
            joint = schema.Define(builder.stage, path)
            for rel, end in ((joint.CreateBody0Rel, ends[0]), (joint.CreateBody1Rel, ends[1])):
                if end:
                    rel().SetTargets([end])
            joint.CreateExcludeFromArticulationAttr(True)
            first = bodies.pose[closure.parent] @ make_pose(closure.origin)
            second = bodies.pose[closure.child] @ make_pose(closure.child_origin)
            if closure.type == "connect":
                first, second = (
                    Pose(translation=first.translation),
                    Pose(translation=second.translation),
                )
            joint.CreateLocalPos0Attr(Gf.Vec3f(*remove_noise(first.translation)))
            joint.CreateLocalRot0Attr(Gf.Quatf(*compute_quaternion(first.rotation)))
            joint.CreateLocalPos1Attr(Gf.Vec3f(*remove_noise(second.translation)))
            joint.CreateLocalRot1Attr(Gf.Quatf(*compute_quaternion(second.rotation)))
            if not closure.is_active:
                joint.CreateJointEnabledAttr(False)


def write_frames(links: LinkWriter, robot: Robot) -> None:
    """Write each named frame as a transform below its link."""
    taken: dict[str, UniqueNames] = {}
    for frame in robot.frames:
        if frame.link not in robot.link:
            continue
        names = taken.setdefault(frame.link, UniqueNames(links.names.link.values()))
        path = links.get_path(frame.link).AppendChild(
            names.take(make_identifier(frame.name, "frame"))
        )
        prim = UsdGeom.Xform.Define(links.builder.stage, path).GetPrim()
        set_pose(prim, make_pose(frame.origin))
        store_name(prim, "frame", frame.name)
