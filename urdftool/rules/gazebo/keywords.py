"""Keywords that sdformat converts inside ``<gazebo>``.

sdformat converts a URDF to SDF. It converts the children of ``<gazebo>`` that are keywords. It
copies all others unchanged into the link, joint or model, where readers ignore them if they are not
SDF.
"""

from __future__ import annotations

from ..words import split_words

LINK_KEYWORDS = split_words(
    "material turnGravityOff mu1 mu2 fdir1 kp kd minDepth maxVel maxContacts selfCollide "
    "laserRetro dampingFactor collision visual canonicalBody"
)

JOINT_KEYWORDS = split_words(
    "springReference springStiffness provideFeedback implicitSpringDamper cfmDamping stopCfm "
    "stopErp fudgeFactor preserveFixedJoint disableFixedJointLumping"
)

ROBOT_KEYWORDS = frozenset(("static",))

KEYWORDS = LINK_KEYWORDS | JOINT_KEYWORDS | ROBOT_KEYWORDS

NUMBERS = split_words(
    "mu1 mu2 kp kd maxVel minDepth laserRetro dampingFactor stopCfm stopErp fudgeFactor "
    "springReference springStiffness maxContacts"
)
"""Keywords read with ``std::stod`` or ``std::stoi``, which throw if the text is not a number."""

FLAGS = split_words(
    "turnGravityOff selfCollide static provideFeedback implicitSpringDamper cfmDamping "
    "preserveFixedJoint disableFixedJointLumping"
)

SURFACE = split_words("mu1 mu2 fdir1 kp kd minDepth maxVel maxContacts laserRetro")
"""Keywords written into the collisions of a link."""

NOT_IN_GZ = split_words(
    "kp kd minDepth maxVel maxContacts dampingFactor laserRetro selfCollide provideFeedback "
    "implicitSpringDamper cfmDamping stopCfm stopErp fudgeFactor"
)
"""Keywords that new Gazebo ignores."""


def is_true(text: str | None) -> bool:
    """Tell whether sdformat reads a flag as true."""
    return text is not None and (text.lower() in ("true", "yes") or text == "1")
