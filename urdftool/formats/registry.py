"""Registry of the formats of robot descriptions.

A format is a folder of this package, a row of ``source.description_formats`` and one of
``CANNOT_EXPRESS``. The folder has

- ``read.py`` with ``read(path, **options) -> Reading``;
- ``write.py`` with ``write(robot, options) -> Written`` and ``options.py`` with ``Options``;
- ``checks.py`` with ``NOT_COMPARED``, and ``check_unwritten``, which compares a copy of an export
  with its source, or ``check_output``, which compares what is on disk.

The modules are imported on first use.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from ..source.description_formats import DESCRIPTION_FORMATS

if TYPE_CHECKING:
    from ..compare.check import Check
    from ..model.elements import Robot
    from .reading import Reading
    from .written import Written


class ExportOptions(Protocol):
    """Options that every writer has."""

    @property
    def file(self) -> str:
        """Return the name of the model file if the output is one file; empty for a folder."""

    @property
    def input_files(self) -> Sequence[Path]:
        """Return the input files that the options name, which an export must not replace."""


@dataclass(frozen=True)
class Format:
    """A format of robot descriptions.

    Attributes:
        name: Name of its folder, also used on the command line.
        title: Display name.
        suffixes: File suffixes, in lower case.
        cannot_express: Codes of losses of URDF data that the format cannot express.
    """

    name: str
    title: str
    suffixes: tuple[str, ...]
    cannot_express: tuple[str, ...]

    def has_suffix(self, path: str | Path) -> bool:
        """Tell whether a path has a suffix of the format's files."""
        return Path(path).suffix.lower() in self.suffixes

    def read(self, path: str | Path, **options: Any) -> Reading:
        """Read a robot, and what the model does not hold of its source.

        Raises:
            SourceError: The file cannot be read.
            ModelError: It is not a robot description.
        """
        reading: Reading = self._make_module("read").read(path, **options)
        return reading

    def write(self, robot: Robot, options: ExportOptions) -> Written:
        """Convert a robot to files of the format, in memory.

        The losses include what the description writes and the robot does not hold.

        Raises:
            Refused: The robot has defects that prevent the export.
        """
        from .common.remarks import add_remarks

        written: Written = self._make_module("write").write(robot, options)
        add_remarks(robot, written)
        return written

    @property
    def not_compared(self) -> tuple[str, ...]:
        """Return the parts of a file that no check compares."""
        names: tuple[str, ...] = self._make_module("checks").NOT_COMPARED
        return names

    def check_unwritten(
        self, robot: Robot, options: ExportOptions, written: Written, *, verify: bool
    ) -> list[Check]:
        """Check an export before user files are replaced.

        Raises:
            OutputError: A reader of the format rejects it.
        """
        check = self._find_check("check_unwritten")
        return [] if check is None else check(robot, options, written, verify=verify)

    def check_output(
        self,
        robot: Robot,
        options: ExportOptions,
        written: Written,
        output: str | Path | None,
    ) -> list[Check]:
        """Compare an export on disk with its source; use a temporary copy if the output is None."""
        check = self._find_check("check_output")
        return [] if check is None else check(robot, options, written, output)

    def _find_check(self, name: str) -> Callable[..., list[Check]] | None:
        """Return a check of the format; None if it does not have that."""
        return getattr(self._make_module("checks"), name, None)

    def _make_module(self, name: str) -> Any:
        return import_module(f".{self.name}.{name}", __package__)


CANNOT_EXPRESS = {
    "urdf": (),
    "sdf": (
        "lossy-calibration",
        "lossy-safety",
        "lossy-transmission",
        "lossy-ros2-control",
    ),
    "mjcf": (
        "lossy-calibration",
        "lossy-safety-controller",
        "lossy-plugin",
        "lossy-velocity",
    ),
    "usd": (
        "lossy-calibration",
        "lossy-safety-controller",
        "lossy-plugin",
        "lossy-sensor",
        "lossy-transmission",
        "lossy-ros2-control",
    ),
}
"""Codes of losses of URDF data that a format cannot express."""

FORMATS = tuple(
    Format(one.name, one.title, one.suffixes, CANNOT_EXPRESS[one.name])
    for one in DESCRIPTION_FORMATS
)
"""Every format."""


def format_named(name: str) -> Format:
    """Return a format by its name.

    Raises:
        KeyError: There is no such format.
    """
    return {format_.name: format_ for format_ in FORMATS}[name]
