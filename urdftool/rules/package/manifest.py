"""Rules on the package.xml and CMakeLists.txt of a description's package."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

from ...errors import PackageNotFound
from ...model.elements import Link, Robot
from ...source.comments import blank_cmake_comments, blank_comments
from ...source.description import Description
from ...source.location import Place
from ...source.nearby_files import read_optional_file
from ...workspace import Workspace
from ..fix import FixContext, Proposal, Span, append_child, safe, substitute, unsafe
from ..mesh.mesh_uses import MeshUse, get_mesh_uses
from ..moveit.semantic import has_srdf
from ..rule import BOTH, ERROR, INFO, ROS, SAFE, UNSAFE, WARNING, Problem, rule
from ..words import quote
from .dependencies import (
    add_dependency,
    find_dependency_chain,
    get_dependencies,
    get_run_tag,
    parse_own_manifest,
    read_manifest_text,
    read_package_text,
)
from .resolution import is_in_own_package

_FIND = re.compile(rb"\$\(find\s+([\w-]+)\s*\)")


_PACKAGE = re.compile(r"[a-z][a-z0-9_-]*")
"""Names of ROS packages: https://www.ros.org/reps/rep-0144.html; hyphens are used as well."""


@rule(
    WARNING,
    on=ROS,
    effects={
        "drake, pybullet": "reject a robot whose meshes are in a package that is not installed",
    },
)
def undeclared_mesh_dependency(robot: Robot, description: Description) -> Iterator[Problem]:
    """The description uses a package that its own package does not depend on.

    ``package://NAME/`` and ``$(find NAME)`` require an installed package, but ``package.xml`` does
    not list it, so the robot only works where the package happens to be installed. If that package
    depends on this one, ``dependency-circle`` is reported instead. Descriptions in a folder
    ``test`` or ``tests`` of the package are not checked.
    """
    own = description.packages.own
    if own is None or _is_in_tests(description, own[1]):
        return
    declared = get_dependencies(description.workspace, own[1])
    spelled = {name.replace("-", "_") for name in declared}  # both are used for one package
    for name, subject, at in _find_used_packages(robot, description, own):
        if _is_misnamed(name, description):
            continue  # package-not-found reports it
        if name.replace("-", "_") in spelled:
            continue
        if not find_dependency_chain(name, own[0], description.packages):
            yield Problem(
                subject,
                f"package '{name}' is used but is not a dependency of '{own[0]}'; "
                f"write <exec_depend>{name}</exec_depend> into its package.xml",
                at=at,
                data={"package": name},
            )


def _is_misnamed(name: str, description: Description) -> bool:
    """Tell whether a package is not found under a name, which is a typo or not one of ROS."""
    try:
        description.packages.find(name)
    except PackageNotFound:
        return not _PACKAGE.fullmatch(name) or description.packages.suggest_package(name) != ""
    return False


@undeclared_mesh_dependency.fix(SAFE)
def declare_dependency(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the dependency after the existing ones.

    A package that is not found is not added, and neither is one that depends on this one, because
    that would create a circle.
    """
    name: str = problem.data["package"]
    manifest = parse_own_manifest(context)
    own, packages = context.description.packages.own, context.description.packages
    if manifest is None or own is None or not re.fullmatch(r"[\w-]+", name):
        return None
    try:
        packages.find(name)
    except PackageNotFound:
        return None
    if find_dependency_chain(name, own[0], packages, conditional=True):
        return None
    tag = get_run_tag(manifest.root)
    return safe(f"add <{tag}>{name}</{tag}> to package.xml", add_dependency(manifest.root, name))


@rule(
    WARNING,
    on=ROS,
    effects={"colcon": "builds nothing: unable to order packages topologically"},
)
def dependency_circle(robot: Robot, description: Description) -> Iterator[Problem]:
    """The description uses a package that depends on its own package.

    colcon builds each package after its dependencies. It cannot order packages in a circle, and
    stops before it builds anything. As long as ``package.xml`` does not list the package, the build
    works, but the files may be missing. Files that two packages use belong in the one that the
    other depends on, or in a third package. Descriptions in a folder ``test`` or ``tests`` are not
    checked.
    """
    own = description.packages.own
    if own is None or _is_in_tests(description, own[1]):
        return
    declared = get_dependencies(description.workspace, own[1])
    for name, subject, at in _find_used_packages(robot, description, own):
        way = find_dependency_chain(name, own[0], description.packages)
        if not way:
            continue
        chain = ", which depends on ".join(f"'{step}'" for step in way[1:])
        fact = f"package '{name}' is used but depends on {chain}"
        if name in declared:
            yield Problem(
                subject,
                f"{fact}, and '{own[0]}' depends on it, so colcon cannot order them; "
                "move the used files",
                at=at,
                severity=ERROR,
            )
        else:
            yield Problem(
                subject,
                f"{fact}, so it cannot be a dependency of '{own[0]}'; move the used files",
                at=at,
            )


def _is_in_tests(description: Description, folder: Path) -> bool:
    """Tell whether a description is in a folder ``test`` or ``tests`` of its package."""
    real_path = description.workspace.resolve_links
    relative = Path(os.path.relpath(real_path(description.packages.file), real_path(folder)))
    return not {"test", "tests"}.isdisjoint(relative.parts[:-1])


def _find_used_packages(
    robot: Robot, description: Description, own: tuple[str, Path]
) -> Iterator[tuple[str, Robot | Link, Place]]:
    """Yield the other packages that a description uses, each at its first use."""
    found = {own[0]}
    for use in get_mesh_uses(robot, description):
        name = _get_package_name(use)
        if name and name not in found and not is_in_own_package(use, description):
            found.add(name)
            if not _is_itself(name, own[1], description):
                yield name, use.link, use.mesh.locate_attribute("filename")
    first = description.files[0]
    for match in _FIND.finditer(first.data):
        name = match[1].decode("ascii")
        line = first.data[: match.start()].rpartition(b"<!--")[2]
        if name in found or (b"-->" not in line and b"<!--" in first.data[: match.start()]):
            continue
        found.add(name)
        if not _is_itself(name, own[1], description):
            yield name, robot, Place(first, match.start(), match.end())


def _is_itself(name: str, folder: Path, description: Description) -> bool:
    """Tell whether a name is the folder of the description's own package."""
    if name != folder.name:
        return False
    try:
        found = description.packages.find(name)
    except PackageNotFound:
        return False
    real_path = description.workspace.resolve_links
    return real_path(found) == real_path(folder)


def _get_package_name(use: MeshUse) -> str:
    return use.uri[10:].partition("/")[0] if use.uri.startswith("package://") else ""


_INSTALL = re.compile(r"\binstall\s*\(([^()]*(?:\([^()]*\)[^()]*)*)\)", re.IGNORECASE)


@rule(
    ERROR,
    on=ROS,
    effects={
        "rviz": "shows no meshes, and reports 'Could not load mesh resource'",
    },
)
def directory_not_installed(robot: Robot, description: Description) -> Iterator[Problem]:
    """CMake does not install a folder that the description uses.

    Used are folders of meshes, of files that ``$(find PACKAGE)/…`` names, and of a description with
    an SRDF. The robot works from the source folder, but not after the package is built and
    installed. Add ``install(DIRECTORY meshes DESTINATION share/${PROJECT_NAME})`` to
    ``CMakeLists.txt``. For ROS 1, where workspaces are mostly used without installation, it is a
    warning, or an info if the package installs nothing.
    """
    own = description.packages.own
    if own is None:
        return
    text = read_package_text(description.workspace, own[1] / "CMakeLists.txt")
    if not text:
        return
    text = re.sub(r"#[^\n]*", "", text)
    installs = " ".join(_INSTALL.findall(text))
    if re.search(r"foreach|ament_auto_package|GLOB|INSTALL_TO_SHARE|macro|function", text, re.I):
        return
    words = {word.strip("\"'").strip("/").removeprefix("./") for word in installs.split()}
    if "." in words or "" in words or "${CMAKE_CURRENT_SOURCE_DIR}" in words:
        return
    places = {word.replace("${CMAKE_CURRENT_SOURCE_DIR}/", "") for word in words}
    severity = None
    if re.search(r"\bcatkin\b", text) and not re.search(r"\bament", text):
        severity = WARNING if installs else INFO
    used: dict[str, Place] = {}
    for use in get_mesh_uses(robot, description):
        if use.exists and use.path is not None and use.uri.startswith(f"package://{own[0]}/"):
            real_path = description.workspace.resolve_links
            relative = os.path.relpath(real_path(use.path), real_path(own[1]))
            top = relative.replace(os.sep, "/").partition("/")[0]
            if top != ".." and "/" in relative:
                element = use.mesh.element
                used.setdefault(top, element.locate_attribute("filename"))
    of_meshes = set(used)
    for folder, place in _find_named_folders(robot, description, own):
        used.setdefault(folder, place)
    for folder, at in used.items():
        if not any(place == folder or place.startswith(folder + "/") for place in places):
            yield Problem(
                robot,
                f"folder '{folder}' of package '{own[0]}' is used but not installed; "
                f"write install(DIRECTORY {folder} DESTINATION share/${{PROJECT_NAME}}) "
                "into CMakeLists.txt",
                at=at,
                severity=severity,
                effects=None if folder in of_meshes else (),
                data={"folder": folder},
            )


def _find_named_folders(
    robot: Robot, description: Description, own: tuple[str, Path]
) -> Iterator[tuple[str, Place]]:
    """Yield folders of the own package that ``$(find …)`` names, and that of an SRDF."""
    named = re.compile(
        rb"\$\(find(?:-pkg-share)?\s+" + re.escape(own[0].encode()) + rb"\s*\)/([\w.-]+)/[\w$]"
    )
    for file in description.files:
        for found in named.finditer(blank_comments(file.data)):
            folder = found[1].decode()
            if description.workspace.is_folder(own[1] / folder):
                yield folder, Place(file, found.start(), found.end(1))
    if has_srdf(robot, description):
        relative = os.path.relpath(os.path.abspath(description.path), own[1]).split(os.sep)
        if len(relative) > 1 and relative[0] != os.pardir:
            yield relative[0], robot.place


_INSTALL_DIRECTORY = re.compile(
    rb"\binstall\s*\(\s*DIRECTORY(?P<folders>(?:\s+[^\s()]+)+?)\s+DESTINATION\s+"
    rb"(?P<where>[^\s()]+)\s*\)",
    re.IGNORECASE,
)
_CATKIN, _SHARE = b"${CATKIN_PACKAGE_SHARE_DESTINATION}", b"share/${PROJECT_NAME}"


@directory_not_installed.fix(UNSAFE)
def install_directory(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the folder to an existing install(), or add one."""
    own = context.description.packages.own
    name: str = problem.data["folder"]
    file = (
        read_optional_file(context.workspace, own[1] / "CMakeLists.txt")
        if own is not None
        else None
    )
    if own is None or file is None or re.search(r"['\s();#\"]", name):
        return None
    folder, data = name.encode(), file.data
    code = blank_cmake_comments(data)
    catkin = re.search(rb"\bcatkin_package\s*\(", code) is not None
    shares = (_CATKIN, _SHARE, b"share/" + own[0].encode())
    for found in _INSTALL_DIRECTORY.finditer(code):
        if found["where"].strip(b'"').rstrip(b"/") in shares:
            *_, (gap, last) = re.findall(rb"(\s+)(\S+)", found["folders"])
            if not last.strip(b'"').endswith(b"/") and last not in (b"FILES", b"PROGRAMS"):
                at = found.end("folders")
                return unsafe(f"install {name}", Span(file, at, at, gap + folder))
    line_end = b"\r\n" if b"\r\n" in data else b"\n"
    line = b"install(DIRECTORY %s DESTINATION %s)" % (folder, _CATKIN if catkin else _SHARE)
    last_call = re.search(rb"^[ \t]*ament_package\s*\(", code, re.MULTILINE)
    if last_call is not None:
        span = Span(file, last_call.start(), last_call.start(), line + line_end)
    else:
        between = b"" if data.endswith(b"\n") or not data else line_end
        span = Span(file, len(data), len(data), between + line + line_end)
    return unsafe(f"install {name}", span)


@rule(
    INFO,
    on=("gazebo-classic", "gz"),
    effects={
        "gz, gazebo-classic": "look for model://NAME/…, which requires an exported path",
    },
    infos=True,
)
def gazebo_path_not_exported(
    robot: Robot, description: Description, targets: frozenset[str]
) -> Iterator[Problem]:
    """The package does not export a model path for Gazebo.

    Gazebo reads ``package://NAME/`` as ``model://NAME/``, and searches the paths in
    ``GAZEBO_MODEL_PATH`` or ``GZ_SIM_RESOURCE_PATH``. The ``<export>`` of ``package.xml``, or a
    launch file, must add the package to them. Robots for ROS 1 alone are not reported: its
    ``spawn_model`` replaces ``package://NAME`` by the folder of the package.
    """
    if "ros1" in targets and "ros2" not in targets:
        return
    own = description.packages.own
    if own is None or "model_path" in read_manifest_text(description.workspace, own[1]):
        return
    if _launch_sets_path(description.workspace, own[1]):
        return
    for use in get_mesh_uses(robot, description):
        if _get_package_name(use) == own[0]:
            yield Problem(
                use.link,
                f"package.xml of '{own[0]}' does not export the path of its meshes to Gazebo; "
                "write "
                '<export><gazebo_ros gazebo_model_path="${prefix}/.."/></export>',
                at=use.mesh.locate_attribute("filename"),
            )
            return


def _launch_sets_path(workspace: Workspace, package: Path) -> bool:
    """Tell whether a launch file or hook of the package sets the model path of Gazebo."""
    for folder in ("launch", "hooks", "env-hooks"):
        for path in workspace.list_matches(package / folder, "*")[:50]:
            text = read_package_text(workspace, path) if workspace.is_file(path) else ""
            if "RESOURCE_PATH" in text or "MODEL_PATH" in text:
                return True
    return False


_MODEL_PATH = '<gazebo_ros gazebo_model_path="${prefix}/.."/>'


@gazebo_path_not_exported.fix(BOTH)
def export_model_path(problem: Problem, context: FixContext) -> Proposal | None:
    """Export the model path.

    With catkin the export requires a dependency on gazebo_ros, so the fix is unsafe if the package
    has none.
    """
    manifest = parse_own_manifest(context)
    if manifest is None:
        return None
    root, export = manifest.root, manifest.root.find_child("export")
    if export is not None:
        change = append_child(export, _MODEL_PATH)
    else:
        change = append_child(root, "<export>", f"\t{_MODEL_PATH}", "</export>")
    words = {child.text.strip() for child in root.children if child.tag.endswith("depend")}
    if "catkin" not in words or "gazebo_ros" in words:
        return safe("export the path in package.xml", change)
    return unsafe(
        "export the path in package.xml, and depend on gazebo_ros",
        add_dependency(root, "gazebo_ros"),
        change,
    )


@rule(
    ERROR,
    effects={
        "pybullet, drake": "reject the robot if the other package is not found",
    },
)
def wrong_package_in_uri(robot: Robot, description: Description) -> Iterator[Problem]:
    """A mesh URI refers to a different package, but the mesh is in this one.

    This happens if a description is copied and renamed: its URIs still refer to the original
    package. If that package is installed, its meshes are shown.
    """
    own = description.packages.own
    if own is None:
        return
    wrong: dict[str, list[MeshUse]] = {}
    for use in get_mesh_uses(robot, description):
        if is_in_own_package(use, description):
            wrong.setdefault(_get_package_name(use), []).append(use)
    for name, uses in wrong.items():
        files = quote(dict.fromkeys(use.uri[10:].partition("/")[2] for use in uses), 3)
        yield Problem(
            uses[0].link,
            f"package '{name}' does not have {files}, but this package does; "
            f"write package://{own[0]}/…",
            at=uses[0].mesh.locate_attribute("filename"),
            data={"package": name, "write": own[0]},
        )


@wrong_package_in_uri.fix(UNSAFE, reveals=True)
def write_own_package(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the own package in all URIs of the other, if it has all of the files."""
    own = context.description.packages.own
    if own is None:
        return None
    changes = []
    for use in get_mesh_uses(context.robot, context.description):
        if use.uri.startswith(f"package://{problem.data['package']}/"):
            inside = use.uri.partition("://")[2].partition("/")[2]
            if not context.workspace.is_file(own[1] / inside):
                return None
            right = f"package://{own[0]}/"
            changes.append(substitute(use.mesh.element, "filename", "^package://[^/]*/", right))
    return unsafe(f"write package://{own[0]}/…", *changes) if changes else None
