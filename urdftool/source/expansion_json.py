"""Expansions and errors as JSON, with which a process that is not trusted returns them."""

from __future__ import annotations

import codecs
import json
from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any, TypeVar, get_args

from ..errors import PackageNotFound, SourceError, UrdftoolError, XacroError, XmlError
from .expansion import Argument, ExpandedNode, Expansion, Lookup, LookupKind, Warned
from .location import Call, Place, SourceFile
from .well_formed import MAX_DEPTH
from .xacro_tree import CDATA, COMMENT, INSTRUCTION, TEXT, Characters, XacroDocument, XacroElement

_ERRORS = {kind.__name__: kind for kind in (SourceError, XmlError, XacroError, PackageNotFound)}

T = TypeVar("T")
Json = dict[str, Any]

_LOOKUP_KINDS = get_args(LookupKind)
_KINDS = frozenset((TEXT, COMMENT, CDATA, INSTRUCTION))


class Writer:
    """Conversion of an expansion or an error to JSON, by the side that expanded.

    Places refer to files by their index in ``files``.
    """

    def __init__(self, files: Sequence[SourceFile]) -> None:
        """Set the files, in the order in which the other side knows them."""
        self._files = {id(file): index for index, file in enumerate(files)}
        self._encodings = [file.encoding for file in files]
        self._calls: list[Any] = []
        self._call_indices: dict[int, int] = {}
        self._stacks: list[list[int]] = []
        self._stack_indices: dict[int, int] = {}
        self._kept: list[object] = []  # objects whose id() is a key

    def write_result(self, result: Expansion, included: Sequence[str]) -> tuple[Json, list[bytes]]:
        """Return an expansion and the files that xacro included.

        Returns:
            Its values without its nodes, and its nodes as :func:`split_nodes` does.

        Raises:
            XacroError: The tree is too deep.
        """
        pieces = split_nodes(self._list_nodes(result.tree))
        value = self._finish(
            pieces=[len(piece) for piece in pieces],
            arguments=[
                (a.name, a.default, self._write_place(a.place)) for a in result.arguments.values()
            ],
            warnings=[(w.message, self._write_place(w.place)) for w in result.warnings],
            included=list(included),
            read=[self._files[id(file)] for file in result.files.values()],
            lookups=self._list_lookups(result.lookups or ()),
        )
        return value, pieces

    def write_error(self, error: UrdftoolError) -> Json:
        """Return an error."""
        return self._finish(
            error=type(error).__name__,
            message=error.message,
            path=error.path,
            line=error.line,
            column=error.column,
            at=self._write_place(error.at),
            calls=self._write_calls(error.calls),
            notes=error.notes,
            rule=error.rule,
            case=error.case,
            data=dict(error.data),
        )

    def _finish(self, **values: Any) -> Json:
        return {
            **values,
            "encodings": self._encodings,
            "call_table": self._calls,
            "stack_table": self._stacks,
        }

    def _list_lookups(self, lookups: Iterable[Lookup]) -> list[Any]:
        return [
            (
                self._files[id(one.file)],
                *one[1:4],
                [(self._files[id(file)], start) for file, start in one.definitions],
            )
            for one in lookups
        ]

    def _list_nodes(self, document: XacroDocument) -> list[Any]:
        """Return the nodes in document order, each with its depth."""
        nodes: list[Any] = []
        above: list[XacroElement] = []
        node = document.firstChild
        while node is not None or above:
            if node is None:
                node = above.pop().nextSibling
            elif isinstance(node, XacroElement):
                if len(above) >= MAX_DEPTH:
                    raise XacroError(
                        f"expanded elements are nested more than {MAX_DEPTH} deep, the limit of a "
                        "robot description",
                        at=node.place,
                    )
                place = self._files[id(node.file)], node.start, self._write_calls(node.calls)
                nodes.append((len(above) + 1, node.tagName, node.attributes, *place))
                above.append(node)
                node = node.firstChild
            else:
                if isinstance(node, Characters) and not _is_indentation(node):
                    nodes.append((len(above) + 1, node.nodeType, node.data))
                node = node.nextSibling
        return nodes

    def _write_place(self, place: Place | None) -> Any:
        if place is None:
            return None
        calls = self._write_calls(place.calls)
        return self._files[id(place.file)], place.start, place.end, calls

    def _write_calls(self, calls: tuple[Call, ...]) -> int:
        """Return the index of a stack of calls."""
        index = self._stack_indices.get(id(calls))
        if index is None:
            index = self._stack_indices[id(calls)] = len(self._stacks)
            self._kept.append(calls)
            self._stacks.append([self._write_call(call) for call in calls])
        return index

    def _write_call(self, call: Call) -> int:
        index = self._call_indices.get(id(call))
        if index is None:
            index = self._call_indices[id(call)] = len(self._calls)
            self._kept.append(call)
            self._calls.append((self._files[id(call.file)], call.start, call.macro, call.arguments))
        return index


def split_nodes(nodes: Sequence[Any]) -> list[bytes]:
    """Return nodes as JSON: one piece for each child of the root element, and what follows it.

    The first piece has what is before the first child.
    """
    starts = [i for i, node in enumerate(nodes) if node[0] <= _CHILD and len(node) == _PARTS]
    starts = [0, *(index for index in starts if index > starts[0]), len(nodes)] if starts else [0]
    encode = json.JSONEncoder(check_circular=False).encode
    return [encode(nodes[start:end]).encode("ascii") for start, end in pairwise(starts)]


_CHILD = 2  # depth of the children of the root element, by definition of depth


def _is_indentation(node: Characters) -> bool:
    """Tell whether a node is white space next to another kind of node, which no reader uses."""
    if node.nodeType != TEXT or not node.data.isspace():
        return False
    before, after = node.previousSibling, node.nextSibling
    return (before is not None and before.nodeType != TEXT) or (
        after is not None and after.nodeType != TEXT
    )


class Reader:
    """Conversion of JSON to an expansion or an error, by the side that reads files.

    Attributes:
        pieces: Nodes of the last expansion of the description by their JSON; after one was read,
            its own.
        new: Nodes of the expansion that are not in a known piece, and those before the first child
            of the root element.
    """

    def __init__(
        self, value: Json, files: Sequence[SourceFile], pieces: dict[bytes, Piece] | None = None
    ) -> None:
        """Set the JSON of :class:`Writer`, the files to which it refers, and the known pieces."""
        self._value = value
        self.pieces = pieces or {}
        self.new: list[ExpandedNode] = []
        self._files = files
        for file, encoding in zip(files, value["encodings"], strict=False):
            file.encoding = codecs.lookup(_require_text(encoding)).name and encoding
        calls = [
            Call(
                *self._read_start(index, start),
                _require_text(macro),
                tuple((_require_text(k), _require_text(v)) for k, v in arguments),
            )
            for index, start, macro, arguments in value["call_table"]
        ]
        self._stacks = [
            tuple(_pick(calls, index) for index in stack) for stack in value["stack_table"]
        ]

    def read_result(self, result: Expansion, data: bytes) -> list[str]:
        """Set files, nodes, arguments and warnings of an expansion; return the included files."""
        value = self._value
        read = [_pick(self._files, index) for index in value["read"]]
        result.files = {file.path: file for file in read}
        result.nodes = self._read_nodes(data)
        for name, default, place in value["arguments"]:
            argument = Argument(
                _require_text(name), _require_text(default), self._read_place(place)
            )
            result.arguments[argument.name] = argument
        result.warnings = [
            Warned(_require_text(message), None if place is None else self._read_place(place))
            for message, place in value["warnings"]
        ]
        if result.lookups is not None:
            result.lookups = [self._read_lookup(*words) for words in value["lookups"]]
        return [_require_text(path) for path in value["included"]]

    def _read_lookup(self, file: Any, start: Any, kind: Any, name: Any, definitions: Any) -> Lookup:
        if kind not in _LOOKUP_KINDS:
            raise ValueError(f"kind {kind!r}")
        sites = tuple(self._read_start(*site) for site in definitions)
        return Lookup(*self._read_start(file, start), kind, _require_text(name), sites)

    def read_error(self) -> UrdftoolError:
        """Return an error."""
        value = self._value
        kind = _ERRORS.get(_require_text(value["error"]), XacroError)
        facts: Json = {key: _require_text(value[key]) for key in ("rule", "case")}
        if value["path"] is not None:
            facts["path"] = _require_text(value["path"])
        for key in ("line", "column"):
            facts[key] = None if value[key] is None else _require_number(value[key])
        at = value["at"]
        return kind(
            _require_text(value["message"]),
            **facts,
            data={_require_text(key): one for key, one in value["data"].items()},
            at=None if at is None else self._read_place(at),
            calls=_pick(self._stacks, value["calls"]),
            notes=[_require_text(note) for note in value["notes"]],
        )

    def _read_start(self, index: Any, start: Any) -> tuple[SourceFile, int]:
        """Return a file and the position of a byte in it."""
        file = _pick(self._files, index)
        if _require_number(start) > len(file.data):
            raise ValueError(f"byte {start} of a file of {len(file.data)}")
        return file, start

    def _read_place(self, place: Any) -> Place:
        index, start, end, calls = place
        file, _ = self._read_start(index, end)
        if _require_number(start) > end:
            raise ValueError(f"from byte {start} to byte {end}")
        return Place(file, start, end, _pick(self._stacks, calls))

    def _read_nodes(self, data: bytes) -> list[ExpandedNode]:
        """Return nodes whose values have the expected types, below one root element."""
        nodes: list[ExpandedNode] = []
        files, stacks = self._files, self._stacks
        sizes = [len(file.data) for file in files]
        known, self.pieces = self.pieces, {}
        start, reached, roots = 0, 1, 0
        for length in self._value["pieces"]:
            text = data[start : start + _require_number(length)]
            start += length
            piece = known.get(text) or Piece(text)
            self.pieces[text] = piece
            if piece.depth > reached:
                raise ValueError(f"depth {piece.depth} below {reached}")
            if piece.most_calls >= len(stacks):
                raise ValueError(f"stack {piece.most_calls} of {len(stacks)}")
            for file, most in piece.most_starts.items():
                if most > sizes[file]:
                    raise ValueError(f"byte {most} of a file of {sizes[file]}")
            begin = len(nodes)
            nodes += [
                node
                if len(node) != _PARTS
                else (*node[:3], files[node[3]], node[4], stacks[node[5]])
                for node in piece.nodes
            ]
            if not roots or text not in known:
                self.new += nodes[begin:]
            reached, roots = piece.reached, roots + piece.roots
            if piece.roots and text not in known:
                known = {}  # what it declares decides which names are right below it
        if roots != 1:
            raise ValueError(f"{roots} root elements")
        return nodes


class Piece:
    """Nodes of a part of an expanded tree, whose values have the expected types.

    Attributes:
        nodes: The nodes; of an element with the indices of its file and of its stack of calls.
        depth: Depth of the first node.
        reached: Maximum depth of a node after the last one.
        roots: Number of root elements.
        most_starts: Last byte at which an element starts, by index of the file.
        most_calls: Last index of a stack; -1 without elements.
    """

    __slots__ = ("depth", "most_calls", "most_starts", "nodes", "reached", "roots")

    def __init__(self, text: bytes) -> None:
        """Read nodes as JSON.

        Raises:
            TypeError, ValueError, LookupError: A value is not as expected.
        """
        self.nodes: list[tuple[Any, ...]] = []
        self.most_starts: dict[int, int] = {}
        self.most_calls, self.roots, self.reached = -1, 0, MAX_DEPTH + 1
        for node in json.loads(text):
            if len(node) != _PARTS:
                self.reached, kind, data = _read_characters(node, self.reached)
                self.nodes.append((self.reached, kind, data))
                continue
            depth, kind, data, file, start, calls = node
            if not type(depth) is type(file) is type(start) is type(calls) is int:
                raise TypeError(f"{node!r} in place of numbers")
            if type(kind) is not str or not _TEXTS.issuperset(map(type, data.values())):
                raise TypeError("a tag or the value of an attribute is not text")
            if not 0 < depth <= self.reached:
                raise ValueError(f"depth {depth} below {self.reached}")
            if file < 0 or calls < 0 or start < 0:
                raise ValueError(f"{node!r}: a number is below 0")
            self.nodes.append(tuple(node))
            self.most_starts[file] = max(start, self.most_starts.get(file, 0))
            self.most_calls = max(calls, self.most_calls)
            self.reached, self.roots = min(depth, MAX_DEPTH) + 1, self.roots + (depth == 1)
        self.depth: int = self.nodes[0][0]


_TEXTS = frozenset((str,))
_PARTS = 6  # of an element, by definition of Writer: depth, tag, attributes, file, byte, calls


def _read_characters(node: Any, reached: int) -> tuple[int, int, str]:
    """Return depth, type and text of a node that is not an element."""
    depth, kind, data = node
    if not 0 < _require_number(depth) <= reached:
        raise ValueError(f"depth {depth} below {reached}")
    if type(kind) is not int or kind not in _KINDS:
        raise ValueError(f"kind {kind}")
    return depth, kind, _require_text(data)


def _pick(items: Sequence[T], index: Any) -> T:
    return items[_require_number(index)]


def _require_number(value: Any) -> int:
    if type(value) is not int or value < 0:
        raise TypeError(f"{value!r} in place of a number from 0")
    return value


def _require_text(value: Any) -> str:
    if type(value) is not str:
        raise TypeError(f"{type(value).__name__} in place of text")
    return value
