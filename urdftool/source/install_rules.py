"""Install rules in the CMakeLists.txt of a package.

``$(find NAME)`` and ``package://NAME/`` refer to the *installed* package; the layout of a source
tree differs if ``install(DIRECTORY description/urdf DESTINATION share/${PROJECT_NAME})`` moves
files. Only ``project``, ``set`` and ``install(DIRECTORY|FILES|PROGRAMS …)`` are read.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

from ..workspace import Workspace
from .comments import blank_cmake_comments

_MAX_TEXT, _MAX_VALUE = 1 << 20, 512  # characters of a CMakeLists.txt and of a variable; chosen
_COMMAND = re.compile(r"\b(project|set|install)\s*\(([^()]*(?:\([^()]*\)[^()]*)*)\)", re.IGNORECASE)
_WORD = re.compile(r'"([^"]*)"|([^\s"]+)')
_VARIABLE = re.compile(r"\$\{(\w+)\}")
_KEYWORDS = frozenset(
    (
        *("DIRECTORY", "FILES", "PROGRAMS", "TARGETS", "EXPORT", "DESTINATION", "PATTERN", "REGEX"),
        *("EXCLUDE", "PERMISSIONS", "USE_SOURCE_PERMISSIONS", "FILES_MATCHING", "OPTIONAL"),
        *("COMPONENT", "CONFIGURATIONS", "RENAME", "TYPE", "MESSAGE_NEVER", "EXCLUDE_FROM_ALL"),
        *("FILE_PERMISSIONS", "DIRECTORY_PERMISSIONS"),
    )
)


class InstallRule(NamedTuple):
    """Path of the source tree and its destination below the share folder of the package.

    Attributes:
        source: A file or folder of the source tree.
        target: Its path below ``share/NAME``; ``.`` is that folder itself.
    """

    source: Path
    target: str


def read_install_rules(package_dir: Path, name: str, workspace: Workspace) -> list[InstallRule]:
    """Read the install rules of a package with a destination below its share folder.

    Returns:
        Rules in the order of the file; empty without a CMakeLists.txt.
    """
    try:
        text = workspace.read_text(package_dir / "CMakeLists.txt")
    except OSError:
        return []
    share = f"share/{name}"
    variables = {
        "PROJECT_NAME": name,
        "CMAKE_PROJECT_NAME": name,
        "PROJECT_SOURCE_DIR": str(package_dir),
        "CMAKE_SOURCE_DIR": str(package_dir),
        "CMAKE_CURRENT_SOURCE_DIR": str(package_dir),
        "CMAKE_CURRENT_LIST_DIR": str(package_dir),
        "CMAKE_INSTALL_PREFIX": "",
        "CMAKE_INSTALL_DATAROOTDIR": "share",
        "CMAKE_INSTALL_DATADIR": "share",
        "CATKIN_PACKAGE_SHARE_DESTINATION": share,
        "CATKIN_GLOBAL_SHARE_DESTINATION": "share",
    }
    rules: list[InstallRule] = []
    code = blank_cmake_comments(text[:_MAX_TEXT].encode()).decode()
    for command in _COMMAND.finditer(code):
        words = [
            _VARIABLE.sub(lambda m: variables.get(m[1], m[0]), quoted or bare)
            for quoted, bare in _WORD.findall(command[2])
        ]
        verb = command[1].lower()
        if verb == "project" and words:
            variables["PROJECT_NAME"] = variables["CMAKE_PROJECT_NAME"] = words[0]
            variables["CATKIN_PACKAGE_SHARE_DESTINATION"] = f"share/{words[0]}"
        elif verb == "set" and len(words) >= 2:
            variables[words[0]] = " ".join(words[1:])[:_MAX_VALUE]
        elif verb == "install" and words:
            rules.extend(_install(package_dir, share, words))
    return rules


def is_installed_as(package_dir: Path, name: str, workspace: Workspace) -> bool:
    """Tell whether the CMakeLists.txt of a package with another name installs files as ``name``.

    ``${PROJECT_NAME}`` of CMake may differ from the name in package.xml; the folder ``share/NAME``,
    in which readers look, has that of CMake.
    """
    try:
        text = workspace.read_text(package_dir / "CMakeLists.txt")[:_MAX_TEXT]
    except OSError:
        return False
    code = blank_cmake_comments(text.encode()).decode()
    project = re.search(rf"\bproject\s*\(\s*\"?{re.escape(name)}[\"\s)]", code, re.IGNORECASE)
    return project is not None and bool(read_install_rules(package_dir, name, workspace))


def _install(package_dir: Path, share: str, words: list[str]) -> list[InstallRule]:
    if words[0].upper() not in ("DIRECTORY", "FILES", "PROGRAMS") or "DESTINATION" not in words:
        return []
    destination = words[words.index("DESTINATION") + 1 : words.index("DESTINATION") + 2]
    target = destination[0].strip("/").removeprefix("./") if destination else ""
    if target != share and not target.startswith(share + "/"):
        return []
    target = target[len(share) :].strip("/") or "."
    rename = words[words.index("RENAME") + 1] if "RENAME" in words[:-1] else None
    rules = []
    for word in words[1:]:
        if word in _KEYWORDS:
            break
        source = package_dir / word
        if words[0].upper() == "DIRECTORY" and word.endswith("/"):
            rules.append(InstallRule(source, target))
        else:
            rules.append(InstallRule(source, f"{target}/{rename or source.name}"))
    return rules


def find_installed(rules: list[InstallRule], relative: str, workspace: Workspace) -> Path | None:
    """Return the source file that is installed at a path below the share folder, or None."""
    parts = Path(relative).parts
    for rule in rules:
        target = Path(rule.target).parts
        if parts[: len(target)] == target:
            candidate = rule.source.joinpath(*parts[len(target) :])
            if workspace.exists(candidate):
                return candidate
    return None
