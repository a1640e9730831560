"""Check properties that one simulator treats differently."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Mesh, Robot
from ..cross_file_references import check_not_included
from ..fix import Change, FixContext, Lines, Proposal, escape_attribute, is_computed, unsafe
from ..gazebo.contact import get_contact_role
from ..rule import INFO, UNSAFE, Problem, rule


@rule(
    INFO,
    on=("pybullet",),
    effects={
        "pybullet": "computes it from the collisions, unless URDF_USE_INERTIA_FROM_FILE is set",
    },
)
def pybullet_ignores_inertia(robot: Robot) -> Iterator[Problem]:
    """PyBullet ignores the inertia of a URDF by default.

    ``loadURDF`` uses the mass and computes the inertia from the collision geometry. Pass
    ``flags=URDF_USE_INERTIA_FROM_FILE`` to use the values of the file.
    """
    for link in robot.links:
        if link.inertial is not None and link.inertial.inertia is not None:
            yield Problem(
                robot,
                "PyBullet uses the inertias of this file only with "
                "flags=URDF_USE_INERTIA_FROM_FILE",
                at=link.inertial.inertia,
            )
            return


@rule(INFO, on=("mujoco",), effects={"mujoco": "fuses the root into the world; its mass is lost"})
def mujoco_welds_root(robot: Robot) -> Iterator[Problem]:
    """MuJoCo welds the root of a robot on wheels or legs to the world.

    MuJoCo makes the root of a URDF part of the world, without a joint. A mobile robot needs a
    root without mass, such as ``world``, and a joint of type ``floating``; Gazebo rejects
    that joint.
    """
    root = robot.tree.root
    if root is None or root.name == "world":
        return
    weight = sum(robot.link[name].mass for name in robot.tree.body_links[root.name])
    if weight <= 0:
        return
    if not any(
        get_contact_role(robot, link) in ("wheel", "caster", "foot") for link in robot.links
    ):
        return  # a manipulator on a fixed base
    yield Problem(
        root,
        f"MuJoCo welds root link '{root.name}' to the world and ignores its mass ({weight:g} kg); "
        "for a free base, add a link 'world' and a floating joint above it",
        data={"mass": weight},
    )


@mujoco_welds_root.fix(UNSAFE)
def add_floating_joint(problem: Problem, context: FixContext) -> Proposal | None:
    """Add a link ``world`` and a floating joint, which Gazebo rejects."""
    robot, root = context.robot, context.get_link(problem)
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
        "add a link 'world' and a floating joint above the root",
        Change("first", robot.element, blocks=blocks),
    )


@rule(
    INFO,
    on=("mujoco",),
    effects={
        "mujoco": "drops visuals, and lumps fixed links",
    },
)
def mujoco_missing_compiler(robot: Robot) -> Iterator[Problem]:
    """A robot for MuJoCo has no ``<mujoco><compiler>``.

    By default MuJoCo drops the visuals of a URDF and lumps fixed links. ``<mujoco><compiler
    discardvisual="false" …/>`` in the robot changes this, and sets the folder of the meshes.
    """
    if any(mujoco.find_child("compiler") for mujoco in robot.element.list_children("mujoco")):
        return
    meshes = sum(1 for _, shape in robot.shapes if isinstance(shape.geometry, Mesh))
    if meshes:
        yield Problem(
            robot,
            f"the robot with {meshes} meshes has no <mujoco><compiler>, so MuJoCo drops its "
            "visuals; add it",
            data={"meshes": meshes},
        )


@mujoco_missing_compiler.fix(UNSAFE)
def write_compiler(problem: Problem, context: FixContext) -> Proposal | None:
    """Write MuJoCo's settings with the folder of the meshes."""
    from ..mesh.changes import propose_compiler

    return propose_compiler(context)
