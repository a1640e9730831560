"""Gains, armature and damping of joints from a TOML file, for exports with actuators.

A table ``[joints."NAME"]`` sets the joint of that name, or all joints that match a pattern such as
``*_hip_joint``. For each key, an exact name takes precedence over patterns, and a later pattern
over an earlier one::

    [joints."*"]
    armature = 0.01           # kg·m² (kg for a slide)

    [joints."*_knee_joint"]
    kp = 120                  # N·m/rad (N/m)
    kd = 3                    # N·m·s/rad (N·s/m)
    force-range = [-60, 60]   # N·m (N), or one number for both directions
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from ...errors import ConfigError
from ...model.settings import RESISTANCE, Setting
from ...suggestions import suggest_name
from .option import Option

KEYS = ("kp", "kd", *sorted(row.name for row in RESISTANCE), "force-range", "type")
TYPES = ("position", "velocity", "motor")

_TABLE = "joints"


def make_file_option(keys: Sequence[str] = KEYS, end: str = ".") -> Option:
    """Make the option with the path of such a file, of which an export uses some keys."""
    *others, last = keys
    text = f"TOML file with {', '.join(others)} and {last} under "
    return Option(f'{text}[joints."NAME or PATTERN"]{end}', kind=Path, metavar="FILE")


@dataclass(frozen=True)
class JointSettings:
    """Settings of one joint; None where the file sets none.

    Attributes:
        kp: Position gain [N·m/rad or N/m].
        kd: Velocity gain [N·m·s/rad or N·s/m].
        armature: Rotor inertia reflected at the joint [kg·m² or kg].
        damping: Viscous damping of the joint [N·m·s/rad or N·s/m].
        friction: Dry friction of the joint [N·m or N].
        force_range: Lowest and highest force of the actuator [N·m or N].
        type: Kind of the actuator.
        command_range: Lowest and highest command, from the description; the file has none.
    """

    kp: float | None = None
    kd: float | None = None
    armature: float | None = None
    damping: float | None = None
    friction: float | None = None
    force_range: tuple[float, float] | None = None
    type: str | None = None
    command_range: tuple[float, float] | None = None

    def override(self, other: JointSettings) -> JointSettings:
        """Return these settings, with missing values taken from ``other``."""
        values = {
            field.name: getattr(other, field.name)
            if getattr(self, field.name) is None
            else getattr(self, field.name)
            for field in fields(self)
        }
        return JointSettings(**values)

    def list_resistance(self, rows: Iterable[Setting] = RESISTANCE) -> dict[str, Any]:
        """Return the values of the dynamics of a joint that are set, by their names."""
        values = {row.name: getattr(self, row.name) for row in rows}
        return {name: value for name, value in values.items() if value is not None}


@dataclass(frozen=True)
class ActuatorConfig:
    """Contents of the file: settings by joint name or pattern, in file order."""

    path: Path
    tables: Mapping[str, JointSettings]

    def match_joints(self, joints: Iterable[str]) -> dict[str, JointSettings]:
        """Choose the settings of each joint.

        Raises:
            ConfigError: A name or pattern of the file matches no joint.
        """
        names = list(joints)
        found = dict.fromkeys(names, JointSettings())
        exact = {}
        for pattern, settings in self.tables.items():
            if pattern in found:
                exact[pattern] = settings
                continue
            fitting = [name for name in names if fnmatchcase(name, pattern)]
            if not fitting:
                raise ConfigError(self._format_unknown(pattern, names), path=self.path)
            for name in fitting:
                found[name] = settings.override(found[name])
        for name, settings in exact.items():
            found[name] = settings.override(found[name])
        return found

    def _format_unknown(self, pattern: str, names: list[str]) -> str:
        what = "pattern" if set(pattern) & set("*?[") else "name"
        hint = suggest_name(pattern, names, 0.5) or f"; there are {', '.join(names) or 'none'}"
        return f'[{_TABLE}."{pattern}"]: no joint that moves has this {what}{hint}'


def read_actuator_config(path: Path) -> ActuatorConfig:
    """Read an actuator configuration file.

    Raises:
        ConfigError: The file cannot be read, is not TOML, or has an invalid key or value.
    """
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib  # type: ignore[import-not-found, unused-ignore]
    try:
        root: Any = tomllib.loads(path.read_bytes().decode("utf-8"))
    except OSError as error:
        raise ConfigError(f"cannot be read: {error.strerror}", path=path) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"not valid TOML: {error}", path=path) from None
    for name in root:
        if name != _TABLE:
            raise ConfigError(
                f'unknown table [{name}]; joints have tables such as [{_TABLE}."*_knee"]',
                path=path,
            )
    joints = root.get(_TABLE, {})
    if not isinstance(joints, dict):
        raise ConfigError(f"'{_TABLE}' must be a table of tables, one a joint", path=path)
    return ActuatorConfig(
        path, {name: _make_settings(name, table, path) for name, table in joints.items()}
    )


def _make_settings(name: str, table: Any, path: Path) -> JointSettings:
    where = f'[{_TABLE}."{name}"]'
    if not isinstance(table, dict):
        raise ConfigError(f"{where} must be a table, with keys such as kp = 100", path=path)
    values: dict[str, Any] = {}
    for key, value in table.items():
        if key not in KEYS:
            hint = suggest_name(key, KEYS, 0.5) or f"; there are {', '.join(KEYS)}"
            raise ConfigError(f"{where}: unknown key '{key}'{hint}", path=path)
        if key == "force-range":
            values["force_range"] = _parse_range(where, value, path)
        elif key == "type":
            if value not in TYPES:
                text = f"{where}: type must be {', '.join(TYPES[:-1])} or {TYPES[-1]}"
                raise ConfigError(text, path=path)
            values["type"] = value
        else:
            if not _is_number(value) or value < 0:
                raise ConfigError(f"{where}: {key} must be a number, zero or above", path=path)
            values[key] = float(value)
    return JointSettings(**values)


def _parse_range(where: str, value: Any, path: Path) -> tuple[float, float]:
    pair = [-value, value] if _is_number(value) else value
    right = isinstance(pair, list) and len(pair) == 2 and all(map(_is_number, pair))
    if not right or not pair[0] < pair[1]:
        text = f"{where}: force-range must be [lower, upper] with lower < upper, or one number > 0"
        raise ConfigError(text, path=path)
    return float(pair[0]), float(pair[1])


def _is_number(value: Any) -> bool:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return is_number and math.isfinite(value)
