"""Check properties that importers of Isaac Sim and Newton change."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...mechanics.spatial_inertia import link_inertia
from ...mechanics.tensor import compute_principal_moments
from ...model.elements import Robot
from ..rule import INFO, WARNING, Problem, rule

_LEAST_MOMENT = 1e-10  # [kg·m²]
_LEAST_PART = 1e-6  # of the largest moment


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
        if low < max(_LEAST_PART * high, _LEAST_MOMENT):
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
        if dynamics is not None and (dynamics.friction or dynamics.damping):
            yield Problem(
                joint,
                f"friction and damping of joint '{joint.name}' are dropped by the importer of "
                "Isaac Sim 6.1; set them in the configuration, or use 'urdftool export usd'",
                at=dynamics,
            )


@rule(
    INFO,
    on=("newton", "isaac"),
    effects={"newton": "has another name"},
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
