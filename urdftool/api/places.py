"""Checks of the options with which functions of Python read a description."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import get_args

from ..errors import ConfigError
from ..source.description import GltfUp
from ..suggestions import require_number, require_word


def check_places(
    packages: Mapping[str, str | Path] | None,
    package_paths: Iterable[str | Path],
    *,
    gltf_up: GltfUp | None = None,
) -> tuple[str | Path, ...]:
    """Warn of folders of packages that do not exist, and return ``package_paths`` as a tuple.

    Args:
        packages: Folders of ROS packages by name.
        package_paths: Folders that contain ROS packages.
        gltf_up: Up axis of glTF meshes.

    Raises:
        ConfigError: ``package_paths`` is a text, or ``gltf_up`` is not an axis of glTF files.
    """
    paths = _list_paths(package_paths)
    if gltf_up is not None:
        require_word("gltf_up", gltf_up, get_args(GltfUp))
    for name, folder in (packages or {}).items():
        if not Path(folder).is_dir():
            _warn(f"packages: '{folder}', the folder of package '{name}', does not exist")
    for folder in paths:
        if not Path(folder).is_dir():
            _warn(f"package_paths: folder '{folder}' does not exist")
    return paths


def list_words(name: str, words: Iterable[str]) -> list[str]:
    """Return the words of an option as a list.

    Raises:
        ConfigError: The option is one text, which would be taken as a list of letters.
    """
    _refuse_text(name, words)
    return list(words)


def check_settings(settings: object, kind: type) -> None:
    """Raise ConfigError if settings are neither None nor of a class."""
    if settings is not None and not isinstance(settings, kind):
        name = f"{kind.__module__}.{kind.__qualname__}"
        raise ConfigError(f"settings is {settings!r}, which is not a {name}")


def check_jobs(jobs: int | None) -> None:
    """Raise ConfigError if a number of processes is not a number of at least 1."""
    if jobs is not None:
        require_number("jobs", jobs, 1)


def _list_paths(paths: Iterable[str | Path]) -> tuple[str | Path, ...]:
    _refuse_text("package_paths", paths)
    return tuple(paths)


def _refuse_text(name: str, value: object) -> None:
    if isinstance(value, str | Path):
        raise ConfigError(f"{name} is {str(value)!r}, which is not a list; pass [{str(value)!r}]")


def _warn(message: str) -> None:
    warnings.warn(message, UserWarning, stacklevel=5)  # the line that called the API
