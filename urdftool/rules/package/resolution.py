"""Rules on packages in mesh URIs."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from ...diagnostic import Severity
from ...model.elements import Robot
from ...source.description import Description
from ...source.packages import shorten_path, suggest_folder
from ..mesh.dropped import is_dropped
from ..mesh.mesh_uses import MeshUse, get_mesh_uses
from ..mujoco import find_lost_in_mujoco, get_assumed_package
from ..rule import INFO, ROS, WARNING, Problem, rule

APPLIES_TO = ("mesh",)


@rule(
    WARNING,
    effects={
        "xacro (in $(find …))": "stops with an error",
        "rviz": "shows none of its meshes, and reports 'Could not load mesh resource'",
        "drake": "rejects the robot",
        "pybullet (no such folder)": "rejects the robot: it finds no folder of that name",
        "pybullet (a folder)": "takes the folder of that name as the package",
        "mujoco (a folder)": "4.0 rejects the robot: it does not resolve package://",
    },
    group="repository",
)
def package_not_found(
    robot: Robot, description: Description, targets: frozenset[str]
) -> Iterator[Problem]:
    """A package cannot be found.

    ``$(find NAME)`` and ``package://NAME/`` refer to a ROS package, which is neither near the file,
    in its workspace, in the configuration, nor in ``ROS_PACKAGE_PATH`` and ``AMENT_PREFIX_PATH``.
    The robot may be correct if the package is only missing on this machine, but its meshes were not
    checked. Pass ``--package NAME=DIR`` or ``--package-path DIR``. If a folder of that name near
    the file has the mesh, as for ``package://meshes/arm.stl``, its meshes are read and checked, but
    ROS does not find them: an info if nothing shows that the robot is for ROS.
    """
    lost: dict[str, list[MeshUse]] = {}
    for use in get_mesh_uses(robot, description):
        if use.missing_package and not is_in_own_package(use, description):
            lost.setdefault(use.missing_package, []).append(use)
    for name, uses in lost.items():
        count = len({use.uri for use in uses})
        meshes = f"{count} of its meshes were" if count > 1 else "its mesh was"
        near = description.packages.find_folder_with(name, _get_inner_path(uses[0].uri))
        meant = description.packages.suggest_package(name)
        remedy = f"pass --package {name}=DIR or --package-path DIR"
        if near is not None:
            remedy = suggest_folder(name, near)
        if meant:
            remedy = f"did you mean '{meant}'? Otherwise {remedy}"
        yield Problem(
            uses[0].link,
            f"package '{name}' is not found, so {meshes} not checked; {remedy}",
            at=uses[0].mesh.locate_attribute("filename"),
            hint="; ".join(f"searched {place}" for place in _shorten_places(uses[0].searched)),
            effects=(*_select_rviz_effect(uses), "drake", "pybullet (no such folder)"),
            alike=(name, meant),
            group=f"package '{name}' is not found, so the meshes of {{count}} places were not "
            f"checked; {remedy}",
        )
    severity = INFO if targets.isdisjoint(ROS) else WARNING
    yield from _report_assumed_packages(robot, description, severity)


def _report_assumed_packages(
    robot: Robot, description: Description, severity: Severity
) -> Iterator[Problem]:
    """Report packages in whose place a folder of the same name is read."""
    found: dict[str, list[MeshUse]] = {}
    lost = {use.uri for use in find_lost_in_mujoco(robot, description)}
    for use in get_mesh_uses(robot, description):
        if name := get_assumed_package(use, description):
            found.setdefault(name, []).append(use)
    for name, uses in found.items():
        count = len({use.uri for use in uses})
        meshes = f"{count} meshes are" if count > 1 else "a mesh is"
        folder = description.packages.assumed[name]
        yield Problem(
            uses[0].link,
            f"package '{name}' is not found, so {meshes} read from the folder "
            f"'{shorten_path(folder)}', as PyBullet does; write "
            f"'{_make_uri_from(uses[0], folder, description)}'",
            at=uses[0].mesh.locate_attribute("filename"),
            effects=(
                *(*_select_rviz_effect(uses), "drake", "pybullet (a folder)"),
                *["mujoco (a folder)"] * any(use.uri in lost for use in uses),
            ),
            severity=severity,
            alike=(name,),
            group=f"package '{name}' is not found, so the meshes of {{count}} places are read from "
            "folders of that name, as PyBullet does; write relative paths",
        )


def _select_rviz_effect(uses: list[MeshUse]) -> tuple[str, ...]:
    """Select the effect in RViz, which does not load meshes of shapes that urdfdom drops."""
    return () if all(map(is_dropped, uses)) else ("rviz",)


def _make_uri(use: MeshUse, description: Description) -> str:
    """Make a URI that every reader finds, or a path if the file is not in a package."""
    file = description.packages.file
    own = description.packages.own
    path = use.path or file
    start = file.parent if own is None else own[1]
    inside = os.path.relpath(path, start).replace(os.sep, "/")
    return inside if own is None or inside.startswith("..") else f"package://{own[0]}/{inside}"


def _make_uri_from(use: MeshUse, folder: Path, description: Description) -> str:
    """Make the URI or path of a mesh that is read from a folder in place of its package.

    It is known also if the file is missing or must not be read.
    """
    if use.path is not None:
        return _make_uri(use, description)
    path = Path(folder) / _get_inner_path(use.uri)
    return os.path.relpath(path, description.packages.file.parent).replace(os.sep, "/")


def is_in_own_package(use: MeshUse, description: Description) -> bool:
    """Tell whether a mesh of a different package exists in the description's own package."""
    scheme, _, rest = use.uri.partition("://")
    name, _, inside = rest.partition("/")
    if scheme != "package" or use.exists or not inside:
        return False
    known: dict[str, bool] = description.memo.get(is_in_own_package, dict)
    if use.uri not in known:
        own = description.packages.own
        path = None if own is None or name == own[0] else own[1] / inside
        known[use.uri] = path is not None and description.workspace.is_file(path)
    return known[use.uri]


def _get_inner_path(uri: str) -> str:
    """Get the path in a URI after the package name."""
    return uri.partition("://")[2].partition("/")[2]


def _shorten_places(searched: list[str]) -> list[str]:
    return [place.removeprefix("searched ") for place in searched]
