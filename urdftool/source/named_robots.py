"""Robots by name, from the packages ``robot_descriptions`` and ``mujoco-menagerie``.

Both download a robot when it is first used, and keep it in a cache of their own.
"""

from __future__ import annotations

import sys
from contextlib import redirect_stdout
from importlib import import_module
from pkgutil import iter_modules
from typing import Any

from ..errors import SourceError
from ..extras import is_installed, make_missing_error
from ..suggestions import find_nearest

_DESCRIPTIONS, _MENAGERIE = "robot_descriptions", "mujoco_menagerie"
_ENDING = "_description"
_PATHS = ("URDF_PATH", "XACRO_PATH", "MJCF_PATH")
"""Names of the path in a module of robot_descriptions."""


def find_named_robot(name: str) -> str:
    """Return the path of the description of a robot, which may be downloaded.

    Args:
        name: Name in robot_descriptions, with or without ``_description``, or in mujoco-menagerie.

    Raises:
        MissingDependency: Neither package is installed.
        SourceError: Neither knows the robot, or it cannot be downloaded.
    """
    installed = [package for package in (_DESCRIPTIONS, _MENAGERIE) if is_installed(package)]
    if not installed:
        raise make_missing_error(_DESCRIPTIONS, f"-r {name}")
    readers = {_DESCRIPTIONS: _find_description, _MENAGERIE: _find_model}
    known: list[str] = []
    for package in installed:
        try:
            with redirect_stdout(sys.stderr):  # standard output is for results
                names = _list_names(import_module(package), package)
                if name.removesuffix(_ENDING) in names:
                    return readers[package](name.removesuffix(_ENDING))
        except Exception as error:
            reason = str(error).strip().partition("\n")[0] or type(error).__name__
            raise SourceError(f"robot '{name}' of {package} cannot be read: {reason}") from None
        known += names
    nearest = find_nearest(name, known)
    hint = f"; did you mean '{nearest}'?" if nearest else ""
    raise SourceError(f"{' and '.join(installed)} have no robot '{name}'{hint}")


def _list_names(package: Any, name: str) -> list[str]:
    if name == _MENAGERIE:
        return [str(robot) for robot in package.names()]
    modules = (module.name for module in iter_modules(package.__path__))
    return [module.removesuffix(_ENDING) for module in modules if module.endswith(_ENDING)]


def _find_description(name: str) -> str:
    module = import_module(f"{_DESCRIPTIONS}.{name}{_ENDING}")
    return next(str(getattr(module, path)) for path in _PATHS if hasattr(module, path))


def _find_model(name: str) -> str:
    robot = import_module(_MENAGERIE).get(name)
    return str(robot.xml(robot.default_model))
