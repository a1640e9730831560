"""Edits of several files, and the proof that they change nothing but names."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping

from ..errors import UrdftoolError
from ..source.description import Description, read_description
from ..source.document import Element
from ..source.edit import Edit, apply
from ..source.location import Place, SourceFile
from .edits import Edits
from .knowledge import Knowledge, make_path

NewNames = Mapping[tuple[int, str], str]
"""New values by id of an expanded element and attribute; of its text for an empty attribute."""


class RefusedRename(UrdftoolError):  # noqa: N818 -- reads as what happened
    """Signal that a name is not changed, with the reason and its place."""


class SourceEdits:
    """Edits by file."""

    def __init__(self, knowledge: Knowledge) -> None:
        """Create no edits."""
        self.knowledge = knowledge
        self._files: dict[str, SourceFile] = {}
        self._edits: dict[str, dict[tuple[int, int], bytes]] = {}

    @property
    def paths(self) -> set[str]:
        """Return the resolved paths of the edited files."""
        return set(self._edits)

    def replace(self, file: SourceFile, start: int, end: int, text: str) -> None:
        """Replace bytes of a file.

        Raises:
            RefusedRename: They are replaced by another text already.
        """
        data = text.encode(file.encoding, "xmlcharrefreplace")
        self.add(file, Edit(start, end, data))

    def add(self, file: SourceFile, edit: Edit) -> None:
        """Add an edit of a file.

        Raises:
            RefusedRename: Its bytes are replaced by another text already.
        """
        path = make_path(file.path)
        self._files[path] = file
        known = self._edits.setdefault(path, {}).setdefault((edit.start, edit.end), edit.text)
        if known != edit.text:
            message = "this text is the name of several parts, which get different names"
            raise RefusedRename(message, at=Place(file, edit.start, edit.end))

    def check_inside(self, path: str) -> None:
        """Check that a file belongs to the workspace of the editor or the project.

        Raises:
            RefusedRename: It does not.
        """
        if not self.knowledge.is_in_workspace(path):
            raise RefusedRename(f"{path} has this name too, and is not a file of the workspace")

    def make_contents(self) -> dict[str, bytes]:
        """Return the new contents of each file."""
        return {
            path: apply(self._files[path], [Edit(*span, text) for span, text in edits.items()])
            for path, edits in self._edits.items()
        }

    def convert(self, knowledge: Knowledge) -> Edits:
        """Return the edits of the protocol."""
        made: Edits = {}
        for path, edits in self._edits.items():
            file = self._files[path]
            table = knowledge.make_table(file)
            made[path] = [
                {
                    "range": table.get_range(start, end),
                    "newText": text.decode(file.encoding, "replace"),
                }
                for (start, end), text in sorted(edits.items())
            ]
        return made


def prove(
    knowledge: Knowledge, edits: SourceEdits, names: NewNames, arguments: Mapping[str, str]
) -> None:
    """Read each robot with the edits, and compare it with the robot before.

    Raises:
        RefusedRename: A robot cannot be read, or something else is different.
    """
    for path in sorted(edits.paths):
        knowledge.read_robots(path)
    contents = edits.make_contents()
    for description in list_affected(knowledge, edits):
        after = _read_edited(knowledge, description, contents, arguments)
        place = find_difference(description.document.root, after.document.root, names)
        if place is not None:
            raise RefusedRename("the robot would be different here", at=place)


def list_affected(knowledge: Knowledge, edits: SourceEdits) -> Iterator[Description]:
    """Yield the descriptions that have an edited file."""
    for state in knowledge.states.values():
        if state.files & edits.paths:
            yield from (description for description, _ in state.descriptions)


def _read_edited(
    knowledge: Knowledge,
    description: Description,
    contents: Mapping[str, bytes],
    arguments: Mapping[str, str],
) -> Description:
    workspace = knowledge.make_workspace(contents)
    given = {arguments.get(name, name): one for name, one in description.arguments.items()}
    try:
        return read_description(
            description.path,
            given,
            workspace=workspace,
            finder=description.packages.with_workspace(workspace),
        )
    except UrdftoolError as error:
        message = f"{os.path.basename(description.path)} could not be read: {error.message}"
        raise RefusedRename(message, at=error.at) from None


def find_difference(before: Element, after: Element, names: NewNames) -> Place | None:
    """Return the first place where two robots differ in more than names; None if nowhere."""
    pairs = [(before, after)]
    while pairs:
        one, two = pairs.pop()
        values = {key: names.get((id(one), key), value) for key, value in one.attributes.items()}
        text = names.get((id(one), ""), one.text.strip())
        same = (one.tag, values, text) == (two.tag, two.attributes, two.text.strip())
        if not same or len(one.children) != len(two.children):
            return one.place
        pairs += zip(one.children, two.children, strict=True)
    return None
