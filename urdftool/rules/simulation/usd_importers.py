"""Check properties that importers of Isaac Sim and Newton change."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from ...mechanics.spatial_inertia import link_inertia
from ...mechanics.tensor import compute_principal_moments
from ...model.elements import Capsule, Robot
from ...model.kinematics import get_limits
from ...model.settings import RESISTANCE_OF_URDF
from ...source.description import Description
from ..gazebo.contact import get_contact_role
from ..rule import INFO, WARNING, Problem, rule

_LEAST_MOMENT = 1e-10
"""[kg·m²]. Chosen, no source."""

_LEAST_PART = 1e-6
"""Of the largest moment. Chosen, no source."""


@rule(
    WARNING,
    on=("newton", "isaac"),
    effects={
        "newton": "computes the mass from the collision geometry, at the density of water",
        "isaac": "gives the link 1 kg",
    },
)
def usd_computed_mass(robot: Robot) -> Iterator[Problem]:
    """A link without mass has collision geometry, from which importers compute a mass.

    In Newton 1.8, a link without ``<inertial>`` gets the mass of its collision geometry at
    1000 kg/m³. A link with a mass of 0 gets it if the robot is converted to USD by
    urdf-usd-converter, the converter of Isaac Sim. PhysX allows no mass of 0 and assumes 1 kg.
    ``urdftool export usd`` writes such a link without a body.
    """
    for link in robot.links:
        if link.mass > 0 or not link.collisions:
            continue
        if link.name == "world" or link is robot.tree.root:
            continue
        what = "no <inertial>" if link.inertial is None else "a mass of 0"
        yield Problem(
            link,
            f"link '{link.name}' has {what} but collision geometry; importers of USD give it a "
            "mass; write its mass, or use 'urdftool export usd'",
            data={"has_inertial": link.inertial is not None},
        )


@rule(
    WARNING,
    on=("newton",),
    effects={"newton": "raises the moments by about 1e-6 kg·m²"},
    formats=("urdf", "usd"),
)
def newton_raised_inertia(robot: Robot) -> Iterator[Problem]:
    """A principal moment of inertia is so small that Newton raises all of them.

    ``ModelBuilder.finalize`` of Newton 1.8 requires a smallest principal moment of 1e-10 kg·m²,
    and of 1e-6 of the largest; it adds the difference and 1e-6 kg·m² to each moment. A body with
    moments of 1e-12 kg·m² gets 1e-6.
    """
    for link in robot.links:
        if link.mass <= 0 or link.inertial is None or link.inertial.inertia is None:
            continue
        low, _, high = compute_principal_moments(link_inertia(link).tensor)
        if 0 <= low < max(_LEAST_PART * high, _LEAST_MOMENT):  # Newton drops negative ones
            yield Problem(
                link,
                f"inertia of link '{link.name}' has a principal moment of {low:.3g} kg·m², which "
                "Newton raises to about 1e-6; correct it",
                at=link.inertial.inertia,
                data={"least": low, "largest": high},
            )


@rule(
    WARNING,
    on=("isaac",),
    effects={"isaac": "drops friction and damping"},
)
def isaac_drops_dynamics(robot: Robot) -> Iterator[Problem]:
    """A joint has friction or damping, which the importer of Isaac Sim 6.1 drops.

    It writes attributes of Newton, and PhysX reads others. ``urdftool export usd`` writes both.
    """
    for joint in robot.joints:
        dynamics = joint.dynamics
        if dynamics is not None and any(getattr(dynamics, name) for name in RESISTANCE_OF_URDF):
            yield Problem(
                joint,
                f"friction and damping of joint '{joint.name}' are dropped by the importer of "
                "Isaac Sim 6.1; set them in the configuration, or use 'urdftool export usd'",
                at=dynamics,
            )


@rule(
    INFO,
    on=("isaac",),
    effects={"isaac": "has another name"},
)
def usd_name(robot: Robot) -> Iterator[Problem]:
    """A name is not valid for a prim of USD, so the part is renamed.

    Names of prims have ASCII letters, digits and underscores, and no digit at the start. The
    converter of Isaac Sim writes ``link_8.0`` as ``tn__link_80_XB``.
    """
    for kind, parts in (("link", robot.links), ("joint", robot.joints)):
        for part in parts:
            if part.name and not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", part.name):
                yield Problem(
                    part,
                    f"{kind} '{part.name}' is renamed in USD, where names have only ASCII letters, "
                    "digits and underscores",
                    data={"name": part.name},
                )


@rule(
    WARNING,
    on=("newton",),
    effects={"newton": "reads an attribute height instead, and takes 1 m without it"},
)
def newton_capsule_length(robot: Robot) -> Iterator[Problem]:
    """A capsule has another length in Newton, which does not read the attribute.

    ``add_urdf`` of Newton 1.8 reads ``height`` where URDF 1.1 has ``length``, and takes 1 m for a
    missing one. ``urdftool export usd`` keeps the length.
    """
    for link, shape in robot.shapes:
        capsule = shape.geometry
        if not isinstance(capsule, Capsule) or capsule.element.get("height") is not None:
            continue
        if capsule.length != 1.0:
            yield Problem(
                link,
                f"capsule of link '{link.name}' has a length of {capsule.length:g} m, for which "
                "Newton takes 1 m; add the attribute height, or use 'urdftool export usd'",
                at=capsule,
                data={"length": capsule.length},
            )


@rule(
    INFO,
    on=("newton",),
    effects={"newton": "fixes the root to the world"},
)
def newton_fixes_root(robot: Robot) -> Iterator[Problem]:
    """Newton fixes the root of a robot on wheels or legs to the world.

    ``add_urdf`` of Newton 1.8 adds a fixed joint above the root unless it is called with
    ``floating=True``. ``urdftool export usd`` writes a free base for robots that stand on legs or
    wheels.
    """
    root = robot.tree.root
    if root is None or root.name == "world" or len(robot.links) < 2:
        return
    below = robot.tree.get_child_joints(root.name)
    if len(below) == 1 and below[0].type == "floating":
        return
    roles = {get_contact_role(robot, link) for link in robot.links}
    if roles & {"wheel", "caster", "foot"}:
        yield Problem(
            root,
            f"Newton fixes root link '{root.name}' to the world; for a free base call "
            "add_urdf(floating=True), or use 'urdftool export usd'",
        )


@rule(
    WARNING,
    on=("isaac",),
    effects={"isaac": "ignores the mimic joint, with an error in its log"},
)
def isaac_mimic_without_limits(robot: Robot) -> Iterator[Problem]:
    """A mimic joint or its leader rotates without limits, which PhysX rejects.

    PhysX requires finite limits of both rotating joints for ``NewtonMimicAPI`` and for
    ``PhysxMimicJointAPI``, and otherwise ignores the relation.
    """
    for joint in robot.joints:
        leader = robot.joint.get(joint.mimic.joint) if joint.mimic is not None else None
        if leader is None:
            continue
        endless = [part for part in (joint, leader) if part.type in ("revolute", "continuous")
                   and not all(map(math.isfinite, get_limits(part)))]  # fmt: skip
        if endless:
            names = " and ".join(f"'{part.name}'" for part in endless)
            yield Problem(
                joint,
                f"joint '{joint.name}' mimics '{leader.name}', but {names} has no limits, so PhysX "
                "ignores the relation; write limits",
                at=joint.mimic,
                data={"unlimited": [part.name for part in endless]},
            )


@rule(
    INFO,
    on=("newton", "isaac"),
    effects={
        "newton": "takes it for a URDF: macros and expressions are not expanded",
        "isaac": "reads only files that end in .urdf",
    },
)
def usd_importers_no_xacro(robot: Robot, description: Description) -> Iterator[Problem]:
    """A description for Newton or Isaac Sim is a xacro file, which their importers do not expand.

    Newton 1.8 reads the text as a URDF, so that it stops at the first expression in a number, and
    has no part that a macro makes. ``urdftool expand`` writes a URDF, and ``urdftool export usd``
    reads xacro.
    """
    if description.path.endswith(".xacro"):
        yield Problem(
            robot,
            "Newton and Isaac Sim do not expand xacro; write a URDF with 'urdftool expand', or use "
            "'urdftool export usd'",
        )
