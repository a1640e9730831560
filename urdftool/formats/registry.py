"""The formats of robot descriptions.

A format is a folder of this package and one line of ``FORMATS``. The folder has

- ``read.py`` with ``read(path, **options) -> Robot``, where the format can be read;
- ``write.py`` with ``write(robot, options) -> Written`` and ``options.py`` with ``Options``, where
  it can be written;
- ``checks.py`` with ``NOT_COMPARED``, ``check_unwritten`` and ``check_output``, which compare an
  export with its source.

They are imported when they are used.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from ..model.elements import Robot
    from .check import Check
    from .written import Written


class ExportOptions(Protocol):
    """The options of a writer, as far as every format has them."""

    @property
    def file(self) -> str:
        """The name of the model's file where the output is one file; empty for a folder."""

    @property
    def input_files(self) -> Sequence[Path]:
        """The files that the options name, which an export must not replace."""


@dataclass(frozen=True)
class Format:
    """A format of robot descriptions.

    Attributes:
        name: The name of its folder, and on the command line.
        title: Its name for people.
        suffixes: The suffixes of its files, in lower case.
        can_read: Whether it has a reader.
        can_write: Whether it has a writer.
        cannot_express: Codes of the losses of URDF that it has no place for.
    """

    name: str
    title: str
    suffixes: tuple[str, ...]
    can_read: bool = False
    can_write: bool = False
    cannot_express: tuple[str, ...] = ()

    def has_suffix(self, path: str | Path) -> bool:
        """Return whether a path has a suffix of the format's files."""
        return Path(path).suffix.lower() in self.suffixes

    def read(self, path: str | Path, **options: Any) -> Robot:
        """Read a robot.

        Raises:
            SourceError: The file cannot be read.
            ModelError: It is not a robot description.
        """
        robot: Robot = self._module("read").read(path, **options)
        return robot

    def write(self, robot: Robot, options: ExportOptions) -> Written:
        """Turn a robot into files of the format, which are not yet on disk.

        Raises:
            Refused: The robot has defects that forbid it.
        """
        written: Written = self._module("write").write(robot, options)
        return written

    @property
    def not_compared(self) -> tuple[str, ...]:
        """Return what a file of the format holds and no check compares."""
        names: tuple[str, ...] = self._module("checks").NOT_COMPARED
        return names

    def check_unwritten(
        self, robot: Robot, options: ExportOptions, written: Written, *, verify: bool
    ) -> list[Check]:
        """Check an export before a file of the user is touched.

        Args:
            robot: The source.
            options: The options it was written with.
            written: The export.
            verify: Whether to compare it with the source, beyond what is checked in any case.

        Raises:
            OutputError: A reader of the format rejects it.
        """
        checks: list[Check] = self._module("checks").check_unwritten(
            robot, options, written, verify=verify
        )
        return checks

    def check_output(
        self,
        robot: Robot,
        options: ExportOptions,
        written: Written,
        output: str | Path | None,
    ) -> list[Check]:
        """Compare an export on disk with its source; a copy of it where the output is None."""
        checks: list[Check] = self._module("checks").check_output(robot, options, written, output)
        return checks

    def _module(self, name: str) -> Any:
        return import_module(f".{self.name}.{name}", __package__)


FORMATS = (
    Format("urdf", "URDF and xacro", (".urdf", ".xacro"), can_read=True),
    Format(
        "sdf",
        "SDF, for Gazebo",
        (".sdf", ".xml", ".world"),
        can_write=True,
        cannot_express=(
            "lossy-calibration",
            "lossy-safety",
            "lossy-transmission",
            "lossy-ros2-control",
        ),
    ),
    Format(
        "mjcf",
        "MJCF, for MuJoCo",
        (".xml", ".mjcf"),
        can_write=True,
        cannot_express=(
            "lossy-calibration",
            "lossy-safety-controller",
            "lossy-plugin",
            "lossy-velocity",
        ),
    ),
)
"""Every format."""


def format_named(name: str) -> Format:
    """Return the format of a name.

    Raises:
        KeyError: There is no format of that name.
    """
    return {format_.name: format_ for format_ in FORMATS}[name]


def writable_formats() -> tuple[Format, ...]:
    """Return the formats that have a writer."""
    return tuple(format_ for format_ in FORMATS if format_.can_write)


def readable_formats() -> tuple[Format, ...]:
    """Return the formats that have a reader."""
    return tuple(format_ for format_ in FORMATS if format_.can_read)
