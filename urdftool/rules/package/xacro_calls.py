"""Rules on calls of xacro in launch files and builds."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from ...model.elements import Robot
from ...source.description import Description
from ...source.location import Place
from ...source.nearby_files import read_optional_file
from ...workspace import Workspace
from ..fix import FixContext, Proposal, Span, safe
from ..rule import INFO, ROS, SAFE, Problem, rule

_OBSOLETE = re.compile(rb"(?<![\w./-])(?:--inorder|--legacy|xacro\.py)\b")
_INSTEAD = {
    "--inorder": "remove it: it is the default since ROS Melodic",
    "--legacy": "remove it: it does not exist since ROS Melodic",
    "xacro.py": "call xacro",
}
_MOST_FILES = 60
"""Number of files that are searched for calls. Chosen, no source."""

_MOST_BYTES = 200_000
"""Size of a file [bytes] up to which it is searched. Chosen, no source."""


@rule(
    INFO,
    on=ROS,
    effects={
        "xacro": "accepts --inorder, and reports that it can be dropped",
    },
)
def obsolete_cli_option(robot: Robot, description: Description) -> Iterator[Problem]:
    """A launch file or the build calls xacro with an obsolete option or name.

    ``--inorder`` is the default since ROS Melodic, ``--legacy`` was removed, and ``xacro.py`` is
    not installed in ROS 2, so the call fails. Checked are lines that contain the name of the
    description, in the launch files, ``CMakeLists.txt`` and README of its package.
    """
    own = description.packages.own
    if own is None:
        return
    name = description.packages.file.name.encode()
    for path in _find_callers(description.workspace, own[1]):
        file = read_optional_file(description.workspace, path)
        if file is None or name not in file.data or len(file.data) > _MOST_BYTES:
            continue
        data = file.data
        for match in _OBSOLETE.finditer(data):
            line_start = data.rfind(b"\n", 0, match.start()) + 1
            line_end = data.find(b"\n", match.end())
            if name in data[line_start : line_end if line_end >= 0 else len(data)]:
                word = match[0].decode()
                yield Problem(
                    robot,
                    f"'{word}' is obsolete; {_INSTEAD[word]}",
                    at=Place(file, match.start(), match.end()),
                )


def _find_callers(workspace: Workspace, package: Path) -> Iterator[Path]:
    """Yield the files of a package that may call xacro."""
    found = [
        *workspace.list_matches(package / "launch", "**/*"),
        *workspace.list_matches(package, "README*"),
    ]
    found += [package / "CMakeLists.txt"]
    for path in sorted(found)[:_MOST_FILES]:
        if workspace.is_file(path):
            yield path


@obsolete_cli_option.fix(SAFE)
def drop_option(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the option and one space; write ``xacro`` for ``xacro.py``."""
    file, start, end = problem.place.file, problem.place.start, problem.place.end
    data = file.data
    if data[start:end] == b"xacro.py":
        return safe("call xacro", Span(file, start, end, b"xacro"))
    if data[start - 1 : start] in (b" ", b"\t"):
        return safe("remove it", Span(file, start - 1, end, b""))
    if data[end : end + 1] in (b" ", b"\t"):
        return safe("remove it", Span(file, start, end + 1, b""))
    return None
