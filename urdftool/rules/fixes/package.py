"""Fixes of a package's own files: package.xml, CMakeLists.txt, and those that call xacro."""

from __future__ import annotations

import re

from ...errors import PackageNotFound
from ...source.document import Document, Element
from ...source.nearby import document_at, file_at
from ...source.packages import own_package
from ..package.dependencies import way_between
from ..rule import Problem
from .proposal import Around, Change, Proposal, Span, after, first, insert, safe, unsafe

_MODEL_PATH = '<gazebo_ros gazebo_model_path="${prefix}/.."/>'


def undeclared_mesh_dependency(problem: Problem, around: Around) -> Proposal | None:
    """Declare the dependency, behind those that are there.

    A package that is not found is not declared, and neither is one that depends on this one: that
    would close a circle.
    """
    match = re.match(r"package '([\w-]+)'", problem.message)
    manifest = _manifest(around)
    own, packages = own_package(around.description.packages.file), around.description.packages
    if match is None or manifest is None or own is None:
        return None
    try:
        packages.find(match[1])
    except PackageNotFound:
        return None
    if way_between(match[1], own[0], packages, conditional=True):
        return None
    tag = _run_tag(manifest.root)
    return safe(f"add <{tag}>{match[1]}</{tag}> to package.xml", _depends(manifest.root, match[1]))


def gazebo_path_not_exported(problem: Problem, around: Around) -> Proposal | None:
    """Export the path.

    With catkin the export is looked at only in a package that depends on gazebo_ros, and a
    description does not become one that needs Gazebo to be built and installed unasked.
    """
    manifest = _manifest(around)
    if manifest is None:
        return None
    root, export = manifest.root, manifest.root.child("export")
    if export is not None:
        change = insert(export, _MODEL_PATH)
    else:
        change = insert(root, "<export>", f"\t{_MODEL_PATH}", "</export>")
    words = {child.text.strip() for child in root.children if child.tag.endswith("depend")}
    if "catkin" not in words or "gazebo_ros" in words:
        return safe("export the path in package.xml", change)
    return unsafe(
        "export the path in package.xml, and depend on gazebo_ros",
        _depends(root, "gazebo_ros"),
        change,
    )


def _manifest(around: Around) -> Document | None:
    own = own_package(around.description.packages.file)
    found = document_at(own[1] / "package.xml") if own is not None else None
    return found if found is not None and found.root.tag == "package" else None


def _run_tag(package: Element) -> str:
    """The element for what is needed when it runs, which is another in the first format."""
    return "run_depend" if (package.get("format") or "1").strip() == "1" else "exec_depend"


def _depends(package: Element, name: str) -> Change:
    """A dependency behind its like, or behind what has to stand in front of dependencies."""
    tag = _run_tag(package)
    line = f"<{tag}>{name}</{tag}>"
    others = [child for child in package.children if child.tag not in ("export", "test_depend")]
    likes = [child for child in others if child.tag in (tag, "depend")]
    behind = likes or others
    return after(behind[-1], line) if behind else first(package, line)


_INSTALL = re.compile(
    rb"\binstall\s*\(\s*DIRECTORY(?P<folders>(?:\s+[^\s()]+)+?)\s+DESTINATION\s+"
    rb"(?P<where>[^\s()]+)\s*\)",
    re.IGNORECASE,
)
_COMMENT = re.compile(rb"#\[\[.*?\]\]|#[^\n]*", re.DOTALL)
_CATKIN, _SHARE = b"${CATKIN_PACKAGE_SHARE_DESTINATION}", b"share/${PROJECT_NAME}"


def directory_not_installed(problem: Problem, around: Around) -> Proposal | None:
    """Installed with the others, or by a line of its own."""
    own = own_package(around.description.packages.file)
    match = re.match(r"folder '([^'\s();#\"]+)'", problem.message)
    file = file_at(own[1] / "CMakeLists.txt") if own is not None else None
    if own is None or match is None or file is None:
        return None
    folder, data = match[1].encode(), file.data
    code = _COMMENT.sub(lambda comment: re.sub(rb"[^\n]", b" ", comment[0]), data)
    catkin = re.search(rb"\bcatkin_package\s*\(", code) is not None
    shares = (_CATKIN, _SHARE, b"share/" + own[0].encode())
    for found in _INSTALL.finditer(code):
        if found["where"].strip(b'"').rstrip(b"/") in shares:
            *_, (gap, last) = re.findall(rb"(\s+)(\S+)", found["folders"])
            if not last.strip(b'"').endswith(b"/") and last not in (b"FILES", b"PROGRAMS"):
                at = found.end("folders")
                return unsafe(f"install {match[1]}", Span(file, at, at, gap + folder))
    line_end = b"\r\n" if b"\r\n" in data else b"\n"
    line = b"install(DIRECTORY %s DESTINATION %s)" % (folder, _CATKIN if catkin else _SHARE)
    last_call = re.search(rb"^[ \t]*ament_package\s*\(", code, re.MULTILINE)
    if last_call is not None:
        span = Span(file, last_call.start(), last_call.start(), line + line_end)
    else:
        between = b"" if data.endswith(b"\n") or not data else line_end
        span = Span(file, len(data), len(data), between + line + line_end)
    return unsafe(f"install {match[1]}", span)


def obsolete_cli_option(problem: Problem, around: Around) -> Proposal | None:
    """Gone, with a blank beside it; ``xacro`` for ``xacro.py``."""
    file, start, end = problem.place.file, problem.place.start, problem.place.end
    data = file.data
    if data[start:end] == b"xacro.py":
        return safe("call xacro", Span(file, start, end, b"xacro"))
    if data[start - 1 : start] in (b" ", b"\t"):
        return safe("leave it out", Span(file, start - 1, end, b""))
    if data[end : end + 1] in (b" ", b"\t"):
        return safe("leave it out", Span(file, start, end + 1, b""))
    return None
