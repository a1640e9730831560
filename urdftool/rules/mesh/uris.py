"""How a mesh file is named."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator

from ...model.elements import Collision, Mesh, Robot
from ...source.description import Description
from ...source.document import Element
from ...source.packages import own_package
from ..mujoco import keeps_visuals
from ..rule import ERROR, INFO, WARNING, Problem, rule
from ..xml.vocabulary_table import misspelt_attributes
from .uses import MeshUse, mesh_uses

APPLIES_TO = ("mesh",)


@rule(
    WARNING,
    effects={
        "pybullet, drake": "reject the robot on any other machine",
    },
)
def absolute_path(
    robot: Robot, description: Description, *, together: float = 3
) -> Iterator[Problem]:
    r"""A mesh is named by a path from the root of a disk.

    ``/home/…``, ``C:\…`` or ``file:///…`` is right on the machine it was written on. What xacro
    makes of ``file://$(find NAME)`` is not meant: that is found anew on every machine. Where the
    file is not on this machine either, it is an error, and more than ``together`` such files of one
    folder are one.
    """
    told: set[str] = set()
    lost: dict[str, list[Problem]] = {}
    for use in mesh_uses(robot, description):
        if not use.is_absolute or use.uri in told or "$" in use.written:
            continue
        told.add(use.uri)
        folder = folder_of(use)
        name = use.uri.replace("\\", "/").rstrip("/").rpartition("/")[2]
        problem = Problem(
            use.link,
            f"mesh '{use.uri}' is a path of one machine{'' if use.exists else ', and not there'}; "
            f"write package://PACKAGE/meshes/{name}",
            at=use.mesh.element.attribute_place("filename"),
            severity=None if use.exists else ERROR,
        )
        if use.exists:
            yield problem
        else:
            lost.setdefault(folder, []).append(problem)
    for folder, problems in lost.items():
        if len(problems) > together:
            problems[0].message += f"; {len(problems) - 1} more are wanted from {folder}"
            del problems[1:]
        yield from problems


def folder_of(use: MeshUse) -> str:
    """The folder of a mesh as it is named."""
    return use.uri.replace("\\", "/").rstrip("/").rpartition("/")[0]


_URDFDOM = "urdfdom, gz, gazebo-classic, pinocchio"


@rule(
    ERROR,
    effects={
        _URDFDOM: (
            "load the link without its visuals and collisions (the collisions alone where it "
            "is in one), with an error in the log"
        ),
        "pybullet, drake": "reject the robot",
        "mujoco": "rejects the file",
    },
)
def mesh_without_filename(robot: Robot) -> Iterator[Problem]:
    """A ``<mesh>`` has no ``filename``.

    urdfdom stops reading the link at that point and keeps what it has: a visual without a file
    takes the collisions of the link with it, and ``check_urdf`` reports success.
    """
    keeps = keeps_visuals(robot)
    for link, shape in robot.shapes:
        if not isinstance(shape.geometry, Mesh):
            continue
        element = shape.geometry.element
        if "filename" in element.attributes or _is_misspelt(element):
            continue
        yield Problem(
            link,
            f"a <mesh> of link '{link.name}' has no filename; name the file, "
            f"or remove the <{shape.element.tag}>",
            at=element,
            effects=[
                *(_URDFDOM, "pybullet, drake"),
                *["mujoco"] * (keeps or isinstance(shape, Collision)),
            ],
        )


def _is_misspelt(element: Element) -> bool:
    """Whether the attribute is there under another name, which is a finding of its own."""
    if "filename" in misspelt_attributes(element).values():
        return True
    return any(name in element.attributes or element.child(name) for name in _MISNAMED)


_MISNAMED = ("uri", "file", "url")


@rule(
    ERROR,
    effects={
        "pybullet, drake": "reject the robot: the file is not found",
        "mujoco": "rejects the robot for a collision: the file is not found",
    },
)
def malformed_uri(robot: Robot, description: Description) -> Iterator[Problem]:
    r"""The name of a mesh file is no proper URI or path.

    Backslashes, ``package:/`` with one slash, no name at all: one loader mends it and the next
    does not. Blanks, ``%20`` and doubled slashes pass where the name is used as a path, and fail
    where it is taken for the URI it is; where the file is found here, they are a warning.
    """
    told: set[str] = set()
    for use in mesh_uses(robot, description):
        if use.uri in told:
            continue
        told.add(use.uri)
        wrong = malformation(use)
        if wrong:
            element = use.mesh.element
            passes = use.exists and "\\" not in use.uri
            yield Problem(
                use.link,
                wrong,
                at=element.attribute_place("filename"),
                severity=WARNING if passes else ERROR,
            )


def malformation(use: MeshUse) -> str:
    """What is wrong with how a mesh is named, with what would be right; empty if nothing is."""
    uri = use.uri
    scheme, separator, rest = uri.partition("://")
    if "filename" not in use.mesh.element.attributes or "${" in uri or "$(" in uri:
        return ""
    if not uri.strip():
        return f"a mesh of link '{use.link.name}' has an empty filename; name the file"
    if re.match(r"(package|model|file):(?!//)", uri):
        name, _, path = uri.partition(":")
        return f"mesh '{uri}' lacks a slash; write '{name}://{path.lstrip('/')}'"
    if separator and scheme in ("package", "model") and not rest.strip("/").partition("/")[2]:
        return f"mesh '{uri}' names no file; write {scheme}://PACKAGE/meshes/FILE"
    if "\\" in uri and not use.is_absolute:
        return f"mesh '{uri}' has backslashes; write '{uri.replace(chr(92), '/')}'"
    if uri != uri.strip():
        return f"mesh '{uri}' begins or ends with a blank; take it away"
    if separator and scheme in ("package", "model") and "//" in rest:
        right = re.sub("/{2,}", "/", rest)
        return f"mesh '{uri}' has a doubled slash; write '{scheme}://{right}'"
    if separator and (" " in uri or "%20" in uri):
        return f"mesh '{uri}' has a blank in it, which no URI may have; take it out of the name"
    return ""


@rule(
    WARNING,
    raised={"pybullet": ERROR},
    effects={
        "rviz": "downloads it",
        "gz": "downloads from Fuel servers alone",
        "pybullet, drake": "reject the robot",
        "pinocchio": "rejects the shapes of the robot",
        "mujoco": "rejects the file (4.0)",
    },
)
def unsupported_uri_scheme(robot: Robot, description: Description) -> Iterator[Problem]:
    """A mesh is to be downloaded, or its URI begins with an unknown scheme.

    URDF knows ``package://`` and ``file://``, Gazebo ``model://`` as well. Some readers download
    ``https://``; all others reject the robot or leave the shape out. A robot that does is not the
    same tomorrow, and does not load without a network. Of a scheme that no reader knows the shape
    is missing in all of them; that is an error. One finding names the files of a server.
    """
    keeps = keeps_visuals(robot)
    found: dict[str, list[MeshUse]] = {}
    for use in mesh_uses(robot, description):
        scheme, separator, rest = use.uri.partition("://")
        if separator and re.fullmatch(r"[A-Za-z][\w+.-]*", scheme) and scheme not in _LOCAL:
            found.setdefault(f"{scheme}://{rest.partition('/')[0]}", []).append(use)
    for server, uses in found.items():
        first = uses[0]
        count = len({use.uri for use in uses})
        more = f" and {count - 1} more from there" if count > 1 else ""
        scheme = server.partition("://")[0]
        known = scheme.lower() in ("http", "https")
        if known:
            what = "most readers download nothing; put the file into the package"
        else:
            what = f"no reader knows the scheme '{scheme}'; write package://PACKAGE/meshes/FILE"
        yield Problem(
            first.link,
            f"mesh '{first.uri}'{more}: {what}",
            at=first.mesh.element.attribute_place("filename"),
            severity=None if known else ERROR,
            effects=[
                *(["rviz", "gz"] if known else []),
                *("pybullet, drake", "pinocchio"),
                *["mujoco"] * (keeps or any(use.collides for use in uses)),
            ],
        )


_LOCAL = ("package", "model", "file")


@rule(
    WARNING,
    on=("ros1", "ros2", "gz"),
    effects={
        "rviz": "cannot find it, for the robot comes over a topic without its folder",
        "gz": "cannot find it when the robot is given as text",
    },
)
def relative_uri_in_ros(robot: Robot, description: Description) -> Iterator[Problem]:
    """A mesh is named by a relative path, in a ROS package.

    Relative to what? A robot that comes over a topic or a parameter has no folder.
    ``package://NAME/…`` is found wherever the package is. One finding names the meshes.
    """
    own = own_package(description.packages.file)
    if own is None:
        return
    relative = [
        use
        for use in mesh_uses(robot, description)
        if use.uri.strip()
        and "://" not in use.uri
        and not use.is_absolute
        and not malformation(use)
    ]
    if relative:
        first = relative[0]
        count = len({use.uri for use in relative})
        more = f" (and {count - 1} more)" if count > 1 else ""
        right = f"package://{own[0]}/…"
        if first.path is not None and first.exists:
            inside = os.path.relpath(os.path.normpath(first.path), own[1]).replace(os.sep, "/")
            right = right if inside.startswith("..") else f"package://{own[0]}/{inside}"
        yield Problem(
            first.link,
            f"mesh '{first.uri}'{more} is a relative path; write {right}",
            at=first.mesh.element.attribute_place("filename"),
        )


@rule(
    WARNING,
    effects={
        "mujoco, pybullet, pinocchio": "open a file with a blank in its name",
    },
)
def unsafe_file_name(robot: Robot, description: Description) -> Iterator[Problem]:
    """The name of a mesh file has a character that is special somewhere.

    ``#``, ``?`` and ``%`` mean something in a URI, letters beyond ASCII are encoded in several
    ways, and a blank ends a word.
    """
    told: set[str] = set()
    for use in mesh_uses(robot, description):
        if use.uri in told or malformation(use) or "${" in use.uri or "$(" in use.uri:
            continue
        told.add(use.uri)
        odd = sorted({c for c in use.uri if c in '#?%<>|*"' or c == " " or not c.isascii()})
        if odd:
            what = "a blank" if odd == [" "] else " ".join(f"'{c}'" for c in odd)
            yield Problem(
                use.link,
                f"mesh '{use.uri}' has {what} in its name; use letters, digits, _ and -",
                at=use.mesh.element.attribute_place("filename"),
            )


@rule(
    INFO,
    on=("mujoco",),
    effects={"mujoco": "cannot open package:// paths"},
)
def package_uri_unresolvable(robot: Robot, description: Description) -> Iterator[Problem]:
    """A robot for MuJoCo names meshes by package.

    MuJoCo does not know ROS packages. Its ``<mujoco><compiler meshdir="…" strippath="true"/>`` in
    the URDF drops the folders and looks for the files in one place; before 3.7 it drops them
    anyway.
    """
    for mujoco in robot.element.all("mujoco"):
        compiler = mujoco.child("compiler")
        if compiler is not None and {"meshdir", "strippath"} & compiler.attributes.keys():
            return
    for use in mesh_uses(robot, description):
        if use.uri.startswith("package://") and use.collides:
            yield Problem(
                use.link,
                f"MuJoCo cannot open '{use.uri}'; "
                'write <mujoco><compiler meshdir="…" strippath="true"/> into the robot',
                at=use.mesh.element.attribute_place("filename"),
            )
            return


@rule(
    WARNING,
    raised={"mujoco": ERROR},
    on=("mujoco",),
    effects={
        "mujoco": "3.3 takes one file for both; 4.0 loads the two",
    },
)
def mesh_stem_collision(robot: Robot, description: Description) -> Iterator[Problem]:
    """Two mesh files have one name, but for their folders or endings.

    MuJoCo before 4.0 calls a mesh by the name of its file alone: ``visual/arm.stl`` and
    ``collision/arm.stl`` are both ``arm``. Visuals count where the robot's ``<compiler>`` keeps
    them.
    """
    all_of_them = keeps_visuals(robot)
    first: dict[str, str] = {}
    found: dict[str, MeshUse] = {}
    for use in mesh_uses(robot, description):
        if not (use.collides or all_of_them):
            continue  # MuJoCo drops visuals
        stem = use.uri.replace("\\", "/").rpartition("/")[2].rpartition(".")[0]
        other = first.setdefault(stem, use.uri)
        if stem and other != use.uri:
            found.setdefault(stem, use)
    if found:
        stem, use = next(iter(found.items()))
        more = f" (and {len(found) - 1} more pairs)" if len(found) > 1 else ""
        yield Problem(
            use.link,
            f"meshes '{first[stem]}' and '{use.uri}' are both '{stem}' to MuJoCo{more}; rename one",
            at=use.mesh.element.attribute_place("filename"),
        )
