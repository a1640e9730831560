"""Rules on the launch files of a description's package."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from ...errors import PackageNotFound
from ...model.elements import Robot
from ...source.description import Description
from ...source.location import Place, SourceFile
from ...source.nearby_files import read_optional_file
from ..fix import FixContext, Proposal, safe
from ..rule import SAFE, WARNING, Problem, rule
from .dependencies import (
    add_dependency,
    find_dependency_chain,
    get_dependencies,
    get_run_tag,
    parse_own_manifest,
)

_OF_LAUNCH = frozenset(
    (
        "ament_index_python",
        "launch",
        "launch_ros",
        "launch_xml",
        "launch_yaml",
        "ros2cli",
        "ros2pkg",
    )
)
"""Dependencies of ros2launch: ros2/launch_ros ros2launch/package.xml."""

_PYTHON_PACKAGES = frozenset(
    (
        *("controller_manager", "launch_param_builder", "launch_pytest", "launch_testing"),
        *("launch_testing_ros", "moveit_configs_utils", "nav2_common", "nav2_simple_commander"),
        *("rclpy", "ros_gz_bridge", "ros_gz_sim", "tf2_ros", "webots_ros2_driver", "xacro"),
    )
)
"""ROS packages that launch files import, named as their Python modules. Chosen, no source."""

_MOST_BYTES = 1 << 20
"""Size [bytes] above which a launch file is not read; chosen."""


@rule(
    WARNING,
    on=("ros2",),
    effects={
        "ros2 launch": "stops with ModuleNotFoundError where the package is not installed",
    },
)
def undeclared_launch_dependency(robot: Robot, description: Description) -> Iterator[Problem]:
    """A launch file imports a package that its own package does not depend on.

    ``import xacro`` in a launch file in Python requires the package ``xacro``, but ``package.xml``
    does not list it, so ``rosdep`` does not install it. Packages that ``ros2 launch`` itself
    requires, such as ``launch_ros``, need not be listed. An import in a ``try`` that catches
    ``ImportError`` is optional.

    The launch files in the folder ``launch`` of the description's package are read, except for
    those that name other descriptions only. Modules of Python packages that are neither known
    packages of ROS nor in the workspace are not reported.
    """
    own = description.packages.own
    if own is None:
        return
    declared = get_dependencies(description.workspace, own[1]) | _OF_LAUNCH | {own[0]}
    for file in _list_launch_files(description, own[1]):
        for name, place in _list_imports(file):
            if name not in declared and _is_package(name, description):
                declared.add(name)
                yield Problem(
                    robot,
                    f"the launch file imports '{name}', which is not a dependency of '{own[0]}'; "
                    f"write <exec_depend>{name}</exec_depend> into its package.xml",
                    at=place,
                    data={"package": name},
                )


@undeclared_launch_dependency.fix(SAFE)
def declare_launch_dependency(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the dependency after the existing ones, if the package does not depend on this one."""
    name: str = problem.data["package"]
    manifest, own = parse_own_manifest(context), context.description.packages.own
    if manifest is None or own is None:
        return None
    if find_dependency_chain(name, own[0], context.description.packages, conditional=True):
        return None
    tag = get_run_tag(manifest.root)
    return safe(f"add <{tag}>{name}</{tag}> to package.xml", add_dependency(manifest.root, name))


def _list_launch_files(description: Description, package: Path) -> Iterator[SourceFile]:
    """Yield the launch files in Python that name a description, or no description at all."""
    workspace, name = description.workspace, Path(description.path).name.encode()
    for path in workspace.list_matches(package / "launch", "*.py"):
        file = read_optional_file(workspace, path)
        if file is None or len(file.data) > _MOST_BYTES:
            continue
        if name in file.data or not any(end in file.data for end in (b".urdf", b".xacro")):
            yield file


def _list_imports(file: SourceFile) -> list[tuple[str, Place]]:
    """Return the imported modules of a file, and where; none if it is not Python."""
    try:
        tree = ast.parse(file.data)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return []
    begins = [0]
    for line in file.data.splitlines(keepends=True):
        begins.append(begins[-1] + len(line))
    optional = {id(inner) for node in ast.walk(tree) for inner in _list_optional(node)}
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom) and id(node) not in optional:
            start = _locate(begins, node.lineno, node.col_offset)
            place = Place(file, start, _locate(begins, node.end_lineno, node.end_col_offset))
            found += [(name, place) for name in _list_modules(node)]
    return found


def _list_modules(node: ast.Import | ast.ImportFrom) -> Iterable[str]:
    """Return the top-level modules that a statement imports."""
    if isinstance(node, ast.Import):
        return [alias.name.partition(".")[0] for alias in node.names]
    if node.level == 0 and node.module:
        return [node.module.partition(".")[0]]
    return []


def _list_optional(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the statements of a ``try`` that catches a failed import."""
    if isinstance(node, ast.Try) and any(map(_is_import_guard, node.handlers)):
        for statement in node.body:
            yield from ast.walk(statement)


def _is_import_guard(handler: ast.ExceptHandler) -> bool:
    kinds = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
    names = {kind.id for kind in kinds if isinstance(kind, ast.Name)}
    return None in kinds or not names.isdisjoint(
        ("ImportError", "ModuleNotFoundError", "Exception")
    )


def _locate(begins: list[int], line: int | None, column: int | None) -> int:
    """Return the byte of a place in Python, from the first bytes of lines."""
    return begins[(line or 1) - 1] + (column or 0)


def _is_package(name: str, description: Description) -> bool:
    """Return whether a module is that of a ROS package, known or in the workspace."""
    if name in _PYTHON_PACKAGES:
        return True
    if name in sys.stdlib_module_names:
        return False
    try:
        folder = description.packages.find(name)
    except PackageNotFound:
        return False
    return description.workspace.is_file(folder / name / "__init__.py")
