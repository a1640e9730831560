"""Rename a link, joint or material with every reference in the description and its SRDF.

It is refused if another file of the package refers to the old name, such as a list of
controllers.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ..diagnostic import Severity
from ..model.elements import Joint, Link, Robot
from ..model.references import has_block
from ..model.urdf_schema import BLOCKS
from ..source.document import Element
from .fix import Change, FixContext, Proposal, set_attribute, set_text, unsafe
from .rule import Problem

_LINK_AT = {"link": "name", "parent": "link", "child": "link"}


def rename_part(context: FixContext, part: Link | Joint, new: str) -> Proposal | None:
    """Rename a link or joint; None if the new name is taken, or the old one is in wide use.

    Controllers, launch files and programs of other packages refer to moving joints; an info does
    not justify breaking them.

    Raises:
        RefusedError: Another file of the package refers to it.
    """
    robot, old = context.robot, part.name
    if isinstance(part, Joint) and not part.is_fixed and context.severity is Severity.INFO:
        return None
    if not new or new == old or new in robot.link or new in robot.joint:
        return None
    if old in robot.link and old in robot.joint and has_block(robot, old):
        return None  # it is unknown whether the link or the joint is meant
    kind = "link" if isinstance(part, Link) else "joint"
    namings = (find_link_references if kind == "link" else find_joint_references)(
        robot.element, old
    )
    changes = [set_text(e, new) if not at else set_attribute(e, at, new) for e, at in namings]
    from .cross_file_references import check_alone
    from .moveit.semantic import find_references, get_srdf_documents

    documents = get_srdf_documents(robot, context.description)
    for document in documents:
        for element, attribute, _ in find_references(document.root, kind):
            if element.get(attribute) == old:
                changes.append(set_attribute(element, attribute, new))
    check_alone(context, old, robots=False, but=[d.file.path for d in documents])
    return unsafe(f"rename it to '{new}', with all references", *changes)


def find_link_references(root: Element, name: str) -> Iterator[tuple[Element, str]]:
    """Find the references to a link.

    Yields:
        The element, and the attribute; empty for the element's text.
    """
    return ((element, at) for element, at, known in list_link_references(root) if known == name)


def list_link_references(root: Element) -> Iterator[tuple[Element, str, str]]:
    """List what may refer to links.

    Yields:
        The element, the attribute, or an empty text for the element's own text, and the name.
    """
    for element in root.walk():
        attribute = _LINK_AT.get(element.tag, "reference" if element.tag == "gazebo" else "")
        if attribute and element.get(attribute):
            yield element, attribute, element.get(attribute) or ""
        elif not element.children and (text := element.text.strip()):
            if re.search("ame|ink|ody", element.tag):
                yield element, "", text


def find_joint_references(root: Element, name: str) -> Iterator[tuple[Element, str]]:
    """Find the references to a joint, as :func:`find_link_references`."""
    return ((element, at) for element, at, known in list_joint_references(root) if known == name)


def list_joint_references(root: Element) -> Iterator[tuple[Element, str, str]]:
    """List what may refer to joints, as :func:`list_link_references`."""
    for element in root.walk():
        attribute = {"joint": "name", "mimic": "joint", "gazebo": "reference"}.get(element.tag, "")
        if attribute and element.get(attribute):
            yield element, attribute, element.get(attribute) or ""
        elif not element.children and (text := element.text.strip()):
            if "oint" in element.tag or element.get("name") == "mimic":
                yield element, "", text


def list_names_in_blocks(robot: Robot, joint: Joint) -> list[tuple[str, str]]:
    """List what names a joint, or the link that it moves, in blocks for simulators and drives.

    Gazebo lumps the child of a fixed joint into its parent, with the sensors of its own blocks:
    what names the joint or the link elsewhere then names nothing.

    Returns:
        The name, and the tag or attribute that holds it.
    """
    if robot.format != "urdf":
        return []
    found = []
    for block in robot.element.children:
        if block.tag in BLOCKS:
            for element, attribute in find_joint_references(block, joint.name):
                found.append((joint.name, attribute or element.tag))
            for element, attribute in find_link_references(block, joint.child):
                if element is not block:
                    found.append((joint.child, attribute or element.tag))
    return found


def get_part(problem: Problem) -> Link | Joint | None:
    """Get the link or joint that a problem is about; None for anything else."""
    return problem.subject if isinstance(problem.subject, Link | Joint) else None


def rename_material(robot: Robot, old: str, new: str) -> Proposal | None:
    """Rename a material in all places; None if the new name is taken."""
    found = [e for e in robot.element.walk() if e.tag == "material" and e.get("name") == old]
    if any(e.tag == "material" and e.get("name") == new for e in robot.element.walk()):
        return None
    changes: list[Change] = [set_attribute(element, "name", new) for element in found]
    return unsafe(f"rename it to '{new}', with all references", *changes)
