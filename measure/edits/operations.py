"""Every operation that a robot allows, and the way back."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from urdftool.edit.finish import Edited
from urdftool.model.elements import Robot

MOVING = ("revolute", "continuous", "prismatic")
MOUNT = (0.1, 0.2, 0.3)
"""Position of an attached robot in the last link [m]."""


class Operation(NamedTuple):
    """An operation on a robot.

    Attributes:
        name: Its name in the table.
        make: Makes it.
        back: Makes the opposite operation on the result; None for none.
        argument: Its link, for another tool.
    """

    name: str
    make: Callable[[Robot], Edited]
    back: Callable[[Robot], Edited] | None = None
    argument: str = ""


def list_moving(robot: Robot) -> list[str]:
    """Return the joints with one position."""
    return [joint.name for joint in robot.joints if joint.type in MOVING]


def list_zeros(robot: Robot) -> dict[str, float]:
    """Return the new zero of each joint [rad, m]."""
    moving = list_moving(robot)
    return {name: round(0.1 * (number % 7 + 1), 3) for number, name in enumerate(moving)}


def list_operations(robot: Robot) -> list[Operation]:
    """Return the operations that a robot allows."""
    order, moving, zeros = robot.tree.order, list_moving(robot), list_zeros(robot)
    leaves = [name for name in order if not robot.tree.get_child_joints(name)]
    last = ([name for name in leaves if robot.link[name].mass] or leaves)[-1]
    root, lowest = order[0], leaves[-1]
    found = [
        Operation("prefix", lambda r: r.prefix("p_")),
        Operation("merge-fixed", lambda r: r.merge_fixed()),
        Operation(
            "mirror (`--mesh scale`)",
            lambda r: r.mirror("xz", meshes="scale"),
            lambda r: r.mirror("xz", meshes="scale"),
        ),
        Operation("round (1e-12)", lambda r: r.round_numbers(1e-12)),
        Operation(
            "attach",
            lambda r: r.attach(r, to=order[-1], prefix="g_", xyz=MOUNT),
            lambda r: r.cut(_find_attached(r)),
        ),
    ]
    if moving:
        opposite = {name: -value for name, value in zeros.items()}
        found += [
            Operation("zero", lambda r: r.change_zero(zeros), lambda r: r.change_zero(opposite)),
            Operation(
                "sign",
                lambda r: r.reverse_sign(moving),
                lambda r: r.reverse_sign(moving),
                moving[0],
            ),
        ]
    if len(order) > 1:
        found += [
            Operation("root", lambda r: r.change_root(last), lambda r: r.change_root(root), last),
            Operation("root `--move-frames`", lambda r: r.change_root(last, move_frames=True)),
            Operation("cut", lambda r: r.cut(lowest)),
        ]
    return found


def _find_attached(robot: Robot) -> str:
    """Return the first link of the attached robot."""
    return next(name for name in robot.tree.order if name.startswith("g_"))
