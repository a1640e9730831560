"""Text of an MJCF file for MuJoCo, one start tag per line, with the element of each line.

MuJoCo reports lines only, and none for included files. Here includes are expanded, so that the line
of every element of the text leads to its place in the source.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path, PurePath
from xml.sax.saxutils import quoteattr

from ...errors import ModelError, SourceError, XmlError
from ...source.document import STDIN, Element, parse, read_file
from ...source.location import SourceFile
from ...source.well_formed import repair
from ...workspace import Workspace

MAX_ELEMENTS = 200_000
"""Maximum number of elements, including copies by ``<replicate>``."""

_BLOCK = 1_000_000
"""Lines between the texts of two attached models."""


@dataclass
class Expanded:
    """An MJCF model without includes.

    Attributes:
        root: Root element of the main file.
        text: XML for MuJoCo.
        models: Text of each attached model by its path as written.
        files: Files that were read, the main one first.
        lines: Element by its line in ``text`` or in an attached model.
    """

    root: Element
    text: str = ""
    models: dict[str, bytes] = field(default_factory=dict)
    files: list[SourceFile] = field(default_factory=list)
    lines: dict[int, Element] = field(default_factory=dict)

    def get_element_at(self, line: int) -> Element:
        """Return the element of a line; the root for a line without an element."""
        return self.lines.get(line, self.root)


def expand(file: SourceFile, workspace: Workspace) -> Expanded:
    """Expand the includes of an MJCF file and find the models that it attaches.

    Raises:
        SourceError: A file is missing, not well-formed, included twice or attached to itself.
        ModelError: The root is not ``<mujoco>``, or the model has too many elements.
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
    expanded = Expanded(root, files=reader.files, lines=reader.lines, models=reader.models)
    folder = Path() if file.path == STDIN else Path(file.path).parent
    expanded.text = reader.write_text(root, folder, 0, (_make_key(file.path),))
    return expanded


class _Reader:
    """State of one expansion."""

    def __init__(self, workspace: Workspace) -> None:
        self.workspace = workspace
        self.files: list[SourceFile] = []
        self.lines: dict[int, Element] = {}
        self.models: dict[str, bytes] = {}
        self._count = 0

    def parse_file(self, file: SourceFile) -> Element:
        """Parse a file; MuJoCo's XML reader accepts some text that is not well-formed."""
        self.files.append(file)
        try:
            return parse(file).root
        except XmlError:
            repaired = repair(file)
            if repaired is None:
                raise
        return parse(repaired).root

    def write_text(self, root: Element, folder: Path, first: int, above: tuple[str, ...]) -> str:
        """Write a model with one start tag per line, and register its lines.

        Args:
            root: Its root element.
            folder: Folder to which its paths are relative.
            first: Number of lines before it.
            above: Paths of the main file and the models that lead to this one.
        """
        out: list[str] = []
        included: set[str] = set()
        todo: list[tuple[Element, int] | str] = [(root, 1)]
        while todo:
            item = todo.pop()
            if isinstance(item, str):
                out[-1] += item
                continue
            element, copies = item
            if element.tag == "include":
                todo += [
                    (child, copies) for child in self._include(element, folder, included, above[-1])
                ]
                continue
            if element.tag == "replicate":
                copies *= _count_copies(element)
            self._count += copies
            if self._count > MAX_ELEMENTS:
                raise ModelError(
                    f"the model has more than {MAX_ELEMENTS} elements; it is not read",
                    at=element.place,
                )
            if element.tag == "model" and element.get("file"):
                self._attach(element, folder, above)
            written = "".join(f" {name}={quoteattr(v)}" for name, v in element.attributes.items())
            out.append(f"<{element.tag}{written}>{_escape(element.text)}")
            self.lines[first + len(out)] = element
            todo.append(f"</{element.tag}>")
            todo += [(child, copies) for child in reversed(element.children)]
        return "\n".join(out)

    def _include(
        self, element: Element, folder: Path, included: set[str], above: str
    ) -> Iterator[Element]:
        """Return the elements of an included file, the last first.

        Paths are relative to the main file, or to the including file.
        """
        name = element.get("file") or ""
        if not name:
            raise SourceError("<include> has no file", at=element.place)
        beside = Path(element.file.path).parent / name
        path = folder / name
        if not self.workspace.is_file(path) and self.workspace.is_file(beside):
            path = beside
        key = _make_key(path)
        if key == above:
            raise SourceError(f"file '{name}' includes itself", at=element.place)
        if key in included:
            raise SourceError(
                f"file '{name}' is included twice, which MuJoCo refuses", at=element.place
            )
        included.add(key)
        return reversed(self.parse_file(self._read_file(path, name, element)).children)

    def _attach(self, element: Element, folder: Path, above: tuple[str, ...]) -> None:
        name = element.get("file") or ""
        path = folder / name
        if _make_key(path) in above:
            raise SourceError(f"model '{name}' attaches itself", at=element.place)
        if name in self.models:
            return
        first = _BLOCK * (len(self.models) + 1)
        self.models[name] = b""
        root = self.parse_file(self._read_file(path, name, element))
        text = self.write_text(root, path.parent, first, (*above, _make_key(path)))
        self.models[name] = b"\n" * first + text.encode()

    def _read_file(self, path: Path, name: str, element: Element) -> SourceFile:
        try:
            return read_file(str(path), self.workspace)
        except SourceError as error:
            raise SourceError(f"file '{name}' {error.message}", at=element.place) from None


def _count_copies(element: Element) -> int:
    try:
        return max(1, int(element.get("count") or "1"))
    except ValueError:
        return 1  # MuJoCo reports it


def _make_key(path: str | PurePath) -> str:
    return str(Path(path).resolve())


def _escape(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace("\n", " ").strip()
