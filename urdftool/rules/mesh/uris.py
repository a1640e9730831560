"""Check the URIs of mesh files."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from ...model.elements import Collision, Mesh, Robot
from ...source.description import Description
from ...source.document import Element
from ..fix import (
    OUTER_BLANKS,
    Change,
    FixContext,
    Proposal,
    safe,
    set_attribute,
    substitute,
    unsafe,
)
from ..mujoco import is_found_by_mujoco, keeps_visuals, read_mesh_folder
from ..rule import ERROR, INFO, SAFE, UNSAFE, URDF_AND_SDF, WARNING, Problem, rule
from ..xml.vocabulary_table import find_misspelled_attributes
from .changes import change_uses
from .mesh_uses import MeshUse, get_mesh_uses

APPLIES_TO = ("mesh",)


@rule(
    WARNING,
    effects={
        "pybullet, drake": "reject the robot on any other machine",
    },
    formats=URDF_AND_SDF,
)
def absolute_path(
    robot: Robot, description: Description, *, together: float = 3
) -> Iterator[Problem]:
    r"""A mesh has an absolute path.

    ``/home/…``, ``C:\…`` or ``file:///…`` works only on the machine where it was written; write a
    ``package://`` URI. ``file://$(find NAME)`` in xacro is accepted, because each machine resolves
    it. If the file does not exist on this machine either, it is an error, and more than
    ``together`` such files of one folder are one finding.
    """
    seen: set[str] = set()
    lost: dict[str, list[MeshUse]] = {}
    for use in get_mesh_uses(robot, description):
        if not use.is_fixed_path or use.uri in seen:
            continue
        seen.add(use.uri)
        if use.exists:
            yield _report_absolute(use)
        else:
            lost.setdefault(_get_folder(use), []).append(use)
    for folder, uses in lost.items():
        if len(uses) > together:
            yield _report_absolute(uses[0], len(uses) - 1, folder)
        else:
            yield from map(_report_absolute, uses)


def _report_absolute(use: MeshUse, others: int = 0, folder: str | None = None) -> Problem:
    """Report a mesh, and the number of other missing files in its folder."""
    name = use.uri.replace("\\", "/").rstrip("/").rpartition("/")[2]
    scheme = "package://PACKAGE" if use.mesh.xml is not None else "model://MODEL"
    more = "" if folder is None else f"; {others} more meshes refer to folder {folder}"
    data = {"uri": use.uri} if folder is None else {"uri": use.uri, "folder": folder}
    return Problem(
        use.link,
        f"mesh '{use.uri}' is an absolute path{'' if use.exists else ' that does not exist here'}; "
        f"write {scheme}/meshes/{name}{more}",
        at=use.mesh.locate_attribute("filename"),
        severity=None if use.exists else ERROR,
        data=data,
    )


def _get_folder(use: MeshUse) -> str:
    """Get the folder of a mesh as written in its URI."""
    return use.uri.replace("\\", "/").rstrip("/").rpartition("/")[0]


@absolute_path.fix(UNSAFE)
def write_package_uri(problem: Problem, context: FixContext) -> Proposal | None:
    """Write a URI of the own package, if it has the file or one of the same name.

    For a missing folder, all of its meshes that the package has are changed.
    """
    own = context.description.packages.own

    def change(use: MeshUse) -> Change | None:
        uri = _get_package_uri(use, own)
        if uri is None and own is not None:
            parts = use.uri.replace("\\", "/").split("/")
            if own[0] in parts[:-1]:
                rest = parts[len(parts) - parts[::-1].index(own[0]) :]
                if use.workspace.is_file(own[1].joinpath(*rest)):
                    uri = f"package://{own[0]}/{'/'.join(rest)}"
        return None if uri is None else set_attribute(use.mesh.element, "filename", uri)

    folder = problem.data.get("folder")
    if folder is None:
        changes = change_uses(problem, context, change)
    else:
        uses = get_mesh_uses(context.robot, context.description)
        lost = [use for use in uses if use.is_fixed_path and not use.exists]
        changes = list(filter(None, [change(use) for use in lost if _get_folder(use) == folder]))
    return unsafe("write a package:// URI", *changes) if changes else None


def _get_package_uri(use: MeshUse, own: tuple[str, Path] | None) -> str | None:
    """Get the package URI of a mesh; None if the package does not have the file."""
    files = use.workspace
    if use.path is None or own is None or not files.is_file(use.path):
        return None
    inside = os.path.relpath(files.resolve_links(use.path), files.resolve_links(own[1]))
    inside = inside.replace(os.sep, "/")
    return None if inside.startswith("..") else f"package://{own[0]}/{inside}"


_URDFDOM = "urdfdom, gz, gazebo-classic, pinocchio"


@rule(
    ERROR,
    effects={
        f"{_URDFDOM} (a visual)": (
            "load the link without its visuals and collisions, with an error in the log"
        ),
        f"{_URDFDOM} (a collision)": (
            "load the link without its collisions, with an error in the log"
        ),
        "pybullet, drake": "reject the robot",
        "mujoco": "rejects the file",
    },
)
def mesh_without_filename(robot: Robot) -> Iterator[Problem]:
    """A ``<mesh>`` has no ``filename``.

    urdfdom stops reading the link at this element and drops the rest of it: a visual without a
    file also loses the collisions of the link, and ``check_urdf`` still reports success.
    """
    keeps = keeps_visuals(robot)
    for link, shape in robot.shapes:
        if not isinstance(shape.geometry, Mesh):
            continue
        element = shape.geometry.element
        if "filename" in element.attributes or _is_misspelled(element):
            continue
        yield Problem(
            link,
            f"a <mesh> of link '{link.name}' has no filename; add the file name, "
            f"or remove the <{shape.element.tag}>",
            at=element,
            effects=[
                *(f"{_URDFDOM} (a {shape.element.tag})", "pybullet, drake"),
                *["mujoco"] * (keeps or isinstance(shape, Collision)),
            ],
        )


def _is_misspelled(element: Element) -> bool:
    """Tell whether the attribute has a misspelled name, which another rule reports."""
    if "filename" in find_misspelled_attributes(element).values():
        return True
    return any(name in element.attributes or element.find_child(name) for name in _MISNAMED)


_MISNAMED = ("uri", "file", "url")


@rule(
    ERROR,
    effects={
        "pybullet, drake": "reject the robot: the file is not found",
        "mujoco": "rejects the robot: the file is not found",
    },
    group="robot",
)
def malformed_uri(robot: Robot, description: Description) -> Iterator[Problem]:
    r"""The URI of a mesh file is malformed.

    Backslashes, ``package:/`` with one slash, or an empty name: some readers correct it and others
    do not. Spaces and ``%20`` work if a reader uses the URI as a path, and fail if it parses the
    URI; they are a warning if the file is found here. A double slash in the path is an info,
    because readers that use it as a path open the file. If the file of such a URI does not exist,
    ``mesh-not-found`` reports it instead.
    """
    seen: set[str] = set()
    keeps, meshes = keeps_visuals(robot), read_mesh_folder(robot)
    for use in get_mesh_uses(robot, description):
        if use.uri in seen:
            continue
        seen.add(use.uri)
        wrong = find_malformation(use)
        if wrong:
            element = use.mesh.element
            beside = _is_beside(use, description)
            passes = (use.exists or beside) and "\\" not in use.uri
            passes = passes or (wrong.defect == "blank" and use.path is None)
            slashes, named = wrong.defect == "double slash", wrong.defect != "no file"
            opened = keeps or use.collides
            lost = opened and not is_found_by_mujoco(use, meshes, description)
            path = use.uri.partition("://")[2].strip("/")
            right = f"mesh '{use.uri}' names no file of a package; write '{path}'"
            yield Problem(
                use.link,
                right if beside and not named else wrong.text,
                at=element.locate_attribute("filename"),
                severity=INFO if slashes else WARNING if passes and named else ERROR,
                data={"uri": use.uri, "defect": wrong.defect},
                alike=wrong.defect,
                effects=[
                    *["pybullet, drake"] * (not passes),
                    *["mujoco"] * (lost and (beside or not passes)),
                ],
            )


def _is_beside(use: MeshUse, description: Description) -> bool:
    """Tell whether the path of a URI is a file from the folder of the description on.

    PyBullet opens ``package:///arm.stl`` so; MuJoCo 4.0 does not.
    """
    inside = use.uri.partition("://")[2].lstrip("/")
    return bool(inside) and use.workspace.is_file(description.packages.file.parent / inside)


class Malformation(NamedTuple):
    """A defect of the URI of a mesh.

    Attributes:
        defect: ``empty``, ``lacks slash``, ``no file``, ``backslash``, ``outer blank``,
            ``double slash`` or ``blank``.
        text: Message about it.
    """

    defect: str
    text: str


def find_malformation(use: MeshUse) -> Malformation | None:
    """Find the defect of a mesh URI; None if it has none."""
    uri = use.uri
    scheme, separator, rest = uri.partition("://")
    if (
        (use.mesh.xml is not None and "filename" not in use.mesh.xml.attributes)
        or "${" in uri
        or "$(" in uri
    ):
        return None
    absent = use.path is not None and not use.exists
    defect, what = "", ""
    if not uri.strip():
        what = f"a mesh of link '{use.link.name}' has an empty filename; add the file name"
        return Malformation("empty", what)
    if re.match(r"(package|model|file):(?!//)", uri):
        name, _, path = uri.partition(":")
        defect, what = "lacks slash", f"lacks a slash; write '{name}://{path.lstrip('/')}'"
    elif separator and scheme in ("package", "model") and not rest.strip("/").partition("/")[2]:
        defect, what = "no file", f"names no file; write {scheme}://PACKAGE/meshes/FILE"
    elif "\\" in uri and not use.is_absolute:
        defect, what = "backslash", f"has backslashes; write '{uri.replace(chr(92), '/')}'"
    elif uri != uri.strip():
        defect, what = "outer blank", "begins or ends with a space; remove it"
    elif separator and scheme in ("package", "model") and "//" in rest and not absent:
        right = re.sub("/{2,}", "/", rest)
        defect, what = "double slash", f"has a double slash; write '{scheme}://{right}'"
    elif separator and ("%20" in uri or (" " in uri and not absent)):
        defect, what = "blank", "contains a space, which URIs do not allow; rename the file"
    return Malformation(defect, f"mesh '{uri}' {what}") if defect else None


_REPAIRS = {
    "lacks slash": (r"^(package|model|file):/*", r"\1://"),
    "backslash": (r"\\+", "/"),
    "double slash": (r"(?<!:)/{2,}", "/"),
    "outer blank": (OUTER_BLANKS, ""),
}
"""Pattern in the URI as written, and its replacement, by the defect."""


@malformed_uri.fix(SAFE, reveals=True)
def correct_uri(problem: Problem, context: FixContext) -> Proposal | None:
    """Correct slashes, and remove outer spaces; a missing name is not corrected."""
    if problem.data["defect"] not in _REPAIRS:
        return None
    pattern, new = _REPAIRS[problem.data["defect"]]

    def change(use: MeshUse) -> Change:
        return substitute(use.mesh.element, "filename", pattern, new)

    changes = change_uses(problem, context, change)
    return safe("correct the URI", *changes) if changes else None


@rule(
    WARNING,
    raised={"pybullet": ERROR},
    effects={
        "rviz": "downloads it",
        "gz": "downloads from Fuel servers only",
        "pybullet, drake": "reject the robot",
        "pinocchio": "rejects the geometry of the robot",
        "mujoco": "rejects the file (4.0)",
    },
)
def unsupported_uri_scheme(robot: Robot, description: Description) -> Iterator[Problem]:
    """A mesh URI has a scheme that most readers do not support.

    URDF readers support ``package://`` and ``file://``, Gazebo also ``model://``. Some readers
    download ``https://``; all others reject the robot or omit the shape. A download can change at
    any time and requires a network. A scheme that no reader supports is an error. One finding
    names all files of a server.
    """
    keeps, meshes = keeps_visuals(robot), read_mesh_folder(robot)
    found: dict[str, list[MeshUse]] = {}
    for use in get_mesh_uses(robot, description):
        scheme, separator, rest = use.uri.partition("://")
        if separator and re.fullmatch(r"[A-Za-z][\w+.-]*", scheme) and scheme not in _LOCAL:
            found.setdefault(f"{scheme}://{rest.partition('/')[0]}", []).append(use)
    for server, uses in found.items():
        first = uses[0]
        count = len({use.uri for use in uses})
        more = f" and {count - 1} more of this server" if count > 1 else ""
        lost = [use for use in uses if not is_found_by_mujoco(use, meshes, description)]
        scheme = server.partition("://")[0]
        known = scheme.lower() in ("http", "https")
        if known:
            what = "most readers do not download meshes; put the file into the package"
        else:
            what = f"no reader supports the scheme '{scheme}'; write package://PACKAGE/meshes/FILE"
        yield Problem(
            first.link,
            f"mesh '{first.uri}'{more}: {what}",
            at=first.mesh.locate_attribute("filename"),
            data={"scheme": scheme, "uris": list(dict.fromkeys(use.uri for use in uses))},
            severity=None if known else ERROR,
            effects=[
                *(["rviz", "gz"] if known else []),
                *("pybullet, drake", "pinocchio"),
                *["mujoco"] * any(keeps or use.collides for use in lost),
            ],
        )


_LOCAL = ("package", "model", "file")


@rule(
    WARNING,
    on=("ros1", "ros2", "gz"),
    effects={
        "rviz": "cannot find it, because the robot arrives on a topic without its folder",
        "gz": "cannot find it if the robot is passed as text",
    },
)
def relative_uri_in_ros(robot: Robot, description: Description) -> Iterator[Problem]:
    """A mesh in a ROS package has a relative path.

    A robot that arrives on a topic or a parameter has no folder, so RViz cannot resolve relative
    paths. Write ``package://NAME/…``, which every installation of the package resolves. One finding
    names all such meshes. A file that does not exist is a finding of ``mesh-not-found`` instead,
    and one outside of the package is left out, because no such URI names it. PyBullet takes the
    name in a URI as that of a folder above the description; if the folder of the package has
    another name, the message adds it.
    """
    own = description.packages.own
    if own is None:
        return
    uses = _select_relative(get_mesh_uses(robot, description))
    relative = [use for use in uses if _get_package_uri(use, own) is not None]
    if relative:
        first = relative[0]
        count = len({use.uri for use in relative})
        more = f" (and {count - 1} more)" if count > 1 else ""
        right = _get_package_uri(first, own)
        if own[1].name != own[0]:
            right = f"{right}, which PyBullet finds only in a folder '{own[0]}'"
        yield Problem(
            first.link,
            f"mesh '{first.uri}'{more} is a relative path; write {right}",
            at=first.mesh.locate_attribute("filename"),
            data={"uris": list(dict.fromkeys(use.uri for use in relative))},
        )


@relative_uri_in_ros.fix(UNSAFE)
def write_package_uris(problem: Problem, context: FixContext) -> Proposal | None:
    """Write all of them as URIs of the own package; None if it lacks one."""
    own = context.description.packages.own
    changes = []
    for use in _select_relative(get_mesh_uses(context.robot, context.description)):
        uri = _get_package_uri(use, own)
        if uri is None:
            continue  # it does not exist, or is not in the package
        changes.append(set_attribute(use.mesh.element, "filename", uri))
    return unsafe(f"write package://{own[0] if own else ''}/…", *changes) if changes else None


def _select_relative(uses: list[MeshUse]) -> list[MeshUse]:
    """Select the meshes with relative paths."""
    return [
        use
        for use in uses
        if use.uri.strip()
        and "://" not in use.uri
        and not use.is_absolute
        and not find_malformation(use)
    ]
