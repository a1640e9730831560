"""Files that readers require next to a description, and that could not be read."""

from __future__ import annotations

from typing import NamedTuple

from ..errors import ConfigError, UrdftoolError
from ..model.elements import Robot
from ..source.location import SourceFile
from ..source.yaml_tree import Node, is_blank, parse_yaml
from ..suggestions import find_nearest

_UNREAD = "unread files"
_PARAMETERS = "ros__parameters"


class UnreadFile(NamedTuple):
    """A file that could not be read.

    Attributes:
        error: Why.
        case: Case of the effects of ``unreadable-configuration`` if a reader rejects the file;
            empty if it may be right, such as one of more than the size limit.
        partly: Whether its content was read all the same, as a tolerant reader does.
    """

    error: UrdftoolError
    case: str = ""
    partly: bool = False


def get_unread_files(robot: Robot) -> dict[str, UnreadFile]:
    """Get the files around a robot that could not be read so far, by path; readers add to it."""
    known: dict[str, UnreadFile] = robot.memo.get(_UNREAD, dict)
    return known


def collect_unread_files(robot: Robot) -> dict[str, str]:
    """Collect why files around a robot could not be read, so that no rule checks them, by path."""
    files: dict[str, UnreadFile] = robot.memo.peek(_UNREAD) or {}
    return {path: file.error.message for path, file in files.items() if not file.partly}


def read_parameters(robot: Robot, file: SourceFile, case: str) -> Node | None:
    """Parse a YAML file, once for all rules.

    Args:
        robot: The robot, to whose unread files it is added if it cannot be parsed.
        file: The file.
        case: Case of ``unreadable-configuration`` if it is not YAML; empty if nothing shows that
            the robot requires the file.

    Returns:
        Its mapping; None if it is empty or cannot be parsed.
    """

    def parse() -> Node | None:
        try:
            root = None if is_blank(file) else parse_yaml(file)
            wrong = None if root is None else _find_misspelled(root)
            if wrong is not None and case:
                get_unread_files(robot)[file.path] = UnreadFile(
                    wrong.make_error(f"'{wrong.key}' is not '{_PARAMETERS}'"), case
                )
            return root
        except ConfigError as error:
            rejected = case if error.rule and not is_template(file) else ""
            get_unread_files(robot)[file.path] = UnreadFile(error, rejected)
            return None

    return robot.memo.get(("parameters", file.path), parse)


def _find_misspelled(root: Node) -> Node | None:
    """Find a mapping of parameters of ROS 2 with a misspelled key, which rcl rejects."""
    for _, node in root.walk():
        for key, inner in (node.fields or {}).items():
            if key.startswith("ros") and inner.fields and find_nearest(key, (_PARAMETERS,), 0.8):
                return inner
    return None


def is_template(file: SourceFile) -> bool:
    """Tell whether a file is a template of Jinja, which becomes YAML when it is loaded."""
    return b"{{" in file.data or b"{%" in file.data
