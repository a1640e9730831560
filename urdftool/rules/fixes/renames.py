"""Another name for a link, a joint or a material: here, in the SRDF, and wherever it is named.

Where another file of the package names it, such as a list of controllers, it keeps its name.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator

from ...finding import Severity
from ...model.elements import Joint, Link, Robot
from ...source.document import Element
from ..moveit.semantic import references, semantics
from ..rule import Problem
from .elsewhere import check_alone
from .proposal import Around, Change, Proposal, put, say, to_write, unsafe

_LINK_AT = {"link": "name", "parent": "link", "child": "link"}
_LETTERS = str.maketrans({"ß": "ss", "æ": "ae", "ø": "o", "ł": "l", "đ": "d", "œ": "oe", "Ø": "O"})


def renamed(around: Around, part: Link | Joint, new: str) -> Proposal | None:
    """Give a link or joint another name; None where that is taken, or the name is worth more.

    Controllers, launch files and programs of other packages name the joints that move, and a
    remark is no reason to break them.

    Raises:
        RefusedError: Another file of the package names it.
    """
    robot, old = around.robot, part.name
    if isinstance(part, Joint) and not part.is_fixed and around.severity is Severity.INFO:
        return None
    if not new or new == old or new in robot.link or new in robot.joint:
        return None
    if old in robot.link and old in robot.joint and robot.extensions.get(old):
        return None  # the link or the joint may be meant
    kind = "link" if isinstance(part, Link) else "joint"
    namings = (links_named if kind == "link" else joints_named)(robot.element, old)
    changes = [say(e, new) if not at else put(e, at, new) for e, at in namings]
    documents = semantics(robot, around.description)
    for document in documents:
        for element, attribute, _ in references(document.root, kind):
            if element.get(attribute) == old:
                changes.append(put(element, attribute, new))
    check_alone(around, old, robots=False, but=[d.file.path for d in documents])
    return unsafe(f"call it '{new}', here and where it is named", *changes)


def links_named(root: Element, name: str) -> Iterator[tuple[Element, str]]:
    """Where a link is named: the element, and the attribute or an empty word for its text."""
    for element in root.walk():
        attribute = _LINK_AT.get(element.tag, "reference" if element.tag == "gazebo" else "")
        if attribute and element.get(attribute) == name:
            yield element, attribute
        elif not attribute and element.text.strip() == name and not element.children:
            if re.search("ame|ink|ody", element.tag):
                yield element, ""


def joints_named(root: Element, name: str) -> Iterator[tuple[Element, str]]:
    """The same of a joint."""
    for element in root.walk():
        attribute = {"joint": "name", "mimic": "joint", "gazebo": "reference"}.get(element.tag, "")
        if attribute and element.get(attribute) == name:
            yield element, attribute
        elif element.text.strip() == name and not element.children:
            if "oint" in element.tag or element.get("name") == "mimic":
                yield element, ""


def _part(problem: Problem) -> Link | Joint | None:
    return problem.subject if isinstance(problem.subject, Link | Joint) else None


def invalid_frame_name(problem: Problem, around: Around) -> Proposal | None:
    """Without slash and blanks; many have a cause elsewhere."""
    if "; write '" not in problem.message:
        return None
    new = problem.message.rpartition("; write '")[2].partition("'")[0]
    return renamed(around, around.link(problem), new)


def link_joint_name_clash(problem: Problem, around: Around) -> Proposal | None:
    """The joint is called ``…_joint``."""
    joint = around.joint(problem)
    return renamed(around, joint, f"{joint.name}_joint")


def reserved_name(problem: Problem, around: Around) -> Proposal | None:
    """Without its underscores; ``world_link`` for a world that is not the root."""
    part = _part(problem)
    if part is None:
        return None
    return renamed(around, part, "world_link" if part.name == "world" else part.name.strip("_"))


def not_portable_identifier(problem: Problem, around: Around) -> Proposal | None:
    """With underscores for what is no letter or digit."""
    part = _part(problem)
    return renamed(around, part, to_write(problem)) if part is not None else None


def name_style(problem: Problem, around: Around) -> Proposal | None:
    """In lower case, with underscores between words."""
    part = _part(problem)
    if part is None or not part.name.isascii():
        return None
    words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])|[^A-Za-z0-9]+", "_", part.name)
    return renamed(around, part, re.sub("_+", "_", words).strip("_").lower())


def non_ascii_name(problem: Problem, around: Around) -> Proposal | None:
    """With the letters that are nearest; other scripts keep theirs."""
    name = problem.name
    plain = "".join(
        letter
        for letter in unicodedata.normalize("NFKD", name.translate(_LETTERS))
        if not unicodedata.combining(letter)
    )
    if not plain.isascii():
        return None
    part = _part(problem)
    if part is None:
        return _material(around.robot, name, plain)
    return renamed(around, part, plain)


def _material(robot: Robot, old: str, new: str) -> Proposal | None:
    found = [e for e in robot.element.walk() if e.tag == "material" and e.get("name") == old]
    if any(e.tag == "material" and e.get("name") == new for e in robot.element.walk()):
        return None
    changes: list[Change] = [put(element, "name", new) for element in found]
    return unsafe(f"call it '{new}', here and where it is named", *changes)
