"""Edits of collisions in the source itself: URDF, and xacro where it is literal.

A tag in a macro appears in every link that calls it. A place is edited only if all its links
require the same change, and only if the mesh name is a literal there. A computed origin is kept as
written, which is not possible for a primitive.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ..errors import SourceError
from ..model.elements import Mesh, Robot
from ..source import edit
from ..source.document import Element
from ..source.location import SourceFile
from ..source.packages import find_own_package, shorten_path
from .compute import Result, Task
from .links import LinkPlan
from .rewrite import Layout, format_piece_blocks, is_literal, link_edits, rewrite_robot

Place = tuple[str, int]


@dataclass
class Edited:
    """Changed files, and links that could not be edited."""

    files: dict[str, bytes] = field(default_factory=dict)
    plans: list[LinkPlan] = field(default_factory=list)
    used: set[Task] = field(default_factory=set)
    refused: list[str] = field(default_factory=list)


def edit_sources(
    robot: Robot, plans: Sequence[LinkPlan], results: Mapping[Task, Result], layout: Layout
) -> Edited:
    """Edit the source of a robot to use new collisions."""
    assert robot.source is not None
    found = Edited()
    if robot.source.expansion is None:
        found.plans = list(plans)
        found.used = _collect_tasks(plans)
        found.files = {robot.source.files[0].path: rewrite_robot(robot, plans, results, layout)}
        return found
    _Xacro(robot, results, layout).settle(plans, found)
    return found


def _collect_tasks(plans: Sequence[LinkPlan]) -> set[Task]:
    return {use.task for item in plans for use in item.uses if use.task is not None}


class _Refused(Exception):  # noqa: N818 -- caught within this file
    """The reason why a link is not edited."""


class _Xacro:
    """Decision on which places of a xacro source may be edited."""

    def __init__(self, robot: Robot, results: Mapping[Task, Result], layout: Layout) -> None:
        assert robot.source is not None
        self.description = robot.source
        self.results = results
        self.layout = layout
        self.sources: dict[str, edit.Source] = {}
        self.links: dict[Place, list[str]] = {}
        for link in robot.links:
            self.links.setdefault(_place(link.element), []).append(link.name)

    def settle(self, plans: Sequence[LinkPlan], found: Edited) -> None:
        """Divide the links into edited and refused, and create the files."""
        made: dict[Place, list[tuple[LinkPlan, list[edit.Edit]]]] = {}
        for item in plans:
            try:
                made.setdefault(_place(item.link.element), []).append(
                    (item, self._make_edits(item))
                )
            except (_Refused, SourceError) as error:
                found.refused.append(f"link '{item.link.name}' is left as it is: {error}")
        edits: dict[str, list[edit.Edit]] = {}
        for place, same in made.items():
            names = {item.link.name for item, _ in same}
            others = [name for name in self.links[place] if name not in names]
            if others or any(changes != same[0][1] for _, changes in same):
                why = f"'{others[0]}'" if others else "its other expansions"
                found.refused += [
                    f"link '{item.link.name}' is left as it is: it comes from a macro that "
                    f"{why} would have to change with, in another way"
                    for item, _ in same
                ]
                continue
            edits.setdefault(place[0], []).extend(same[0][1])
            found.plans += [item for item, _ in same]
        found.plans.sort(key=lambda item: item.index)
        found.used = _collect_tasks(found.plans)
        for path, changes in edits.items():
            found.files[path] = edit.apply(self.sources[path].file, changes)

    def _make_edits(self, item: LinkPlan) -> list[edit.Edit]:
        source, link = self._find_source(item.link.element)
        old = []
        for number in item.replaced:
            element = item.link.collisions[number].element
            if element.file.path != source.file.path or element.start not in source.elements:
                raise _Refused("its collision comes from a macro of its own")
            old.append(source.elements[element.start])
        if any(element.parent is not link for element in old):
            raise _Refused("its collision is written elsewhere, or under a condition")
        blocks: list[list[str]] = []
        for use in item.uses:
            if use.task is None:
                raise _Refused("one of its visuals is a primitive; write its collision by hand")
            blocks += self._make_blocks(source, use.shape, self.results[use.task])
        return link_edits(source, link, old, blocks)

    def _make_blocks(self, source: edit.Source, shape: object, result: Result) -> list[list[str]]:
        mesh, origin = shape.geometry, shape.origin  # type: ignore[attr-defined]
        assert isinstance(mesh, Mesh)
        name = self._format_original(mesh.element, "filename")
        if not is_literal(name) or not is_literal(self._format_original(mesh.element, "scale")):
            raise _Refused(f'the mesh is not literal there: "{name}"')
        blocks = format_piece_blocks(shape, result, self.layout)  # type: ignore[arg-type]
        if origin is None:
            return blocks
        raw = {key: self._format_original(origin.element, key) for key in origin.element.attributes}
        if all(map(is_literal, raw.values())):
            return blocks
        if any(piece.is_primitive for piece in result.pieces):
            raise _Refused("its origin is computed, and a primitive needs one of its own")
        words = "".join(f' {key}="{_escape(value)}"' for key, value in raw.items())
        return [
            [f"\t<origin{words}/>" if line.startswith("\t<origin") else line for line in block]
            for block in blocks
        ]

    def _format_original(self, element: Element, name: str) -> str:
        if name not in element.attributes:
            return ""
        source = self._open(element.file)
        if element.start not in source.elements:
            raise _Refused("its mesh is not written as an element of its own")
        return edit.read_literal(source.elements[element.start], name) or ""

    def _find_source(self, element: Element) -> tuple[edit.Source, Element]:
        source = self._open(element.file)
        found = source.elements.get(element.start)
        if found is None or found.tag != "link":
            raise _Refused("it is not written as a <link> of its own")
        return source, found

    def _open(self, file: SourceFile) -> edit.Source:
        if file.path not in self.sources:
            path = self.description.packages.file
            own = find_own_package(path)
            root = str(own[1] if own else path.parent)
            if not os.path.abspath(file.path).startswith(root + os.sep):
                raise _Refused(f"it is written in {file.path}, outside of {shorten_path(root)}")
            self.sources[file.path] = edit.parse_source(file)
        return self.sources[file.path]


def _place(element: Element) -> Place:
    return element.file.path, element.start


def _escape(value: str) -> str:
    from xml.sax.saxutils import escape

    return escape(value, {'"': "&quot;"})
