"""``expand`` against xacro"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

from . import peers
from .robots import CORPUS, FIXTURES, made_xacro
from .table import Pairs, Table
from .timing import URDFTOOL, command, in_turn

PEERS = ("xacro",)
SHIM = Path(__file__).parent / "without_ros"

STRANDBEEST = "RobotLocomotion__drake/examples/multibody/strandbeest/model"
FRANKA = "frankaemika__franka_description/robots"

ROBOTS = (
    ("ros__xacro/test/robots/pr2/pr2.urdf.xacro", ()),
    (f"{STRANDBEEST}/StrandbeestBushings.urdf.xacro", ()),
    (f"{STRANDBEEST}/StrandbeestConstraints.urdf.xacro", ()),
    (f"{FRANKA}/multi_arm/multi_arm.urdf.xacro", ()),
    (f"{FRANKA}/fr3/fr3.urdf.xacro", ("hand:=true", "ros2_control:=true", "robot_ip:=1.2.3.4")),
)
ABOUT = """\
The output is equal as XML. Without ROS, xacro finds no packages: a replacement of the ROS index
answers its `$(find)`, in negligible time."""


def rows() -> Iterator[Table | str]:
    """A row a robot."""
    xacro = peers.tool("xacro")
    if xacro is None:
        yield peers.missing("xacro")
        return
    if not CORPUS.exists():
        yield "The large robots of the collection of the tests are not there, so they are left out."
    pairs = Pairs("robot", ["xacro"])
    with tempfile.TemporaryDirectory() as folder:
        for name, path, arguments in _robots(Path(folder)):
            env = {**os.environ, "PYTHONPATH": str(SHIM), "PACKAGE_ROOTS": str(_root(path))}
            sides = {
                "urdftool": command([*URDFTOOL, "expand", path, *arguments]),
                "xacro": command([xacro, path, *arguments], env=env),
            }
            pairs.add(name, in_turn(sides, budget=12, label=name))
    yield pairs.table(
        "Both run xacro: xacro compiles every expression each time, urdftool caches compiled "
        "expressions. For small robots most of the time is the start of Python."
    )


def _robots(folder: Path) -> Iterator[tuple[str, Path, tuple[str, ...]]]:
    for place, arguments in ROBOTS:
        if (CORPUS / place).exists():
            yield Path(place).name, CORPUS / place, arguments
    path = FIXTURES / "robots" / "my_robot" / "urdf" / "mobile_manipulator.urdf.xacro"
    yield path.name, path, ()
    large = folder / "made.urdf.xacro"
    large.write_text(made_xacro(200), "utf-8")
    yield "generated, 200 calls of a macro", large, ()


def _root(path: Path) -> Path:
    return CORPUS if CORPUS in path.parents else FIXTURES / "robots"
