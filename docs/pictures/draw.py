"""Draw the pictures of robots in the documentation: ``python docs/pictures/draw.py``.

They are written by ``urdftool view``, ``simulate`` and ``collision`` for robots of the fixtures.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from urdftool import cli

FOLDER = Path(__file__).resolve().parent
ROBOTS = FOLDER.parents[1] / "fixtures" / "robots"

PICTURES = {
    "view_mobile_manipulator.png": (
        "my_robot/urdf/mobile_manipulator.urdf.xacro",
        *("--pose", "shoulder_joint=0.5", "--pose", "elbow_joint=1.2"),
        *("--size", "960x720", "--picture"),
    ),
    "view_collisions.png": (
        "my_robot/urdf/mobile_manipulator.urdf.xacro",
        *("--pose", "shoulder_joint=0.5", "--pose", "elbow_joint=1.2"),
        *("--show", "both", "--size", "960x720", "--picture"),
    ),
    "view_findings.png": (
        "demo_arm/urdf/arm.urdf.xacro",
        *("--findings", "--size", "960x720", "--picture"),
    ),
    "view_contact_sheet.png": (
        "demo_arm/urdf/arm_sound.urdf.xacro",
        *("--size", "320x270", "--contact-sheet"),
    ),
}
"""By file: the robot, and the other arguments of ``view``."""

SIMULATED = {
    "simulate_plot.png": (
        "ros2_arm/urdf/robot2_sound.urdf.xacro", "--limp", "--engine", "both", "--plot",
    ),
    "simulate_collapse.gif": ("ros2_arm/urdf/robot2_sound.urdf.xacro", "--limp", "--video"),
    "simulate_settled.png": (
        "my_robot/urdf/mobile_manipulator.urdf.xacro",
        *("--pose", "shoulder_joint=0.6", "--pose", "elbow_joint=0.8", "--picture"),
    ),
}  # fmt: skip
"""The same for ``simulate``; its exit code is 1 if the robot does not stand."""

COLLISIONS = {
    "collision_auto.png": (
        "my_robot/urdf/mobile_manipulator.urdf.xacro",
        *("-o", "robot.urdf", "--quality", "tight", "--replace-primitives", "--picture"),
    ),
    "collision_cuts.png": (
        "mesh",
        *("my_robot/meshes/arm_base.stl", "-o", "base.obj", "--max-error", "0.01", "--picture"),
    ),
}
"""The same for ``collision``; its other outputs are removed."""

STAGES = {
    "view_stage.png": (
        "my_robot/urdf/mobile_manipulator.urdf.xacro",
        *("--pose", "shoulder_joint=0.5", "--pose", "elbow_joint=1.2"),
        *("--size", "480x360", "--picture"),
    ),
}
"""The same for ``view`` of the stage that ``export usd`` writes; requires usd-core."""


def run() -> int:
    """Draw all pictures; return the exit code of the first command that fails."""
    for name, (robot, *words) in SIMULATED.items():
        code = cli.call(["simulate", str(ROBOTS / robot), *words, str(FOLDER / name)])
        if code > 1:
            return code
    for name, (robot, *words) in PICTURES.items():
        code = cli.call(["view", str(ROBOTS / robot), *words, str(FOLDER / name)])
        if code > ("--findings" in words):  # 1, because a mesh of that robot is missing
            return code
    with tempfile.TemporaryDirectory() as folder:
        for name, (robot, *words) in STAGES.items():
            stage = str(Path(folder) / "robot.usdc")
            code = cli.call(["export", "usd", str(ROBOTS / robot), "-o", stage])
            code = code or cli.call(["view", stage, *words, str(FOLDER / name)])
            if code:
                return code
        for name, words in COLLISIONS.items():
            paths = [str(ROBOTS / word) if "/" in word else word for word in words]
            paths[paths.index("-o") + 1] = str(Path(folder) / paths[paths.index("-o") + 1])
            code = cli.call(["collision", *paths, str(FOLDER / name)])
            if code:
                return code
    return 0


if __name__ == "__main__":
    sys.exit(run())
