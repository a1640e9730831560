"""Rules on the XML document as a whole."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...finding import Finding
from ...model.elements import Joint, Link, Robot
from ...model.load import OLD_SDF, is_old_sdf
from ...source.comments import list_comments
from ...source.description import Description
from ...source.document import Element
from ..cross_file_references import find_including_file
from ..fix import FixContext, Proposal, Span, safe, set_attribute, unsafe
from ..rule import ERROR, SAFE, UNSAFE, WARNING, Problem, rule, select_holding

_READERS = "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake"


@rule(
    ERROR,
    effects={
        "xacro": "rejects the file, as all XML parsers of Python do",
        f"{_READERS} ('--' in a comment)": "accept it",
        f"{_READERS} (a wrong declaration)": "ignore the declaration",
        f"{_READERS} (an element that is not closed)": "reject the file",
    },
)
def not_well_formed() -> tuple[Problem, ...]:
    """The file is not well-formed XML.

    Examples are an element that is not closed, ``--`` in a comment, or an unknown entity. C++
    readers have tolerant parsers and accept some of them, so the file may load in RViz but fail in
    xacro and Python tools.
    """
    return ()


@not_well_formed.fix(SAFE, of_file=True, reveals=True)
def separate_hyphens(finding: Finding, context: FixContext) -> Proposal | None:
    """Write ``- -`` for ``--`` in all comments."""
    if finding.data.get("case") != "'--' in a comment":
        return None
    file = finding.location.file
    spans = []
    for begin, end in list_comments(file.data):
        inner = file.data[begin + 4 : end - 3]
        new = re.sub(rb"-(?=-)", b"- ", inner)
        new = new + b" " if new.endswith(b"-") else new
        if new != inner:
            spans.append(Span(file, begin + 4, end - 3, new))
    return safe("write '- -' in comments", *spans) if spans else None


@rule(
    ERROR,
    effects={
        "xacro": "rejects the file, as all XML parsers of Python do",
        f"{_READERS} (blanks)": "accept it",
        "urdfdom (a comment)": "3 (ROS 1, ROS 2 up to Iron) accepts it; 4 and later reject it",
        "gz, gazebo-classic, mujoco, pybullet, drake (a comment)": "reject the file",
        f"{_READERS} (other text)": "reject the file",
    },
)
def content_before_declaration() -> tuple[Problem, ...]:
    """Content is before the ``<?xml …?>`` declaration.

    Usually it is a license comment or an empty line. The declaration must be at the start of the
    file. C++ readers accept spaces before it; xacro and Python do not. With a comment before it, a
    robot may load in ROS 1 but not in ROS 2.
    """
    return ()


_ROOT_REMEDIES = {
    "sdf": "check SDF files with 'gz sdf --check'",
    "mujoco": "check MJCF files with the MuJoCo compiler",
    "launch": "a launch file is not a robot description",
    "package": "a package manifest is not a robot description",
    "gazebo": "write it inside a <robot>",
}


@content_before_declaration.fix(SAFE, of_file=True, reveals=True)
def move_declaration(finding: Finding, context: FixContext) -> Proposal | None:
    """Move the declaration to the start of the file."""
    file = finding.location.file
    match = re.search(rb"<\?xml[^>]*?\?>", file.data)
    if match is None or file.data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return None
    begin = 3 if file.data.startswith(b"\xef\xbb\xbf") else 0
    before = file.data[begin : match.start()]
    if not before.strip():
        return safe("remove the content before it", Span(file, begin, match.start(), b""))
    rest = re.match(rb"[ \t]*\r?\n", file.data[match.end() :])
    end = match.end() + (rest.end() if rest else 0)
    line_end = b"\r\n" if b"\r\n" in file.data else b"\n"
    if not file.data[: match.start()].endswith(b"\n"):
        end = match.end()
    return safe(
        "move it to the start of the file",
        Span(file, begin, begin, match[0] + line_end),
        Span(file, match.start(), end, b""),
    )


@rule(
    ERROR,
    effects={
        "urdfdom": "rejects the file: no 'robot' element",
    },
)
def wrong_root() -> tuple[Problem, ...]:
    """The root element is not ``<robot>``.

    Readers require ``<robot>``, so nothing else in the file is checked. Usually an SDF, MJCF or
    launch file has the wrong file extension.
    """
    return ()


@rule(
    ERROR,
    formats=("sdf", "mjcf"),
    evidence="the reader of the format rejects the file, with its message",
)
def unreadable_model() -> tuple[Problem, ...]:
    """An SDF or MJCF file cannot be read as a robot.

    Examples are two links of the same name, a joint without its child, or a model that MuJoCo does
    not compile. Nothing else in the file is checked.
    """
    return ()


def describe_root(root: Element) -> str:
    """Describe a root that is not ``<robot>``, and the probable format of the file."""
    belongs = _ROOT_REMEDIES.get(root.tag, 'a robot description starts with <robot name="…">')
    return f"the root element is <{root.tag}>; {OLD_SDF if is_old_sdf(root) else belongs}"


_NAME_EFFECTS = {
    "urdfdom, gz, gazebo-classic, pybullet, pinocchio, drake (a robot, no attribute)": "reject it",
    "gz, gazebo-classic (a robot, empty)": "reject it",
    "drake (a robot, empty)": "crashes",
    "urdfdom, pybullet, pinocchio, mujoco (a robot, empty)": "accept it",
    "urdfdom, gz, gazebo-classic, pybullet, pinocchio, drake (a link)": "reject the robot",
    "urdfdom, gz, gazebo-classic, pybullet, pinocchio, drake (a joint, no attribute)": (
        "reject the robot"
    ),
    "mujoco (a robot, no attribute)": "accepts it",
    "mujoco (a joint, no attribute)": "rejects the file",
    "pinocchio (a joint, empty)": "accepts it",
    "pybullet (a joint, empty)": "crashes",
}


@rule(
    WARNING,
    effects=_NAME_EFFECTS,
    pedantic="transmissions with an attribute type, as in PR2 and Drake, where no reader "
    "requires the name",
)
def missing_name(description: Description) -> Iterator[Problem]:
    """A robot, link, joint or transmission has no name.

    Other elements refer to links and joints by name. urdfdom rejects a robot with such a link, and
    SDFormat one whose own name is empty. A ``<robot>`` without elements needs no name, and
    neither does one that another file includes.
    """
    root = description.document.root
    named = ("link", "joint", "transmission")
    elements = [child for child in root.children if child.tag in named]
    if root.children and not _is_part(description):
        elements.insert(0, root)
    for element in elements:
        if element.tag in ("robot", *named) and not (element.get("name") or "").strip():
            at = element.locate_attribute("name") if "name" in element.attributes else None
            severity = WARNING if element.tag == "transmission" else ERROR
            blank = "blank" if element.get("name") else "empty"
            case = (f"a {element.tag}", "no attribute" if at is None else blank)
            yield Problem(
                element,
                _describe_missing_name(element),
                at=at,
                severity=severity,
                effects=select_holding(_NAME_EFFECTS, *case),
                pedantic=element.tag == "transmission" and "type" in element.attributes,
            )


def _is_part(description: Description) -> bool:
    """Tell whether a xacro file without the name of a robot is a part of another."""
    if description.expansion is None or description.document.root.get("name"):
        return False
    return bool(find_including_file(description))


@missing_name.full
def report_missing_names(robot: Robot) -> Iterator[Problem]:
    """Report each link and joint of the robot without a name."""
    parts: tuple[Link | Joint, ...] = (*robot.links, *robot.joints)
    for part in parts:
        if not part.name:
            yield Problem(part, _describe_missing_name(part.element))


def _describe_missing_name(element: Element) -> str:
    how = "an empty name" if "name" in element.attributes else "no name"
    return f'<{element.tag}> has {how}; write name="…"'


@missing_name.fix(UNSAFE)
def name_after_file(problem: Problem, context: FixContext) -> Proposal | None:
    """Use the file name as the name of the robot."""
    element = problem.element
    stem = re.sub(r"\W+", "_", context.description.files[0].path.rpartition("/")[2].split(".")[0])
    if element.tag != "robot" or not stem.strip("_") or element.attributes.get("name", "").strip():
        return None
    return unsafe(f'write name="{stem}", as its file', set_attribute(element, "name", stem))
