"""Contact settings that MuJoCo has, and what is lost of ``<gazebo>``."""

from __future__ import annotations

from collections.abc import Iterable

from ...diagnostic import Severity
from ...model.elements import Collision, Link, Robot
from ...model.numbers import format_content, format_numbers_text
from ...model.settings import LOST_SETTINGS, SURFACE_OF_MUJOCO, Setting, Settings, get_number
from ..common.unexpressed import Reason, report_blocks, report_unwritten_settings
from ..written import Written

DEFAULT_FRICTION = "1 0.005 0.0001"
"""MuJoCo's sliding, torsional [m] and rolling [m] friction."""

USUAL_FRICTION = float(DEFAULT_FRICTION.split()[0])
"""MuJoCo's sliding friction of a geom."""

_DAMPS_JOINTS = Reason("MuJoCo damps joints, not bodies", Severity.WARNING)
_COLLIDES = Reason("bodies of a robot collide in MuJoCo unless they are excluded", Severity.INFO)
_SOFT_STOPS = Reason("limits have a softness of MuJoCo (solreflimit)", Severity.INFO)

MISSING: dict[str, Reason] = {
    "friction_direction": Reason("MuJoCo's geoms have no friction direction", Severity.WARNING),
    "contact_stiffness": Reason("contacts keep MuJoCo's stiffness (solref)", Severity.INFO),
    "contact_damping": Reason("contacts keep MuJoCo's damping (solref)", Severity.INFO),
    "correction_velocity": Reason(
        "MuJoCo has no limit of the contact correction velocity", Severity.INFO
    ),
    "contact_depth": Reason("MuJoCo has no such contact depth", Severity.INFO),
    "max_contacts": Reason(
        "MuJoCo limits the number of contacts of the whole model", Severity.INFO
    ),
    "laser_retro": Reason("MuJoCo has no laser intensity", Severity.WARNING),
    "linear_decay": _DAMPS_JOINTS,
    "angular_decay": _DAMPS_JOINTS,
    "self_collide": _COLLIDES,
    "implicit_spring_damper": Reason("MuJoCo always integrates damping implicitly", Severity.INFO),
    "stop_cfm": _SOFT_STOPS,
    "stop_erp": _SOFT_STOPS,
    "fudge_factor": Reason("a parameter of another solver", Severity.INFO),
    "provide_feedback": Reason("MuJoCo measures forces with sensors", Severity.INFO),
}
"""Why MuJoCo does not have settings, by the names of their rows."""

LOST: dict[str, str] = {
    "projector": "MuJoCo has no projectors",
    "audio_sink": "MuJoCo has no sound",
    "audio_source": "MuJoCo has no sound",
    "battery": "MuJoCo has no batteries",
    "particle_emitter": "MuJoCo has no particles",
    "gripper": "MuJoCo grasps by contact only",
    "include": "other models are not included",
}
"""Why elements of SDF in a block are not exported, by tag."""


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
            data = {LOST_SETTINGS: ("second_friction",)}
            written.report_loss("friction", text, at, kind="link", name=link.name, data=data)
        if bounce is not None and bounce.content:
            text = f"restitution {bounce.content:g} of '{link.name}' is not exported: MuJoCo's "
            text += "contacts are damped springs (solref)"
            data, at = {LOST_SETTINGS: ("restitution",)}, bounce.place
            written.report_loss("restitution", text, at, kind="link", name=link.name, data=data)
        if collision.surface is link.surface:
            return


def _is_written(row: Setting) -> bool:
    """Tell whether an export writes a setting, or reports it itself."""
    return bool(row.mjcf) or row.name == "restitution"


def report_gazebo_losses(robot: Robot, written: Written) -> None:
    """Report the settings and extensions that are not exported."""
    report_unwritten_settings(robot, written, _is_written, MISSING)
    report_blocks(robot, written, LOST)
    for plugin in robot.plugins:
        written.report_loss(
            "plugin",
            f"plugin {plugin.filename or plugin.name} is a Gazebo plugin and is not exported",
            plugin.place,
            kind="plugin",
            name=plugin.name,
            severity=Severity.INFO,
        )
