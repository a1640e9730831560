"""Configuration of a description: the nearest configuration file in its folder or above.

``pyproject.toml`` has it under ``[tool.urdftool]``; ``urdftool.toml`` and ``.urdftool.toml``, for
ROS packages without a ``pyproject.toml``, at the top level.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .errors import ConfigError
from .projects import explain_link_out
from .suggestions import suggest_name
from .workspace import Workspace, memoize_by_workspace

if TYPE_CHECKING:
    from .source.description import GltfUp
    from .source.packages import ConfiguredFolder

NAMES = (".urdftool.toml", "urdftool.toml", "pyproject.toml")
TABLES = ("packages", "lint", "collision", "simulate")
GLTF_UP = "gltf-up"
_MOST_BYTES = 1 << 20
"""Maximum size of a configuration file; chosen, a long pyproject.toml has 50 kB."""
_MOST_DOTS = 500
"""Maximum number of dots in a line; chosen, a dotted key of 20,000 parts takes 1.5 GB."""


@dataclass
class Configuration:
    """Contents of a configuration file.

    Attributes:
        path: Path of the file; None if there is no configuration file.
        packages: Absolute folders by ROS package name; in a file that the user did not name, with
            their places, because it may have come with an untrusted description.
        lint: The ``lint`` table as written.
        collision: The ``collision`` table as written.
        simulate: The ``simulate`` table as written.
        gltf_up: Up axis of glTF meshes.
    """

    path: str | None = None
    packages: Mapping[str, Path | ConfiguredFolder] = field(default_factory=dict)
    lint: dict[str, Any] = field(default_factory=dict)
    collision: dict[str, Any] = field(default_factory=dict)
    simulate: dict[str, Any] = field(default_factory=dict)
    gltf_up: GltfUp = "y"


def find_configuration(
    file: str | Path, given: str | None = None, workspace: Workspace | None = None
) -> Configuration:
    """Return the configuration of a description.

    One that is given counts for every description.

    Raises:
        ConfigError: The file cannot be read, is not valid TOML, or has an unknown table or value.
    """
    workspace = workspace or Workspace()
    if given is not None:
        return _parse(workspace, Path(given), required=True) or Configuration(given)
    folder = os.getcwd() if str(file) == "-" else os.path.dirname(os.path.abspath(file))
    return _find_above(workspace, folder)


@memoize_by_workspace
def _find_above(workspace: Workspace, folder: str) -> Configuration:
    """Return the configuration nearest to a folder."""
    here = (_parse(workspace, Path(folder, name), required=False) for name in NAMES)
    found = next((configuration for configuration in here if configuration), None)
    if found is not None:
        return found
    parent = os.path.dirname(folder)
    return _find_above(workspace, parent) if parent != folder else Configuration()


def _parse(workspace: Workspace, path: Path, *, required: bool) -> Configuration | None:
    if not required:
        if not workspace.exists(path):
            return None
        outside = explain_link_out(path, workspace.restrict(None))
        if outside:
            raise ConfigError(f"is not read: it {outside} with --config", path=path)
    try:
        with workspace.open(path) as stream:
            data = stream.read(_MOST_BYTES + 1)
    except OSError as error:
        if required:
            raise ConfigError(
                f"cannot be read: {error.strerror}; pass a TOML file with --config", path=path
            ) from None
        return None
    if len(data) > _MOST_BYTES or _has_long_key(data):
        raise ConfigError("is not read: it is too large, or has too long a dotted key", path=path)
    in_pyproject = path.name == "pyproject.toml"
    if in_pyproject and b"tool.urdftool" not in data:
        return None
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib  # type: ignore[import-not-found, unused-ignore]
    try:
        table: Any = tomllib.loads(data.decode("utf-8"))
    except (ValueError, RecursionError) as error:
        raise ConfigError(f"is not valid TOML: {error}", path=path) from None
    if in_pyproject or "tool" in table:
        tool = table.get("tool", {})
        table = tool.get("urdftool", {}) if isinstance(tool, dict) else None
    if not isinstance(table, dict):
        raise ConfigError("[tool.urdftool] is not a table", path=path)
    for name in table:
        if name not in (*TABLES, GLTF_UP):
            raise ConfigError(
                f"table '{name}' is unknown{_suggest_name(name)}",
                path=path,
            )
    packages = table.get("packages", {})
    lint = table.get("lint", {})
    if not isinstance(packages, dict) or not all(
        isinstance(value, str) and "\0" not in value for value in packages.values()
    ):
        raise ConfigError('[packages] requires entries like my_robot = "../my_robot"', path=path)
    collision = table.get("collision", {})
    simulate = table.get("simulate", {})
    for name, value in (("lint", lint), ("collision", collision), ("simulate", simulate)):
        if not isinstance(value, dict):
            raise ConfigError(f"[{name}] is not a table", path=path)
    gltf_up = table.get(GLTF_UP, "y")
    if gltf_up not in ("y", "z"):
        raise ConfigError(f'{GLTF_UP} must be "y" or "z", the up axis of glTF files', path=path)
    folder = Path(os.path.abspath(path)).parent
    lines = _find_lines(data) if packages else {}
    return Configuration(
        str(path),
        {
            name: folder / value
            if required
            else _make_folder(folder / value, str(path), lines.get(name, 1))
            for name, value in packages.items()
        },
        lint,
        collision,
        simulate,
        gltf_up,
    )


def _make_folder(folder: Path, path: str, line: int) -> ConfiguredFolder:
    """Return the folder of a package that line ``line`` of a configuration names."""
    from .source.packages import ConfiguredFolder  # many runs have no such line

    return ConfiguredFolder(folder, path, line)


def _has_long_key(data: bytes) -> bool:
    """Tell whether a line may have a dotted key for which a parser needs much memory."""
    return any(line.count(b".") > _MOST_DOTS for line in data.splitlines())


def _find_lines(data: bytes) -> dict[str, int]:
    """Return the first line of each key, from 1."""
    found: dict[str, int] = {}
    for number, line in enumerate(data.decode("utf-8").split("\n"), 1):
        key, assigns, _ = line.partition("=")
        if assigns:
            found.setdefault(key.strip(" \t\"'"), number)
    return found


def _suggest_name(name: str) -> str:
    return suggest_name(name, (*TABLES, GLTF_UP), 0.5) or f"; use {', '.join(TABLES)}"
