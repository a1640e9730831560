"""Files around a description: SRDF, controllers, limits and initial positions in YAML."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from ..errors import ConfigError, ModelError, UrdftoolError
from ..model.numbers import number
from ..rules.control.controller_files import get_package
from ..rules.moveit.semantic import find_references
from ..source.document import parse, read_file
from ..source.edit import Edit
from ..source.location import SourceFile
from ..source.packages import shorten_path
from ..source.yaml_tree import Node, list_scalars, parse_yaml
from .change import Change
from .draft import Draft, TextDraft, open_file
from .semantic_files import SEMANTIC, find_semantics, open_semantics, report_xacro

_MOST_FILES = 60
"""Number of YAML files of a folder that are read. Chosen, no source."""
_SUFFIXES = (".yaml", ".yml")


@dataclass
class YamlDraft(TextDraft):
    """A YAML file with changes that are not made yet."""

    def list_edits(self) -> list[Edit]:
        """Return all changes as edits of the file."""
        return self.edits

    def set_scalar(self, node: Node, text: str) -> None:
        """Replace a scalar; its quotes stay."""
        start, end = node.start, node.end
        if node.quoted:
            start, end = start + 1, end - 1
        self.edits.append(Edit(start, end, text.encode("utf-8")))


def add_files_around(draft: Draft, given: Iterable[str | Path] = ()) -> None:
    """Add the files around a description, and those that are given, to its draft.

    These are its SRDF, the files of its controllers, and the YAML files in the folders of both and
    in ``config`` of its package that name one of its joints or links.

    Raises:
        UrdftoolError: A given file cannot be read.
    """
    known: dict[str, TextDraft] = {}
    for path in given:
        file = read_file(str(path))
        known[_resolve(file.path)] = _open_file(draft, file)
    description = draft.description
    if description.path == "-":
        draft.around += known.values()
        return
    has_semantics = any(not isinstance(file, YamlDraft) for file in known.values())
    for one in () if has_semantics else find_semantics(draft):
        known[_resolve(one.file.path)] = one
    for path in _list_yaml(draft, [Path(one.file.path).parent for one in known.values()]):
        if _resolve(path) in known:
            continue
        try:
            file = read_file(shorten_path(path), description.workspace)
            if _has_joint_name(draft, file):
                known[_resolve(path)] = YamlDraft(file)
        except UrdftoolError:
            continue  # such as a file with $(var): it is not one of parameters
    draft.around += known.values()
    for folder in dict.fromkeys(Path(one.file.path).parent for one in draft.around):
        report_xacro(draft, folder)


def apply_changes(draft: Draft) -> Draft:
    """Return a draft of the bytes that a draft makes, with its files, lines and notes."""
    made = open_file(draft.description, SourceFile(draft.file.path, draft.make_bytes()))
    made.lines, made.notes, made.meshes = draft.lines, draft.notes, draft.meshes
    made.around = [
        type(file)(SourceFile(file.file.path, file.make_bytes())) for file in draft.around
    ]
    return made


def _resolve(path: str | Path) -> str:
    return str(Path(path).resolve())


def _open_file(draft: Draft, file: SourceFile) -> TextDraft:
    if file.path.endswith(_SUFFIXES):
        list_scalars(file)
        return YamlDraft(file)
    if not file.path.endswith(SEMANTIC) or parse(file).root.tag != "robot":
        raise ConfigError("is neither an SRDF nor a YAML file", path=file.path)
    return open_semantics(draft, file)


def _list_yaml(draft: Draft, folders: list[Path]) -> Iterator[Path]:
    package = get_package(draft.robot, draft.description)
    for one in package.controller_files:
        yield Path(one.file.path)
    if package.folder is not None:
        folders = [*folders, package.folder / "config"]
    for folder in dict.fromkeys(folders):
        for suffix in _SUFFIXES:
            found = draft.description.workspace.list_matches(folder, f"*{suffix}")
            yield from found[:_MOST_FILES]


def _has_joint_name(draft: Draft, file: SourceFile) -> bool:
    robot = draft.robot
    moving = {joint.name for joint in robot.joints if not joint.is_fixed}
    return any(part in moving for node in list_scalars(file) for part in _split(node.text))


def _split(text: str | None) -> list[str]:
    return (text or "").split("/")


def rename_in_files(
    draft: Draft, names: Mapping[str, str], kinds: Mapping[str, Mapping[str, str]]
) -> int:
    """Change names in the files around; return the number of changes."""
    count = 0
    for file in draft.around:
        if isinstance(file, YamlDraft):
            for node in list_scalars(file.file):
                parts = _split(node.text)
                new = "/".join(names.get(part, part) for part in parts)
                if new != node.text:
                    file.set_scalar(node, new)
                    count += 1
            continue
        for kind, known in kinds.items():
            for element, attribute, _ in find_references(file.source.document.root, kind):
                name = element.get(attribute) or ""
                if name in known:
                    file.set(element, attribute, known[name])
                    count += 1
    return count


def check_no_computed_names(draft: Draft) -> None:
    """Check that no name is computed, in the files around or in the description.

    Raises:
        ModelError: One is, such as ``$(var prefix)elbow``.
    """
    for element in draft.root.walk():
        for attribute in ("name", "link", "joint", "reference"):
            if "$" in (element.get(attribute) or ""):
                raise ModelError(
                    f"name '{element.get(attribute)}' is computed; no prefix can be added to it",
                    at=element.locate_attribute(attribute),
                )
    parts = {*draft.robot.link, *draft.robot.joint}
    for file in draft.around:
        nodes = list_scalars(file.file) if isinstance(file, YamlDraft) else []
        for node in nodes:
            text = node.text or ""
            if "$(" in text and any(text.rpartition(")")[2] == p for p in parts if p):
                raise ModelError(
                    f"name '{text}' is computed; no prefix can be added to it", at=node.place
                )


def shift_files(draft: Draft, changes: Mapping[str, Change]) -> None:
    """Shift positions of joints in the files around: SRDF states, initial positions, limits."""
    for file in draft.around:
        if isinstance(file, YamlDraft):
            _shift_yaml(file, parse_yaml(file.file), changes)
            continue
        for state in file.source.document.root.list_children("group_state"):
            for element in state.list_children("joint"):
                change = changes.get(element.get("name") or "")
                new = None if change is None else change.format(element.get("value"))
                if new is not None:
                    file.set(element, "value", new)


def _shift_yaml(file: YamlDraft, root: Node, changes: Mapping[str, Change]) -> None:
    for path, mapping in root.walk():
        for name, change in changes.items():
            node = (mapping.fields or {}).get(name)
            if node is not None and node.fields is None and node.text is not None:
                new = change.format(node.text)
                if new is not None and not node.quoted:
                    file.set_scalar(node, new)
        if path and path[-1] in changes:
            _shift_limits(file, mapping, changes[path[-1]])


def _shift_limits(file: YamlDraft, mapping: Node, change: Change) -> None:
    """Shift the limits of a joint in ``joint_limits.yaml``, which a negative sign exchanges."""
    fields = mapping.fields or {}
    nodes = fields.get("min_position"), fields.get("max_position")
    texts = [None if node is None else change.format(node.text) for node in nodes]
    if change.sign < 0:
        if None in nodes and nodes != (None, None):
            raise ModelError(
                "only one of min_position and max_position is written; their exchange needs both",
                at=mapping.place,
            )
        texts.reverse()
    for node, text in zip(nodes, texts, strict=True):
        if node is not None and text is not None and number(node.text) is not None:
            file.set_scalar(node, text)
