"""Tags in ``<gazebo reference="…">`` blocks, and the SDF element that each sets.

One table for each kind of reference; the page of the mapping is generated from them. The kind of a
tag's value is known to :func:`urdftool.rules.gazebo.block_values.get_kind`.
"""

from __future__ import annotations

from typing import NamedTuple


class Keyword(NamedTuple):
    """A tag.

    Attributes:
        path: Path of the SDF element, below the element of the link or joint.
        note: Additional note for the page of the mapping.
        also: A second path, which older readers use.
    """

    path: str
    note: str = ""
    also: str = ""


COLLISION_KEYWORDS = {
    "mu1": Keyword("surface/friction/ode/mu"),
    "mu2": Keyword("surface/friction/ode/mu2"),
    "fdir1": Keyword("surface/friction/ode/fdir1", "in the frame of the collision"),
    "kp": Keyword("surface/contact/ode/kp"),
    "kd": Keyword("surface/contact/ode/kd"),
    "maxVel": Keyword("surface/contact/ode/max_vel"),
    "minDepth": Keyword("surface/contact/ode/min_depth"),
    "maxContacts": Keyword("max_contacts"),
    "laserRetro": Keyword("laser_retro", "for gz in each visual too, where its lidar looks"),
}
"""Tags of a link that apply to each of its collisions."""

LINK_KEYWORDS = {
    "selfCollide": Keyword("self_collide"),
    "turnGravityOff": Keyword("gravity", "negated"),
    "dampingFactor": Keyword("velocity_decay", "both linear and angular"),
}
"""Tags of a link that apply to the link."""

LINK_ELEMENTS = frozenset(
    ("gravity", "self_collide", "velocity_decay", "enable_wind", "kinematic", "must_be_base_link")
)
"""Elements of an SDF link that a block may hold unchanged; each occurs once."""

JOINT_KEYWORDS = {
    "stopCfm": Keyword("physics/ode/limit/cfm"),
    "stopErp": Keyword("physics/ode/limit/erp"),
    "fudgeFactor": Keyword("physics/ode/fudge_factor"),
    "implicitSpringDamper": Keyword(
        "physics/ode/implicit_spring_damper", "", "physics/ode/cfm_damping"
    ),
    "cfmDamping": Keyword(
        "physics/ode/implicit_spring_damper",
        "the old name of it",
        "physics/ode/cfm_damping",
    ),
    "provideFeedback": Keyword("physics/provide_feedback"),
    "springStiffness": Keyword("axis/dynamics/spring_stiffness"),
    "springReference": Keyword("axis/dynamics/spring_reference"),
}
"""Tags of a joint."""

LUMPING_KEYWORDS = ("preserveFixedJoint", "disableFixedJointLumping")
"""Tags of a fixed joint that prevent its lumping; the joint stays fixed, also with the second."""

IGNORED = ("canonicalBody",)
"""Tags that Gazebo ignores, too."""
