"""What one simulator makes of a URDF."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Mesh, Robot
from ..cross_file_references import check_not_included
from ..fix import (
    Change,
    FixContext,
    Lines,
    Proposal,
    escape_attribute,
    is_computed,
    unsafe,
)
from ..gazebo.contact import contact_role
from ..rule import INFO, UNSAFE, Problem, rule


@rule(
    INFO,
    on=("pybullet",),
    effects={
        "pybullet": "computes it from the collisions instead; URDF_USE_INERTIA_FROM_FILE takes it",
    },
)
def pybullet_ignores_inertia(robot: Robot) -> Iterator[Problem]:
    """PyBullet does not read the inertia of a URDF unless it is told to.

    ``loadURDF`` takes the mass and computes the inertia from the collision shapes. With
    ``flags=URDF_USE_INERTIA_FROM_FILE`` what is written counts.
    """
    for link in robot.links:
        if link.inertial is not None and link.inertial.inertia is not None:
            yield Problem(
                robot,
                "PyBullet reads the inertias of this file only with "
                "flags=URDF_USE_INERTIA_FROM_FILE",
                at=link.inertial.inertia,
            )
            return


@rule(INFO, on=("mujoco",), effects={"mujoco": "fuses the root into the world; its mass is lost"})
def mujoco_welds_root(robot: Robot) -> Iterator[Problem]:
    """A robot on wheels or legs has its root welded to the world in MuJoCo.

    MuJoCo has no joint above the root of a URDF, and makes it part of the ground. A robot that
    should move wants a root without mass, such as ``world``, and a joint of type ``floating``;
    Gazebo in turn rejects that joint.
    """
    root = robot.tree.root
    if root is None or root.name == "world":
        return
    weight = sum(robot.link[name].mass for name in robot.tree.body_links[root.name])
    if weight <= 0:
        return
    if not any(contact_role(robot, link) in ("wheel", "caster", "foot") for link in robot.links):
        return  # an arm: it is bolted down
    yield Problem(
        root,
        f"MuJoCo makes '{root.name}' part of the world, and its {weight:g} kg do not count; "
        "put a link 'world' and a floating joint above it if it is to move",
        data={"mass": weight},
    )


@mujoco_welds_root.fix(UNSAFE)
def add_floating_joint(problem: Problem, context: FixContext) -> Proposal | None:
    """Add a link ``world`` and a floating joint, which Gazebo does not accept."""
    robot, root = context.robot, context.link(problem)
    if context.targets != {"mujoco"} or is_computed(root.element):
        return None
    if "world" in robot.link or "world_joint" in robot.joint:
        return None
    check_not_included(context)
    blocks: tuple[Lines, ...] = (
        ('<link name="world"/>',),
        (
            '<joint name="world_joint" type="floating">',
            '\t<parent link="world"/>',
            f'\t<child link="{escape_attribute(root.name)}"/>',
            "</joint>",
        ),
    )
    return unsafe(
        "put a link 'world' and a floating joint above it",
        Change("first", robot.element, blocks=blocks),
    )


@rule(
    INFO,
    on=("mujoco",),
    effects={
        "mujoco": "drops visuals, and merges fixed links",
    },
)
def mujoco_missing_compiler(robot: Robot) -> Iterator[Problem]:
    """A robot for MuJoCo does not say how it is to be compiled.

    Of a URDF MuJoCo drops the visuals and fuses what is fixed. ``<mujoco><compiler
    discardvisual="false" …/>`` in the robot says otherwise, and where meshes are.
    """
    if any(mujoco.child("compiler") for mujoco in robot.element.all("mujoco")):
        return
    meshes = sum(1 for _, shape in robot.shapes if isinstance(shape.geometry, Mesh))
    if meshes:
        yield Problem(
            robot,
            f"no <mujoco><compiler> says what MuJoCo should do with {meshes} meshes; "
            "its own way is to drop visuals",
            data={"meshes": meshes},
        )


@mujoco_missing_compiler.fix(UNSAFE)
def write_compiler(problem: Problem, context: FixContext) -> Proposal | None:
    """Write MuJoCo's settings with the folder of the meshes."""
    from ..mesh.changes import propose_compiler

    return propose_compiler(context)


@rule(INFO, default=False)
def isaac_empty_root(robot: Robot) -> Iterator[Problem]:
    """The root is a frame without mass and shape, which Isaac Sim makes a body.

    Gazebo and MuJoCo fuse such a root, as ``base_footprint``, with what is fixed to it, and KDL
    wants it. The importer of Isaac Sim makes a rigid body of each link, of a frame too, and the
    robot hangs on one without mass. Merge fixed joints when importing, or let the robot begin at
    its first link with a mass.
    """
    root = robot.tree.root
    if root is None or root.inertial is not None or root.visuals or root.collisions:
        return
    below = [joint.child for joint in robot.joints if joint.parent == root.name]
    begin = f", or begin with '{below[0]}'" if len(below) == 1 else ""
    yield Problem(
        root,
        f"root '{root.name}' has neither mass nor shape; for Isaac Sim merge fixed joints when "
        f"importing{begin}",
    )
