"""Completion of the SRDF of an existing MoveIt package by edits of its bytes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from ...errors import ConfigError
from ...model.part import Part
from ...model.semantic import Group, PassiveJoint, SemanticDescription
from ...source import edit
from ...source.document import Element
from ...workspace import Workspace
from ..existing import check_robot, judge, read_srdf
from ..groups import GivenGroup, add_groups, find_groups
from ..update import Update, update
from ..verdicts import Verdicts
from ..write import list_lines
from .configuration import Configuration

DecidePairs = Callable[[], "Verdicts | None"]
"""Decides the pairs of the robot; None if it has no geometry to compare."""


@dataclass
class SrdfChanges:
    """Changes of an existing SRDF."""

    groups: list[Group] = field(default_factory=list)
    refused: list[str] = field(default_factory=list)
    pairs: Update | None = None

    @property
    def is_incomplete(self) -> bool:
        """Whether something that is needed was not added, or a pair stays that can touch."""
        pairs = self.pairs
        return bool(self.refused or (pairs is not None and (pairs.refused or pairs.kept)))


def complete_srdf(
    configuration: Configuration, path: Path, given: Sequence[GivenGroup], decide: DecidePairs
) -> tuple[SemanticDescription, bytes, SrdfChanges]:
    """Add groups that an SRDF lacks, and update its pairs; return its content and bytes.

    Raises:
        ConfigError: A given group has the name of another one.
        ModelError: The SRDF is of another robot.
    """
    robot, content = configuration.robot, configuration.semantic
    check_robot(robot, content)
    changes, data = SrdfChanges(), content.element.file.data
    new = _list_missing(configuration, path, given)
    if new.groups:
        data = _insert(content, new, changes)
        content = _read_again(path, data)
    verdicts = decide()
    if verdicts is not None:
        changes.pairs = update(content, judge(content, robot, verdicts))
        data = changes.pairs.data
    return _read_again(path, data), data, changes


def _read_again(path: Path, data: bytes) -> SemanticDescription:
    return read_srdf(path, None, None, Workspace({str(path): data}))


def _list_missing(
    configuration: Configuration, path: Path, given: Sequence[GivenGroup]
) -> SemanticDescription:
    """List the groups whose joints are in no existing group, and those that the user asks for."""
    lacking = [one for one in given if not _has_chain(configuration, path, one)]
    found = SemanticDescription(None, configuration.semantic.name)
    add_groups(found, find_groups(configuration.robot, lacking))
    planned = replace(configuration, semantic=found)
    existing = configuration.semantic.groups
    used = {one.name for group in existing for one in configuration.list_group_joints(group)}
    known = set(configuration.groups)
    lacking_names = {one.name for one in lacking}
    new = []
    for group in found.groups:
        joints = {one.name for one in planned.list_group_joints(group)}
        is_free = bool(joints) and not joints & used and set(group.groups) <= known
        if group.name in lacking_names or (is_free and group.name not in known):
            new.append(group)
            known.add(group.name)
    return _select(planned, new, configuration.semantic)


def _has_chain(configuration: Configuration, path: Path, one: GivenGroup) -> bool:
    """Tell whether the SRDF has a group that the user asks for.

    Raises:
        ConfigError: It has another group of this name.
    """
    group = configuration.groups.get(one.name)
    if group is None:
        return False
    if any((chain.base, chain.tip) == (one.base, one.tip) for chain in group.chains):
        return True
    raise ConfigError(
        f"has a group '{one.name}' that is not the chain from '{one.base}' to '{one.tip}'; "
        "edit it, or give the new group another name",
        path=path,
    )


def _select(
    planned: Configuration, groups: list[Group], existing: SemanticDescription
) -> SemanticDescription:
    """Return some of the planned groups, with what belongs to them and does not exist."""
    found, names = planned.semantic, {group.name for group in groups}
    states = {(state.name, state.group) for state in existing.states}
    effectors = {one.name for one in existing.end_effectors}
    known = names | {group.name for group in existing.groups}
    return SemanticDescription(
        None,
        found.name,
        groups,
        [s for s in found.states if s.group in names and (s.name, s.group) not in states],
        [
            replace(one, parent_group=one.parent_group if one.parent_group in known else "")
            for one in found.end_effectors
            if one.group in names and one.name not in effectors
        ],
        passive_joints=_list_followers(planned, groups, existing),
    )


def _list_followers(
    planned: Configuration, groups: list[Group], existing: SemanticDescription
) -> list[PassiveJoint]:
    """List the passive joints that follow joints of groups, and that an SRDF does not have."""
    joints = {one.name for group in groups for one in planned.list_group_joints(group)}
    present = {joint.name for joint in existing.passive_joints}
    robot = planned.robot
    return [
        joint
        for joint in planned.semantic.passive_joints
        if joint.name not in present
        and (mimic := robot.joint[joint.name].mimic) is not None
        and mimic.joint in joints
    ]


def _insert(content: SemanticDescription, new: SemanticDescription, changes: SrdfChanges) -> bytes:
    """Insert new groups after the last part that is no pair; refused in macros."""
    file = content.element.file
    source = edit.parse_source(file)
    parts = list(_list_parts(content))
    if not all(_is_plain(source, part) for part in [*parts, *content.disabled]):
        changes.refused = [group.name for group in new.groups]
        return file.data
    changes.groups = new.groups
    places = [part.element.start for part in parts]
    last = source.elements[max(places)] if places else None
    lines = [_indent(line) for line in list_lines(new)]
    return edit.apply(file, [edit.insert_child(source, source.document.root, lines, after=last)])


def _list_parts(content: SemanticDescription) -> Iterator[Part]:
    yield from content.groups
    yield from content.states
    yield from content.end_effectors
    yield from content.virtual_joints
    yield from content.passive_joints


def _is_plain(source: edit.Source, part: Part) -> bool:
    """Tell whether a part is written below the root of a file, without expressions."""
    element: Element = part.element
    if element.file is not source.file or element.start not in source.elements:
        return False
    written = source.elements[element.start]
    return (
        written.parent is source.document.root
        and b"$" not in source.file.data[written.start : written.end]
    )


def _indent(line: str) -> str:
    """Write a line in ASCII, with one tab for each level."""
    text = line.lstrip(" ")
    tabs = "\t" * ((len(line) - len(text)) // 2)
    return tabs + text.encode("ascii", "xmlcharrefreplace").decode("ascii")
