"""Check that mesh files exist and contain a mesh."""

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
from ...model.mesh_formats import get_suffix
from ...source.description import Description
from ...source.packages import find_own_package, shorten_path
from ...workspace import Workspace, memoize_by_workspace
from ..fix import Change, FixContext, Proposal, safe, substitute
from ..mujoco import find_lost_in_mujoco, keeps_visuals, locate_in_mujoco, read_mesh_folder
from ..rule import ERROR, INFO, SAFE, URDF_AND_SDF, WARNING, Problem, rule
from ..words import find_nearest
from .archives import find_packed
from .changes import change_uses
from .dropped import is_dropped
from .found_by_mujoco import report_found_by_mujoco, report_lost, take_found_by_mujoco
from .mesh_uses import MeshUse, find_actual_case, get_mesh_uses
from .uris import find_malformation

APPLIES_TO = ("mesh",)

_MAX_FILES = 5000
"""Number of files of a folder up to which it is searched for a mesh. Chosen, no source."""

_NOT_OPENED = "urdfdom, gz, gazebo-classic"


@rule(
    ERROR,
    effects={
        "rviz": "shows nothing for this shape, and reports 'Could not load mesh resource'",
        "gz": "shows nothing for this shape",
        "pybullet, drake (nowhere)": "reject the robot",
        "drake (above)": "rejects the robot",
        "mujoco": "rejects the robot",
        "mujoco (folder)": "rejects the robot; 3.3 loads it if the file is in the folder",
        "newton": "drops the shape with a warning",
        "urdfdom, gz, gazebo-classic": "load the robot without opening the file (sdformat 12.3)",
    },
    formats=URDF_AND_SDF,
    group="robot",
)
def mesh_not_found(
    robot: Robot, description: Description, *, together: float = 3
) -> Iterator[Problem]:
    """A mesh file does not exist.

    The link then has no visual or no collision geometry, or readers reject the robot. It goes
    unnoticed on machines that have the file in a cache or in another checkout. Several uses of one
    file are one finding, and so are missing files of one folder; without the folder, if they are
    more than ``together``.
    A ``file://`` URI with a relative path names no file for RViz, even if the file is next to the
    description, where PyBullet and readers with a path of resources find it. All of them are one
    finding.
    If ``<mujoco><compiler meshdir="…">`` names a folder, MuJoCo searches the files there. Files
    that exist and that it does not find are a warning, and so are files that only it finds.
    Files in a zip file next to the description are an info: a program unpacks it at its start.
    Files outside of the project are not read; the summary counts them as not checked.
    """
    missing: dict[Path, list[MeshUse]] = {}
    yield from _report_refused(get_mesh_uses(robot, description))
    lost = find_lost_in_mujoco(robot, description)
    yield from report_lost(lost, robot, description)
    yield from _report_relative(get_mesh_uses(robot, description), lost)
    for use in get_mesh_uses(robot, description):
        if use.path is None or use.exists or use.is_fixed_path or _get_relative_path(use):
            continue
        if (
            find_malformation(use)
            or find_actual_case(use.workspace, use.path)
            or _is_in_own_package(use, description)
        ):
            continue
        missing.setdefault(Path(os.path.normpath(use.path)), []).append(use)
    found = take_found_by_mujoco(missing, robot, description)
    if found:
        yield report_found_by_mujoco(robot, found, _select_effects([], found))
    for archive, paths in find_packed(list(missing), description).items():
        uses = [use for path in paths for use in missing.pop(path)]
        yield Problem(
            uses[0].link,
            f"{len(paths)} mesh files are only in '{shorten_path(archive)}', first "
            f"'{uses[0].uri}'; unpack it before the robot is loaded",
            at=uses[0].mesh.locate_attribute("filename"),
            data={"archive": str(archive), "count": len(paths)},
            severity=INFO,
            effects=_select_effects(lost, uses),
        )
    folders: dict[Path, list[Path]] = {}
    for path in missing:
        folders.setdefault(_find_missing_folder(description.workspace, path), []).append(path)
    for folder, paths in folders.items():
        if len(paths) > together and not description.workspace.exists(folder):
            first = missing[paths[0]][0]
            yield Problem(
                first.link,
                f"folder '{shorten_path(folder)}' does not exist, but {len(paths)} meshes refer to "
                f"it, first '{first.uri}'",
                at=first.mesh.locate_attribute("filename"),
                data={"folder": str(folder), "count": len(paths)},
                alike=str(folder),
                effects=_select_effects(lost, [use for path in paths for use in missing[path]]),
            )
            continue
        for path in paths:
            first = missing[path][0]
            similar = _suggest_file(description.workspace, path)
            yield Problem(
                first.link,
                f"mesh file of link '{first.link.name}' does not exist: '{first.uri}' refers to "
                f"'{shorten_path(path)}'{similar}",
                at=first.mesh.locate_attribute("filename"),
                data={"uri": first.uri, "path": str(path)},
                alike=str(path if similar else path.parent),
                group=f"{{count}} mesh files of the folder '{shorten_path(path.parent)}' do not "
                f"exist, first '{first.uri}'; links: {{names}}",
                effects=_select_effects(lost, missing[path]),
            )


def _report_refused(uses: list[MeshUse]) -> Iterator[Problem]:
    """Report devices and pipes; the summary counts other files that may not be read."""
    groups: dict[str, dict[str, MeshUse]] = {}
    for use in uses:
        if use.refusal and not use.is_unread:
            groups.setdefault(use.refusal_reason, {}).setdefault(use.uri, use)
    for group in groups.values():
        use, others = next(iter(group.values())), len(group) - 1
        more = f" (and {others} more meshes)" if others else ""
        yield Problem(
            use.link,
            f"mesh of link '{use.link.name}' is not read{more}: {use.refusal}",
            at=use.mesh.locate_attribute("filename"),
            severity=WARNING,
            data={"uri": use.uri, "refusal": use.refusal},
            alike=use.uri,
            effects=[],
        )


def _get_relative_path(use: MeshUse) -> str:
    """Get the path of a ``file://`` URI that is relative; empty for other URIs."""
    scheme, separator, rest = use.uri.partition("://")
    return "" if not separator or scheme != "file" or use.is_absolute else rest


def _report_relative(uses: list[MeshUse], lost: list[MeshUse]) -> Iterator[Problem]:
    """Report ``file://`` URIs with a relative path, those next to the description on their own."""
    groups: dict[bool, list[MeshUse]] = {}
    for use in uses:
        if _get_relative_path(use) and not find_malformation(use):
            groups.setdefault(_is_above(use), []).append(use)
    for above, group in groups.items():
        use, count = group[0], len({use.uri for use in group})
        path = _get_relative_path(use)
        more = f" (and {count - 1} more)" if count > 1 else ""
        there = f"'{path}' does not exist in the folder of the description or above it"
        if above:
            there = f"'{path}' exists at the description or above it, where PyBullet finds it, and "
            there += "Gazebo if its resource path names that folder"
        yield Problem(
            use.link,
            f"mesh '{use.uri}'{more} is a file:// URI without an absolute path; {there}; write "
            "package://PACKAGE/… or a relative path without file://",
            at=use.mesh.locate_attribute("filename"),
            data={"uri": use.uri, "path": path, "count": count},
            alike=path,
            effects=[one for one in _select_effects(lost, group) if not above or one != "gz"],
        )


def _select_effects(lost: list[MeshUse], uses: list[MeshUse]) -> list[str]:
    """Select the effects of a missing file.

    RViz and gz do not open the file of a shape that urdfdom drops.
    """
    shown = () if all(map(is_dropped, uses)) else ("rviz", "gz")
    opened = any(use is other for use in uses for other in lost)
    rejecting = "drake (above)" if all(map(_is_above, uses)) else "pybullet, drake (nowhere)"
    return [*shown, _NOT_OPENED, rejecting, *["mujoco"] * opened]


def _is_above(use: MeshUse) -> bool:
    """Tell whether PyBullet finds a file, as it searches all folders above the description."""
    path = use.uri.removeprefix("package://").removeprefix("file://")
    folder = Path(use.workspace.resolve_links(use.mesh.place.path)).parent
    folders = (folder, *folder.parents[:-1])
    return any(use.workspace.is_file(above / path) for above in folders)


def _is_in_own_package(use: MeshUse, description: Description) -> bool:
    from ..package.resolution import is_in_own_package

    return is_in_own_package(use, description)


def _find_missing_folder(workspace: Workspace, path: Path) -> Path:
    """Find the uppermost missing folder above a missing file; the file's folder if that exists."""
    folder = path.parent
    while (
        folder != folder.parent
        and not workspace.exists(folder)
        and not workspace.exists(folder.parent)
    ):
        folder = folder.parent
    return folder


def _suggest_file(workspace: Workspace, path: Path) -> str:
    """Suggest a file of nearly that name in the folder, or of that name in the package."""
    try:
        names = [entry.name for entry in workspace.list_folder(path.parent)]
        near = find_nearest(path.name, names, 0.8)
    except OSError:
        near = ""
    if near:
        return f"; did you mean '{near}'?"
    own = find_own_package(path, workspace)
    if own is None:
        return ""
    folder = str(own[1])
    other = _list_files_below(workspace, folder).get(path.name)
    return f"; the package has '{os.path.relpath(other, folder)}'" if other else ""


@memoize_by_workspace
def _list_files_below(workspace: Workspace, folder: str) -> dict[str, str]:
    return dict(_walk_files(workspace, folder))


def _walk_files(workspace: Workspace, folder: str) -> Iterator[tuple[str, str]]:
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
            "reject the robot on Linux, whose file names are case-sensitive; by default those of "
            "macOS and Windows are not"
        ),
        "mujoco": "rejects the robot on Linux",
    },
    group="repository",
    formats=URDF_AND_SDF,
)
def mesh_case_mismatch(robot: Robot, description: Description) -> Iterator[Problem]:
    """The name of a mesh file differs in case from the file on disk.

    ``Base.STL`` and ``base.stl`` are one file on macOS and Windows, but two files on Linux, which
    robots and build servers use. There the file is not found. All files of one folder in a
    repository are one finding.
    """
    seen: set[str] = set()
    lost = {use.uri for use in find_lost_in_mujoco(robot, description)}
    for use in get_mesh_uses(robot, description):
        if use.path is None or use.exists or use.uri in seen:
            continue
        actual = find_actual_case(use.workspace, use.path)
        if actual is not None:
            seen.add(use.uri)
            pairs = zip(actual.parts, use.path.parts, strict=True)
            same = sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs))
            shown = "/".join(actual.parts[same:])
            yield Problem(
                use.link,
                f"mesh '{use.uri}' is '{shown}' on disk, so Linux does not find it; match the case",
                at=use.mesh.locate_attribute("filename"),
                data={"uri": use.uri, "name": shown},
                effects=["pybullet, drake", *["mujoco"] * (use.uri in lost)],
                alike=str(actual.parent),
                group="{count} URIs of meshes differ in case from the files in "
                f"'{shorten_path(actual.parent)}', first '{use.uri}' from '{shown}', so Linux does "
                "not find them; match the case, or rename the files",
            )


@mesh_case_mismatch.fix(SAFE, reveals=True)
def write_name_on_disk(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the name in the case that the file and its folders have on disk."""

    def change(use: MeshUse) -> Change | None:
        if use.path is None:
            return None
        actual = find_actual_case(use.workspace, use.path)
        if actual is None:
            return None
        new = use.uri
        for missing, there in zip(use.path.parts, actual.parts, strict=True):
            if missing != there:
                head, found, tail = new.rpartition(missing)
                if not found:
                    return None
                new = head + there + tail
        pattern, text = _split_difference(use.uri, new)
        return substitute(use.mesh.element, "filename", pattern, text)

    changes = change_uses(problem, context, change)
    return safe("write the name of the file on disk", *changes) if changes else None


def _split_difference(old: str, new: str) -> tuple[str, str]:
    """Return a pattern for the differing end of the first of two names, and the second's end."""
    differs = next((i for i, (a, b) in enumerate(zip(old, new, strict=False)) if a != b), 0)
    same = old.rfind("/", 0, differs) + 1
    return re.escape(old[same:]) + "$", new[same:].replace("\\", r"\\")


@rule(
    ERROR,
    effects={
        "rviz": "shows nothing for this shape",
        "mujoco (not OBJ)": "rejects the robot",
        "mujoco (OBJ)": "uses the convex hull of its points, if it has points",
        "pybullet": "loads the link without the shape, with a warning",
        "pinocchio": "rejects the geometry of the robot",
        "drake": "rejects the robot",
    },
    formats=URDF_AND_SDF,
)
def corrupt_mesh(robot: Robot, description: Description) -> Iterator[Problem]:
    """A mesh file exists, but does not contain a mesh.

    It is empty, an STL file that ends before its last triangle, or a file without triangles: an
    OBJ with only points and lines, or a COLLADA file that was exported without geometry. Readers
    report wrong numbers or an unknown format, or show nothing without a message. Export the file
    again.
    """
    seen: set[Path] = set()
    for use in get_mesh_uses(robot, description):
        if use.path is None or not use.exists or use.path in seen:
            continue
        seen.add(use.path)
        wrong = describe_defect(use)
        if wrong and wrong != _LFS:
            yield Problem(
                use.link,
                f"mesh '{use.uri}' {wrong}",
                at=use.mesh.locate_attribute("filename"),
                data={"uri": use.uri},
                effects=_select_readers(robot, description, use, _name_format(use)),
            )


@rule(
    ERROR,
    effects={
        "rviz": "shows nothing for this shape",
        "mujoco": "rejects the robot: a wrong header or number of faces",
        "pybullet": "loads the link without the shape, with a warning",
        "pinocchio": "rejects the geometry of the robot",
        "drake": "rejects the robot",
    },
    group="repository",
    formats=URDF_AND_SDF,
)
def git_lfs_pointer(robot: Robot, description: Description) -> Iterator[Problem]:
    """A mesh file is a git-lfs pointer instead of the mesh.

    The repository keeps its meshes in git-lfs, and this checkout has not fetched them: each file
    is a text of three lines. Readers report wrong numbers or formats, or nothing. ``git lfs pull``
    fetches all files, so all pointers of a repository are one finding.
    """
    reported: set[Path] = set()
    for use in get_mesh_uses(robot, description):
        if use.path is None or not use.exists or use.path in reported:
            continue
        reported.add(use.path)
        if describe_defect(use) == _LFS:
            yield Problem(
                use.link,
                f"mesh '{use.uri}' {_LFS}",
                at=use.mesh.locate_attribute("filename"),
                data={"uri": use.uri},
                effects=_select_readers(robot, description, use),
                group="{count} mesh files are git-lfs pointers instead of meshes, in the links "
                "{names}; run 'git lfs pull'",
            )


def _name_format(use: MeshUse) -> str:
    """Name the format of a file as the effect on MuJoCo depends on it."""
    return " (OBJ)" if get_suffix(use.uri) == "obj" else " (not OBJ)"


def _select_readers(
    robot: Robot, description: Description, use: MeshUse, case: str = ""
) -> list[str]:
    """Select the readers that open a file: for a visual, not those that ignore visuals.

    PyBullet draws a visual without the shape; MuJoCo discards visuals unless the robot keeps them.

    Args:
        robot: The robot.
        description: Its description.
        use: The use of the file.
        case: Case of the effect on MuJoCo, in parentheses; empty without cases.
    """
    same = [one for one in get_mesh_uses(robot, description) if one.path == use.path]
    here = Path(os.path.normpath(use.path or ""))
    folder, keeps = read_mesh_folder(robot), keeps_visuals(robot)
    opened = [locate_in_mujoco(one, folder, description) for one in same if keeps or one.collides]
    return [
        *("rviz", "pinocchio"),
        *[f"mujoco{case}"] * any(path is None or path == here for path in opened),
        *["pybullet", "drake"] * any(one.collides for one in same),
    ]


_STARTS = {".glb": (b"glTF", "a GLB file"), ".ply": (b"ply", "a PLY file")}
"""First bytes of a file and what it is, by its ending."""


def _find_wrong_start(suffix: str, head: bytes, size: int) -> str:
    """Describe why the first bytes are not those of the format; empty if they are."""
    if suffix == ".gltf":
        is_object = head.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] in (b"{", b"")
        return "" if is_object else "is not a glTF file"
    start, name = _STARTS.get(suffix, (b"", ""))
    if not head.startswith(start):
        return f"is not {name}"
    expected = int.from_bytes(head[8:12], "little")
    if suffix == ".glb" and size < expected:
        return f"is truncated: its header announces {expected} bytes, but the file has {size}"
    return ""


def describe_defect(use: MeshUse) -> str:
    """Describe why a file is not a mesh, to follow its name; empty if it is one."""
    if use.path is None:
        return ""
    try:
        path = use.workspace.materialize(use.path)
        if path.suffix.lower() != ".stl":
            with open(path, "rb") as file:
                head = file.read(len(LFS_MARK))
                if not head:
                    return "is an empty file"
                if head == LFS_MARK:
                    return _LFS
                size = file.seek(0, os.SEEK_END)
                if defect := _find_wrong_start(path.suffix.lower(), head, size):
                    return defect
                return "has no faces" if _has_no_faces(file, path.suffix.lower()) else ""
        facts = read_stl_header(path)
    except OSError as error:
        return f"cannot be read: {(error.strerror or 'unknown').lower()}"
    if facts.kind == "lfs-pointer":
        return _LFS
    if facts.kind == "empty":
        return "is an empty file"
    if facts.kind == "unknown":
        return "is not an STL file"
    if facts.kind == "binary" and facts.triangles == 0:
        return "has no triangles"
    expected = facts.expected_bytes
    if expected is not None and facts.bytes < expected:
        return (
            f"is truncated: {facts.triangles} triangles need {expected} bytes, but the file has "
            f"{facts.bytes}"
        )
    return ""


_FACES = {
    ".obj": (b"\nf ", re.compile(rb"(?:^|[\r\n])[ \t]*fo?[ \t]")),
    ".dae": (b"<triangles", re.compile(rb"<(?:\w+:)?(?:triangles|polylist|polygons|tri\w+s)\b")),
}
"""Beginning of a face by the suffix of a file: the usual one, and a pattern for all."""


def _has_no_faces(file: BinaryIO, suffix: str) -> bool:
    """Tell whether a mesh file has no faces."""
    if suffix not in _FACES:
        return False
    mostly, any_of = _FACES[suffix]
    with mmap(file.fileno(), 0, access=ACCESS_READ) as data:
        if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
            return False  # UTF-16, which the patterns of bytes do not match
        return data.find(mostly) < 0 and any_of.search(data) is None


_LFS = "is a git-lfs pointer instead of the mesh; run 'git lfs pull'"
