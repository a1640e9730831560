"""Text of YAML parameter files, and their completion by byte edits."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from ...source.edit import Edit
from ...source.yaml_tree import Node

Scalar: TypeAlias = "float | int | bool | str"
Value: TypeAlias = "Mapping[str, Value] | list[str] | Commented | Scalar"
Tree: TypeAlias = "Mapping[str, Value]"

_PLAIN = re.compile(r"[A-Za-z_][\w/.:+-]*", re.ASCII)
_WORDS = frozenset(("y", "n", "yes", "no", "true", "false", "on", "off", "null"))


@dataclass(frozen=True)
class Commented:
    """Value with a comment at the end of its line."""

    value: Scalar
    comment: str


def format_yaml(tree: Tree, comments: tuple[str, ...] = ()) -> str:
    """Format a parameter file."""
    return "\n".join([*(f"# {line}" for line in comments), *_format_mapping(tree, 0), ""])


def _format_mapping(tree: Tree, depth: int) -> Iterator[str]:
    indentation = "  " * depth
    for key, value in tree.items():
        name = f"{indentation}{format_scalar(key)}:"
        if isinstance(value, Mapping):
            yield name if value else f"{name} {{}}"
            yield from _format_mapping(value, depth + 1)
        elif isinstance(value, list):
            yield name if value else f"{name} []"
            yield from (f"{indentation}  - {format_scalar(item)}" for item in value)
        elif isinstance(value, Commented):
            yield f"{name} {format_scalar(value.value)}  # {value.comment}"
        else:
            yield f"{name} {format_scalar(value)}"


def format_scalar(value: Scalar) -> str:
    """Format a scalar so that YAML 1.1 reads it back with its type.

    A double has a decimal point. Text is quoted unless it is a plain word; braces in it are
    escaped, because ``launch_param_builder`` renders the files as Jinja templates.
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        if _PLAIN.fullmatch(value) and value.lower() not in _WORDS and value[-1] != ":":
            return value
        return json.dumps(value, ensure_ascii=False).replace("{", "\\x7B").replace("}", "\\x7D")
    return format_double(value) if isinstance(value, float) else str(value)


def format_double(value: float) -> str:
    """Format a number as a YAML double: with a decimal point, also before an exponent.

    Raises:
        ValueError: It is not finite.
    """
    if not math.isfinite(value):
        raise ValueError(f"{value} is not a number of a parameter file")
    mantissa, exponent, power = repr(float(value)).partition("e")
    return mantissa + (".0" if "." not in mantissa else "") + exponent + power


def complete(root: Node, tree: Tree) -> Iterator[tuple[str, Edit]]:
    """Yield the edits that add missing keys to a parameter file, each with the path of its key.

    Present values, also of other types, are kept.
    """
    yield from _complete(root, tree, ())


def append_items(node: Node, items: Sequence[str]) -> Edit:
    """Return the edit that adds items to a sequence, in its style."""
    data = node.file.data
    line_end = b"\r\n" if b"\r\n" in data else b"\n"
    texts = [format_scalar(item).encode() for item in items]
    if not node.items or data[node.start : node.start + 1] == b"[":
        at = data.rindex(b"]", node.start, node.end)
        before = b", " if node.items else b""
        return Edit(at, at, before + b", ".join(texts))
    column = node.start - (data.rfind(b"\n", 0, node.start) + 1)
    at = _find_end(data, node)
    before = b"" if at and data[at - 1 : at] == b"\n" else line_end
    return Edit(at, at, before + b"".join(b" " * column + b"- " + t + line_end for t in texts))


def _complete(node: Node, tree: Tree, path: tuple[str, ...]) -> Iterator[tuple[str, Edit]]:
    missing: dict[str, Value] = {}
    for key, value in tree.items():
        inner = (node.fields or {}).get(key)
        if inner is None:
            missing[key] = value
        elif isinstance(value, Mapping) and inner.fields is not None:
            yield from _complete(inner, value, (*path, key))
    if missing:
        yield ", ".join(".".join((*path, key)) for key in missing), _insert(node, missing)


def _insert(node: Node, tree: Tree) -> Edit:
    """Return the edit that adds keys at the end of a mapping, in its style."""
    data = node.file.data
    line_end = b"\r\n" if b"\r\n" in data else b"\n"
    if data[node.start : node.start + 1] == b"{":
        at = data.rindex(b"}", node.start, node.end)
        text = _format_flow(tree)
        inside = data[node.start + 1 : at].strip()
        return Edit(at, at, (", " if inside and inside[-1:] != b"," else "").encode() + text)
    column = node.start - (data.rfind(b"\n", 0, node.start) + 1)
    lines = [" " * column + line for line in _format_mapping(tree, 0)]
    at = _find_end(data, node)
    text = line_end.join(line.encode() for line in lines)
    before = b"" if at and data[at - 1 : at] == b"\n" else line_end
    return Edit(at, at, before + text + line_end)


def _format_flow(tree: Tree) -> bytes:
    parts = []
    for key, value in tree.items():
        if isinstance(value, Mapping):
            shown = "{" + _format_flow(value).decode() + "}"
        elif isinstance(value, list):
            shown = f"[{', '.join(map(format_scalar, value))}]"
        else:
            shown = format_scalar(value.value if isinstance(value, Commented) else value)
        parts.append(f"{format_scalar(key)}: {shown}")
    return ", ".join(parts).encode()


def _find_end(data: bytes, node: Node) -> int:
    """Return the byte after the last line of a block mapping, without what follows it."""
    last = max(_list_ends(node))
    end = data.find(b"\n", last)
    return len(data) if end < 0 else end + 1


def _list_ends(node: Node) -> Iterator[int]:
    """Yield the byte after each scalar and each flow collection in a node."""
    data = node.file.data
    children = [*(node.fields or {}).values(), *(node.items or ())]
    if not children or data[node.start : node.start + 1] in (b"{", b"["):
        yield node.end
        return
    for child in children:
        yield from _list_ends(child)
