"""Keywords that sdformat converts inside ``<gazebo>``.

sdformat converts a URDF to SDF. It converts the children of ``<gazebo>`` that are keywords. It
copies all others unchanged into the link, joint or model, where readers ignore them if they are not
SDF.
"""

from __future__ import annotations

from ...model.settings import JOINT_TAGS, LUMPING_TAGS, OF_LINKS, SURFACE_TAGS, TABLES
from ..words import split_words

LINK_KEYWORDS = (
    SURFACE_TAGS
    | {tag for row in OF_LINKS for tag in (*row.tags, row.opposite) if tag}
    | {"material", "collision", "visual", "canonicalBody"}
)

JOINT_KEYWORDS = JOINT_TAGS | LUMPING_TAGS

ROBOT_KEYWORDS = frozenset(("static",))

KEYWORDS = LINK_KEYWORDS | JOINT_KEYWORDS | ROBOT_KEYWORDS

NUMBERS = frozenset(
    tag for t in TABLES for r in t if r.kind in ("number", "count") for tag in r.tags
)
"""Keywords read with ``std::stod`` or ``std::stoi``, which throw if the text is not a number."""

NOT_IN_GZ = split_words(
    "kp kd minDepth maxVel maxContacts dampingFactor laserRetro selfCollide provideFeedback "
    "implicitSpringDamper cfmDamping stopCfm stopErp fudgeFactor"
)
"""Keywords that new Gazebo ignores."""
