"""Robots to measure on: of two packages of PyPI, of the tests' collection, and made ones."""

from __future__ import annotations

import csv
import os
import sys
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

from . import peers

ROOT = Path(__file__).resolve().parents[2]
FIXTURES = ROOT / "fixtures"
CORPUS = ROOT.parent / "shared" / "corpus"
"""Some 200 descriptions from public repositories; not part of the project."""

ARM = 10
"""Links of an arm of a made robot."""

SPACE = 2.5
"""Distance of its arms [m]: they do not touch each other."""


@cache
def _packages() -> tuple[Path, ...]:
    """Folders where packages of Python are: of the others, and ours."""
    found = [path for path in peers.FOLDER.glob("lib/python*/site-packages") if path.is_dir()]
    return (*found, *(Path(path) for path in sys.path if path.endswith("-packages")))


def example_folder() -> Path | None:
    """The folder that bears the package example-robot-data; None if it is not installed."""
    for folder in _packages():
        found = folder / "cmeel.prefix" / "share" / "example-robot-data"
        if found.is_dir():
            return found
    return None


def example_robots() -> list[Path]:
    """The descriptions of example-robot-data that have a link."""
    folder = example_folder()
    found = sorted(folder.rglob("*.urdf")) if folder else []
    return [path for path in found if b"<link" in path.read_bytes()]


def bullet_robots() -> list[Path]:
    """The descriptions of pybullet_data that have a link, without its 1,000 random objects."""
    for folder in _packages():
        data = folder / "pybullet_data"
        if data.is_dir():
            found = sorted(data.rglob("*.urdf"))
            found = [path for path in found if "random_urdfs" not in path.parts]
            return [path for path in found if b"<link" in path.read_bytes()]
    return []


def example(name: str) -> Path | None:
    """A robot of example-robot-data by the name of its file."""
    return next((path for path in example_robots() if path.name == name), None)


def examples_and_made(names: Iterable[str], folder: Path) -> Iterator[tuple[str, Path]]:
    """Robots of example-robot-data that are there, and a made one of 100 links in a folder."""
    for name in names:
        path = example(name)
        if path is not None:
            yield name, path
    path = folder / "made.urdf"
    path.write_text(made(100), "utf-8")
    yield "generated, 100 links", path


def options_of(path: Path) -> list[str]:
    """What urdftool is told of where packages are."""
    folder = example_folder()
    return ["--package-path", str(folder.parent)] if folder and folder in path.parents else []


def resolved(path: Path, folder: Path) -> Path:
    """A copy whose package URIs are paths, for those that do not look for packages."""
    text = path.read_text("utf-8", "replace")
    share = example_folder()
    if share is not None:
        text = text.replace("package:///", "package://").replace(
            "package://example-robot-data", str(share)
        )
    target = folder / path.name
    folder.mkdir(parents=True, exist_ok=True)
    target.write_text(text, "utf-8")
    if share is None or share not in path.parents:  # its meshes are beside it
        for item in path.parent.iterdir():
            beside = folder / item.name
            if not beside.exists():
                os.symlink(item, beside)
    return target


def manifest() -> list[dict[str, str]]:
    """The entries of the collection; none where it is not there."""
    try:
        with open(CORPUS / "MANIFEST.tsv", encoding="utf-8") as table:
            return list(csv.DictReader(table, delimiter="\t"))
    except OSError:
        return []


def made(links: int) -> str:
    """A URDF of a base and arms of ten links, each link with inertia, a box and a joint."""
    return f'<robot name="made">\n{"".join(_links(links))}</robot>\n'


def _links(count: int) -> Iterator[str]:
    yield _LINK.format(name="base")
    for number in range(1, count):
        first = (number - 1) % ARM == 0
        parent = "base" if first else f"link_{number - 1}"
        arm = (number - 1) // ARM
        place = f"{SPACE * (arm % 25):g} {SPACE * (arm // 25):g} 0.3"
        yield _LINK.format(name=f"link_{number}")
        yield _JOINT.format(
            name=f"joint_{number}", parent=parent, child=f"link_{number}",
            xyz=place if first else "0 0 0.2", yaw="0",
        )  # fmt: skip


_LINK = """\
  <link name="{name}">
    <inertial>
      <origin xyz="0 0 0.1"/>
      <mass value="1.2"/>
      <inertia ixx="0.00425" ixy="0" ixz="0" iyy="0.00425" iyz="0" izz="0.0005"/>
    </inertial>
    <visual>
      <origin xyz="0 0 0.1"/>
      <geometry><box size="0.05 0.05 0.2"/></geometry>
    </visual>
    <collision>
      <origin xyz="0 0 0.1"/>
      <geometry><box size="0.05 0.05 0.2"/></geometry>
    </collision>
  </link>
"""
_JOINT = """\
  <joint name="{name}" type="revolute">
    <origin xyz="{xyz}" rpy="0.1 0 {yaw}"/>
    <parent link="{parent}"/>
    <child link="{child}"/>
    <axis xyz="0 1 0"/>
    <limit lower="-1.5" upper="1.5" effort="10" velocity="2"/>
    <dynamics damping="0.1" friction="0.1"/>
  </joint>
"""


def made_xacro(links: int) -> str:
    """The same by xacro: a macro a link with properties and expressions, called for each."""
    macro = _LINK.format(name="${name}") + _JOINT.format(
        name="${name}_joint", parent="${parent}", child="${name}", xyz="0 0 ${length}",
        yaw="${turn * pi}",
    )  # fmt: skip
    for plain, expression in (
        ('value="1.2"', 'value="${mass}"'),
        ('ixx="0.00425"', 'ixx="${mass * (width**2 + length**2) / 12}"'),
        ('iyy="0.00425"', 'iyy="${mass * (width**2 + length**2) / 12}"'),
        ('izz="0.0005"', 'izz="${mass * width**2 / 6}"'),
        ('size="0.05 0.05 0.2"', 'size="${width} ${width} ${length}"'),
    ):
        macro = macro.replace(plain, expression)
    calls = []
    for number in range(1, links):
        parent = "base" if (number - 1) % ARM == 0 else f"link_{number - 1}"
        calls.append(f'<xacro:part name="link_{number}" parent="{parent}" turn="{number % 7}"/>\n')
    return (
        '<robot name="made" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '<xacro:property name="width" value="0.05"/>\n<xacro:property name="length" value="0.2"/>\n'
        '<xacro:property name="mass" value="1.2"/>\n'
        f'<xacro:macro name="part" params="name parent turn">\n{macro}</xacro:macro>\n'
        f"{_LINK.format(name='base')}{''.join(calls)}</robot>\n"
    )
