"""Access of descriptions to environment variables and files.

A description is a program. Untrusted descriptions see only the variables in
``VISIBLE_ENV_VARS``, and read only the files that ``access`` allows.
"""

from __future__ import annotations

from pathlib import Path

from ..errors import XacroError
from ..projects import TRUST_REMEDY, is_trusted
from .location import Place
from .packages import Packages

VISIBLE_ENV_VARS = frozenset(("ROS_DISTRO", "ROS_VERSION", "ROS_PYTHON_VERSION", "ROS_NAMESPACE"))
"""Environment variables that any description may read."""


class Sandbox:
    """Access of one description to variables and files."""

    def __init__(self, packages: Packages) -> None:
        """Set the packages of the description."""
        self.packages = packages
        self.workspace = packages.workspace
        self.trusted = is_trusted(self.workspace)

    def read_variable(self, name: str) -> str:
        """Return the value of ``$(env NAME)``.

        Raises:
            XacroError: It is not set, or not accessible.
        """
        value = self.workspace.read_variable(name)
        if value is not None and not self._can_read_variable(name):
            raise _make_hidden_error(name)
        if value is None:
            raise XacroError(
                f"environment variable '{name}' is not set; set it, or use "
                f"$(optenv {name} DEFAULT)",
                rule="expansion-failed",
            )
        return value

    def read_optional_variable(self, name: str, default: str = "") -> str:
        """Return the value of ``$(optenv NAME DEFAULT)``.

        Raises:
            XacroError: The variable is set, but not accessible.
        """
        value = self.workspace.read_variable(name)
        if value is not None and not self._can_read_variable(name):
            raise _make_hidden_error(name)
        return default if value is None else value

    def check_file(self, path: str | Path, at: Place | None = None) -> None:
        """Check that the description may read a file; see :meth:`FileAccess.check`.

        Raises:
            AccessError: It may not.
        """
        self.packages.access.check(path, at)

    def _can_read_variable(self, name: str) -> bool:
        return self.trusted or name in VISIBLE_ENV_VARS


def _make_hidden_error(name: str) -> XacroError:
    return XacroError(
        f"environment variable '{name}' is hidden from robot descriptions; {TRUST_REMEDY}",
        rule="expansion-failed",
    )
