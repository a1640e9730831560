"""Tags in ``<gazebo reference="…">`` blocks: their type of value, and the SDF element they set.

One table for each kind of reference; the page of the mapping is generated from them.
"""

from __future__ import annotations

from typing import NamedTuple


class Keyword(NamedTuple):
    """A tag.

    Attributes:
        holds: Type of value: ``number``, ``count``, ``vector`` (3 numbers) or ``flag``.
        path: Path of the SDF element, below the element of the link or joint.
        note: Additional note for the page of the mapping.
        also: A second path, which older readers use.
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
"""Tags of a link that apply to each of its collisions."""

LINK_KEYWORDS = {
    "selfCollide": Keyword("flag", "self_collide"),
    "turnGravityOff": Keyword("flag", "gravity", "negated"),
    "dampingFactor": Keyword("number", "velocity_decay", "both linear and angular"),
}
"""Tags of a link that apply to the link."""

LINK_ELEMENTS = frozenset(
    ("gravity", "self_collide", "velocity_decay", "enable_wind", "kinematic", "must_be_base_link")
)
"""Elements of an SDF link that a block may hold unchanged; each occurs once."""

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
"""Tags of a fixed joint that prevent its lumping; the joint stays fixed, also with the second."""

IGNORED = ("canonicalBody",)
"""Tags that Gazebo ignores, too."""
