"""Robots that their consumers load well, from pybullet_data and example-robot-data."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from xml.etree import ElementTree

PYBULLET = (
    "a1/a1.urdf",
    "franka_panda/panda.urdf",
    "kuka_iiwa/model.urdf",
    "laikago/laikago_toes_zup.urdf",
    "mini_cheetah/mini_cheetah.urdf",
    "r2d2.urdf",
)
EXAMPLES = (
    "allegro_hand_description/urdf/allegro_right_hand.urdf",
    "anymal_c_simple_description/urdf/anymal.urdf",
    "b1_description/urdf/b1.urdf",
    "baxter_description/urdf/baxter.urdf",
    "bolt_description/robots/bolt.urdf",
    "go2_description/urdf/go2.urdf",
    "hyq_description/robots/hyq_no_sensors.urdf",
    "kinova_description/robots/kinova.urdf",
    "panda_description/urdf/panda.urdf",
    "romeo_description/urdf/romeo.urdf",
    "simple_humanoid_description/urdf/simple_humanoid.urdf",
    "so_arm_description/urdf/so101.urdf",
    "solo_description/robots/solo12.urdf",
    "talos_data/robots/talos_reduced.urdf",
    "tiago_description/robots/tiago_no_hand.urdf",
    "ur_description/urdf/ur5_robot.urdf",
    "xarm_description/urdf/xarm7.urdf",
    "z1_description/urdf/z1.urdf",
)
SHORT = ("model",)
"""Those of the short form: the iiwa of pybullet_data, which is checked in a tenth of a second."""


@dataclass
class Sample:
    """A robot of a collection, as text that can be written anywhere.

    Attributes:
        packages: Where the packages are that its meshes name.
    """

    path: Path
    text: str
    packages: dict[str, Path] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """Its collection and file."""
        return f"{self.path.parent.parent.name}/{self.path.stem}"


def samples() -> list[Sample]:
    """The robots of the collections that are installed."""
    return [*of_pybullet(PYBULLET), *of_examples(EXAMPLES)]


def of_pybullet(names: Iterable[str]) -> list[Sample]:
    """Robots of pybullet_data; none where it is not installed."""
    data = pybullet_data()
    if data is None:
        return []
    return [_sample(data / name, data, {"pybullet_data": data}) for name in names]


def of_examples(names: Iterable[str]) -> list[Sample]:
    """Robots of example-robot-data; none where it is not installed."""
    data = example_robot_data()
    if data is None:
        return []
    packages = {"example-robot-data": data}
    return [_sample(data / "robots" / name, data, packages) for name in names]


def pybullet_data() -> Path | None:
    """The folder of the robots that come with PyBullet."""
    spec = find_spec("pybullet_data")
    return Path(spec.origin).parent if spec is not None and spec.origin else None


def example_robot_data() -> Path | None:
    """The folder of the robots that come with Pinocchio."""
    for folder in sys.path:
        data = Path(folder) / "cmeel.prefix" / "share" / "example-robot-data"
        if data.is_dir():
            return data
    return None


def _sample(path: Path, data: Path, packages: dict[str, Path]) -> Sample:
    """A robot with its relative mesh files named by package, so that it stands anywhere."""
    root = ElementTree.fromstring(path.read_bytes())
    for mesh in root.iter("mesh"):
        uri = mesh.get("filename", "").replace("package://meshes", "meshes")
        if "://" not in uri:
            inside = (path.parent / uri).resolve().relative_to(data.resolve())
            mesh.set("filename", f"package://{next(iter(packages))}/{inside}")
    for material in root.iter("texture"):
        material.attrib.pop("filename", None)
    return Sample(path, ElementTree.tostring(root, encoding="unicode"), packages)
