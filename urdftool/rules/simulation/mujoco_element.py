"""Check the ``<mujoco>`` element of a URDF."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ...model.mujoco_values import BAD_VALUE, list_parents
from ..rule import ERROR, WARNING, Problem, rule
from ..unexpanded import is_unexpanded

APPLIES_TO = ("mujoco",)

_READ = "mujoco (compiler, option, size)"
_UNREAD = "mujoco (visual, statistic)"


@rule(
    ERROR,
    effects={
        _READ: "rejects the robot",
        _UNREAD: "ignores it in a URDF, and rejects an MJCF with it",
    },
)
def bad_mujoco_value(robot: Robot) -> Iterator[Problem]:
    """A value in ``<mujoco>`` is not one that MuJoCo takes there.

    MuJoCo reads ``<compiler>``, ``<option>`` and ``<size>`` of this element of a URDF, and rejects
    the whole robot if a number has another text, or a word is not one that it knows: write a value
    in the unit and with the words of its XML reference. ``export mjcf`` copies them, with
    ``<visual>`` and ``<statistic>``, in which a wrong value is a warning.
    """
    for one in robot.rejected_settings:
        if one.code != BAD_VALUE or is_unexpanded(one.text):
            continue
        is_read = {"visual", "statistic"}.isdisjoint(list_parents(one))
        effect = ", so MuJoCo rejects the robot" if is_read else ", so MuJoCo rejects an MJCF of it"
        yield Problem(
            robot,
            one.fact + effect,
            at=one,
            severity=None if is_read else WARNING,
            effects=(_READ if is_read else _UNREAD,),
        )


@bad_mujoco_value.full
def report_bad_mujoco_values(robot: Robot) -> Iterator[Problem]:
    """Report each value that an MJCF would have, too."""
    for one in robot.rejected_settings:
        if one.code == BAD_VALUE:
            yield Problem(robot, one.fact, at=one)
