"""Draw the pictures of robots in the documentation: ``python docs/pictures/draw.py``.

Each is what ``urdftool view`` or ``simulate`` writes for a robot of the fixtures.
"""

from __future__ import annotations

import sys
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
    "view_contact_sheet.png": (
        "demo_arm/urdf/arm_sound.urdf.xacro",
        *("--size", "320x270", "--contact-sheet"),
    ),
}
"""By file: the robot, and the words that follow it."""

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
"""The same for ``simulate``, which says by its exit code whether the robot stands."""


def main() -> int:
    """Draw them all; the exit code is that of the first that fails."""
    for name, (robot, *words) in SIMULATED.items():
        code = cli.call(["simulate", str(ROBOTS / robot), *words, str(FOLDER / name)])
        if code > 1:
            return code
    for name, (robot, *words) in PICTURES.items():
        code = cli.call(["view", str(ROBOTS / robot), *words, str(FOLDER / name)])
        if code:
            return code
    return 0


if __name__ == "__main__":
    sys.exit(main())
