"""Settings of the world around a robot: ``<option>`` of MJCF, and ``<world>`` of SDF, as tables.

The formats share gravity alone: wind and magnetic field have other effects, or units, in MuJoCo.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ..source.document import Element
from .elements import Robot
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
    Setting("jacobian", "text", "", "", "auto", mjcf="option jacobian"),
    Setting("solver", "text", "", "", "Newton", mjcf="option solver"),
    Setting("disabled", "text", "", "", "", mjcf="option disableflags"),
    Setting("enabled", "text", "", "", "", mjcf="option enableflags"),
)
"""Settings of the world around a robot, of ``<option>`` of MJCF, with MuJoCo's defaults."""

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

BY_FORMAT = {"mjcf": OF_MUJOCO, "urdf": OF_MUJOCO, "sdf": OF_SDF}
"""Settings of the world of a robot by its format; a URDF has those in ``<mujoco>``."""


def list_changed(robot: Robot) -> Iterator[tuple[Setting, Value]]:
    """Yield the settings of the world of a robot that are not the defaults of its format."""
    for row in BY_FORMAT.get(robot.format, ()):
        value = robot.world.get(row.name)
        if value is not None and value.content != row.default:
            yield row, value


_WORDS: dict[str, tuple[Content, ...]] = {
    "integrator": ("Euler", "RK4", "implicit", "implicitfast"),
    "cone": ("pyramidal", "elliptic"),
    "jacobian": ("dense", "sparse", "auto"),
    "solver": ("PGS", "CG", "Newton"),
}
"""Words that MuJoCo's reader accepts, by the name of the row."""

_ENABLED = ("override", "energy", "fwdinv", "invdiscrete", "sleep")
"""Flags of ``<option>`` that are off by default in every version of MuJoCo."""


def read_options(extensions: Iterable[Element]) -> Settings:
    """Return the settings of the world in the ``<option>`` elements of ``<mujoco>`` elements."""
    values: Settings = {}
    flags: dict[str, tuple[Element, str]] = {}
    for option in (one for each in extensions for one in each.list_children("option")):
        for row in OF_MUJOCO:
            text = option.get(row.mjcf.partition(" ")[2])
            content = None if text is None else parse(row.kind, text.strip())
            if content is not None and content in _WORDS.get(row.name, (content,)):
                values[row.name] = Value(option, content)
        for flag in option.list_children("flag"):
            flags |= {name: (flag, state) for name, state in flag.attributes.items()}
    for name, state, is_extra in (("disabled", "disable", False), ("enabled", "enable", True)):
        chosen = [flag for flag, (_, text) in flags.items() if text == state]
        words = [flag for flag in chosen if (flag in _ENABLED) is is_extra]
        if words:
            values[name] = Value(flags[words[0]][0], " ".join(sorted(words)))
    return values
