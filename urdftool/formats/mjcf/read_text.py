"""Text of an MJCF file for MuJoCo, one start tag per line, with the element of each line.

MuJoCo reports lines only, and none for included files. Here includes are expanded, so that the line
of every element of the text leads to its place in the source.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from graphlib import CycleError, TopologicalSorter
from pathlib import Path, PurePath
from xml.sax.saxutils import quoteattr

from ...errors import ModelError, SourceError, XmlError
from ...source.document import STDIN, Element, read_file
from ...source.location import Place, SourceFile
from ...source.tinyxml2 import parse_as_tinyxml2
from ...workspace import Workspace
from .read_assets import Asset, AssetNames

MAX_ELEMENTS = 40_000
"""Maximum number of elements with those that MuJoCo creates: copies by ``<replicate>``, points of
``<flexcomp>`` and ``<composite>``, attached models. Chosen, no source."""

MAX_MODELS = 500
"""Maximum number of files of attached models. Chosen, no source."""

_COUNTED = ("replicate", "flexcomp", "composite")


@dataclass
class Expanded:
    """An MJCF model without includes.

    Attributes:
        root: Root element of the main file.
        text: XML for MuJoCo.
        models: Text of each attached model by its name in ``text``.
        assets: Each file that the models name, by its name in ``text``.
        files: Files that were read, the main one first.
        lines: Element by its line in ``text`` or in an attached model.
        surplus: End tags after the root of a file.
        tolerated: Other defects of XML that MuJoCo accepts.
    """

    root: Element
    text: str = ""
    models: dict[str, bytes] = field(default_factory=dict)
    assets: dict[str, Asset] = field(default_factory=dict)
    files: list[SourceFile] = field(default_factory=list)
    lines: dict[int, Element] = field(default_factory=dict)
    surplus: list[Place] = field(default_factory=list)
    tolerated: list[XmlError] = field(default_factory=list)

    def get_element_at(self, line: int) -> Element:
        """Return the element of a line; the root for a line without an element."""
        return self.lines.get(line, self.root)


def expand(file: SourceFile, workspace: Workspace) -> Expanded:
    """Expand the includes of an MJCF file and find the models that it attaches.

    Raises:
        SourceError: A file is missing, not well-formed, included twice or attached to itself.
        ModelError: The root is not ``<mujoco>``, or the model is too large.
    """
    reader = _Reader(workspace)
    root = reader.parse_file(file)
    if root.tag != "mujoco":
        what = "a fragment that other MJCF files include" if root.tag == "mujocoinclude" else ""
        raise ModelError(
            f"the root element is <{root.tag}>, {what or 'not <mujoco>'}; name a file that "
            "starts with <mujoco>",
            at=root.place,
        )
    expanded = Expanded(
        root,
        files=reader.files,
        lines=reader.lines,
        assets=reader.assets,
        surplus=reader.surplus,
        tolerated=reader.tolerated,
    )
    folder = Path() if file.path == STDIN else Path(file.path).parent
    main = _Model(_make_key(file.path), "", root, folder, "")
    expanded.text = reader.write_text(main, 0)
    models = [main]
    for model in models:  # a model that is attached follows
        for child, _ in model.attached.values():
            if child.name not in expanded.models:
                models.append(child)
                first = next(reversed(reader.lines)) + 1
                text = reader.write_text(child, first)
                expanded.models[child.name] = b"\n" * first + text.encode()
    _count_elements(models)
    return expanded


@dataclass(eq=False)
class _Model:
    """A model: the main one, or one that a model attaches.

    Attributes:
        key: Path without links.
        name: Name for MuJoCo.
        root: Its root element.
        folder: Folder to which its paths are relative.
        place: That folder, relative to that of the main file.
        count: Number of its elements, without those of attached models.
        attached: Models that it names and the elements that name them, by the name in it.
        attaches: Name of each model that it attaches, the number of copies, and the element.
    """

    key: str
    name: str
    root: Element
    folder: Path
    place: str
    count: int = 0
    attached: dict[str, tuple[_Model, Element]] = field(default_factory=dict)
    attaches: list[tuple[str, int, Element]] = field(default_factory=list)


class _Reader:
    """State of one expansion."""

    def __init__(self, workspace: Workspace) -> None:
        self.workspace = workspace
        self.files: list[SourceFile] = []
        self.surplus: list[Place] = []
        self.tolerated: list[XmlError] = []
        self.lines: dict[int, Element] = {}
        self.assets: dict[str, Asset] = {}
        self._models: dict[str, _Model] = {}

    def parse_file(self, file: SourceFile) -> Element:
        """Parse a file as MuJoCo's XML reader does."""
        self.files.append(file)
        read = parse_as_tinyxml2(file)
        if read.surplus is not None:
            self.surplus.append(read.surplus)
        if read.error is not None:
            self.tolerated.append(read.error)
        return read.document.root

    def write_text(self, model: _Model, first: int) -> str:
        """Write a model with one start tag per line, and register its lines.

        Args:
            model: The model; the models that it attaches are added to it.
            first: Number of lines before it.
        """
        self._models[model.key] = model
        out: list[str] = []
        included: set[str] = set()
        known = len(self.assets)
        names = AssetNames(model.place, self.assets)
        todo: list[tuple[Element, int] | str] = [(model.root, 1)]
        while todo:
            item = todo.pop()
            if isinstance(item, str):
                out[-1] += item
                continue
            element, copies = item
            if element.tag == "include":
                children = self._include(element, model, included)
                todo += [(child, copies) for child in children]
                continue
            parts = copies * _count_parts(element)
            model.count += parts
            if max(model.count, len(self.lines)) > MAX_ELEMENTS:
                raise _make_count_error(element)
            attributes = names.rewrite(element)
            if element.tag == "model" and element.get("file"):
                attributes["file"] = self._attach(element, model)
            elif element.tag == "attach" and element.get("model"):
                model.attaches.append((element.get("model") or "", copies, element))
            written = "".join(f" {name}={quoteattr(v)}" for name, v in attributes.items())
            out.append(f"<{element.tag}{written}>{_escape(element.text)}")
            self.lines[first + len(out)] = element
            todo.append(f"</{element.tag}>")
            inner = parts if element.tag == "replicate" else copies
            todo += [(child, inner) for child in reversed(element.children)]
        main = os.path.dirname(self.files[0].path)
        names.add_folders(known, main, self.workspace)
        return "\n".join(out)

    def _include(self, element: Element, model: _Model, included: set[str]) -> Iterator[Element]:
        """Return the elements of an included file, the last first.

        Paths are relative to the main file, or to the including file.
        """
        name = element.get("file") or ""
        if not name:
            raise SourceError("<include> has no file", at=element.place)
        beside = Path(element.file.path).parent / name
        path = model.folder / name
        if not self.workspace.is_file(path) and self.workspace.is_file(beside):
            path = beside
        key = _make_key(path)
        if key == model.key:
            raise SourceError(f"file '{name}' includes itself", at=element.place)
        if key in included:
            raise SourceError(
                f"file '{name}' is included twice, which MuJoCo refuses", at=element.place
            )
        included.add(key)
        return reversed(self.parse_file(self._read_file(path, name, element)).children)

    def _attach(self, element: Element, model: _Model) -> str:
        """Add a model that another one names, and return its name for MuJoCo."""
        name = element.get("file") or ""
        path = model.folder / name
        key = _make_key(path)
        found = self._models.get(key)
        if found is None:
            if len(self._models) > MAX_MODELS:
                text = f"the model attaches more than {MAX_MODELS} files; it is not read"
                raise ModelError(text, at=element.place)
            root = self.parse_file(self._read_file(path, name, element))
            place = os.path.join(model.place, os.path.dirname(name))
            new = f"model-{len(self._models)}{path.suffix}"
            found = self._models[key] = _Model(key, new, root, path.parent, place)
        model.attached[element.get("name") or found.root.get("model") or ""] = found, element
        return found.name

    def _read_file(self, path: Path, name: str, element: Element) -> SourceFile:
        try:
            return read_file(str(path), self.workspace)
        except SourceError as error:
            raise SourceError(
                f"file '{name}' {error.message}",
                at=element.place,
                data={} if self.workspace.exists(path) else {"missing": name},
            ) from None


def _count_parts(element: Element) -> int:
    """Return the number of copies of its content, or of points, that an element makes."""
    if element.tag not in _COUNTED:
        return 1
    try:
        return math.prod(max(1, int(part)) for part in (element.get("count") or "1").split())
    except ValueError:
        return 1  # MuJoCo reports it


def _count_elements(models: list[_Model]) -> None:
    """Check the number of elements with those of attached models.

    Raises:
        SourceError: A model attaches itself.
        ModelError: There are too many.
    """
    graph = {model: {child for child, _ in model.attached.values()} for model in models}
    try:
        order = list(TopologicalSorter(graph).static_order())
    except CycleError as error:
        attached, model = error.args[1][:2]
        element = next(at for child, at in model.attached.values() if child is attached)
        text = f"model '{element.get('file')}' attaches itself"
        raise SourceError(text, at=element.place) from None
    for model in order:
        for name, copies, element in model.attaches:
            if name in model.attached:
                model.count += copies * model.attached[name][0].count
            if model.count > MAX_ELEMENTS:
                raise _make_count_error(element)


def _make_count_error(element: Element) -> ModelError:
    return ModelError(
        f"the model has more than {MAX_ELEMENTS} elements; it is not read", at=element.place
    )


def _make_key(path: str | PurePath) -> str:
    return str(Path(path).resolve())


def _escape(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace("\n", " ").strip()
