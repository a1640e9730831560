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

from ..diagnostic import Severity
from ..errors import UrdftoolError
from ..finding import Finding
from ..model.elements import Robot
from ..projects import list_above
from ..rules.rule import GAZEBO, ROS, Rule
from ..source.comments import blank_comments
from ..source.description import Description
from ..source.nearby_files import read_optional_file
from ..workspace import Workspace, memoize_by_workspace
from .evidence import read_launch_files

_READERS = {
    **dict.fromkeys(("mujoco", "mujoco_py", "dm_control", "robosuite", "brax"), "mujoco"),
    **dict.fromkeys(("mujoco_warp", "mujoco_playground", "gymnasium_robotics"), "mujoco"),
    **dict.fromkeys(("pybullet", "pybullet_utils", "pybullet_data"), "pybullet"),
    **dict.fromkeys(("pinocchio", "crocoddyl", "tsid", "pink", "placo"), "pinocchio"),
    **dict.fromkeys(("jiminy_py", "gym_jiminy"), "pinocchio"),
    "pydrake": "drake",
    "newton": "newton",
    **dict.fromkeys(("hpp", "pyhpp", "hppfcl", "coal", "gepetto"), "pinocchio"),
    **dict.fromkeys(("ikpy", "kinpy", "pytorch_kinematics", "tracikpy", "pyroki"), "kinematics"),
}
"""Reader, as effects name it, of each library; "kinematics" reads no masses and no collisions."""

_WITHOUT_DYNAMICS = frozenset(
    (
        *("ikpy", "kinpy", "pytorch_kinematics", "tracikpy", "pyroki"),
        *("hpp", "pyhpp", "hppfcl", "coal", "gepetto"),
    )
)
"""Libraries of kinematics, distances and path planning."""

_OF_PLANNER = re.compile(rb"<(name|\w*depend)>\s*hpp[-_][\w-]+\s*</\1>")
"""What a package.xml of HPP says: its name, or a package that it depends on."""


class Use(NamedTuple):
    """Who uses the descriptions of a project.

    Attributes:
        readers: The readers, as effects name them.
        moves: Whether one of them computes dynamics.
        keeps_inertia: Whether PyBullet gets the flag that keeps inertias.
    """

    readers: frozenset[str]
    moves: bool = True
    keeps_inertia: bool = False


_PLANNER = Use(frozenset(("pinocchio",)), moves=False)

_OTHER_ENGINES = frozenset(
    (
        *("isaacgym", "isaacsim", "isaaclab", "omni", "genesis", "sapien", "mani_skill", "dartpy"),
        *("raisimpy", "scenario", "gym_ignition", "jaxsim", "idyntree", "roboticstoolbox", "gz"),
        *("rclpy", "rospy", "moveit_commander", "klampt", "chrono", "pychrono", "adam"),
    )
)
"""Libraries of dynamics, simulators and ROS, whose behavior few effects describe."""

_WORDS = frozenset(("adam", "chrono", "genesis", "gz", "newton", "omni", "pink", "scenario"))
"""Names of libraries that are words too: only where a line imports them."""

_PACKAGING = ("pyproject.toml", "setup.py", "PKG-INFO", ".git")
_IMPORT = re.compile(rb"(?m)^[ \t]*(?:import|from)[ \t]+(\w+)")
_IMPORT_LINE = re.compile(rb"\b(?:import|from)\b[^\n]*(?:\\\r?\n[^\n]*)*")
_NAMED = re.compile(
    rb"\b(?:%s)\b" % b"|".join(sorted(n.encode() for n in {*_READERS, *_OTHER_ENGINES} - _WORDS))
)
_WORD = re.compile(rb"\w+")
_KEEPS_INERTIA = re.compile(rb"URDF_USE_INERTIA_FROM_FILE|\bflags\s*=\s*[1-9]")

_FILES = _FOLDERS = 400
"""Maximum number of files and of folders; of more, none is read. Chosen, no source."""

_BYTES = 1 << 20
"""Maximum size of a file of code; of a larger one, nothing is known. Chosen, no source."""

_UNAFFECTED = re.compile(r"(?:accept|read)s? it$")
"""Effect on a reader to which the finding does not matter."""

_SIMULATORS = frozenset(("gz", "gazebo-classic", "mujoco", "pybullet", "drake", "newton"))


def find_imported_readers(description: Description, targets: frozenset[str]) -> Use | None:
    """Find the readers for which a project brings a description.

    Returns:
        The readers; None if the code imports none, or an engine that effects do not name, or if the
        project is for ROS, where others use its packages, or has a launch file that starts Gazebo.
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
            return _PLANNER
        if _is_packaged(files, place, holds_module):
            if read_launch_files(files, place):
                return None
            found = _read_imports(files, str(place))
            return found and found._replace(readers=found.readers | targets)
    return None


def is_of_planner(files: Workspace, folder: Path) -> bool:
    """Tell whether a folder is that of a package of HPP, a planner without dynamics."""
    manifest = read_optional_file(files, folder / "package.xml")
    return manifest is not None and bool(_OF_PLANNER.search(blank_comments(manifest.data)))


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


@memoize_by_workspace
def _read_imports(files: Workspace, folder: str) -> Use | None:
    """Return the readers that code imports or names; None if it imports none.

    A name in other text, such as a requirement, a module that is imported by its name or a comment,
    counts as use, since it may be one.
    """
    paths: list[str] = []
    waiting = [folder]
    for place in waiting:
        if len(paths) > _FILES or len(waiting) > _FOLDERS:
            return None
        found, folders = files.list_code(place)
        paths += (os.path.join(place, name) for name in found)
        waiting += (os.path.join(place, name) for name in folders)
    imported: set[bytes] = set()
    named: set[bytes] = set()
    keeps_inertia = False
    for path in paths:
        try:
            text = files.read_bytes(path, _BYTES)
        except (OSError, UrdftoolError):
            return None
        keeps_inertia = keeps_inertia or bool(_KEEPS_INERTIA.search(text))
        imported.update(_IMPORT.findall(text))
        named.update(_NAMED.findall(text))
        named.update(word for line in _IMPORT_LINE.findall(text) for word in _WORD.findall(line))
    if _READERS.keys().isdisjoint(name.decode() for name in imported):
        return None
    names = {name.decode() for name in named}
    if names & _OTHER_ENGINES:
        return None
    used = names & {*_READERS}
    return Use(frozenset(_READERS[n] for n in used), bool(used - _WITHOUT_DYNAMICS), keeps_inertia)


def is_for_other_readers(rule: Rule, finding: Finding, used: Use | None) -> bool:
    """Tell whether a finding below error has effects on readers that a project does not use.

    A project without dynamics uses no inertia. Of rules that are not about motion, only remarks
    about simulators are judged, and settings for Gazebo alone: a file that readers take differently
    is worth knowing.
    """
    if used is None or finding.severity is Severity.ERROR:
        return False
    is_of_inertia = rule.of_motion and rule.family == "inertia"
    if is_of_inertia and not used.moves:
        return True
    readers = {
        reader
        for key, effect in finding.effects.items()
        if not _UNAFFECTED.match(effect)
        for reader in key.split(", ")
    }
    if not readers or not readers.isdisjoint(used.readers):
        return False
    if is_of_inertia and used.keeps_inertia:
        return False
    if rule.family == "inertia" or rule.of_motion or readers <= set(GAZEBO):
        return True
    return finding.severity is Severity.INFO and readers <= _SIMULATORS


def is_of_unmoved_robot(rule: Rule, finding: Finding, robot: Robot | None) -> bool:
    """Tell whether a remark about motion is about a robot that no simulator moves.

    That is a marker, of which no joint moves and nothing collides, and a robot for kinematics, of
    which no link has an inertial: ``missing-inertial`` reports that once. A single body with
    collision geometry, as a drone or an object to grasp, moves as a whole.
    """
    if robot is None or not rule.of_motion or finding.severity is Severity.ERROR:
        return False
    if not robot.links:
        return False
    if robot.moving_joints:
        return robot.format == "urdf" and all(link.inertial is None for link in robot.links)
    return not any(link.collisions for link in robot.links)
