"""Absolute folders of the sources, which a bundle does not contain.

xacro writes ``$(find NAME)`` as the folder of the package. In a bundle this folder is
``package://NAME`` again: the same on every machine, and without the name of a user.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path

from ..model.elements import Robot
from ..projects import find_project
from ..source.document import STDIN
from ..source.packages import find_own_package

_SHORTEST = 3
"""Parts of the path of a folder from which it is replaced: not ``/opt``, which is no user's.
Chosen, no source."""


def list_source_folders(robot: Robot) -> dict[str, str]:
    """Return the URI of each folder of the sources, the deepest folder first.

    Folders are the packages that the description uses, its own package, its project and its own
    folder. Without a package, the project is ``.`` in the result.
    """
    source = robot.source
    if source is None:
        return {}
    folders = {folder: f"package://{name}" for name, folder in source.packages.used.items()}
    if source.path not in ("-", STDIN):
        path = Path(os.path.abspath(source.path))
        if own := find_own_package(path):
            folders.setdefault(own[1], f"package://{own[0]}")
        folders.setdefault(path.parent, ".")
        if (project := find_project(path, source.packages.files)) is not None:
            folders.setdefault(project, ".")
    found = {}
    for folder, uri in folders.items():
        for place in {os.path.abspath(folder), os.path.realpath(folder)}:
            if len(Path(place).parts) >= _SHORTEST:
                found[place] = uri
    return dict(sorted(found.items(), key=lambda pair: (-len(pair[0]), pair[0])))


def replace_folders(text: str, folders: Mapping[str, str]) -> str:
    """Return a text in which the folders of the sources are replaced by their URIs."""
    for folder, uri in folders.items():
        if folder in text:
            pattern = rf"(?:file://|(?<![\w./-])){re.escape(folder)}(?=/|$|[^\w.-])"
            text = re.sub(pattern, uri.replace("\\", r"\\"), text)
    return text
