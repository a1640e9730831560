"""Settings of the world around a robot, as tables: of MJCF, SDF and USD.

The formats share gravity alone: wind and magnetic field have other effects, or units, in MuJoCo.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ..source.document import Element
from .elements import Robot
from .numbers import describe_content
from .settings import Content, Setting, Settings, Value, add_kinds, parse

_GRAVITY = "physics:gravityMagnitude"

OF_MUJOCO = (
    Setting("integrator", "", "", "Euler", mjcf="option integrator", kind="text"),
    Setting("cone", "", "", "pyramidal", mjcf="option cone", kind="text"),
    Setting(
        "gravity",
        "m/s²",
        "gravity",
        (0.0, 0.0, -9.81),
        mjcf="option gravity",
        usd=_GRAVITY,
        kind="vector",
    ),
    Setting("wind", "m/s", "", (0.0, 0.0, 0.0), mjcf="option wind", kind="vector"),
    Setting("magnetic", "", "", (0.0, -0.5, 0.0), mjcf="option magnetic", kind="vector"),
    Setting("density", "kg/m³", "", 0.0, mjcf="option density", kind="number"),
    Setting("viscosity", "Pa·s", "", 0.0, mjcf="option viscosity", kind="number"),
    Setting("timestep", "s", "", 0.002, mjcf="option timestep", kind="number"),
    Setting("impratio", "", "", 1.0, mjcf="option impratio", kind="number"),
    Setting("tolerance", "", "", 1e-8, mjcf="option tolerance", kind="number"),
    Setting("iterations", "", "", 100.0, mjcf="option iterations", kind="count"),
    Setting("ls_tolerance", "", "", 0.01, mjcf="option ls_tolerance", kind="number"),
    Setting("ls_iterations", "", "", 50.0, mjcf="option ls_iterations", kind="count"),
    Setting("noslip_tolerance", "", "", 1e-6, mjcf="option noslip_tolerance", kind="number"),
    Setting("noslip_iterations", "", "", 0.0, mjcf="option noslip_iterations", kind="count"),
    Setting("ccd_tolerance", "", "", 1e-6, mjcf="option ccd_tolerance", kind="number"),
    Setting("ccd_iterations", "", "", 35.0, mjcf="option ccd_iterations", kind="count"),
    Setting("sdf_iterations", "", "", 10.0, mjcf="option sdf_iterations", kind="count"),
    Setting("sdf_initpoints", "", "", 40.0, mjcf="option sdf_initpoints", kind="count"),
    Setting("sleep_tolerance", "", "", 1e-3, mjcf="option sleep_tolerance", kind="number"),
    Setting("contact_margin", "m", "", 0.0, mjcf="option o_margin", kind="number"),
    Setting("contact_solref", "", "", (0.02, 1.0), mjcf="option o_solref", kind="list"),
    Setting(
        "contact_solimp", "", "", (0.9, 0.95, 0.001, 0.5, 2.0), mjcf="option o_solimp", kind="list"
    ),
    Setting(
        "contact_friction",
        "",
        "",
        (1.0, 1.0, 0.005, 0.0001, 0.0001),
        mjcf="option o_friction",
        kind="list",
    ),
    Setting("disabled_actuators", "", "", "", mjcf="option actuatorgroupdisable", kind="text"),
    Setting("jacobian", "", "", "auto", mjcf="option jacobian", kind="text"),
    Setting("solver", "", "", "Newton", mjcf="option solver", kind="text"),
    Setting("disabled", "", "", "", mjcf="option disableflags", kind="text"),
    Setting("enabled", "", "", "", mjcf="option enableflags", kind="text"),
)
"""Settings of the world around a robot: ``<option>`` of MJCF, with the defaults of MuJoCo 4.0."""

OF_SDF = add_kinds("world", (
    Setting("gravity", "m/s²", "gravity", (0.0, 0.0, -9.8), mjcf="option gravity",
            usd=_GRAVITY, also="physics/gravity"),
    Setting("wind_velocity", "m/s", "wind/linear_velocity", (0.0, 0.0, 0.0)),
    Setting("magnetic_field", "T", "magnetic_field", (6e-06, 2.3e-05, -4.2e-05),
            also="physics/magnetic_field"),
    Setting("temperature", "K", "atmosphere/temperature", 288.15),
    Setting("temperature_gradient", "K/m", "atmosphere/temperature_gradient", -0.0065),
    Setting("pressure", "Pa", "atmosphere/pressure", 101325.0),
))  # fmt: skip
"""Settings of ``<world>`` of SDF, with the defaults of its specification.

Gravity and magnetic field are in ``<physics>`` before SDF 1.6.
"""

OF_USD = tuple(row for row in OF_MUJOCO if row.usd)
"""Settings of a ``PhysicsScene`` of USD, of which Newton has the same gravity by default."""

_CONTACT = ("collisions", "surface", "contact pairs")

_DECIDED: dict[str, tuple[str, ...]] = {
    "gravity": ("gravity",),
    "wind": ("link flags",),
    "density": ("link flags",),
    "viscosity": ("link flags",),
    "magnetic": ("sensors",),
    "disabled_actuators": ("actuators",),
    "contact_margin": _CONTACT,
    "contact_solref": ("surface",),
    "contact_solimp": ("surface",),
    "contact_friction": ("surface",),
    "wind_velocity": ("link flags",),
    "magnetic_field": ("sensors",),
    "temperature": ("sensors",),
    "temperature_gradient": ("sensors",),
    "pressure": ("sensors",),
}
"""What of a robot depends on a setting of its world, in the words of the rows of a comparison."""

_DECIDED_BY_FLAG: dict[str, tuple[str, ...]] = {
    "constraint": ("limits", "joint physics", "tree", "loops", *_CONTACT),
    "equality": ("tree", "loops"),
    "frictionloss": ("joint physics",),
    "limit": ("limits",),
    "contact": _CONTACT,
    "spring": ("joint physics",),
    "damper": ("joint physics",),
    "gravity": ("gravity",),
    "clampctrl": ("actuators", "limits"),
    "filterparent": ("contact pairs",),
    "actuation": ("actuators",),
    "refsafe": ("surface",),
    "sensor": ("sensors",),
    "override": _CONTACT,
}
"""The same for a flag of ``<option>`` that is not as by default; others concern the solver."""

BY_FORMAT = {"mjcf": OF_MUJOCO, "urdf": OF_MUJOCO, "sdf": OF_SDF, "usd": OF_USD}
"""Settings of the world of a robot by its format; a URDF has those in ``<mujoco>``."""


def list_changed(robot: Robot) -> Iterator[tuple[Setting, Value]]:
    """Yield the settings of the world of a robot that are not the defaults of its format."""
    for row in BY_FORMAT.get(robot.format, ()):
        value = robot.world.get(row.name)
        if value is not None and value.content != row.default:
            yield row, value


def describe_setting(row: Setting, content: Content) -> str:
    """Describe a setting of a world with its value."""
    value = describe_content(content)
    return f"{row.name.replace('_', ' ')} {f'{value:g}' if isinstance(value, float) else value}"


def list_decided(row: Setting, content: Content) -> tuple[str, ...]:
    """Return what of a robot depends on a setting of its world, in the words of the rows.

    Args:
        row: The setting.
        content: Its value; of flags, those that count.
    """
    if row.name not in _FLAGS:
        return _DECIDED.get(row.name, ())
    found = (name for flag in str(content).split() for name in _DECIDED_BY_FLAG.get(flag, ()))
    return tuple(dict.fromkeys(found))


_FLAGS = ("disabled", "enabled")
"""Settings that are the names of flags."""

_WORDS: dict[str, tuple[Content, ...]] = {
    "integrator": ("Euler", "RK4", "implicit", "implicitfast"),
    "cone": ("pyramidal", "elliptic"),
    "jacobian": ("dense", "sparse", "auto"),
    "solver": ("PGS", "CG", "Newton"),
}
"""Words that MuJoCo's reader accepts, by the name of the row."""

_ENABLED = ("override", "energy", "fwdinv", "invdiscrete", "sleep", "diagexact", "ipc",
            "speculative")  # fmt: skip
"""Flags of ``<option>`` that are off by default in every version of MuJoCo that has them."""


def read_options(extensions: Iterable[Element]) -> Settings:
    """Return the settings of the world in the ``<option>`` elements of ``<mujoco>`` elements."""
    values: Settings = {}
    flags: dict[str, tuple[Element, str]] = {}
    for option in (one for each in extensions for one in each.list_children("option")):
        for row in OF_MUJOCO:
            text = option.get(row.mjcf.partition(" ")[2])
            content = None if text is None else parse(row.kind, text.strip())
            if content is not None and _is_accepted(row, content):
                values[row.name] = Value(option, content)
        for flag in option.list_children("flag"):
            flags |= {name: (flag, state) for name, state in flag.attributes.items()}
    for name, state, is_extra in (("disabled", "disable", False), ("enabled", "enable", True)):
        chosen = [flag for flag, (_, text) in flags.items() if text == state]
        words = [flag for flag in chosen if (flag in _ENABLED) is is_extra]
        if words:
            values[name] = Value(flags[words[0]][0], " ".join(sorted(words)))
    return values


def _is_accepted(row: Setting, content: Content) -> bool:
    """Tell whether MuJoCo's reader accepts a value: one of its words, or not too many numbers."""
    if isinstance(content, tuple) and isinstance(row.default, tuple):
        return len(content) <= len(row.default)
    return content in _WORDS.get(row.name, (content,))
