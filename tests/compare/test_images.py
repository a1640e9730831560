"""Comparison of the images of visuals among formats."""

import struct
import zlib

import pytest

import urdftool
from urdftool.compare.compare import compare_robots

MESH = """v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1
vt 0 0\nvt 1 0\nvt 0 1
f 1/1 3/3 2/2\nf 1/1 2/2 4/3\nf 2/1 3/2 4/3\nf 3/1 1/2 4/3
"""
ROBOT = """<robot name="r"><link name="a">
  <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  <visual><geometry><mesh filename="part.obj"/></geometry>
    <material name="painted"><texture filename="image.png"/></material></visual>
  <collision><geometry><mesh filename="part.obj"/></geometry></collision>
</link></robot>
"""


def make_png(color):
    """Return a PNG of 2 × 2 pixels of a color."""

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    rows = b"".join(b"\0" + bytes(color) * 2 for _ in range(2))
    header = struct.pack(">IIBBBBB", 2, 2, 8, 2, 0, 0, 0)
    parts = chunk(b"IHDR", header), chunk(b"IDAT", zlib.compress(rows)), chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


@pytest.fixture
def painted(write):
    """Return the path of a robot with an image."""
    write("part.obj", MESH)
    write("image.png", make_png((255, 0, 0)))
    return write("r.urdf", ROBOT)


def compare_textures(one, other):
    comparison = compare_robots(urdftool.load(one), urdftool.load(other))
    return [(d.what, d.values) for d in comparison.differences if d.row == "textures"]


@pytest.mark.usefixtures("stages_are_read_here")
@pytest.mark.parametrize(
    "kind",
    [
        "sdf",
        pytest.param("mjcf", marks=pytest.mark.library("mujoco")),
        pytest.param("usd", marks=pytest.mark.library("pxr")),
    ],
)
def test_an_image_is_compared_in_every_format(painted, write, tmp_path, kind):
    made = getattr(urdftool, f"export_{kind}")(
        urdftool.load(painted), tmp_path / "made", verify=True
    )
    rows = {check.name: check for check in made.checks}
    assert rows["textures"].verdict == "equal"
    path = next(p for p in (tmp_path / "made").rglob("*") if p.suffix in (".sdf", ".xml", ".usda"))
    assert compare_textures(painted, path) == []
    write("image.png", make_png((0, 255, 0)))
    assert [what for what, _ in compare_textures(painted, path)] == ["image of a visual"]


def test_images_that_do_not_exist_are_compared_by_name(write):
    write("part.obj", MESH)
    one = write("one.urdf", ROBOT)
    other = write("other.urdf", ROBOT.replace("image.png", "picture.png"))
    assert compare_textures(one, one) == []
    assert compare_textures(one, other) == [("image of a visual", ("image.png", "picture.png"))]
