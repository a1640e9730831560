"""Small robots, and what is seen of them."""

import math
from pathlib import Path

import numpy as np

from urdftool.drawing.camera import View
from urdftool.drawing.picture import draw
from urdftool.drawing.shapes import read_robot_shapes
from urdftool.model.kinematics import link_poses
from urdftool.model.load import load

MAGENTA = (1.0, 0.0, 1.0)
BOX = '<geometry><box size="{}"/></geometry>'
CUBE = BOX.format("1 1 1")


def visual(shape=CUBE, rgba=None, xyz="0 0 0", material=""):
    if rgba:
        material = f'<material name=""><color rgba="{rgba}"/></material>'
    return f'<visual><origin xyz="{xyz}"/>{shape}{material}</visual>'


def link(name, *inside):
    return f'<link name="{name}">{"".join(inside)}</link>'


def joint(name, parent, child, kind="revolute", rest="", xyz="0 0 0", axis="0 0 1"):
    limit = '<limit lower="-1" upper="2" effort="1" velocity="1"/>' if kind == "revolute" else ""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}"/><axis xyz="{axis}"/>{limit}{rest}</joint>'
    )


def read(folder: Path, *inside):
    path = folder / "r.urdf"
    path.write_text(f'<robot name="r">{"".join(inside)}</robot>', "utf-8")
    return load(path)


def front_view(distance=1000.0, half=1.0, size=(200, 200), side="x"):
    """From far away along an axis; the picture spans ``half`` to each side of the origin."""
    axes = {
        "x": [[0, 1, 0], [0, 0, 1], [1, 0, 0]],
        "z": [[0, 1, 0], [-1, 0, 0], [0, 0, 1]],
    }[side]
    axes = np.array(axes, dtype=float)
    reach = half / distance
    return View(axes, axes[2] * distance, (reach * size[0] / size[1], reach), size)


def seen(robot, view=None, positions=None, show="visual", **more):
    shapes = read_robot_shapes(robot, show=show)
    poses = link_poses(robot, positions or {})
    more = {"ground": False, "background": MAGENTA, **more}
    return draw(shapes, poses, camera=view or front_view(), **more)


def mask(image):
    """Where anything is in front of the magenta."""
    return (image != np.array([255, 0, 255])).any(axis=-1)


def middle(there):
    """Column and row of the middle of what is seen, in pixels."""
    rows, columns = np.nonzero(there)
    return columns.mean() + 0.5, rows.mean() + 0.5


def rad(degrees):
    return math.radians(degrees)
