"""Sandbox of xacro expansion: accessible environment variables and files.

A description is a program. Untrusted descriptions see only the variables in
``VISIBLE_ENV_VARS``, and read only files of ROS packages and of their own project. Expressions
use the functions of ``safe_builtins`` in any case.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ..errors import XacroError
from . import safe_builtins
from .expressions import BUILTINS, compile_expression
from .location import Place
from .packages import Packages, find_own_package

TRUST = "URDFTOOL_TRUST"
"""Environment variable that trusts descriptions, also in child processes; ``--trust`` sets it."""

VISIBLE_ENV_VARS = frozenset(("ROS_DISTRO", "ROS_VERSION", "ROS_PYTHON_VERSION", "ROS_NAMESPACE"))
"""Environment variables that any description may read."""

_HOW = "pass --trust if the input is trusted"
_PROJECT_MARKS = (".git", ".hg", "pyproject.toml", "CMakeLists.txt", "urdftool.toml")
_MAX_CLIMB = 6


def disable_sandbox() -> None:
    """Trust all descriptions in this process and its children."""
    os.environ[TRUST] = "1"


class Sandbox:
    """Access of one description to variables and files."""

    def __init__(self, packages: Packages, load_yaml: Callable[[str], Any]) -> None:
        """Set the packages and the loader of YAML files.

        Args:
            packages: Packages of the description.
            load_yaml: Function for ``xacro.load_yaml``, which checks access.
        """
        self.packages = packages
        self.workspace = packages.workspace
        self.load_yaml = load_yaml
        self.trusted = self.workspace.read_variable(TRUST) == "1"

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
        """Check that a file is in a package or in the project of the description.

        Args:
            path: Path of the file.
            at: Location of the reference, if known.

        Raises:
            XacroError: It is outside, directly or through a symbolic link, or is a device or pipe.
        """
        files = self.workspace
        real = Path(files.resolve_links(path))
        if files.exists(real) and not files.is_file(real) and not files.is_folder(real):
            raise XacroError(
                f"{path} is a device or a pipe, not a file", at=at, rule="include-not-found"
            )
        if self.trusted:
            return
        if find_own_package(real, files) or any(
            _is_within(real, root) for root in self._list_roots()
        ):
            return
        linked = "" if str(real) == os.path.abspath(path) else f" (a link to {real})"
        raise XacroError(
            f"{path}{linked} is outside of the project and not in a ROS package; set the package "
            f"with --package NAME=DIR, or {_HOW}",
            at=at,
            rule="include-not-found",
        )

    def make_symbols(
        self, original: Mapping[str, Any], warn: Callable[[str], object]
    ) -> dict[str, Any]:
        """Return the global symbols of expressions, with bounded functions and checked file access.

        Args:
            original: xacro's global symbols with the namespaces ``python``, ``math`` and ``xacro``.
            warn: Called with a warning if a function is called without its namespace.
        """
        replaced = {
            "python": safe_builtins.PYTHON,
            "math": safe_builtins.MATH,
            "xacro": {"load_yaml": self.load_yaml},
        }
        found = dict(original)
        for name, functions in replaced.items():
            space = type(original[name])()  # a parent would expose Python's functions
            space.update({**original[name], **functions})
            found[name] = space
            for key, function in functions.items():
                if key in original:
                    old = original[key] is not original[name].get(key)
                    found[key] = _wrap_deprecated(function, key, name, warn) if old else function
        return found

    def make_ros1_evaluation(self, ros: Any) -> Callable[[str, dict[str, Any]], str]:
        """Return a function for ``$(eval …)`` with the names that ROS 1 defines for it.

        Args:
            ros: xacro's module ``substitution_args``.
        """

        def evaluate(text: str, context: dict[str, Any]) -> str:
            arguments = context.setdefault("arg", {})

            def argument(name: str) -> Any:
                return ros.convert_value(ros._eval_arg(name, args=arguments), "auto")

            names = {name: value for name, value in ros._eval_dict.items() if name[:2] != "__"}
            names |= ros._eval_dict["__builtins__"] | safe_builtins.MATH
            names |= {"arg": argument, "dirname": lambda: ros._eval_dirname(context["filename"])}
            code = compile_expression(text)
            names |= {n: argument(n) for n in code.co_names if n in arguments and n not in names}
            return str(eval(code, {"__builtins__": BUILTINS}, names))

        return evaluate

    def _can_read_variable(self, name: str) -> bool:
        return self.trusted or name in VISIBLE_ENV_VARS

    def _list_roots(self) -> list[Path]:
        known: list[str | Path] = [self._find_project()]
        packages = self.packages
        for folders in (packages.named, packages.configured, packages.used):
            known += folders.values()
        known += packages.paths
        for variable in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"):
            known += filter(None, (self.workspace.read_variable(variable) or "").split(os.pathsep))
        return [Path(self.workspace.resolve_links(folder)) for folder in known]

    def _find_project(self) -> Path:
        """Return the project folder of a description without a package.

        That is the nearest folder above it with a project file, else the parent of its folder, for
        layouts such as ``robot/urdf`` and ``robot/config``.
        """
        folder = self.packages.file.parent
        above = [folder, *folder.parents][:_MAX_CLIMB]
        deep = [place for place in above if len(place.parts) > 2]  # not /, /home or /tmp
        for place in deep:
            if any(self.workspace.exists(place / mark) for mark in _PROJECT_MARKS):
                return place
        return deep[1] if len(deep) > 1 else folder


def evaluate_number(text: str, symbols: Mapping[str, Any]) -> Any:
    """Evaluate a number with units in a YAML file; replaces ``xacro.safe_eval``."""
    return eval(compile_expression(text), {**symbols, "__builtins__": BUILTINS})


def _make_hidden_error(name: str) -> XacroError:
    return XacroError(
        f"environment variable '{name}' is hidden from robot descriptions; {_HOW}",
        rule="expansion-failed",
    )


def _is_within(path: Path, root: Path) -> bool:
    """Tell whether a file is below a folder and not in a hidden folder there."""
    if not path.is_relative_to(root):
        return False
    return not any(part.startswith(".") for part in path.relative_to(root).parts)


def _wrap_deprecated(
    function: Callable[..., Any], name: str, space: str, warn: Callable[[str], object]
) -> Callable[..., Any]:
    """Wrap a function called by its deprecated name; warn as xacro does."""

    def call(*args: Any, **kwargs: Any) -> Any:
        warn(f"Using {name}() directly is deprecated. Use {space}.{name}() instead.")
        return function(*args, **kwargs)

    return call
