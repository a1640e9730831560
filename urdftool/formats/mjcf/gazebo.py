"""Contact settings that MuJoCo has, and what is lost of ``<gazebo>``."""

from __future__ import annotations

from collections.abc import Iterable

from ...diagnostic import Severity
from ...model.blocks import list_elements
from ...model.elements import Collision, GazeboExtension, Link, Robot
from ...model.numbers import format_content, format_numbers_text
from ...model.settings import SURFACE_OF_MUJOCO, Setting, Settings, Value, get_number, is_set
from ...source.document import Element
from ..common.unexpressed import report_unwritten_settings
from ..written import Written

DEFAULT_FRICTION = "1 0.005 0.0001"
"""MuJoCo's sliding, torsional [m] and rolling [m] friction."""

USUAL_FRICTION = float(DEFAULT_FRICTION.split()[0])
"""MuJoCo's sliding friction of a geom."""

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
    "stopCfm": ("limits have a softness of MuJoCo (solreflimit)", Severity.INFO),
    "stopErp": ("limits have a softness of MuJoCo (solreflimit)", Severity.INFO),
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


def get_surface_attributes(collision: Collision) -> dict[str, str]:
    """Return the attributes of the geoms of a collision for its friction and contact."""
    found, surface = {}, collision.surface
    usual = [float(part) for part in DEFAULT_FRICTION.split()]
    names = ("friction", "spinning_friction", "rolling_friction")
    numbers = [get_number(surface, name) for name in names]
    if any(number is not None for number in numbers):
        pairs = zip(numbers, usual, strict=True)
        found["friction"] = format_numbers_text(
            default if number is None else number for number, default in pairs
        )
    rows = [row for row in SURFACE_OF_MUJOCO if row.name not in names]
    return found | get_attributes(surface, rows)


def get_attributes(settings: Settings, rows: Iterable[Setting]) -> dict[str, str]:
    """Return the attributes of MJCF for settings, by name."""
    return {
        row.mjcf.partition(" ")[2]: format_content(settings[row.name].content)
        for row in rows
        if row.name in settings
    }


def report_surface_losses(link: Link, written: Written) -> None:
    """Report friction by direction and restitution, which geoms do not have."""
    for collision in link.collisions:
        one, two = (get_number(collision.surface, name) for name in ("friction", "second_friction"))
        bounce = collision.surface.get("restitution")
        one = USUAL_FRICTION if one is None else one
        if two is not None and one != two:
            text = f"friction of '{link.name}' is {one:g} and {two:g} by direction; MuJoCo's geoms "
            at = collision.surface["second_friction"].place
            text += f"have one, {one:g}"
            written.report_loss("friction", text, at, kind="link", name=link.name)
        if bounce is not None and bounce.content:
            text = f"restitution {bounce.content:g} of '{link.name}' is not exported: MuJoCo's "
            text += "contacts are damped springs (solref)"
            written.report_loss("restitution", text, bounce.place, kind="link", name=link.name)
        if collision.surface is link.surface:
            return


def _is_written(row: Setting) -> bool:
    """Tell whether an export writes a setting, or reports it itself."""
    return bool(row.mjcf) or row.name in ("restitution", "self_collide")


def _is_reported(value: Value) -> bool:
    """Tell whether the element of a ``<gazebo>`` block that holds a value is reported itself."""
    element = value.xml
    while element is not None and element.parent is not None:
        if element.parent.tag == "gazebo":
            return element.tag not in KNOWN
        element = element.parent
    return False


def _report_self_collision(robot: Robot, written: Written) -> None:
    """Report the flags of self-collision of a robot that was not read from URDF, once."""
    owners: list[Robot | Link] = [robot, *robot.links]
    flags = [one.settings["self_collide"] for one in owners if is_set(one.settings, "self_collide")]
    if flags:
        why, severity = LOST["self_collide"]
        text = f"self collide of robot '{robot.name}' is not written: {why}"
        written.report_loss(
            "setting", text, flags[0].place, kind="robot", name=robot.name, severity=severity
        )


def report_gazebo_losses(robot: Robot, written: Written) -> None:
    """Report the settings and extensions that are not exported."""
    report_unwritten_settings(robot, written, _is_written, _is_reported)
    if robot.xml is None:
        _report_self_collision(robot, written)
    for block, child in list_elements(robot):
        reference = block.reference
        if reference is None or reference in robot.link or reference in robot.joint:
            _report_keyword_loss(block, child, written)
    for plugin in robot.plugins:
        written.report_loss(
            "plugin",
            f"plugin {plugin.filename or plugin.name} is a Gazebo plugin and is not exported",
            plugin.place,
            kind="plugin",
            name=plugin.name,
            severity=Severity.INFO,
        )


def _report_keyword_loss(block: GazeboExtension, child: Element, written: Written) -> None:
    about = f" of '{block.reference}'" if block.reference else ""
    lost = LOST.get(child.tag)
    if lost is None and child.tag in KNOWN:
        return
    why, severity = lost or ("the element is unknown", Severity.INFO)
    written.report_loss(
        "gazebo",
        f"<{child.tag}>{about} is not exported: {why}",
        child.place,
        kind="gazebo",
        name=block.reference or "",
        severity=severity,
    )
