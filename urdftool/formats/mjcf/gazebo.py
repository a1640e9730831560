"""Settings of links, joints and the robot in ``<gazebo>`` that MuJoCo supports."""

from __future__ import annotations

from ...diagnostic import Severity
from ...model.elements import GazeboExtension, Robot
from ...model.read import number
from ...rules.gazebo.block_values import is_false
from ...rules.gazebo.keywords import is_true
from ..common.contact_friction import get_gazebo_friction
from ..written import Written
from .digits import number_text

DEFAULT_FRICTION = "1 0.005 0.0001"
"""MuJoCo's sliding, torsional [m] and rolling [m] friction."""

# keyword -> why it is not exported, and the severity of the loss
LOST: dict[str, tuple[str, Severity]] = {
    "fdir1": ("MuJoCo's geoms have no friction direction", Severity.WARNING),
    "kp": ("contacts keep MuJoCo's stiffness (solref)", Severity.INFO),
    "kd": ("contacts keep MuJoCo's damping (solref)", Severity.INFO),
    "maxVel": ("MuJoCo has no limit of the contact correction velocity", Severity.INFO),
    "minDepth": ("MuJoCo has no such contact depth", Severity.INFO),
    "maxContacts": ("MuJoCo limits the number of contacts of the whole model", Severity.INFO),
    "laserRetro": ("MuJoCo has no laser intensity", Severity.WARNING),
    "dampingFactor": ("MuJoCo damps joints, not bodies", Severity.WARNING),
    "selfCollide": ("bodies of a robot collide in MuJoCo unless they are excluded", Severity.INFO),
    "self_collide": ("bodies of a robot collide in MuJoCo unless they are excluded", Severity.INFO),
    "implicitSpringDamper": ("MuJoCo always integrates damping implicitly", Severity.INFO),
    "cfmDamping": ("MuJoCo always integrates damping implicitly", Severity.INFO),
    "stopCfm": ("limits keep MuJoCo's softness (solreflimit)", Severity.INFO),
    "stopErp": ("limits keep MuJoCo's softness (solreflimit)", Severity.INFO),
    "fudgeFactor": ("a parameter of another solver", Severity.INFO),
    "provideFeedback": ("MuJoCo measures forces with sensors", Severity.INFO),
    "projector": ("MuJoCo has no projectors", Severity.WARNING),
    "audio_sink": ("MuJoCo has no sound", Severity.WARNING),
    "audio_source": ("MuJoCo has no sound", Severity.WARNING),
    "battery": ("MuJoCo has no batteries", Severity.WARNING),
    "particle_emitter": ("MuJoCo has no particles", Severity.WARNING),
    "gripper": ("MuJoCo grasps by contact only", Severity.WARNING),
    "include": ("other models are not included", Severity.WARNING),
    "velocity_decay": ("MuJoCo damps joints, not bodies", Severity.WARNING),
}

KNOWN = frozenset(
    ("mu1", "mu2", "mu", "material", "turnGravityOff", "gravity", "sensor", "light", "plugin",
     "springStiffness", "springReference", "static", "preserveFixedJoint",
     "disableFixedJointLumping", "canonicalBody", "visual", "collision", "pose", "joint")
)  # fmt: skip
"""Keywords that are exported or need no export."""


def link_friction(robot: Robot, link: str) -> dict[str, str]:
    """Return the friction attributes of a link's collision geoms, from Gazebo's ``mu1``.

    MuJoCo uses the larger friction of two geoms, Gazebo the smaller. A friction below MuJoCo's
    default gets a ``priority``, so that it is used unchanged; a caster with friction 0 slides.
    """
    sliding = get_gazebo_friction(robot, link)
    if sliding is None:
        return {}
    usual = DEFAULT_FRICTION.split()
    attributes = {"friction": " ".join([number_text(sliding), *usual[1:]])}
    return attributes | ({"priority": "1"} if sliding < float(usual[0]) else {})


def link_is_weightless(robot: Robot, link: str) -> bool:
    """Tell whether gravity is disabled for a link."""
    weightless = False
    for block in robot.extensions.get(link, ()):
        off, gravity = block.get_value("turnGravityOff"), block.get_value("gravity")
        if off:
            weightless = is_true(off)
        if gravity:
            weightless = is_false(gravity)
    return weightless


def get_joint_spring(robot: Robot, joint: str) -> tuple[float, float] | None:
    """Return stiffness [N·m/rad, N/m] and reference [rad, m] of a joint's spring.

    Return None if Gazebo defines no spring, or one with zero stiffness.
    """
    found = None
    for block in robot.extensions.get(joint, ()):
        stiffness = number(block.get_value("springStiffness"))
        if stiffness:
            found = stiffness, number(block.get_value("springReference")) or 0.0
    return found


def report_gazebo_losses(robot: Robot, written: Written) -> None:
    """Report the extensions that are not exported."""
    for block in robot.gazebo:
        reference = block.reference
        if reference is not None and reference not in robot.link and reference not in robot.joint:
            written.report_loss(
                "gazebo",
                (
                    f"<gazebo reference='{reference}'> does not name a link or joint of the "
                    "robot; it "
                    "is not exported"
                ),
                block.place,
                kind="gazebo",
                name=reference,
            )
            continue
        _report_keyword_losses(block, written)
        _add_unequal_friction(block, written)
    for plugin in robot.plugins:
        written.report_loss(
            "plugin",
            f"plugin {plugin.filename or plugin.name} is a Gazebo plugin and is not exported",
            plugin.place,
            kind="plugin",
            name=plugin.name,
            severity=Severity.INFO,
        )


def _report_keyword_losses(block: GazeboExtension, written: Written) -> None:
    about = f" of '{block.reference}'" if block.reference else ""
    for child in block.element.children:
        lost = LOST.get(child.tag)
        if lost is None and child.tag in KNOWN:
            continue
        why, severity = lost or ("the element is unknown", Severity.INFO)
        written.report_loss(
            "gazebo",
            f"<{child.tag}>{about} is not exported: {why}",
            child.place,
            kind="gazebo",
            name=block.reference or "",
            severity=severity,
        )


def _add_unequal_friction(block: GazeboExtension, written: Written) -> None:
    one, two = number(block.get_value("mu1")), number(block.get_value("mu2"))
    if one is not None and two is not None and one != two:
        written.report_loss(
            "friction",
            f"friction of '{block.reference}' is {one:g} and {two:g} by direction; MuJoCo's geoms "
            f"have one, {one:g}",
            block.place,
            kind="link",
            name=block.reference or "",
        )
