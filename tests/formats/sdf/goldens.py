"""The goldens of the SDF export: ``python -m tests.formats.sdf.goldens`` writes them anew."""

from pathlib import Path

from tests.conftest import FIXTURES
from urdftool.formats.sdf.options import Options
from urdftool.formats.sdf.write import write
from urdftool.model.load import load

FOLDER = FIXTURES / "formats" / "sdf"

GOLDENS = {
    ("gripper_arm", "gz"): Options(),
    ("gripper_arm", "lumped"): Options(fixed_joints="lump", version="1.9"),
    ("gripper_arm", "classic"): Options(target="gazebo-classic"),
    ("gripper_arm", "classic9"): Options(target="gazebo-classic", version="1.6"),
    ("lidar_rover", "gz"): Options(version="1.12", world=True, file="rover.world"),
    ("lidar_rover", "classic"): Options(target="gazebo-classic"),
}


def text(name: str, options: Options) -> str:
    """The model without its mark, in which the version stands."""
    written = write(load(FOLDER / f"{name}.urdf"), options)
    lines = written.files[written.main].decode().splitlines(keepends=True)
    return "".join(line for line in lines if not line.startswith("<!-- Exported by"))


def path(name: str, kind: str) -> Path:
    return FOLDER / f"{name}.{kind}.sdf"


if __name__ == "__main__":
    for (golden, kind), choices in GOLDENS.items():
        path(golden, kind).write_text(text(golden, choices), "utf-8")
