"""``expand`` against the ``xacro`` command, on the five largest xacro robots of the corpus."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path

from .timing import CORPUS, PYTHON, URDFTOOL, in_turn, row, run

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


def rows() -> Iterator[str]:
    """A row a robot; ``$(find)`` of plain xacro is answered by a stand-in for ROS's index."""
    if not CORPUS.exists() or shutil.which("xacro", path=Path(PYTHON).parent.as_posix()) is None:
        yield f"skipped: needs {CORPUS} and the xacro command"
        return
    xacro = str(Path(PYTHON).parent / "xacro")
    env = {**os.environ, "PYTHONPATH": str(SHIM), "PACKAGE_ROOTS": str(CORPUS)}
    for path, arguments in ROBOTS:
        robot = str(CORPUS / path)
        medians = in_turn(
            {
                "urdftool": run([*URDFTOOL, "expand", robot, *arguments]),
                "xacro": run([xacro, robot, *arguments], env=env),
            }
        )
        yield row(Path(path).name, medians, "urdftool", "xacro")
