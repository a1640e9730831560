"""The SRDF of a description: next to it, in its package, or in another one of its workspace."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from ..diagnostic import Severity
from ..errors import UrdftoolError
from ..finding import Finding
from ..rules.moveit.semantic import get_srdf_documents
from ..source.description import read_description
from ..source.document import parse, read_file
from ..source.location import SourceFile
from ..source.packages import shorten_path
from .draft import Draft, TextDraft

SEMANTIC = (".srdf", ".srdf.xacro")
"""Endings of SRDF files."""
_FOLDERS = ("config", "srdf", "moveit", "urdf", "")
"""Folders of a package in which an SRDF may be; MoveIt's Setup Assistant writes ``config``."""
_FOLDER_WORDS = "config, srdf, moveit or urdf"
_ARGUMENT = re.compile(r"\$\(arg (\w+)\)")
_MOST_PACKAGES = 200
"""Number of packages of a workspace that are searched. Chosen, no source."""


def find_semantics(draft: Draft) -> list[TextDraft]:
    """Find the SRDF files of a robot, and record if none is edited.

    Searched are the folder of the description; then its package, and the folder above that of the
    description, by the robot name in the SRDF; then the other packages of its workspace. If several
    of these have one, none is chosen.
    """
    beside = get_srdf_documents(draft.robot, draft.description)
    if beside:
        return [TextDraft(document.file) for document in beside]
    packages = draft.description.packages.list_neighbors()[:_MOST_PACKAGES]
    own, others = packages[:1], packages[1:]
    near = Path(draft.description.path).absolute().parents[:2]  # as urdf/ and srdf/ of a package
    own += [folder for folder in near[1:] if folder.is_relative_to(own[0]) and folder not in own]
    found = [one for folder in own for one in _search(draft, folder)]
    by_package = [] if found else [list(_search(draft, folder)) for folder in others]
    by_package = [files for files in by_package if files]
    if found or len(by_package) == 1:
        return found or by_package[0]
    if by_package:
        names = ", ".join(shorten_path(files[0].file.path) for files in by_package[:3])
        rest = f"several packages have one ({names})"
        _report(draft, f"no SRDF of robot '{draft.robot.name}' is edited: {rest}")
    else:
        _report_none(draft, own)
    return []


def _report(draft: Draft, message: str) -> None:
    text = f"{message}; pass one with --with"
    draft.notes.append(Finding("edit-semantics", Severity.INFO, text, draft.robot.place))


def _report_none(draft: Draft, own: list[Path]) -> None:
    """Record that no SRDF is edited, and the robots of those that the package has."""
    others = [path.name for folder in own for path in _list_files(draft, folder)][:3]
    rest = f"; {', '.join(others)} has another robot name" if others else ""
    name = draft.robot.name
    place = f"{_FOLDER_WORDS} of its package, nor in another package of its workspace"
    _report(draft, f"no SRDF of robot '{name}' is next to it, in {place}{rest}")


def _list_files(draft: Draft, package: Path) -> Iterator[Path]:
    for folder in _FOLDERS:
        for ending in SEMANTIC:
            yield from draft.description.workspace.list_matches(package / folder, f"*{ending}")


def _search(draft: Draft, package: Path) -> Iterator[TextDraft]:
    """Yield the SRDF files of the robot's name in a package; record those that are not expanded."""
    for path in _list_files(draft, package):
        try:
            file = read_file(shorten_path(path), draft.description.workspace)
            root = parse(file).root
        except UrdftoolError:
            continue  # it is read, with its error, where it is given by --with
        name = root.get("name") or ""
        if root.tag != "robot" or (name != draft.robot.name and "$" not in name):
            continue
        try:
            one = open_semantics(draft, file)
        except UrdftoolError as error:
            message = f"{path.name} cannot be expanded, and is not edited: {error.message}"
            draft.report("semantics", message, root.place)
            continue
        if one.source.document.root.get("name") == draft.robot.name:
            yield one


def open_semantics(draft: Draft, file: SourceFile) -> TextDraft:
    """Return the draft of an SRDF; for xacro, of its expansion with the arguments of the robot.

    An argument that is its robot name, as in ``<robot name="$(arg name)">``, has that of the robot.

    Raises:
        UrdftoolError: It cannot be read or expanded.
    """
    description = draft.description
    own = _ARGUMENT.fullmatch(parse(file).root.get("name") or "")
    read = read_description(
        file.path,
        {**({own[1]: draft.robot.name} if own else {}), **description.arguments},
        file=file,
        workspace=description.packages.workspace,
        finder=description.packages.make_finder_for(file.path),
    )
    if read.expansion is None:
        return TextDraft(file)
    return TextDraft(SourceFile(file.path, read.expansion.text.encode("utf-8")))


def report_xacro(draft: Draft, folder: Path) -> None:
    """Record the xacro files of a folder that name joints of the robot and are not edited.

    Such is the ``ROBOT.ros2_control.xacro`` of MoveIt's Setup Assistant.
    """
    joints = {joint.name for joint in draft.robot.joints if not joint.is_fixed}
    read = {Path(one.path).resolve() for one in draft.description.files}
    for path in draft.description.workspace.list_matches(folder, "*.xacro"):
        if path.resolve() in read or path.name.endswith(SEMANTIC):
            continue
        try:
            root = parse(read_file(shorten_path(path), draft.description.workspace)).root
        except UrdftoolError:
            continue  # it is not a part of the robot
        named = [e for e in root.walk() if e.tag == "joint" and e.get("name") in joints]
        if named:
            message = f"{path.name} names joint '{named[0].get('name')}'; xacro is not edited"
            draft.report("xacro", message, named[0].place)
