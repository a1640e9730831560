"""Readers of robots that the Python code of a project imports: who uses the description there.

A package such as an environment of PyBullet brings its robots for one engine, one of the Humanoid
Path Planner (HPP) for a planner without dynamics. What another engine would do with an implausible
inertia is not seen there, so such findings are off by default, and the last lines of a report count
them.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import NamedTuple

from ..errors import UrdftoolError
from ..projects import list_above
from ..rules.rule import ROS
from ..source.comments import blank_comments
from ..source.description import Description
from ..source.nearby_files import read_optional_file
from ..workspace import Workspace, memoize_by_workspace
from .called_names import list_names
from .evidence import read_launch_files
from .libraries import (
    GYM,
    NAMES_OF_CALLS,
    OF_ROS,
    OTHER_ENGINES,
    OWN,
    READERS,
    WORDS,
    find_moving_readers,
)

_OF_PACKAGE_OF_HPP = re.compile(rb"<(name|\w*depend)>\s*hpp[-_][\w-]+\s*</\1>")
"""What a package.xml of HPP says: its name, or a package that it depends on."""


class Use(NamedTuple):
    """Who uses the descriptions of a project.

    Attributes:
        readers: The readers, as effects name them; also the kinds of readers in ``libraries``.
        moving: Those of them by which code computes dynamics, or of which that is not known.
        keeps_inertia: Whether PyBullet gets the flag that keeps inertias.
    """

    readers: frozenset[str]
    moving: frozenset[str]
    keeps_inertia: bool = False

    def with_readers(self, readers: frozenset[str]) -> Use:
        """Return this use by other readers; one that is new may compute dynamics."""
        return self._replace(
            readers=readers, moving=(self.moving | readers - self.readers) & readers
        )


_OF_HPP = Use(frozenset(("pinocchio",)), frozenset())

_DESCRIPTIONS_OF_ROS = (b"robot_description", b"xacro")
"""What code with ROS contains that reads a description, if it does not mention URDF."""

_ANY_ENGINE = frozenset(("mujoco", "pybullet", "pinocchio", "drake", "newton", "isaac"))
"""Readers whose effects show what another engine may do."""

_PACKAGING = ("pyproject.toml", "setup.py", "setup.cfg", "PKG-INFO", ".git")
_IMPORT = re.compile(rb"(?m)^[ \t]*(?:import|from)[ \t]+(\w+)")
_IMPORT_LINE = re.compile(rb"\b(?:import|from)\b[^\n]*(?:\\\r?\n[^\n]*)*")
_NAMES = tuple(sorted(name.encode() for name in {*READERS, *OTHER_ENGINES} - WORDS))
_CALLED = re.compile(
    rb"\b(?:%s)\b" % b"|".join(re.escape(name.encode()) for name in sorted(NAMES_OF_CALLS))
)
_NAMED = re.compile(rb"\b(?:%s)\b" % b"|".join(_NAMES))
_IMPORT_OF_ROS = re.compile(
    rb"(?m)^[^\n#]*\b(?:import|from)[ \t]+(?:%s)\b"
    % b"|".join(sorted(name.encode() for name in OF_ROS))
)
_OF_XML = re.compile(rb"\b(?:xml\.etree|minidom|lxml|BeautifulSoup|xmltodict)\b")
_OF_JOINTS = re.compile(rb"\bjoint")
_WORD = re.compile(rb"\w+")
_FLAGS = re.compile(rb"URDF_USE_INERTIA_FROM_FILE|\bflags\s*=\s*(\d{1,9})\b", re.ASCII)
_USE_INERTIA_FROM_FILE = 2  # of PyBullet, as a number

_FILES = _FOLDERS = 1000
"""Maximum number of files and of folders; of more, none is read. Chosen, no source."""

_OF_URDF = (".urdf", ".xacro")
_OF_SDF = (".sdf", ".world")

_BYTES = 4 << 20
"""Maximum size of a file of code; of a larger one, nothing is known. Chosen, no source.

A larger notebook, whose size is that of its pictures, is skipped.
"""


def _keeps_inertia(code: bytes) -> bool:
    """Tell whether PyBullet gets the flag with which it takes inertias from the file."""
    found = _FLAGS.finditer(code)
    return any(one[1] is None or int(one[1]) & _USE_INERTIA_FROM_FILE for one in found)


def find_imported_readers(description: Description, targets: frozenset[str]) -> Use | None:
    """Find the readers for which a project brings a description.

    A description in URDF is not read by MuJoCo if code that imports another reader mentions URDF,
    and no code that imports MuJoCo does, which then reads an MJCF. An engine that effects do not
    name may do what any other does.

    Returns:
        The readers; None if the code imports none, or a library of ROS that may read descriptions,
        or if the project has a launch file that starts Gazebo.
    """
    if description.path == "-" or not targets.isdisjoint(ROS):
        return None
    files = description.packages.files
    folder = Path(os.path.abspath(description.path)).parent
    below: Path | None = None
    for place in list_above(folder, files):
        holds_module = below is not None and files.exists(below / "__init__.py")
        below = place
        if is_of_planner(files, place):
            return _OF_HPP
        if _is_packaged(files, place, holds_module):
            if read_launch_files(files, place):
                return None
            imports = _read_imports(files, str(place))
            if imports is None:
                return None
            found = imports.get_use(description.path)
            return found and found.with_readers(found.readers | targets)
    return None


def find_project(files: Workspace, folder: Path) -> Path | None:
    """Return the folder of the Python project or installed package that holds a folder, if any."""
    below: Path | None = None
    for place in list_above(folder, files):
        holds_module = below is not None and files.exists(below / "__init__.py")
        below = place
        if _is_packaged(files, place, holds_module):
            return place
    return None


def is_vendored(files: Workspace, package: Path) -> bool:
    """Tell whether a package of ROS is a copy in a module of a Python project."""
    holds_module = False
    for place in list_above(package.parent, files):
        if holds_module and _is_packaged(files, place, holds_module):
            return True
        holds_module = holds_module or files.exists(place / "__init__.py")
    return False


def is_of_planner(files: Workspace, folder: Path) -> bool:
    """Tell whether a folder is that of a package of HPP, a planner without dynamics."""
    manifest = read_optional_file(files, folder / "package.xml")
    return manifest is not None and bool(_OF_PACKAGE_OF_HPP.search(blank_comments(manifest.data)))


def _is_packaged(files: Workspace, folder: Path, holds_module: bool) -> bool:
    """Tell whether a folder is that of a Python project or of an installed package.

    Only a folder with a module is listed: a report depends on what it lists, and is not kept if
    another program writes a file there.
    """
    if any(files.exists(folder / name) for name in _PACKAGING):
        return True
    if not holds_module:
        return False
    try:
        entries = files.list_folder(folder)
    except OSError:
        return False
    return any(entry.name.endswith((".dist-info", ".egg-info")) for entry in entries)


class _Imports(NamedTuple):
    """Who uses the descriptions of a project, None if ROS may, and who those in URDF."""

    of_any: Use | None
    of_urdf: Use

    def get_use(self, path: str) -> Use | None:
        """Return who uses a description; None if no reader does, as MuJoCo none in SDF."""
        if path.endswith(_OF_URDF):
            return self.of_urdf
        if self.of_any is None or not path.endswith(_OF_SDF):
            return self.of_any
        left = self.of_any.readers - {"mujoco"}
        return self.of_any.with_readers(left) if left else None


@memoize_by_workspace
def _read_imports(files: Workspace, folder: str) -> _Imports | None:
    """Return the readers that code imports or names; None if it imports none.

    A name in other text, such as a requirement, a module that is imported by its name or a comment,
    counts as use, since it may be one. Code with ROS that does not mention URDF, such as the driver
    of a camera, reads no description if other code that imports a reader mentions it.
    """
    imported: set[str] = set()
    named: set[str] = set()
    of_urdf: set[str] = set()
    called: set[str] = set()
    keeps_inertia = has_ros = reads_xml = takes_inertia = False
    for path in list_code_of(files, folder):
        try:
            text = files.read_bytes(path, _BYTES)
        except (OSError, UrdftoolError):
            if path.endswith(".ipynb"):
                continue
            return None
        keeps_inertia = keeps_inertia or _keeps_inertia(text)
        own = {name.decode() for name in _IMPORT.findall(text)}
        words = _NAMED.findall(text) if _holds_any(text, _NAMES) else []
        words += (word for line in _IMPORT_LINE.findall(text) for word in _WORD.findall(line))
        mentioned = {word.decode("utf-8", "replace") for word in words}
        is_about_urdf = b"urdf" in text.lower()
        if _IMPORT_OF_ROS.search(text):
            if is_about_urdf or _holds_any(text, _DESCRIPTIONS_OF_ROS):
                return None
            has_ros = True
        imported |= own
        named |= mentioned & {*READERS, *OTHER_ENGINES, *GYM}
        if is_about_urdf:
            of_urdf |= {READERS[name] for name in own & READERS.keys()}
            if _OF_XML.search(text) and _OF_JOINTS.search(text):
                reads_xml = True
        takes_inertia = takes_inertia or b"inertia" in text
        if _CALLED.search(text):
            called |= list_names(path, text) & NAMES_OF_CALLS
    if reads_xml and not (takes_inertia or has_ros or imported & {*READERS, *OTHER_ENGINES}):
        use = Use(frozenset((OWN,)), frozenset())
        return _Imports(use, use)
    if READERS.keys().isdisjoint(imported) or (has_ros and not of_urdf):
        return None
    readers = {READERS[name] for name in named & READERS.keys()}
    moving = find_moving_readers(frozenset(named), frozenset(called))
    if named & OTHER_ENGINES:
        readers |= _ANY_ENGINE
        moving |= _ANY_ENGINE
    found = Use(frozenset(readers), moving, keeps_inertia)
    is_of_mjcf = bool(of_urdf) and "mujoco" not in of_urdf and named.isdisjoint(OTHER_ENGINES)
    left = found.readers - {"mujoco"} if is_of_mjcf else found.readers
    return _Imports(None if has_ros else found, found.with_readers(left))


def _holds_any(text: bytes, words: tuple[bytes, ...]) -> bool:
    return any(word in text for word in words)


@memoize_by_workspace
def list_code_of(files: Workspace, folder: str) -> list[str]:
    """Return the files of code below a folder; none if there are too many."""
    paths: list[str] = []
    waiting = [folder]
    for place in waiting:  # the loop appends to this list
        if len(paths) > _FILES or len(waiting) > _FOLDERS:
            return []
        found, folders = files.list_code(place)
        paths += (os.path.join(place, name) for name in found)
        waiting += (os.path.join(place, name) for name in folders)
    return paths
