"""What an expansion requests of the process that started it."""

from __future__ import annotations

from typing import Any, Protocol

from .location import SourceFile


class Files(Protocol):
    """Files, packages and variables that an expansion may request."""

    def find_package(self, name: str) -> str:
        """Return the folder of a package."""

    def locate_file(self, path: str) -> str:
        """Return a path, or that of its source by the install rules if it does not exist."""

    def read_xml(self, path: str) -> SourceFile:
        """Return a file to include."""

    def import_yaml(self) -> Any:
        """Return the module yaml."""

    def read_yaml(self, path: str) -> bytes:
        """Return the contents of a YAML file."""

    def list_matches(self, pattern: str) -> list[str]:
        """Return the paths that match a pattern."""

    def read_variable(self, name: str) -> str:
        """Return the value of ``$(env NAME)``."""

    def read_optional_variable(self, name: str, default: str = "") -> str:
        """Return the value of ``$(optenv NAME DEFAULT)``."""

    def suggest_path(self, path: str) -> tuple[str, str]:
        """Return the first missing folder of a path, and the nearest existing name; or empty."""

    def add_message(self, text: str) -> None:
        """Print a message of the description."""

    def mark_place(self, file: SourceFile, start: int) -> None:
        """Store the location of the element that is evaluated."""
