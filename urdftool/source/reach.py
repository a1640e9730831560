"""What a description can reach while it is expanded.

A description is a program. Unless the user trusts it, it sees no environment but what says which
ROS there is, and reads no file but those of ROS packages and of its own project; Python's functions
are the bounded ones either way.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ..errors import XacroError
from . import bounded
from .expressions import BUILTINS, compile_expression
from .location import Place
from .packages import Packages, own_package

TRUST = "URDFTOOL_TRUST"
"""The variable that says so to this process and those it starts; ``--trust`` sets it."""

OPEN_VARIABLES = frozenset(("ROS_DISTRO", "ROS_VERSION", "ROS_PYTHON_VERSION", "ROS_NAMESPACE"))
"""What any description may see of the environment."""

_HOW = "pass --trust if you trust this description"
_PROJECT_MARKS = (".git", ".hg", "pyproject.toml", "CMakeLists.txt", "urdftool.toml")
_MAX_CLIMB = 6


def trust_descriptions() -> None:
    """Trust all descriptions from here on."""
    os.environ[TRUST] = "1"


class Reach:
    """What one description can reach."""

    def __init__(self, packages: Packages, load_yaml: Callable[[str], Any]) -> None:
        """Take what it needs; what can be read is looked up when it is asked for.

        Args:
            packages: Those of the description.
            load_yaml: Loads a file for ``xacro.load_yaml``, if it may be read.
        """
        self.packages = packages
        self.workspace = packages.workspace
        self.load_yaml = load_yaml
        self.trusted = self.workspace.variable(TRUST) == "1"

    def variable(self, name: str) -> str:
        """``$(env NAME)``.

        Raises:
            XacroError: It is not set, or not to be seen.
        """
        value = self.workspace.variable(name)
        if value is not None and not self._sees(name):
            raise _hidden(name)
        if value is None:
            raise XacroError(
                f"the environment variable '{name}' is not set; set it, or write "
                f"$(optenv {name} DEFAULT)",
                rule="expansion-failed",
            )
        return value

    def optional_variable(self, name: str, default: str = "") -> str:
        """``$(optenv NAME DEFAULT)``; a variable that is not to be seen and not set is no loss."""
        value = self.workspace.variable(name)
        if value is not None and not self._sees(name):
            raise _hidden(name)
        return default if value is None else value

    def check_file(self, path: str | Path, at: Place | None = None) -> None:
        """Refuse a file that is neither a package's nor the project's.

        Args:
            path: Where it is.
            at: Where it is asked for, if that is known.

        Raises:
            XacroError: It is somewhere else, or a link leads there.
        """
        files = self.workspace
        real = Path(files.real_path(path))
        if files.exists(real) and not files.is_file(real) and not files.is_folder(real):
            raise XacroError(
                f"{path} is a device or a pipe; a file is wanted", at=at, rule="include-not-found"
            )
        if self.trusted:
            return
        if own_package(real, files) or any(_is_within(real, root) for root in self._roots()):
            return
        led = "" if str(real) == os.path.abspath(path) else f" (a link to {real})"
        raise XacroError(
            f"{path}{led} is in no ROS package and outside the project of this description; "
            f"say where its package is with --package NAME=DIR, or {_HOW}",
            at=at,
            rule="include-not-found",
        )

    def symbols(self, original: Mapping[str, Any], warn: Callable[[str], object]) -> dict[str, Any]:
        """What expressions can name, with the bounded functions and guarded files among them.

        Args:
            original: xacro's global symbols, with the spaces ``python``, ``math`` and ``xacro``.
            warn: What is told of a function that is called by its old name, without its space.
        """
        replaced = {
            "python": bounded.PYTHON,
            "math": bounded.MATH,
            "xacro": {"load_yaml": self.load_yaml},
        }
        found = dict(original)
        for name, functions in replaced.items():
            space = type(original[name])()  # without a parent, which would lead to Python's own
            space.update({**original[name], **functions})
            found[name] = space
            for key, function in functions.items():
                if key in original:
                    old = original[key] is not original[name].get(key)
                    found[key] = _renamed(function, key, name, warn) if old else function
        return found

    def old_evaluation(self, ros: Any) -> Callable[[str, dict[str, Any]], str]:
        """``$(eval …)``: what ROS 1 allows in it, and no more of Python.

        Args:
            ros: The module of xacro that evaluates it otherwise.
        """

        def evaluate(text: str, context: dict[str, Any]) -> str:
            arguments = context.setdefault("arg", {})

            def argument(name: str) -> Any:
                return ros.convert_value(ros._eval_arg(name, args=arguments), "auto")

            names = {name: value for name, value in ros._eval_dict.items() if name[:2] != "__"}
            names |= ros._eval_dict["__builtins__"] | bounded.MATH
            names |= {"arg": argument, "dirname": lambda: ros._eval_dirname(context["filename"])}
            code = compile_expression(text)
            names |= {n: argument(n) for n in code.co_names if n in arguments and n not in names}
            return str(eval(code, {"__builtins__": BUILTINS}, names))

        return evaluate

    def _sees(self, name: str) -> bool:
        return self.trusted or name in OPEN_VARIABLES

    def _roots(self) -> list[Path]:
        known: list[str | Path] = [self._project()]
        packages = self.packages
        for folders in (packages.named, packages.configured, packages.used):
            known += folders.values()
        known += packages.paths
        for variable in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"):
            known += filter(None, (self.workspace.variable(variable) or "").split(os.pathsep))
        return [Path(self.workspace.real_path(folder)) for folder in known]

    def _project(self) -> Path:
        """The folder a description without a package belongs to.

        The nearest one above it that looks like a project, else the one beside whose folder its own
        stands, as in ``robot/urdf`` and ``robot/config``.
        """
        folder = self.packages.file.parent
        above = [folder, *folder.parents][:_MAX_CLIMB]
        deep = [place for place in above if len(place.parts) > 2]  # never /, /home or /tmp
        for place in deep:
            if any(self.workspace.exists(place / mark) for mark in _PROJECT_MARKS):
                return place
        return deep[1] if len(deep) > 1 else folder


def safe_eval(text: str, symbols: Mapping[str, Any]) -> Any:
    """``xacro.safe_eval``, which reads the numbers with units in YAML files."""
    return eval(compile_expression(text), {**symbols, "__builtins__": BUILTINS})


def _hidden(name: str) -> XacroError:
    return XacroError(
        f"the environment variable '{name}' is not shown to descriptions; {_HOW}",
        rule="expansion-failed",
    )


def _is_within(path: Path, root: Path) -> bool:
    """Whether a file is below a folder, and not in a hidden one there."""
    if not path.is_relative_to(root):
        return False
    return not any(part.startswith(".") for part in path.relative_to(root).parts)


def _renamed(
    function: Callable[..., Any], name: str, space: str, warn: Callable[[str], object]
) -> Callable[..., Any]:
    """A function by its old name, which warns as xacro does."""

    def call(*args: Any, **kwargs: Any) -> Any:
        warn(f"Using {name}() directly is deprecated. Use {space}.{name}() instead.")
        return function(*args, **kwargs)

    return call
