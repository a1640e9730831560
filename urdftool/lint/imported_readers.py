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
from .evidence import read_launch_files

CHAIN = "kinematic chains"
"""Readers that take joints and their limits: no masses, no shapes."""

SCENE = "kinematics and shapes"
"""Readers that take joints, and shapes at their places: no masses, no motion."""

_READERS = {
    **dict.fromkeys(("mujoco", "mujoco_py", "dm_control", "robosuite", "brax"), "mujoco"),
    **dict.fromkeys(("mujoco_warp", "mujoco_playground", "gymnasium_robotics"), "mujoco"),
    **dict.fromkeys(("pybullet", "pybullet_utils", "pybullet_data"), "pybullet"),
    **dict.fromkeys(("pinocchio", "crocoddyl", "tsid", "pink", "placo"), "pinocchio"),
    **dict.fromkeys(("jiminy_py", "gym_jiminy"), "pinocchio"),
    "pydrake": "drake",
    "newton": "newton",
    **dict.fromkeys(("hpp", "pyhpp", "hppfcl", "coal", "gepetto"), "pinocchio"),
    **dict.fromkeys(("ikpy", "kinpy", "pytorch_kinematics", "tracikpy", "pypot"), CHAIN),
    **dict.fromkeys(("yourdfpy", "urdfpy", "urchin", "pyroki", "skrobot", "klampt"), SCENE),
    "pytransform3d": SCENE,
}
"""Reader, as effects name it, of each library."""

_WITHOUT_DYNAMICS = frozenset(
    (
        *(name for name, reader in _READERS.items() if reader in (CHAIN, SCENE)),
        *("hpp", "pyhpp", "hppfcl", "coal", "gepetto"),
    )
)
"""Libraries of kinematics, distances and path planning."""

_DYNAMICS_OF_PYBULLET = (
    *(b"setJointMotorControl", b"applyExternal", b"calculateInverseDynamics", b"changeDynamics"),
    *(b"calculateMassMatrix", b"createConstraint", b"resetBaseVelocity", b"getDynamicsInfo"),
    *(b"pybullet_envs", b"import gym", b"from gym"),
)
"""What code with dynamics of PyBullet contains; an environment of Gymnasium moves its robots."""

_DYNAMICS_OF = {
    "pinocchio": re.compile(
        rb"\b(?:rnea|aba|crba|ccrba|computeAllTerms|computeMinverse|nonLinearEffects|dccrba)\b"
        rb"|computeGeneralizedGravity|computeCentroidal|centerOfMass|forwardDynamics|\.inertias\b"
        rb"|RNEA|computeTotalMass|Regressor|computeKineticEnergy|computeStaticTorque"
    ),
    "klampt": re.compile(rb"\bSimulator\b|getMass\b|dynamics|getGravityForces"),
}
"""What code with dynamics calls, of other libraries that are used without dynamics, too."""

_POSES = (b"resetJointState", b"calculateInverseKinematics")
"""What code calls that places the bodies of PyBullet itself, though it may step the simulation."""

_OF_PLANNER = re.compile(rb"<(name|\w*depend)>\s*hpp[-_][\w-]+\s*</\1>")
"""What a package.xml of HPP says: its name, or a package that it depends on."""


class Use(NamedTuple):
    """Who uses the descriptions of a project.

    Attributes:
        readers: The readers, as effects name them; also ``CHAIN`` and ``SCENE``.
        moves: Whether one of them computes dynamics.
        keeps_inertia: Whether PyBullet gets the flag that keeps inertias.
    """

    readers: frozenset[str]
    moves: bool = True
    keeps_inertia: bool = False


_PLANNER = Use(frozenset(("pinocchio",)), moves=False)

_OF_ROS = frozenset(
    (
        *("rclpy", "rospy", "moveit_commander", "moveit", "moveit_msgs", "ament_index_python"),
        *("launch_ros", "roslib", "rospkg", "roslaunch", "tf2_ros", "sensor_msgs"),
        *("scenario", "gym_ignition", "gz"),
    )
)
"""Libraries of ROS and Gazebo."""

_OTHER_ENGINES = frozenset(
    (
        *("isaacgym", "isaacsim", "isaaclab", "omni", "genesis", "sapien", "mani_skill", "dartpy"),
        *("raisimpy", "jaxsim", "idyntree", "roboticstoolbox", "chrono", "pychrono", "adam"),
    )
)
"""Libraries of dynamics and simulators, whose behavior few effects describe."""

_DESCRIPTIONS_OF_ROS = (b"robot_description", b"xacro")
"""What code with ROS contains that reads a description, if it does not mention URDF."""

_ANY_ENGINE = frozenset(("mujoco", "pybullet", "pinocchio", "drake", "newton", "isaac"))
"""Readers whose effects show what another engine may do."""

_WORDS = frozenset(
    (
        *("adam", "chrono", "genesis", "gz", "newton", "omni", "pink", "scenario", "moveit"),
        *("pyroki", "urchin", "coal", "hpp"),
    )
)
"""Names of libraries that are words too: only where a line imports them."""

_PACKAGING = ("pyproject.toml", "setup.py", "setup.cfg", "PKG-INFO", ".git")
_IMPORT = re.compile(rb"(?m)^[ \t]*(?:import|from)[ \t]+(\w+)")
_IMPORT_LINE = re.compile(rb"\b(?:import|from)\b[^\n]*(?:\\\r?\n[^\n]*)*")
_NAMES = tuple(sorted(name.encode() for name in {*_READERS, *_OTHER_ENGINES, *_OF_ROS} - _WORDS))
_NAMED = re.compile(rb"\b(?:%s)\b" % b"|".join(_NAMES))
_IMPORT_OF_ROS = re.compile(
    rb"\b(?:import|from)[ \t]+(?:%s)\b" % b"|".join(sorted(name.encode() for name in _OF_ROS))
)
_WORD = re.compile(rb"\w+")
_KEEPS_INERTIA = re.compile(rb"URDF_USE_INERTIA_FROM_FILE|\bflags\s*=\s*[1-9]")

_FILES = _FOLDERS = 1000
"""Maximum number of files and of folders; of more, none is read. Chosen, no source."""

_OF_URDF = (".urdf", ".xacro")

_BYTES = 4 << 20
"""Maximum size of a file of code; of a larger one, nothing is known. Chosen, no source.

A larger notebook, whose size is that of its pictures, is skipped.
"""


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
            return _PLANNER
        if _is_packaged(files, place, holds_module):
            if read_launch_files(files, place):
                return None
            imports = _read_imports(files, str(place))
            if imports is None:
                return None
            found = imports.of_urdf if description.path.endswith(_OF_URDF) else imports.of_any
            return found and found._replace(readers=found.readers | targets)
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


class _Imports(NamedTuple):
    """Who uses the descriptions of a project, None if ROS may, and who those in URDF."""

    of_any: Use | None
    of_urdf: Use


@memoize_by_workspace
def _read_imports(files: Workspace, folder: str) -> _Imports | None:
    """Return the readers that code imports or names; None if it imports none.

    A name in other text, such as a requirement, a module that is imported by its name or a comment,
    counts as use, since it may be one. Code with ROS that does not mention URDF, such as the driver
    of a camera, reads no description if other code that imports a reader mentions it.
    """
    paths = list_code_of(files, folder)
    imported: set[str] = set()
    named: set[str] = set()
    of_urdf: set[str] = set()
    keeps_inertia = False
    places_bodies = has_ros = False
    moved: set[str] = set()
    for path in paths:
        try:
            text = files.read_bytes(path, _BYTES)
        except (OSError, UrdftoolError):
            if path.endswith(".ipynb"):
                continue
            return None
        keeps_inertia = keeps_inertia or bool(_KEEPS_INERTIA.search(text))
        own = {name.decode() for name in _IMPORT.findall(text)}
        words = _NAMED.findall(text) if _holds_any(text, _NAMES) else []
        words += (word for line in _IMPORT_LINE.findall(text) for word in _WORD.findall(line))
        mentioned = {word.decode("utf-8", "replace") for word in words}
        is_about_urdf = b"urdf" in text.lower()
        if mentioned & _OF_ROS:
            reads = is_about_urdf or _holds_any(text, _DESCRIPTIONS_OF_ROS)
            if reads and _IMPORT_OF_ROS.search(text):
                return None
            has_ros = True
        imported |= own
        named |= mentioned & {*_READERS, *_OTHER_ENGINES}
        if is_about_urdf:
            of_urdf |= {_READERS[name] for name in own & _READERS.keys()}
        for name in mentioned & _DYNAMICS_OF.keys():
            if _DYNAMICS_OF[name].search(text):
                moved.add(name)
        if _holds_any(text, _DYNAMICS_OF_PYBULLET):
            moved.add("pybullet")
        places_bodies = places_bodies or _holds_any(text, _POSES)
    if _READERS.keys().isdisjoint(imported) or (has_ros and not of_urdf):
        return None
    used = named & {*_READERS}
    readers = {_READERS[name] for name in used}
    if named & _OTHER_ENGINES:
        readers |= _ANY_ENGINE
    still = set(_WITHOUT_DYNAMICS) - moved
    still |= {"pinocchio"} - moved
    if places_bodies and "pybullet" not in moved and not keeps_inertia:
        still |= {name for name, reader in _READERS.items() if reader == "pybullet"}
    moves = bool(used - still) or not named.isdisjoint(_OTHER_ENGINES)
    found = Use(frozenset(readers), moves, keeps_inertia)
    is_of_mjcf = bool(of_urdf) and "mujoco" not in of_urdf and named.isdisjoint(_OTHER_ENGINES)
    left = readers - {"mujoco"} if is_of_mjcf else readers
    return _Imports(None if has_ros else found, found._replace(readers=frozenset(left)))


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
