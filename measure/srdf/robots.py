"""Robots to measure on, by class: arms, arms with a gripper, humanoids, legged robots."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

from ..benchmarks.robots import example_folder

ARM, GRIPPER, HUMANOID, LEGGED = "arm", "arm with gripper", "humanoid", "legged"

_EXAMPLES = {
    ARM: "ur_description/urdf/ur3_robot ur_description/urdf/ur5_robot "
    "ur_description/urdf/ur10_robot ur_description/urdf/ur5_joint_limited_robot "
    "xarm_description/urdf/xarm7 hextilt_description/urdf/hextilt_flying_arm_5",
    GRIPPER: "panda_description/urdf/panda ur_description/urdf/ur3_gripper "
    "ur_description/urdf/ur5_gripper kinova_description/robots/kinova z1_description/urdf/z1 "
    "so_arm_description/urdf/so101 so_arm_description/urdf/so100 "
    "talos_data/robots/talos_left_arm",
    HUMANOID: "g1_description/urdf/g1_29dof_rev_1_0 alex_description/urdf/alex_nub_hands "
    "icub_description/robots/icub_reduced romeo_description/urdf/romeo_small "
    "talos_data/robots/talos_reduced baxter_description/urdf/baxter",
    LEGGED: "a1_description/urdf/a1 go2_description/urdf/go2 solo_description/robots/solo12 "
    "hyq_description/robots/hyq_no_sensors bolt_description/robots/bolt "
    "anymal_b_simple_description/robots/anymal",
}
_BULLET = {
    ARM: "kuka_iiwa/model xarm/xarm6_robot",
    GRIPPER: "franka_panda/panda xarm/xarm6_with_gripper",
    LEGGED: "laikago/laikago mini_cheetah/mini_cheetah",
}

SRDF_OF = {
    "ur3_gripper": "ur_description/srdf/ur3_gripper",
    "ur5_gripper": "ur_description/srdf/ur5_gripper",
    "ur5_robot": "ur_description/srdf/ur5",
    "ur5_joint_limited_robot": "ur_description/srdf/ur5_joint_limited_robot",
    "xarm7": "xarm_description/srdf/xarm7",
    "panda": "panda_description/srdf/panda",
    "kinova": "kinova_description/srdf/kinova",
    "baxter": "baxter_description/srdf/baxter_manipulation",
    "a1": "a1_description/srdf/a1",
    "go2": "go2_description/srdf/go2",
    "bolt": "bolt_description/srdf/bolt",
    "hyq_no_sensors": "hyq_description/srdf/hyq",
    "anymal": "anymal_b_simple_description/srdf/anymal",
}
"""Published SRDF of a robot, in example-robot-data."""


@dataclass(frozen=True)
class Source:
    """A robot to measure on.

    Attributes:
        name: Name for tables.
        kind: Its class.
        path: The description.
        srdf: Published SRDF; None without one.
    """

    name: str
    kind: str
    path: Path
    srdf: Path | None = None


def list_sources() -> list[Source]:
    """List the robots of the packages that are installed."""
    found = []
    examples = example_folder()
    if examples is not None:
        for kind, names in _EXAMPLES.items():
            for name in names.split():
                path = examples / "robots" / f"{name}.urdf"
                srdf = SRDF_OF.get(path.stem)
                other = examples / "robots" / f"{srdf}.srdf" if srdf else None
                found.append(Source(path.stem, kind, path, other))
    folders = (Path(folder) / "pybullet_data" for folder in sys.path)
    bullet = next((folder for folder in folders if folder.is_dir()), None)
    if bullet is not None:
        for kind, names in _BULLET.items():
            for name in names.split():
                stem = name.replace("/model", "").split("/")[-1]
                found.append(Source(f"{stem} (pybullet)", kind, bullet / f"{name}.urdf"))
    return [source for source in found if source.path.is_file()]
