"""Settings of the world around a robot: ``<option>`` of MJCF, and ``<world>`` of SDF, as tables.

The formats share gravity alone: wind and magnetic field have other effects, or units, in MuJoCo.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ..source.document import Element
from .elements import Robot
from .numbers import describe_content
from .settings import Content, Setting, Settings, Value, parse

OF_MUJOCO = (
    Setting("integrator", "text", "", "", "Euler", mjcf="option integrator"),
    Setting("cone", "text", "", "", "pyramidal", mjcf="option cone"),
    Setting("gravity", "vector", "m/s²", "gravity", (0.0, 0.0, -9.81), mjcf="option gravity"),
    Setting("wind", "vector", "m/s", "", (0.0, 0.0, 0.0), mjcf="option wind"),
    Setting("magnetic", "vector", "", "", (0.0, -0.5, 0.0), mjcf="option magnetic"),
    Setting("density", "number", "kg/m³", "", 0.0, mjcf="option density"),
    Setting("viscosity", "number", "Pa·s", "", 0.0, mjcf="option viscosity"),
    Setting("timestep", "number", "s", "", 0.002, mjcf="option timestep"),
    Setting("impratio", "number", "", "", 1.0, mjcf="option impratio"),
    Setting("tolerance", "number", "", "", 1e-8, mjcf="option tolerance"),
    Setting("iterations", "count", "", "", 100.0, mjcf="option iterations"),
    Setting("ls_tolerance", "number", "", "", 0.01, mjcf="option ls_tolerance"),
    Setting("ls_iterations", "count", "", "", 50.0, mjcf="option ls_iterations"),
    Setting("noslip_tolerance", "number", "", "", 1e-6, mjcf="option noslip_tolerance"),
    Setting("noslip_iterations", "count", "", "", 0.0, mjcf="option noslip_iterations"),
    Setting("ccd_tolerance", "number", "", "", 1e-6, mjcf="option ccd_tolerance"),
    Setting("ccd_iterations", "count", "", "", 35.0, mjcf="option ccd_iterations"),
    Setting("sdf_iterations", "count", "", "", 10.0, mjcf="option sdf_iterations"),
    Setting("sdf_initpoints", "count", "", "", 40.0, mjcf="option sdf_initpoints"),
    Setting("sleep_tolerance", "number", "", "", 1e-3, mjcf="option sleep_tolerance"),
    Setting("contact_margin", "number", "m", "", 0.0, mjcf="option o_margin"),
    Setting("contact_solref", "list", "", "", (0.02, 1.0), mjcf="option o_solref"),
    Setting("contact_solimp", "list", "", "", (0.9, 0.95, 0.001, 0.5, 2.0), mjcf="option o_solimp"),
    Setting(
        "contact_friction",
        "list",
        "",
        "",
        (1.0, 1.0, 0.005, 0.0001, 0.0001),
        mjcf="option o_friction",
    ),
    Setting("disabled_actuators", "text", "", "", "", mjcf="option actuatorgroupdisable"),
    Setting("jacobian", "text", "", "", "auto", mjcf="option jacobian"),
    Setting("solver", "text", "", "", "Newton", mjcf="option solver"),
    Setting("disabled", "text", "", "", "", mjcf="option disableflags"),
    Setting("enabled", "text", "", "", "", mjcf="option enableflags"),
)
"""Settings of the world around a robot: ``<option>`` of MJCF, with the defaults of MuJoCo 4.0."""

OF_SDF = (
    Setting("gravity", "vector", "m/s²", "gravity", (0.0, 0.0, -9.8), mjcf="option gravity",
            also="physics/gravity"),
    Setting("wind_velocity", "vector", "m/s", "wind/linear_velocity", (0.0, 0.0, 0.0)),
    Setting("magnetic_field", "vector", "T", "magnetic_field", (6e-06, 2.3e-05, -4.2e-05),
            also="physics/magnetic_field"),
    Setting("temperature", "number", "K", "atmosphere/temperature", 288.15),
    Setting("temperature_gradient", "number", "K/m", "atmosphere/temperature_gradient", -0.0065),
    Setting("pressure", "number", "Pa", "atmosphere/pressure", 101325.0),
)  # fmt: skip
"""Settings of ``<world>`` of SDF, with the defaults of its specification.

Gravity and magnetic field are in ``<physics>`` before SDF 1.6.
"""

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

BY_FORMAT = {"mjcf": OF_MUJOCO, "urdf": OF_MUJOCO, "sdf": OF_SDF}
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
