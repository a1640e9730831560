"""Discovery of descriptions: named files, and descriptions in named folders."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Iterator, Sequence

from ..listing import list_first

ENDINGS = (".urdf", ".urdf.xacro")
IGNORED = frozenset(("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE"))
"""Files by which colcon, ament and catkin ignore a folder, such as ``install``."""
_MOST_NAMES = 5  # names that a line lists; chosen, no source
_HEAD = 16_384
"""Bytes at the start of a file in which ``<robot name=`` must be. Chosen, no source."""


def find_descriptions(paths: Iterable[str], links: list[str] | None = None) -> list[str]:
    """Return the files to check, each once: named files, and descriptions below named folders.

    A named path that does not exist is kept, so that it is reported.

    Args:
        paths: Files and folders.
        links: List to which links are added that are not followed.
    """
    found: dict[str, str] = {}
    for path in paths:
        files = list_files(path, links=links) if os.path.isdir(path) else [path]
        for file in files:
            found.setdefault(os.path.realpath(file) if file != "-" else file, file)
    return list(found.values())


def list_parts(paths: Iterable[str], belonging: Collection[str] = ()) -> list[str]:
    """Return the ``.xacro`` files below named folders that are not descriptions by their name."""
    folders = [path for path in paths if os.path.isdir(path)]
    found = (path for folder in folders for path in list_files(folder, (".xacro",)))
    return [
        path
        for path in dict.fromkeys(found)
        if not has_ending(path, *ENDINGS) or os.path.realpath(path) in belonging
    ]


def explain_nothing_found(paths: Iterable[str]) -> str:
    """Return the message for folders without a description, with a ``.xacro`` that may be one."""
    folders = list(paths)
    links: list[str] = []
    find_descriptions(folders, links)
    nothing = f"no .urdf or .urdf.xacro below {', '.join(folders)}"
    message = "; ".join(filter(None, (nothing, describe_links(links))))
    for folder in folders:
        for path in list_files(folder, (".xacro",)):
            if _has_name(path):
                return (
                    f"{message}; .xacro files may be parts of robots: give {path} itself if it is "
                    "a robot"
                )
    return message


def describe_links(links: Iterable[str]) -> str:
    """Return ``links not followed: a.urdf``; empty without links."""
    names = sorted(set(links))
    return f"links not followed: {shorten_list(names)}" if names else ""


def shorten_list(names: Sequence[str]) -> str:
    """Return the first names, and how many more there are."""
    return list_first(names, _MOST_NAMES)


def _has_name(path: str) -> bool:
    """Tell whether a file has a ``<robot>`` with a name, which included files rarely have."""
    try:
        with open(path, "rb") as stream:
            return re.search(rb"<robot\b[^<>]*\sname\s*=", stream.read(_HEAD)) is not None
    except OSError:
        return False


def list_files(
    folder: str, endings: tuple[str, ...] = ENDINGS, links: list[str] | None = None
) -> Iterator[str]:
    """Yield the files below a folder by their ending, which may be in capitals.

    Hidden folders are skipped, those that builds of ROS ignore, and those in which CMake builds; so
    are devices, pipes, and links out of the project of the folder, which came with the files, or to
    nowhere.

    Args:
        folder: The folder.
        endings: Endings of the names.
        links: List to which links are added that are not followed: to folders that are not below
            it, and skipped ones to files with such an ending.
    """
    for root, folders, files in os.walk(folder):
        if root != folder and _is_of_builds(files):
            folders.clear()
            continue
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        if links is not None:
            links += _find_links(root, folders, folder)
        for name in sorted(files):
            path = os.path.normpath(os.path.join(root, name))
            if not has_ending(name, *endings):
                continue
            if not os.path.islink(path) or _is_own(path, folder):
                if os.path.isfile(path):
                    yield path
            elif links is not None:
                links.append(path)


def has_ending(path: str, *endings: str) -> bool:
    """Tell whether a path has one of some endings, in small letters or capitals."""
    return path.lower().endswith(tuple(ending.lower() for ending in endings))


def _find_links(root: str, names: Iterable[str], folder: str) -> list[str]:
    """Return the links to folders that are not below a folder, which a search does not follow."""
    inside = os.path.realpath(folder)
    paths = [os.path.normpath(os.path.join(root, name)) for name in names]
    links = [path for path in paths if os.path.islink(path)]
    return [link for link in links if not _is_below(os.path.realpath(link), inside)]


def _is_below(path: str, folder: str) -> bool:
    return path == folder or path.startswith(os.path.join(folder, ""))


def _is_of_builds(files: Iterable[str]) -> bool:
    """Return whether builds ignore a folder with such files, or CMake builds in it alone."""
    names = frozenset(files)
    built = "CMakeCache.txt" in names and "CMakeLists.txt" not in names
    return built or not IGNORED.isdisjoint(names)


def _is_own(link: str, folder: str) -> bool:
    """Tell whether a link below a folder leads to something, and not to another project."""
    from ..source.packages import Packages

    access = Packages(os.path.join(folder, "-")).access
    return os.path.exists(link) and not access.explain_refusal(link)
