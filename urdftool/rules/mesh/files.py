"""Whether the files are there."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from itertools import takewhile
from mmap import ACCESS_READ, mmap
from pathlib import Path
from typing import BinaryIO

from ...geometry.stl_header import LFS_MARK, read_stl_header
from ...model.elements import Robot
from ...source.description import Description
from ...source.packages import own_package, shown_path
from ...workspace import Workspace, memoized
from ..fix import Change, FixContext, Proposal, safe, substitute
from ..mujoco import keeps_visuals
from ..rule import ERROR, SAFE, Problem, rule
from ..words import nearest
from .changes import change_uses
from .dropped import is_dropped
from .uris import malformation
from .uses import MeshUse, actual_case, mesh_uses

APPLIES_TO = ("mesh",)

_MAX_FILES = 5000
_NOT_OPENED = "urdfdom, gz, gazebo-classic"


@rule(
    ERROR,
    effects={
        "rviz": "shows nothing there, and reports 'Could not load mesh resource'",
        "gz": "shows nothing there",
        "pybullet, drake (nowhere)": "reject the robot",
        "drake (above)": "rejects the robot",
        "mujoco": "rejects the robot",
        "urdfdom, gz, gazebo-classic": "load the robot without opening the file (sdformat 12.3)",
    },
)
def mesh_not_found(
    robot: Robot, description: Description, *, together: float = 3
) -> Iterator[Problem]:
    """A mesh file is not there.

    The path leads to no file, and the link is not seen or does not collide. Whoever looks at the
    model with the meshes cached or in another checkout does not notice. A file that is wanted in
    several places is one finding, and so are more than ``together`` files of one folder that is
    not there.
    """
    wanted: dict[Path, list[MeshUse]] = {}
    for use in mesh_uses(robot, description):
        if use.path is None or use.exists or use.is_absolute:
            continue
        if (
            malformation(use)
            or actual_case(use.workspace, use.path)
            or _is_in_own_package(use, description)
        ):
            continue
        wanted.setdefault(Path(os.path.normpath(use.path)), []).append(use)
    folders: dict[Path, list[Path]] = {}
    for path in wanted:
        folders.setdefault(_missing_folder(description.workspace, path), []).append(path)
    keeps = keeps_visuals(robot)
    for folder, paths in folders.items():
        if len(paths) > together and not description.workspace.exists(folder):
            first = wanted[paths[0]][0]
            yield Problem(
                first.link,
                f"the folder '{shown_path(folder)}' is not there, and {len(paths)} meshes are "
                f"wanted from it, first '{first.uri}'",
                at=first.mesh.element.attribute_place("filename"),
                data={"folder": str(folder), "count": len(paths)},
                effects=_of_missing(keeps, [use for path in paths for use in wanted[path]]),
            )
            continue
        for path in paths:
            first = wanted[path][0]
            yield Problem(
                first.link,
                f"mesh '{first.uri}' of link '{first.link.name}' is not there: "
                f"no file '{shown_path(path)}'{_elsewhere(description.workspace, path)}",
                at=first.mesh.element.attribute_place("filename"),
                data={"uri": first.uri, "path": str(path)},
                effects=_of_missing(keeps, wanted[path]),
            )


def _of_missing(keeps: bool, uses: list[MeshUse]) -> list[str]:
    """The effects of a missing file: MuJoCo opens that of a visual only where it keeps visuals.

    RViz and gz do not look for that of a shape that urdfdom drops.
    """
    shown = () if all(map(is_dropped, uses)) else ("rviz", "gz")
    opened = keeps or any(use.collides for use in uses)
    rejecting = "drake (above)" if all(map(_is_above, uses)) else "pybullet, drake (nowhere)"
    return [*shown, _NOT_OPENED, rejecting, *["mujoco"] * opened]


def _is_above(use: MeshUse) -> bool:
    """Whether PyBullet finds a file: it looks in each folder above that of the description."""
    path = use.uri.removeprefix("package://").removeprefix("file://")
    folder = Path(use.workspace.real_path(use.mesh.element.file.path)).parent
    folders = (folder, *folder.parents[:-1])
    return any(use.workspace.is_file(above / path) for above in folders)


def _is_in_own_package(use: MeshUse, description: Description) -> bool:
    from ..package.resolution import is_in_own_package

    return is_in_own_package(use, description)


def _missing_folder(workspace: Workspace, path: Path) -> Path:
    """The uppermost folder above a file that is not there; its own folder where that is there."""
    folder = path.parent
    while (
        folder != folder.parent
        and not workspace.exists(folder)
        and not workspace.exists(folder.parent)
    ):
        folder = folder.parent
    return folder


def _elsewhere(workspace: Workspace, path: Path) -> str:
    """A hint at a file of nearly that name there, or of that name elsewhere in the package."""
    try:
        names = [entry.name for entry in workspace.list_folder(path.parent)]
        near = nearest(path.name, names, 0.8)
    except OSError:
        near = ""
    if near:
        return f"; did you mean '{near}'?"
    own = own_package(path, workspace)
    if own is None:
        return ""
    folder = str(own[1])
    other = _files_below(workspace, folder).get(path.name)
    return f"; there is '{os.path.relpath(other, folder)}' in its package" if other else ""


@memoized
def _files_below(workspace: Workspace, folder: str) -> dict[str, str]:
    return dict(_files(workspace, folder))


def _files(workspace: Workspace, folder: str) -> Iterator[tuple[str, str]]:
    count = 0
    for where, folders, names in workspace.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in names:
            yield name, os.path.join(where, name)
        count += len(names)
        if count > _MAX_FILES:
            return


@rule(
    ERROR,
    effects={
        "pybullet, drake": (
            "reject the robot on Linux, which tells capitals apart; macOS and Windows do not "
            "by default"
        ),
        "mujoco": "rejects the robot for a collision on Linux",
    },
)
def mesh_case_mismatch(robot: Robot, description: Description) -> Iterator[Problem]:
    """A mesh file is there under a name with other capitals.

    ``Base.STL`` and ``base.stl`` are one file on macOS and Windows and two on Linux, where robots
    and build servers are.
    """
    told: set[str] = set()
    for use in mesh_uses(robot, description):
        if use.path is None or use.exists or use.uri in told:
            continue
        actual = actual_case(use.workspace, use.path)
        if actual is not None:
            told.add(use.uri)
            pairs = zip(actual.parts, use.path.parts, strict=True)
            same = sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs))
            shown = "/".join(actual.parts[same:])
            yield Problem(
                use.link,
                f"mesh '{use.uri}' is called '{shown}' on disk; capitals must agree",
                at=use.mesh.element.attribute_place("filename"),
                data={"uri": use.uri, "name": shown},
            )


@mesh_case_mismatch.fix(SAFE)
def write_name_on_disk(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the name with the capitals that the file and its folders have on disk."""

    def change(use: MeshUse) -> Change | None:
        if use.path is None:
            return None
        actual = actual_case(use.workspace, use.path)
        if actual is None:
            return None
        new = use.uri
        for wanted, there in zip(use.path.parts, actual.parts, strict=True):
            if wanted != there:
                head, found, tail = new.rpartition(wanted)
                if not found:
                    return None
                new = head + there + tail
        pattern, text = _tail(use.uri, new)
        return substitute(use.mesh.element, "filename", pattern, text)

    changes = change_uses(problem, context, change)
    return safe("write it as the file is called", *changes) if changes else None


def _tail(old: str, new: str) -> tuple[str, str]:
    """Return where two names of one length differ: a pattern for the end of one, and the other."""
    differs = next((i for i, (a, b) in enumerate(zip(old, new, strict=False)) if a != b), 0)
    same = old.rfind("/", 0, differs) + 1
    return re.escape(old[same:]) + "$", new[same:].replace("\\", r"\\")


@rule(
    ERROR,
    effects={
        "rviz": "shows nothing there",
        "mujoco": (
            "rejects the robot: 'perhaps this is an ASCII file?'; takes the hull of the points "
            "of an OBJ without faces"
        ),
        "pybullet": "loads the link without the shape, with a warning",
        "pinocchio": "rejects the shapes of the robot",
        "drake": "rejects the robot for a collision",
    },
)
def corrupt_mesh(robot: Robot, description: Description) -> Iterator[Problem]:
    """A mesh file is there and holds no mesh.

    An empty file, an STL file that ends before its last triangle, or a file without triangles: an
    OBJ with points and lines alone, a COLLADA file whose geometry was left out at its export.
    Readers say something about numbers or the format, or nothing.
    """
    told: set[Path] = set()
    for use in mesh_uses(robot, description):
        if use.path is None or not use.exists or use.path in told:
            continue
        told.add(use.path)
        wrong = what_is_wrong(use)
        if wrong and wrong != _LFS:
            yield Problem(
                use.link,
                f"mesh '{use.uri}' {wrong}",
                at=use.mesh.element.attribute_place("filename"),
                data={"uri": use.uri},
            )


@rule(
    ERROR,
    effects={
        "rviz": "shows nothing there",
        "mujoco": "rejects the robot: a wrong header or number of faces",
        "pybullet": "loads the link without the shape, with a warning",
        "pinocchio": "rejects the shapes of the robot",
        "drake": "rejects the robot for a collision",
    },
    group="repository",
)
def git_lfs_pointer(robot: Robot, description: Description) -> Iterator[Problem]:
    """A mesh file is a pointer that git-lfs left in place of the file.

    The repository keeps its meshes in git-lfs, and this checkout has not fetched them: each mesh
    is a text of three lines. Readers report numbers or formats that are wrong, or nothing. One
    ``git lfs pull`` fetches all of them, so all pointers of a repository are one finding.
    """
    reported: set[Path] = set()
    for use in mesh_uses(robot, description):
        if use.path is None or not use.exists or use.path in reported:
            continue
        reported.add(use.path)
        if what_is_wrong(use) == _LFS:
            yield Problem(
                use.link,
                f"mesh '{use.uri}' {_LFS}",
                at=use.mesh.element.attribute_place("filename"),
                data={"uri": use.uri},
                group="{count} mesh files are pointers of git-lfs, not the files themselves, in "
                "the links {names}; run 'git lfs pull'",
            )


def what_is_wrong(use: MeshUse) -> str:
    """What keeps a file from being a mesh, to be read after its name; empty where nothing does."""
    if use.path is None:
        return ""
    try:
        path = use.workspace.local(use.path)
        if path.suffix.lower() != ".stl":
            with open(path, "rb") as file:
                head = file.read(len(LFS_MARK))
                if not head:
                    return "is an empty file"
                if head == LFS_MARK:
                    return _LFS
                return "has no faces" if _has_no_faces(file, path.suffix.lower()) else ""
        facts = read_stl_header(path)
    except OSError as error:
        return f"cannot be read: {(error.strerror or 'unknown').lower()}"
    if facts.kind == "lfs-pointer":
        return _LFS
    if facts.kind == "empty":
        return "is an empty file"
    if facts.kind == "unknown":
        return "is no STL file"
    if facts.kind == "binary" and facts.triangles == 0:
        return "has no triangles"
    expected = facts.expected_bytes
    if expected is not None and facts.bytes < expected:
        return (
            f"ends too early: {facts.triangles} triangles want {expected} bytes, "
            f"and it has {facts.bytes}"
        )
    return ""


_FACES = {
    ".obj": (b"\nf ", re.compile(rb"(?:^|[\r\n])[ \t]*fo?[ \t]")),
    ".dae": (b"<triangles", re.compile(rb"<(?:\w+:)?(?:triangles|polylist|polygons|tri\w+s)\b")),
}
"""What begins a face, by the ending of a file: what it mostly is, and all that it may be."""


def _has_no_faces(file: BinaryIO, suffix: str) -> bool:
    """Whether a file of points says nothing of how they are joined."""
    if suffix not in _FACES:
        return False
    mostly, any_of = _FACES[suffix]
    with mmap(file.fileno(), 0, access=ACCESS_READ) as data:
        if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
            return False  # UTF-16, in which every second byte is none of a letter
        return data.find(mostly) < 0 and any_of.search(data) is None


_LFS = "is a pointer of git-lfs, not the file itself; run 'git lfs pull'"
