"""YAML parameter files as a tree with locations, within size limits."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from ..errors import ConfigError
from .document import read_file
from .location import Place, SourceFile

MOST_BYTES = 256 * 1024  # of a controller file; chosen, no source
MOST_NODES = 50_000
"""Maximum number of nodes of a tree, with aliases resolved. Chosen, no source."""

_DEEP = 100  # nested values; chosen, no source
_YES, _NO = ("true", "yes", "on"), ("false", "no", "off")


@dataclass(eq=False)
class Node:
    """Value in a YAML file.

    Attributes:
        file: Its file.
        start: First byte.
        end: Byte after the last.
        key: Its key in the enclosing mapping.
        text: Text of a scalar; None for others.
        quoted: Whether a scalar is quoted, and therefore a string.
        items: Items of a sequence; None for others.
        fields: Fields of a mapping; None for others.
        kind: Type of a scalar in YAML 1.1: ``int``, ``float``, ``bool``, ``str`` ….
        replaced: Earlier values of the same key, which this one overrides.
    """

    file: SourceFile
    start: int
    end: int
    key: str
    text: str | None
    quoted: bool
    items: list[Node] | None
    fields: dict[str, Node] | None
    kind: str = ""
    replaced: list[Node] = field(default_factory=list)

    @property
    def place(self) -> Place:
        """Return the location."""
        return Place(self.file, self.start, self.end)

    @property
    def at(self) -> tuple[str, int, int]:
        """Return path, first byte and byte after the last."""
        return self.file.path, self.start, self.end

    def find(self, *keys: str) -> Node | None:
        """Return the node at a path of keys; a key may also join several, as ``a.b`` or ``a/b``."""
        if not keys:
            return self
        for count in range(1, len(keys) + 1):
            for mark in ".", "/":
                inner = (self.fields or {}).get(mark.join(keys[:count]))
                found = None if inner is None else inner.find(*keys[count:])
                if found is not None:
                    return found
        start = ".".join(keys) + "."
        parts = {
            key.removeprefix(start): node
            for key, node in (self.fields or {}).items()
            if key.startswith(start)
        }
        if not parts:
            return None
        first, *_, last = (*parts.values(), *parts.values())
        return Node(self.file, first.start, last.end, keys[-1], None, False, None, parts)

    def walk(self, *path: str) -> Iterator[tuple[tuple[str, ...], Node]]:
        """Yield all mappings with the keys that lead to them, this one first."""
        if self.fields is None:
            return
        yield path, self
        for key, node in self.fields.items():
            yield from node.walk(*path, key)

    def make_error(self, message: str) -> ConfigError:
        """Return an error at this location."""
        return ConfigError(message, at=self.place)

    def read_number(self, what: str) -> float:
        """Return a finite number.

        Raises:
            ConfigError: The value is not a finite number.
        """
        try:
            value = float(self.text) if self.text is not None and not self.quoted else math.nan
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise self.make_error(f"{what} is {self.described}, not a finite number")
        return value

    def read_boolean(self, what: str) -> bool:
        """Return a boolean.

        Raises:
            ConfigError: The value is not a boolean.
        """
        word = (self.text or "").lower()
        if word in _YES or word in _NO:
            return word in _YES
        raise self.make_error(f"{what} is {self.described}, not a boolean; use true or false")

    def list_names(self, what: str) -> list[Node]:
        """Return the scalars of a list of names, or a single name as a list.

        Raises:
            ConfigError: A value is not a non-empty scalar.
        """
        nodes = [self] if self.items is None else self.items
        for node in nodes:
            if not node.text:
                raise node.make_error(f"{what} is {node.described}, not the name of a joint")
        return nodes

    @property
    def described(self) -> str:
        """Return a description of the value for messages."""
        if self.fields is not None:
            return "a mapping"
        if self.items is not None:
            return "a list"
        text = self.text or ""
        return f"'{text[:60]}…'" if len(text) > 60 else f"'{text}'"


def read_yaml(path: str) -> Node:
    """Return the mapping in a file.

    Raises:
        ConfigError: It is not valid YAML, not a mapping, or exceeds the limits.
        SourceError: It cannot be read.
    """
    return parse_yaml(read_file(path))


def is_blank(file: SourceFile) -> bool:
    """Tell whether a file has only comments and document marks."""
    lines = (line.strip() for line in file.data.splitlines())
    return all(not line or line[:1] == b"#" or line in (b"---", b"...") for line in lines)


def parse_yaml(file: SourceFile) -> Node:
    """Return the mapping in a file that was read.

    Several documents are one mapping. The last value of a duplicate key counts, as in PyYAML, with
    which ROS 1 reads parameters; in files with ``ros__parameters``, mappings of the same key are
    merged, as in rcl_yaml_param_parser of ROS 2 (``parse_file_events``, ``find_node``).

    Raises:
        ConfigError: It is not valid YAML, not a mapping, or exceeds the limits.
    """
    import yaml

    path = file.path
    if len(file.data) > MOST_BYTES:
        raise ConfigError(
            f"has {len(file.data)} bytes; the limit of a controller file is {MOST_BYTES}",
            path=path,
        )
    text = file.data.decode("utf-8", "replace")
    try:
        roots = [root for root in yaml.compose_all(text, Loader=yaml.SafeLoader) if root]
    except RecursionError:
        raise ConfigError("values are nested too deeply", path=path) from None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        problem = getattr(error, "problem", None) or "it contains a character that YAML forbids"
        start = 0 if mark is None else min(len(text[: mark.index].encode()), len(file.data))
        raise ConfigError(
            f"is not valid YAML: {problem}",
            path=path,
            at=None if mark is None else Place(file, start, min(start + 1, len(file.data))),
            rule="unreadable-configuration",
        ) from None
    roots = [root for root in roots if not _is_empty(root)]
    if not roots or not all(isinstance(root, yaml.MappingNode) for root in roots):
        what = "is not a mapping" if roots else "is empty"
        raise ConfigError(
            f"{what}; a controller file maps names of controllers to their parameters",
            path=path,
            line=1,
        )
    reader = _Reader(file, text)
    first, *others = [reader.build_node(root, "", 0) for root in roots]
    for other in others:
        for name, value in (other.fields or {}).items():
            reader.add(first, name, value)
    return first


def list_scalars(file: SourceFile) -> list[Node]:
    """Return all scalars of a file in their order: keys, whose ``key`` is ``":"``, and values.

    Raises:
        ConfigError: It is not valid YAML, or exceeds the limits.
    """
    import yaml

    if len(file.data) > MOST_BYTES:
        raise ConfigError(f"has more than {MOST_BYTES} bytes", path=file.path)
    reader = _Reader(file, file.data.decode("utf-8", "replace"))
    scalars: list[Node] = []
    try:
        is_key = False
        for token in yaml.scan(reader.text, Loader=yaml.SafeLoader):
            if isinstance(token, yaml.ScalarToken):
                scalars.append(reader.build_scalar(token, ":" if is_key else ""))
            is_key = isinstance(token, yaml.KeyToken)
    except yaml.YAMLError as error:
        raise ConfigError(f"is not valid YAML: {error}", path=file.path) from None
    return scalars


def _is_empty(root: Any) -> bool:
    """Tell whether a document is empty, as after a final ``---``."""
    return str(root.tag).endswith(":null") and not root.value


class _Reader:
    def __init__(self, file: SourceFile, text: str) -> None:
        self.file, self.text, self.count = file, text, 0
        self._ascii = text.isascii()
        self._merges = "ros__parameters" in text

    def _compute_byte(self, index: int) -> int:
        return index if self._ascii else len(self.text[:index].encode())

    def build_scalar(self, token: Any, key: str) -> Node:
        """Return the scalar of a token."""
        start, end = (self._compute_byte(mark.index) for mark in (token.start_mark, token.end_mark))
        return Node(self.file, start, end, key, token.value, not token.plain, None, None)

    def build_node(self, node: Any, key: str, depth: int) -> Node:
        import yaml

        self.count += 1
        start, end = (
            self._compute_byte(node.start_mark.index),
            self._compute_byte(node.end_mark.index),
        )
        if self.count > MOST_NODES or depth > _DEEP:
            raise ConfigError(
                f"has more than {MOST_NODES} values (with aliases), or values nested more than "
                f"{_DEEP} deep",
                path=self.file.path,
                line=node.start_mark.line + 1,
                column=node.start_mark.column + 1,
            )
        made = Node(self.file, start, end, key, None, False, None, None)
        if isinstance(node, yaml.ScalarNode):
            made.text, made.quoted = str(node.value), node.style in ("'", '"')
            made.kind = str(node.tag).rpartition(":")[2]
        elif isinstance(node, yaml.SequenceNode):
            made.items = [self.build_node(item, key, depth + 1) for item in node.value]
        else:
            made.fields = self._build_fields(node, depth)
        return made

    def _build_fields(self, node: Any, depth: int) -> dict[str, Node]:
        merged: dict[str, Node] = {}
        own = Node(self.file, 0, 0, "", None, False, None, {})
        for key, value in node.value:
            name = str(getattr(key, "value", ""))
            if getattr(key, "tag", "") == "tag:yaml.org,2002:merge":
                inner = self.build_node(value, "<<", depth + 1)
                for source in inner.items if inner.items is not None else [inner]:
                    merged = {**(source.fields or {}), **merged}
            else:
                self.add(own, name, self.build_node(value, name, depth + 1))
        return {**merged, **(own.fields or {})}

    def add(self, mapping: Node, name: str, value: Node) -> None:
        """Add a value to a mapping; merge it with or replace the present value of its key."""
        fields = mapping.fields
        assert fields is not None
        known = fields.get(name)
        if known is None:
            fields[name] = value
        elif self._merges and known.fields is not None and value.fields is not None:
            for inner, part in value.fields.items():
                self.add(known, inner, part)
        else:
            value.replaced = [*known.replaced, known]
            fields[name] = value
