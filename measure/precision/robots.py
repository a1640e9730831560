"""Which descriptions of the collections are robots, and not inputs of a parser's tests or objects.

A robot has a joint that moves, and is not in a folder of tests or of lessons. Findings of other
files say how true lint is; whether somebody would act on them cannot be judged: the numbers of a
test of a parser are made up, and the third step of a tutorial lacks what the fourth adds.
"""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from urdftool.errors import UrdftoolError
from urdftool.model.kinematics import MOVABLE
from urdftool.model.load import load

TESTS = re.compile(r"(.*_)?tests?")
"""Folders of tests: ``test``, ``tests``, ``gz_ros2_control_tests``, ``urdf_parser_test``."""

LESSONS = frozenset(("ros__urdf_tutorial",))
"""Folders of the corpus whose files are steps of a lesson."""

_MOVES = re.compile(rb"<joint\b[^>]*\btype\s*=\s*[\"'](?:revolute|continuous|prismatic)[\"']")


def is_robot(name: str, path: str) -> bool:
    """Tell whether a description is a robot.

    Args:
        name: Its name, which starts with the collection.
        path: Where it is. A file that cannot be read as a robot counts by its text.
    """
    if is_test_or_lesson(name):
        return False
    try:
        return any(joint.type in MOVABLE for joint in load(path).joints)
    except UrdftoolError:
        with open(path, "rb") as file:
            return _MOVES.search(file.read()) is not None


def is_test_or_lesson(name: str) -> bool:
    """Tell whether a description is in a folder of tests or of lessons, by its name."""
    folders = PurePosixPath(name).parts[1:-1]
    return any(folder in LESSONS or TESTS.fullmatch(folder) for folder in folders)
