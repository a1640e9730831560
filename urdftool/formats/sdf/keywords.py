"""The tags of ``<gazebo reference="…">``: what each holds, and where SDF has it.

One table for each kind of thing that a block refers to. The page of the mapping is made from them.
"""

from __future__ import annotations

from typing import NamedTuple


class Keyword(NamedTuple):
    """A tag.

    Attributes:
        holds: ``number``, ``count``, ``vector`` (3 numbers) or ``flag``.
        path: Where SDF has it, below the element it belongs to.
        note: What else there is to know, for the page.
        also: A second place, which older readers look at.
    """

    holds: str
    path: str
    note: str = ""
    also: str = ""


COLLISION_KEYWORDS = {
    "mu1": Keyword("number", "surface/friction/ode/mu"),
    "mu2": Keyword("number", "surface/friction/ode/mu2"),
    "fdir1": Keyword("vector", "surface/friction/ode/fdir1", "in the frame of the collision"),
    "kp": Keyword("number", "surface/contact/ode/kp"),
    "kd": Keyword("number", "surface/contact/ode/kd"),
    "maxVel": Keyword("number", "surface/contact/ode/max_vel"),
    "minDepth": Keyword("number", "surface/contact/ode/min_depth"),
    "maxContacts": Keyword("count", "max_contacts"),
    "laserRetro": Keyword(
        "number", "laser_retro", "for gz in each visual too, where its lidar looks"
    ),
}
"""Tags of a link that go into each of its collisions, whatever their names."""

LINK_KEYWORDS = {
    "selfCollide": Keyword("flag", "self_collide"),
    "turnGravityOff": Keyword("flag", "gravity", "negated"),
    "dampingFactor": Keyword("number", "velocity_decay", "both linear and angular"),
}
"""Tags of a link that go into the link."""

LINK_ELEMENTS = frozenset(
    ("gravity", "self_collide", "velocity_decay", "enable_wind", "kinematic", "must_be_base_link")
)
"""Elements of an SDF link that a block may hold as they are; there is one of each."""

JOINT_KEYWORDS = {
    "stopCfm": Keyword("number", "physics/ode/limit/cfm"),
    "stopErp": Keyword("number", "physics/ode/limit/erp"),
    "fudgeFactor": Keyword("number", "physics/ode/fudge_factor"),
    "implicitSpringDamper": Keyword(
        "flag", "physics/ode/implicit_spring_damper", "", "physics/ode/cfm_damping"
    ),
    "cfmDamping": Keyword(
        "flag",
        "physics/ode/implicit_spring_damper",
        "the old name of it",
        "physics/ode/cfm_damping",
    ),
    "provideFeedback": Keyword("flag", "physics/provide_feedback"),
    "springStiffness": Keyword("number", "axis/dynamics/spring_stiffness"),
    "springReference": Keyword("number", "axis/dynamics/spring_reference"),
}
"""Tags of a joint."""

LUMPING_KEYWORDS = ("preserveFixedJoint", "disableFixedJointLumping")
"""Tags of a fixed joint that keep it; it stays fixed, also by the second."""

IGNORED = ("canonicalBody",)
"""Tags that Gazebo ignores too."""
