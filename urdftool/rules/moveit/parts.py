"""Rules on parts of an SRDF that MoveIt drops."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ...model.semantic import read_semantic
from ...model.semantic_groups import list_joints_of_group
from ...model.srdf_schema import ROOT, VIRTUAL_TYPES, SrdfElement
from ...source.description import Description
from ...source.document import Element
from ..fix import write_suggestion
from ..rule import ERROR, UNSAFE, WARNING, Problem, rule
from ..words import find_nearest, join_some, suggest_name
from .semantic import get_srdf_documents

_ON = ("moveit",)


@rule(
    ERROR,
    on=_ON,
    effects={
        "moveit (a group state)": "logs an error, and drops the state",
        "moveit (a subgroup)": "logs an error, and drops the group that contains it",
        "moveit (a parent group)": "logs an error, and takes another group with the parent link",
    },
)
def srdf_unknown_group(robot: Robot, description: Description) -> Iterator[Problem]:
    """The SRDF refers to a group that does not exist.

    MoveIt drops a named pose of such a group, and a group with such a subgroup. For the parent
    group of an end effector it takes another one, which is a warning.
    """
    for document in get_srdf_documents(robot, description):
        groups = [group.get("name") or "" for group in document.root.list_children("group")]
        for element, attribute, case in _find_group_references(document.root):
            name = element.get(attribute)
            if name and name not in groups:
                yield Problem(
                    element,
                    f"<{element.tag}> refers to group '{name}', which the SRDF does not have"
                    + suggest_name(name, groups),
                    at=element.locate_attribute(attribute),
                    severity=WARNING if attribute == "parent_group" else None,
                    effects=(f"moveit ({case})",),
                    data={"suggestion": find_nearest(name, groups)},
                )


srdf_unknown_group.fix(UNSAFE)(write_suggestion)


def _find_group_references(root: Element) -> Iterator[tuple[Element, str, str]]:
    """Yield each reference to a group: the element, its attribute, and the case of its effects."""
    for state in root.list_children("group_state"):
        yield state, "group", "a group state"
    for group in root.list_children("group"):
        for inner in group.list_children("group"):
            yield inner, "name", "a subgroup"
    for tool in root.list_children("end_effector"):
        yield tool, "parent_group", "a parent group"


@rule(
    ERROR,
    on=_ON,
    effects={
        "moveit (a missing attribute)": "logs an error, and ignores the element",
        "moveit (an unknown word)": "does not read it",
        "moveit (an empty group)": "logs a warning, and adds no such group",
        "moveit (a second group)": "logs a warning, and does not add the second group",
        "moveit (an unknown type)": "logs an error, and takes a fixed joint",
        "moveit (below the root)": "logs a warning, and skips the virtual joint",
    },
)
def srdf_part_not_read(robot: Robot, description: Description) -> Iterator[Problem]:
    """MoveIt does not read an element or attribute of the SRDF.

    An element lacks a required attribute, a group is empty or has the name of another one, a
    virtual joint has an unknown type or moves a link that is not the root, or a word is written
    wrong: elements and attributes that are not in SRDF are ignored silently, such
    as ``<disable_collision>`` for ``<disable_collisions>``. Words that are not similar to those of
    SRDF are not reported, since other readers have elements of their own.
    """
    for document in get_srdf_documents(robot, description):
        yield from _check_element(document.root, ROOT)
        yield from _check_virtual_joints(document.root, robot)
        known: set[str] = set()
        for group in document.root.list_children("group"):
            name = group.get("name") or ""
            if name and name in known:
                yield Problem(
                    group,
                    f"a group named '{name}' exists already; MoveIt does not add the second one",
                    effects=("moveit (a second group)",),
                )
            elif name and not group.children:
                yield Problem(
                    group,
                    f"group '{name}' is empty; write a chain, or links or joints",
                    severity=WARNING,
                    effects=("moveit (an empty group)",),
                )
            known.add(name)


def _check_virtual_joints(root: Element, robot: Robot) -> Iterator[Problem]:
    for joint in root.list_children("virtual_joint"):
        kind, child, top = joint.get("type"), joint.get("child_link"), robot.tree.root
        if kind is not None and kind.strip().lower() not in VIRTUAL_TYPES:
            yield Problem(
                joint,
                f"virtual joint '{joint.get('name') or ''}' has type '{kind}'; write fixed, planar "
                "or floating",
                at=joint.locate_attribute("type"),
                effects=("moveit (an unknown type)",),
            )
        elif (
            kind is not None
            and kind.strip().lower() != "fixed"
            and child in robot.link
            and top is not None
            and child != top.name
        ):
            yield Problem(
                joint,
                f"virtual joint '{joint.get('name') or ''}' moves link '{child}', but the root is "
                f"'{top.name}'",
                at=joint.locate_attribute("child_link"),
                severity=WARNING,
                effects=("moveit (below the root)",),
            )


def _check_element(element: Element, kind: SrdfElement) -> Iterator[Problem]:
    known = (*kind.required, *kind.optional)
    strange = [name for name in element.attributes if name not in known and ":" not in name]
    missing = [name for name in kind.required if name not in element.attributes]
    if missing:
        named = f"; {join_some(strange, 'attributes', 3)} is not in SRDF" if strange else ""
        yield Problem(
            element,
            f"<{element.tag}> has no {' and no '.join(missing)}{named}",
            effects=("moveit (a missing attribute)",),
        )
    for name in () if missing else strange:
        near = find_nearest(name, [one for one in known if one not in element.attributes])
        if near:
            yield Problem(
                element,
                f"<{element.tag}> has no attribute '{name}' in SRDF; did you mean '{near}'?",
                at=element.locate_attribute(name),
                severity=WARNING,
                effects=("moveit (an unknown word)",),
            )
    for child in element.children:
        inner = kind.children.get(child.tag)
        if inner is not None:
            yield from _check_element(child, inner)
            continue
        near = find_nearest(child.tag, kind.children)
        is_misplaced = kind is not ROOT and child.tag in ROOT.children
        if ":" not in child.tag and (near or is_misplaced):
            remedy = "write it in <robot>" if is_misplaced else f"did you mean <{near}>?"
            yield Problem(
                child,
                f"<{child.tag}> is not read in <{element.tag}> of an SRDF; {remedy}",
                effects=("moveit (an unknown word)",),
            )


@rule(
    ERROR,
    on=_ON,
    effects={
        "moveit (no number)": "takes 0",
        "moveit (several values)": "logs an error, and leaves the joint out of the pose",
        "moveit (a joint outside)": "logs an error, and leaves the joint out of the pose",
    },
)
def group_state_not_taken(robot: Robot, description: Description) -> Iterator[Problem]:
    """MoveIt does not take a joint position of a named pose as written.

    The value is not one number, or the joint is not in the group of the pose.
    """
    for document in get_srdf_documents(robot, description):
        content = read_semantic(document.root)
        for state in content.states:
            names = list_joints_of_group(content, state.group, robot)
            for part in state.joints:
                joint, text = robot.joint.get(part.name), part.element.get("value")
                if joint is None or not names:
                    continue  # srdf-unknown-joint, srdf-unknown-group
                if part.name not in names:
                    yield Problem(
                        part.element,
                        f"joint '{part.name}' is not in group '{state.group}', so pose "
                        f"'{state.name}' does not move it",
                        at=part.element.locate_attribute("name"),
                        severity=WARNING,
                        effects=("moveit (a joint outside)",),
                    )
                elif part.value is None and joint.has_axis and text is not None:
                    starts = _has_number_first(text)
                    yield Problem(
                        part.element,
                        f"joint '{part.name}' is '{text}' in pose '{state.name}', which is not one "
                        "number",
                        at=part.element.locate_attribute("value"),
                        effects=(f"moveit ({'several values' if starts else 'no number'})",),
                    )


def _has_number_first(text: str) -> bool:
    """Tell whether C++ reads a number at the start of a text, so that the rest is a second one."""
    words = text.split()
    return bool(words) and words[0].lstrip("+-")[:1].isdigit()
