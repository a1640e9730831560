"""Readers of robots that the Python code of a project imports: who uses the description there.

A package such as an environment of PyBullet brings its robots for one engine. What another engine
would do with an implausible inertia is not seen there, so such findings are off by default, and
the last lines of a report count them.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

from ..diagnostic import Severity
from ..errors import UrdftoolError
from ..finding import Finding
from ..model.elements import Robot
from ..projects import list_above
from ..rules.rule import GAZEBO, ROS, Rule
from ..source.description import Description
from ..workspace import Workspace, memoize_by_workspace

_READERS = {
    **dict.fromkeys(("mujoco", "mujoco_py", "dm_control", "robosuite", "brax"), "mujoco"),
    **dict.fromkeys(("mujoco_warp", "mujoco_playground", "gymnasium_robotics"), "mujoco"),
    **dict.fromkeys(("pybullet", "pybullet_utils", "pybullet_data"), "pybullet"),
    **dict.fromkeys(("pinocchio", "crocoddyl", "tsid", "pink", "placo"), "pinocchio"),
    **dict.fromkeys(("jiminy_py", "gym_jiminy"), "pinocchio"),
    "pydrake": "drake",
    "newton": "newton",
    **dict.fromkeys(("ikpy", "kinpy", "pytorch_kinematics", "tracikpy", "pyroki"), "kinematics"),
}
"""Reader, as effects name it, of each library; "kinematics" reads no masses and no collisions."""

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

_SIMULATORS = frozenset(("gz", "gazebo-classic", "mujoco", "pybullet", "drake", "newton"))


def find_imported_readers(
    description: Description, targets: frozenset[str]
) -> frozenset[str] | None:
    """Find the readers for which a project brings a description, as effects name them.

    Returns:
        The readers; None if the code imports none, or an engine that effects do not name, if the
        project is for ROS, where others use its packages, or if it sets the flag of PyBullet that
        keeps inertias.
    """
    if description.path == "-" or not targets.isdisjoint(ROS):
        return None
    files = description.packages.files
    folder = Path(os.path.abspath(description.path)).parent
    below: Path | None = None
    for place in list_above(folder, files):
        holds_module = below is not None and files.exists(below / "__init__.py")
        below = place
        if _is_packaged(files, place, holds_module):
            found = _read_imports(files, str(place))
            return None if found is None else found | targets
    return None


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
def _read_imports(files: Workspace, folder: str) -> frozenset[str] | None:
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
    for path in paths:
        try:
            text = files.read_bytes(path, _BYTES)
        except (OSError, UrdftoolError):
            return None
        if _KEEPS_INERTIA.search(text):
            return None
        imported.update(_IMPORT.findall(text))
        named.update(_NAMED.findall(text))
        named.update(word for line in _IMPORT_LINE.findall(text) for word in _WORD.findall(line))
    if _READERS.keys().isdisjoint(name.decode() for name in imported):
        return None
    names = {name.decode() for name in named}
    return None if names & _OTHER_ENGINES else frozenset(_READERS[n] for n in names & {*_READERS})


def is_for_other_readers(rule: Rule, finding: Finding, used: frozenset[str] | None) -> bool:
    """Tell whether a finding below error has effects on readers that a project does not use.

    Of rules that are not about motion, only remarks about simulators are judged, and settings for
    Gazebo alone: a file that readers take differently is worth knowing.
    """
    if used is None or finding.severity is Severity.ERROR:
        return False
    readers = {reader for key in finding.effects for reader in key.split(", ")}
    if not readers or not readers.isdisjoint(used):
        return False
    if rule.of_motion or readers <= set(GAZEBO):
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
