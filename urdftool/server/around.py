"""Files around robots, SRDF and YAML, whose names are those of links and joints."""

from __future__ import annotations

import os
import re
from typing import cast

from ..edit.around import add_files_around
from ..edit.draft import Draft
from ..edit.semantic_files import SEMANTIC
from ..errors import UrdftoolError
from ..model.elements import Robot
from ..source.description import Description
from ..source.document import Element
from ..source.location import SourceFile
from ..source.yaml_tree import list_scalars
from .knowledge import MOST_ROBOTS, Knowledge, make_path
from .words import Word, WordTable

YAML = (".yaml", ".yml")
_ROBOT = re.compile(rb"""<robot\b[^>]*?\bname\s*=\s*["']([\w.-]+)""")
_PART = re.compile(r"[^/\s]+")

Read = tuple[Description, Robot]


def is_around(path: str) -> bool:
    """Tell whether a file is one that belongs to a robot without being a part of it."""
    return path.endswith((*SEMANTIC, *YAML))


def get_table(knowledge: Knowledge, path: str) -> WordTable | None:
    """Return the names in a file of XML or YAML; None if it cannot be read."""
    if not path.endswith(YAML):
        return knowledge.get_words(path)
    key = "yaml", make_path(path)
    if key not in knowledge.memo:
        try:
            knowledge.memo[key] = YamlWords(knowledge.read(path))
        except UrdftoolError:
            knowledge.memo[key] = None
    return cast("WordTable | None", knowledge.memo[key])


def list_files_around(knowledge: Knowledge, description: Description, robot: Robot) -> list[str]:
    """Return the resolved paths of the SRDF and YAML files of a robot."""
    key = "around", id(description)
    if key not in knowledge.memo:
        draft = Draft(file=description.files[0], robot=robot)
        try:
            add_files_around(draft)
        except UrdftoolError:
            draft.around = []
        paths = [make_path(one.file.path) for one in draft.around]
        knowledge.memo[key] = paths, description  # keeps the id in use
    return cast("list[str]", knowledge.memo[key][0])


def list_robots_around(knowledge: Knowledge, path: str) -> list[Read]:
    """Return the robots to which an SRDF or YAML file belongs, with each set of arguments.

    Read are at most ``MOST_ROBOTS`` of the workspace: first those whose file has the robot name of
    the SRDF, then the nearest in its folders.
    """
    key, real = ("robots", make_path(path)), make_path(path)
    if key not in knowledge.memo:
        found = _ROBOT.search(knowledge.read(real).data)
        name = found[1] if found else b""
        robots = sorted(
            knowledge.get_repository(real).robots,
            key=lambda one: (name not in knowledge.read(one).data, *_rank(one, real)),
        )
        knowledge.memo[key] = [
            pair
            for robot in robots[:MOST_ROBOTS]
            for pair in knowledge.read_descriptions(robot)
            if make_path(pair[0].path) == robot and pair[1].format == "urdf"
            if real in list_files_around(knowledge, *pair)
        ]
    return cast("list[Read]", knowledge.memo[key])


def _rank(robot: str, path: str) -> tuple[int, str]:
    """Return the number of folders between two files as the key of an order."""
    common = os.path.commonpath((os.path.dirname(robot), os.path.dirname(path)))
    folders = (os.path.relpath(one, common).count(os.sep) for one in (robot, path))
    return sum(folders), robot


class YamlWords(WordTable):
    """Names in a YAML file: each part of its keys and values that may be a link or joint."""

    def __init__(self, file: SourceFile) -> None:
        """Find the names.

        Raises:
            ConfigError: It is not valid YAML.
        """
        self._references = {}
        self._definitions = {}
        self.words = []
        for node in list_scalars(file):
            element = Element("", {}, None, file, node.start)
            first = node.start + node.quoted
            text = file.data[first : node.end - node.quoted].decode("utf-8", "replace")
            for match in _PART.finditer(text):
                start = first + len(text[: match.start()].encode("utf-8"))
                end = start + len(match[0].encode("utf-8"))
                self.words.append(Word("part", match[0], start, end, element))
