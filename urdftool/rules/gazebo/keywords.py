"""The words that Gazebo's reader knows inside ``<gazebo>``.

sdformat turns a URDF into SDF. Of the children of a ``<gazebo>`` it converts the keywords here;
all others it copies as they are into the link, joint or model, where only what SDF has there is
read.
"""

from __future__ import annotations

from ..words import words

LINK_KEYWORDS = words(
    "material turnGravityOff mu1 mu2 fdir1 kp kd minDepth maxVel maxContacts selfCollide "
    "laserRetro dampingFactor collision visual canonicalBody"
)

JOINT_KEYWORDS = words(
    "springReference springStiffness provideFeedback implicitSpringDamper cfmDamping stopCfm "
    "stopErp fudgeFactor preserveFixedJoint disableFixedJointLumping"
)

ROBOT_KEYWORDS = frozenset(("static",))

KEYWORDS = LINK_KEYWORDS | JOINT_KEYWORDS | ROBOT_KEYWORDS

NUMBERS = words(
    "mu1 mu2 kp kd maxVel minDepth laserRetro dampingFactor stopCfm stopErp fudgeFactor "
    "springReference springStiffness maxContacts"
)
"""Those read with ``std::stod`` or ``std::stoi``, which throw where there is no number."""

FLAGS = words(
    "turnGravityOff selfCollide static provideFeedback implicitSpringDamper cfmDamping "
    "preserveFixedJoint disableFixedJointLumping"
)

SURFACE = words("mu1 mu2 fdir1 kp kd minDepth maxVel maxContacts laserRetro")
"""Those that are written into the collisions of a link."""

NOT_IN_GZ = words(
    "kp kd minDepth maxVel maxContacts dampingFactor laserRetro selfCollide provideFeedback "
    "implicitSpringDamper cfmDamping stopCfm stopErp fudgeFactor"
)
"""Those that nothing in new Gazebo reads."""


def is_true(text: str | None) -> bool:
    """Whether sdformat takes the value of a flag for true."""
    return text is not None and (text.lower() in ("true", "yes") or text == "1")
