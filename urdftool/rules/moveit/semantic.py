"""Rules on the SRDF of a description."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from ...errors import SourceError, XmlError
from ...model.elements import Robot
from ...model.semantic import read_semantic
from ...source.description import Description
from ...source.document import Document, Element, parse, read_file
from ...source.location import SourceFile
from ...source.packages import shorten_path
from ...source.tinyxml2 import parse_as_tinyxml2
from ...workspace import Workspace
from ..fix import (
    FixContext,
    Proposal,
    append_child,
    escape_attribute,
    safe,
    set_attribute,
    unsafe,
    write_suggestion,
)
from ..rule import ERROR, INFO, SAFE, UNSAFE, WARNING, Problem, rule
from ..unread_files import UnreadFile, get_unread_files
from ..words import find_nearest, find_nearest_joint, suggest_joint, suggest_name

_ON = ("moveit",)


def get_srdf_documents(robot: Robot, description: Description) -> list[Document]:
    """Get the SRDF files next to a description that match its file name or robot name."""
    return robot.memo.get("SRDF files", lambda: list(_read(robot, description)))


def _read(robot: Robot, description: Description) -> Iterator[Document]:
    if description.path == "-":
        return
    path = Path(description.path)
    stem = path.name.split(".")[0]
    workspace = description.workspace
    files = workspace.list_matches(path.parent, "*.srdf")
    named = [file for file in files if file.name.split(".")[0] == stem]
    if not named:
        # an SRDF with the name of a description belongs to that description
        described = workspace.list_matches(path.parent, "*.urdf*")
        others = {other.name.split(".")[0] for other in described}
        files = [file for file in files if file.name.split(".")[0] not in others]
    for file in named or files:
        document = _read_srdf(file, robot, workspace, is_named=bool(named))
        if document is None or not (named or document.root.get("name") == robot.name):
            continue
        if named or not _is_of_another(document, robot, path, workspace):
            yield document


def _read_srdf(
    path: Path, robot: Robot, workspace: Workspace, *, is_named: bool
) -> Document | None:
    """Parse an SRDF file as srdfdom does, which has TinyXML2; None if it rejects the file.

    A defect is added to the unread files, if the file is of this robot by its name, or by the name
    of the robot in it.
    """
    shown = shorten_path(path)
    document: Document | None = None
    defect: SourceError | None = None
    is_of_robot = is_named
    try:
        file = read_file(shown, workspace)
        is_of_robot = is_named or _has_name_of_robot(file, robot)
        document, defect, _ = parse_as_tinyxml2(file)
        if document.root.tag != "robot":
            message = f"the root element is <{document.root.tag}>, not <robot>"
            defect = XmlError(message, at=document.root.place)
            document = None
    except SourceError as error:
        defect = error
    if defect is not None and is_of_robot:
        case = "an SRDF" if document is None else "an SRDF that TinyXML2 accepts"
        get_unread_files(robot)[shown] = UnreadFile(defect, case, document is not None)
    return document


def _has_name_of_robot(file: SourceFile, robot: Robot) -> bool:
    """Tell whether an element of a file, which may not be XML, has the name of a robot."""
    name = re.escape(robot.name.encode())
    return re.search(rb"<\w+[^<>]*\sname\s*=\s*[\"']" + name + rb"[\"']", file.data) is not None


def _is_of_another(document: Document, robot: Robot, path: Path, workspace: Workspace) -> bool:
    """Tell whether a URDF of the same name next to a description has all links of an SRDF."""
    names = {
        element.get(attribute) or ""
        for element, attribute, _ in find_references(document.root, "link")
    }
    if names <= robot.link.keys():
        return False
    for file in workspace.list_matches(path.parent, "*.urdf"):
        other = None if file.name == path.name else _parse(file, workspace)
        if other is not None and other.root.get("name") == robot.name:
            links = {link.get("name") or "" for link in other.root.list_children("link")}
            if names <= links:
                return True
    return False


def get_documents_of_folder(robot: Robot, description: Description) -> list[Document]:
    """Get the SRDF files in a folder ``srdf`` next to that of a description, with the robot's name.

    They say which contacts are meant; they may be for another description of the robot, so no rule
    checks them.
    """
    if description.path == "-":
        return []
    folder = Path(description.path).absolute().parent.parent / "srdf"
    return [
        document
        for file in description.workspace.list_matches(folder, "*.srdf")
        if (document := _parse(file, description.workspace)) is not None
        and document.root.get("name") == robot.name
    ]


def has_srdf(robot: Robot, description: Description) -> bool:
    """Tell whether a robot has an SRDF, which may be one that cannot be read."""
    documents = get_srdf_documents(robot, description)
    return bool(documents) or any(path.endswith(".srdf") for path in get_unread_files(robot))


def _parse(file: Path, workspace: Workspace) -> Document | None:
    """Parse an SRDF file; None if it is none."""
    try:
        document = parse(read_file(shorten_path(file), workspace))
    except SourceError:
        return None
    return document if document.root.tag == "robot" else None


def find_references(root: Element, kind: str) -> Iterator[tuple[Element, str, bool]]:
    """Yield the references to links or joints: element, attribute, and whether it is essential."""
    links = {
        "chain": ("base_link", "tip_link"),
        "end_effector": ("parent_link",),
        "virtual_joint": ("child_link",),
        "disable_collisions": ("link1", "link2"),
        "enable_collisions": ("link1", "link2"),
        "disable_default_collisions": ("link",),
        "link_sphere_approximation": ("link",),
    }
    for element in root.walk():
        inside = element.parent.tag if element.parent is not None else ""
        if kind == "link":
            for name in links.get(element.tag, ()):
                yield element, name, "collisions" not in element.tag
            if element.tag == "link" and inside == "group":
                yield element, "name", True
        elif element.tag == "joint_property":
            yield element, "joint_name", True
        elif element.tag in ("joint", "passive_joint") and inside in (
            "group",
            "group_state",
            "robot",
        ):
            yield element, "name", True


@rule(
    ERROR,
    on=_ON,
    effects={
        "moveit": "logs an error, and ignores that part",
    },
)
def srdf_unknown_link(robot: Robot, description: Description) -> Iterator[Problem]:
    """The SRDF refers to a link that does not exist in the robot.

    MoveIt ignores the chain, the end effector, the virtual joint, or the ``<link>`` of a group; the
    rest of the group stays. For a pair with disabled collision it is a warning.
    """
    reported: set[str] = set()
    for document in get_srdf_documents(robot, description):
        for element, attribute, essential in find_references(document.root, "link"):
            name = element.get(attribute)
            if name and name not in robot.link and (essential or name not in reported):
                reported.add(name)
                yield Problem(
                    element,
                    f"<{element.tag}> refers to link '{name}', which the robot does not have"
                    + suggest_name(name, robot.link),
                    at=element.locate_attribute(attribute),
                    severity=None if essential else WARNING,
                    data={"suggestion": find_nearest(name, robot.link)},
                )


@rule(
    ERROR,
    on=_ON,
    effects={
        "moveit": "logs an error, and ignores that part",
    },
)
def srdf_unknown_joint(robot: Robot, description: Description) -> Iterator[Problem]:
    """The SRDF refers to a joint that does not exist in the robot.

    Its group does not contain the joint, and MoveIt cannot reach a named pose with it.
    """
    for document in get_srdf_documents(robot, description):
        virtual = {joint.get("name") for joint in document.root.list_children("virtual_joint")}
        for element, attribute, _ in find_references(document.root, "joint"):
            name = element.get(attribute)
            if name and name not in robot.joint and name not in virtual:
                yield Problem(
                    element,
                    f"<{element.tag}> refers to joint '{name}', which the robot does not have"
                    + suggest_joint(robot, name),
                    at=element.locate_attribute(attribute),
                    data={"suggestion": find_nearest_joint(robot, name)},
                )


srdf_unknown_link.fix(UNSAFE)(write_suggestion)
srdf_unknown_joint.fix(UNSAFE)(write_suggestion)


@rule(
    WARNING,
    on=_ON,
    effects={
        "moveit": "logs that the SRDF is for a different robot, and continues",
    },
)
def srdf_robot_name(robot: Robot, description: Description) -> Iterator[Problem]:
    """The SRDF is for a robot with a different name.

    MoveIt reports at every start that the semantic description is not for the same robot, and uses
    it anyway. Either one of the names was not updated, or the file belongs to a different robot.
    """
    for document in get_srdf_documents(robot, description):
        name = document.root.get("name") or ""
        if name != robot.name:
            yield Problem(
                document.root,
                f"SRDF is for robot '{name}', but the robot is '{robot.name}'; write the same name",
                at=document.root.locate_attribute("name"),
            )


@srdf_robot_name.fix(SAFE)
def write_robot_name(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the name of the robot."""
    name = context.robot.name
    return safe(f"write '{name}'", set_attribute(problem.element, "name", name)) if name else None


@rule(
    WARNING,
    on=_ON,
    effects={
        "moveit": "takes the joints up to the link where both branches meet and the joint above; "
        "KDL solves no group of two branches",
    },
)
def chain_not_connected(robot: Robot, description: Description) -> Iterator[Problem]:
    """The tip link of a chain is not a descendant of its base link.

    A chain for inverse kinematics leads down the kinematic tree, from the base link to the tip
    link. MoveIt accepts another one: its group has the joints from both links up to the link where
    they meet, and the joint above that link. Its KDL solver rejects a group of two branches.
    """
    for document in get_srdf_documents(robot, description):
        for element in document.root.walk():
            base, tip = element.get("base_link"), element.get("tip_link")
            if element.tag != "chain" or base not in robot.link or tip not in robot.link:
                continue
            if base != tip and base not in set(robot.tree.list_ancestors(tip or "")):
                yield Problem(
                    element,
                    f"tip link '{tip}' is not a descendant of base link '{base}', so the "
                    "group has joints of another branch or above the base link",
                )


@rule(
    WARNING,
    on=_ON,
    effects={
        "moveit": "keeps the pose as written; planning to it fails",
    },
)
def group_state_out_of_bounds(robot: Robot, description: Description) -> Iterator[Problem]:
    """A named pose has a joint position outside the joint limits.

    MoveIt cannot plan to this pose.
    """
    for document in get_srdf_documents(robot, description):
        for state in read_semantic(document.root).states:
            for part in state.joints:
                element, value = part.element, part.value
                joint = robot.joint.get(part.name)
                if joint is None or value is None or not joint.is_limited or joint.limit is None:
                    continue
                low, high = joint.limit.lower or 0.0, joint.limit.upper or 0.0
                if low <= high and not low - 1e-4 <= value <= high + 1e-4:
                    yield Problem(
                        element,
                        f"joint '{joint.name}' is {value:g} in pose "
                        f"'{state.name}', outside "
                        f"its limits {low:g} to {high:g}",
                        at=element.locate_attribute("value"),
                        data={"nearest": min(max(value, low), high)},
                    )


@group_state_out_of_bounds.fix(UNSAFE)
def clamp_to_limits(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the nearest position inside the limits."""
    nearest_inside = f"{problem.data['nearest']:.12g}"
    change = set_attribute(problem.element, "value", nearest_inside)
    return unsafe(f"write {nearest_inside}", change)


@rule(INFO, default=False, on=_ON, effects={"moveit": "assumes a fixed joint to the world"})
def missing_virtual_joint(robot: Robot, description: Description) -> Iterator[Problem]:
    """The SRDF has no ``<virtual_joint>``.

    A ``<virtual_joint>`` of type ``fixed``, ``planar`` or ``floating`` connects the root to the
    world frame. MoveIt assumes a fixed one.
    """
    for document in get_srdf_documents(robot, description):
        root = robot.tree.root
        if (
            root is not None
            and root.name != "world"
            and document.root.find_child("virtual_joint") is None
        ):
            yield Problem(
                document.root,
                "SRDF has no <virtual_joint>; write one of type fixed, planar or floating for "
                f"'{root.name}'",
            )


@missing_virtual_joint.fix(UNSAFE)
def add_fixed_virtual_joint(problem: Problem, context: FixContext) -> Proposal | None:
    """Add a fixed virtual joint, which MoveIt assumes."""
    root = context.robot.tree.root
    if root is None or "world_joint" in context.robot.joint:
        return None
    line = (
        '<virtual_joint name="world_joint" type="fixed" parent_frame="world" '
        f'child_link="{escape_attribute(root.name)}"/>'
    )
    return unsafe("add a fixed one", append_child(problem.element, line))


@rule(
    ERROR,
    on=_ON,
    effects={
        "moveit": "drops an end effector of an unknown group; reports a group that is its own "
        "parent",
    },
)
def end_effector_group(robot: Robot, description: Description) -> Iterator[Problem]:
    """The group of an end effector does not exist, or contains its parent link.

    The end effector must have its own group, and its parent link must be outside this group.
    """
    for document in get_srdf_documents(robot, description):
        groups = {group.get("name"): group for group in document.root.list_children("group")}
        for element in document.root.list_children("end_effector"):
            name, parent = element.get("group"), element.get("parent_link")
            if name not in groups:
                known = [group for group in groups if group]
                yield Problem(
                    element,
                    f"end effector '{element.get('name') or ''}' has group '{name or ''}', which "
                    f"does not exist{suggest_name(name or '', known)}",
                    at=element.locate_attribute("group"),
                )
            elif any(link.get("name") == parent for link in groups[name].list_children("link")):
                yield Problem(
                    element,
                    f"end effector '{element.get('name') or ''}' has parent link '{parent}', "
                    "which is "
                    "in its own group",
                    at=element.locate_attribute("parent_link"),
                )
