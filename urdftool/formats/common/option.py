"""Declaration of the options of an export, from which the command line and Python take them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import Field, dataclass, field, fields
from pathlib import Path, PurePath
from typing import Any, Literal, TypeVar, get_args

from ...errors import ConfigError
from ...finding import Finding
from ...model.elements import Robot
from ...suggestions import require_word

T = TypeVar("T")

_KEY = "option"

Base = Literal["auto", "fixed", "free"]
"""Whether the root of a robot is fixed to the world."""

Actuators = Literal["auto", "described", "none", "position", "velocity", "motor"]
"""Described drives and position servos for the rest; described ones; none; one kind for all."""

FixInertia = Literal["none", "lift", "balance", "box"]
"""Reject it; the nearest consistent tensor; a sphere's of the same mean; a box's of its size."""

Overlaps = Callable[[Robot, Mapping[str, float]], Finding | None]
"""Finds the links of a robot that overlap at joint positions [rad or m]: a finding whose data has
the ``pairs`` of their names; None for none."""


@dataclass(frozen=True)
class Option:
    """Declaration of one option of an export.

    Attributes:
        help: Description, with units and what is not obvious of its words.
        words: Allowed words; empty if any value of its kind is allowed.
        kind: Type of its value: str, bool, float, Path or dict.
        flag: Name on the command line; empty for the name of the field.
        metavar: Placeholder of its value on the command line; empty for the words or the kind.
        minimum: Least value of a number.
        offered: Default for users, if it is another than that of the field.
        check: Returns a value as it is used, or raises ConfigError.
    """

    help: str
    words: tuple[str, ...] = ()
    kind: type = str
    flag: str = ""
    metavar: str = ""
    minimum: float = -math.inf
    offered: Any = None
    check: Callable[[str], str] | None = None


def declare(default: Any, option: Option | str, **details: Any) -> Any:
    """Return a field of a dataclass that is an option, declared as such or by its help."""
    declared = Option(option, **details) if isinstance(option, str) else option
    metadata = {_KEY: declared}
    if declared.kind is dict:
        return field(default_factory=dict, metadata=metadata)
    return field(default=default, metadata=metadata)


def list_options(options: Any) -> Iterator[tuple[Field[Any], Option]]:
    """Yield the fields of a dataclass that declare an option, with the declarations."""
    for one in fields(options):
        if _KEY in one.metadata:
            yield one, one.metadata[_KEY]


def get_default(one: Field[Any], option: Option) -> Any:
    """Return the default of an option for users; None for a mapping."""
    if option.kind is dict:
        return None
    return one.default if option.offered is None else option.offered


def make_options(options: type[T], choices: Mapping[str, Any], **others: Any) -> T:
    """Make the options of a writer from what a user chose.

    Args:
        options: A dataclass.
        choices: Values by the name of a field; None is its default, text may be a path.
        others: Values of fields that declare no option.

    Raises:
        ConfigError: A value is not allowed.
    """
    values = dict(others)
    for one, option in list_options(options):
        value = choices.get(one.name)
        if value is None:
            value = get_default(one, option)
        if value is not None:
            values[one.name] = Path(value) if option.kind is Path else value
    return options(**values)


def check_options(options: Any) -> None:
    """Raise ConfigError if an option has a word or a number that is not allowed."""
    for one, option in list_options(options):
        value = getattr(options, one.name)
        if value != one.default:
            _check_value(one.name, option, value)


def _check_value(name: str, option: Option, value: Any) -> None:
    if option.words and option.kind is str:
        require_word(name, value, option.words)
    if option.kind is float and not _is_number(value, option.minimum):
        least = "" if option.minimum == -math.inf else f" of at least {option.minimum:g}"
        raise ConfigError(f"{name} is {value!r}, which is not a finite number{least}")
    if option.kind is bool and not isinstance(value, bool | None):
        raise ConfigError(f"{name} is {value!r}, which is not True or False")
    if option.check is not None:
        option.check(value)


def _is_number(value: Any, minimum: float) -> bool:
    return isinstance(value, int | float) and minimum <= value < math.inf


def parse_mesh_folder(value: str) -> str:
    """Return a folder relative to the model, with single slashes.

    Raises:
        ConfigError: The folder is absolute, or outside of the model's folder.
    """
    folder = PurePath(value)
    if folder.is_absolute() or ".." in folder.parts:
        raise ConfigError(
            f"mesh_dir is {value!r}, which is not a folder relative to the model, such as meshes"
        )
    return folder.as_posix()


FORCE = Option("Export despite errors, if a usable robot remains.", kind=bool)

MESH_FOLDER = Option(
    "Folder of the mesh files, relative to the model.", metavar="DIR", check=parse_mesh_folder
)

FIX_INERTIA = Option(
    "Repair of physically inconsistent inertia: lift, balance, box, or none (refuse it).",
    words=get_args(FixInertia),
    metavar="REPAIR",
)

DECOMPOSE = Option("Decompose collision meshes into convex pieces.", kind=bool)

BASE = Option(
    "Base of the robot; auto: free for robots with legs or driven wheels, or if the file "
    "defines it so.",
    words=get_args(Base),
)

ACTUATORS = Option(
    "Actuators: auto (as transmissions, ros2_control and drive plugins describe, and position "
    "servos for the other joints), described (without these servos), none, or position, velocity "
    "or motor for all joints.",
    words=get_args(Actuators),
    metavar="KIND",
)

POSE = Option(
    "Home position of joints [rad or m] by name or pattern; an SRDF group state; or stand, with "
    "bent legs. Repeatable.",
    kind=dict,
    metavar="JOINT=VALUE|NAME",
)

TIMESTEP = Option(
    "Physics time step [s], for which gains of servos are chosen.  [default: 0.002]",
    kind=float,
    metavar="SECONDS",
    minimum=1e-6,
)
