"""Rules on files that MoveIt and ros2_control read next to a description."""

from __future__ import annotations

import os
from collections.abc import Iterator

from ...model.elements import Robot
from ...source.description import Description
from ...source.location import Place, SourceFile
from ..control.controller_files import get_package
from ..moveit.configuration import read_configuration
from ..rule import ERROR, ROS, WARNING, Problem, rule, select_holding
from ..unread_files import get_unread_files

_EFFECTS = {
    "moveit (an SRDF)": "cannot parse the SRDF, and loads no model of the robot",
    "moveit (an SRDF that TinyXML2 accepts)": "accepts it as text; moveit_configs_utils reads it "
    "through xacro, which rejects it",
    "moveit (parameters of MoveIt)": "moveit_configs_utils raises the error of PyYAML, and nothing "
    "is launched",
    "ros2_control (controllers)": "the node does not start: it cannot parse the parameter file",
}


@rule(ERROR, on=("moveit", *ROS), effects=_EFFECTS)
def unreadable_configuration(
    robot: Robot, description: Description, targets: frozenset[str]
) -> Iterator[Problem]:
    """A file that MoveIt or ros2_control reads with the robot cannot be parsed.

    Such files are the SRDF, the YAML files of a MoveIt configuration next to it, and controller
    files that a plugin of the robot or a launch file names; ROS 2 rejects also a misspelled
    ``ros__parameters`` in these. Nothing in such a file is checked. A file that is a template of
    Jinja is not reported; the summary lists it as not checked. An SRDF that TinyXML2 accepts, such
    as one with ``--`` in a comment, is checked, and a warning.
    """
    is_ros2 = "ros2" in targets
    if "moveit" in targets:
        read_configuration(robot, description)
    if not targets.isdisjoint(ROS):
        get_package(robot, description).controller_files  # noqa: B018 -- reads them
    for path, unread in get_unread_files(robot).items():
        if not unread.case:
            continue
        error = unread.error
        cases = (unread.case,) if is_ros2 or unread.case == "an SRDF" else ()
        yield Problem(
            robot,
            f"{path.replace(os.sep, '/').rpartition('/')[2]} cannot be used: {error.message}",
            at=error.at or Place(SourceFile(path, b""), 0, 0),
            severity=WARNING if unread.partly else None,
            effects=select_holding(_EFFECTS, *cases),
        )
