"""Robots of several packages, drawn at random."""

from __future__ import annotations

import os
import random
from pathlib import Path
from typing import NamedTuple

from urdftool.compare.mesh_measure import MeshMeasures
from urdftool.formats.detect import format_of
from urdftool.model.elements import Mesh, Robot
from urdftool.model.load import load
from urdftool.source.document import read_file

from ..benchmarks.robots import CORPUS, ROOT, bullet_robots, example_robots, manifest

_WHEELS = Path(os.environ.get("URDFTOOL_MJCF", ROOT / ".venv-mjcf"))
MODELS = next((path.parent for path in sorted(_WHEELS.glob("**/robosuite"))), _WHEELS)
"""Folder of the files of robosuite, dm_control, gymnasium and gymnasium-robotics."""

TUNED_ON = 12
"""Number of robots of example-robot-data, those with the fewest meshes, that were used before."""

PER_GROUP = 10
"""Robots of each group."""

_HEAVIEST = 20_000_000
"""Size of the meshes of a robot [bytes] from which it is not drawn."""

_MODELS = (
    "robosuite/models/assets/robots/*/robot.xml",
    "robosuite/models/assets/grippers/*.xml",
    "dm_control/suite/*.xml",
    "dm_control/locomotion/**/*.xml",
    "gymnasium/envs/mujoco/assets/*.xml",
    "gymnasium_robotics/envs/**/*.xml",
)


class Source(NamedTuple):
    """File of a robot.

    Attributes:
        group: ``example``, ``pybullet``, ``repositories`` or ``other formats``.
        name: Name for tables.
        path: The file.
        arguments: Values of xacro arguments.
    """

    group: str
    name: str
    path: Path
    arguments: dict[str, str]


def list_sources() -> list[Source]:
    """Return every file that may be drawn, in a fixed order."""
    example = sorted(example_robots(), key=lambda p: p.read_text(errors="replace").count("<mesh"))
    found = [Source("example", path.stem, path, {}) for path in sorted(example[TUNED_ON:])]
    bullet = bullet_robots()
    found += [Source("pybullet", path.stem, path, {}) for path in bullet]
    for entry in manifest():
        if entry["kind"] in ("urdf", "xacro"):
            words = (word.partition(":=") for word in entry["xacro_args"].split())
            arguments = {name: value for name, _, value in words}
            path = CORPUS / entry["path"]
            found.append(Source("repositories", entry["path"], path, arguments))
    models = [path for pattern in _MODELS for path in sorted(MODELS.glob(pattern))]
    found += [Source("other formats", str(path.relative_to(MODELS)), path, {}) for path in models]
    if bullet:
        data = next(path for path in bullet[0].parents if path.name == "pybullet_data")
        others = sorted([*data.rglob("*.sdf"), *data.rglob("mjcf/*.xml")])
        found += [Source("other formats", str(path.relative_to(data)), path, {}) for path in others]
    return found


def read(source: Source) -> Robot:
    """Read a robot of any format.

    Raises:
        UrdftoolError: It cannot be read.
    """
    found = format_of(read_file(source.path))
    if found.name != "urdf":
        return found.read(source.path).robot
    folders = {
        "example": source.path.parents[min(3, len(source.path.parents) - 1)].parent,
        "repositories": CORPUS,
    }
    folder = folders.get(source.group)
    return load(source.path, args=source.arguments, package_paths=[folder] if folder else [])


def is_suitable(robot: Robot) -> bool:
    """Tell whether a robot has two moving joints or more, mass, and meshes that are not large."""
    moving = [joint for joint in robot.joints if not joint.is_fixed]
    if len(moving) < 2 or not any(link.mass for link in robot.links):
        return False
    meshes, files = MeshMeasures(), set()
    for _, shape in robot.shapes:
        if isinstance(shape.geometry, Mesh):
            files.add(meshes.find(robot, shape.geometry))
    return sum(path.stat().st_size for path in files if path is not None) < _HEAVIEST


def draw(seed: int) -> dict[str, list[Source]]:
    """Return the files of each group in random order."""
    generator, groups = random.Random(seed), dict[str, list[Source]]()
    for source in list_sources():
        groups.setdefault(source.group, []).append(source)
    for sources in groups.values():
        generator.shuffle(sources)
    return groups
