"""Reports about an expansion: files, arguments, warnings, a make rule, a source map."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from ..source.document import Element, parse, read_file
from ..source.location import Call
from ..source.unknown_arguments import list_unknown_arguments
from ..suggestions import suggest_name
from .json_text import format_json

if TYPE_CHECKING:
    from ..source.expansion import Expansion


def format_files_read(expansion: Expansion) -> list[str]:
    """Return the files that were read, the description first."""
    return list(dict.fromkeys([expansion.file.path, *expansion.files, *expansion.dependencies]))


def format_warnings(expansion: Expansion, given: Mapping[str, str]) -> list[str]:
    """Return a line for each warning: xacro's own, and undeclared arguments."""
    lines = []
    for warned in dict.fromkeys(expansion.warnings):
        where = str(warned.place) if warned.place else expansion.file.path
        lines.append(f"{where}: warning: {' '.join(warned.message.split())}")
    return lines + format_unknown_arguments(expansion.file.path, given, expansion)


def format_unknown_arguments(
    path: str, given: Mapping[str, str], expansion: Expansion | None
) -> list[str]:
    """Return a line for each undeclared argument."""
    return [
        format_unknown_argument(path, name, declared)
        for name, declared in list_unknown_arguments(given, expansion).items()
    ]


def format_unknown_argument(path: str, name: str, declared: Collection[str]) -> str:
    """Return the warning of an argument that a description does not declare."""
    hint = suggest_name(name, declared, 0.6) or f"; declared: {', '.join(declared) or 'none'}"
    return f"{path}: warning: no <xacro:arg> declares '{name}', so {name}:=… has no effect{hint}"


def format_argument_list(expansion: Expansion) -> str:
    """Format the arguments as ``name:=default`` lines, in order of declaration."""
    return "".join(f"{a.name}:={a.default}\n" for a in expansion.arguments.values())


_UNWRITABLE = re.compile(r"[\0-\x1f\x7f;|]|^~|[\\ ]$|\\[ #:*?\[]")
"""Names for which make has no escape: tried with GNU make 4.3, one character after the other."""
_NO_TARGET = re.compile(r"[=%]|&$")
"""Names that make reads as something else where a rule begins."""


def list_not_in_rule(files: Iterable[str]) -> list[str]:
    """Return the files that a make rule cannot name."""
    files = list(files)
    if all("=" in name for name in files):  # the first word is read as an assignment
        return files
    return [name for name in files if _UNWRITABLE.search(name)]


def is_target(name: str) -> bool:
    """Return whether a make rule can begin with a name."""
    return not _UNWRITABLE.search(name) and not _NO_TARGET.search(name)


def make_rule(target: str, files: Iterable[str]) -> str:
    """Format a make rule by which a target depends on files, with an empty rule for each file.

    With the empty rules, make continues after an include was removed; it stops where a name
    has none. Files of `list_not_in_rule` are left out.
    """
    files = list(files)
    left_out = list_not_in_rule(files)
    named = sorted((name for name in files if name not in left_out), key=lambda name: "=" in name)
    rules = "".join(
        f"\n{_escape(name)}:\n" for name in named if name != files[0] and is_target(name)
    )
    return f"{_escape(target)}: " + " \\\n  ".join(map(_escape, named)) + "\n" + rules


def _escape(path: str) -> str:
    return re.sub(r"[ #:*?\[]", r"\\\g<0>", path).replace("$", "$$")


def make_diff_with_committed(expansion: Expansion, committed: str) -> str:
    """Return a unified diff from a committed URDF to the expansion; empty if they are equal.

    Comments and layout are ignored: blanks around a text, and those between elements.
    """
    from difflib import unified_diff

    written = _format_lines(parse(read_file(committed)).root)
    expanded = _format_lines(expansion.make_document().root)
    return "".join(
        line + "\n"
        for line in unified_diff(written, expanded, committed, "expanded", lineterm="", n=2)
    )


def _format_lines(element: Element, indent: str = "") -> list[str]:
    """Format an element as lines that are equal for equal XML."""
    attributes = "".join(
        f' {name}="{value}"'
        for name, value in sorted(element.attributes.items())
        if name != "xmlns:xacro"
    )
    text = " ".join(element.text.split()) if element.children else element.text.strip()
    if not element.children:
        end = f">{text}</{element.tag}>" if text else "/>"
        return [f"{indent}<{element.tag}{attributes}{end}"]
    lines = [f"{indent}<{element.tag}{attributes}>{text}"]
    for child in element.children:
        lines.extend(_format_lines(child, indent + "  "))
    lines.append(f"{indent}</{element.tag}>")
    return lines


def format_source_map(expansion: Expansion) -> str:
    """Return the origin of each element as JSON: XPath, file, line, column and calls."""
    elements: list[dict[str, Any]] = []
    _map(expansion.make_document().root, "", {}, elements)
    table = {"version": 1, "source": expansion.file.path, "elements": elements}
    return format_json(table, 1) + "\n"


def _map(
    element: Element, above: str, counts: dict[str, int], elements: list[dict[str, Any]]
) -> None:
    counts[element.tag] = counts.get(element.tag, 0) + 1
    xpath = f"{above}/{element.tag}" + (f"[{counts[element.tag]}]" if above else "")
    line, column = element.file.position(element.start)
    entry: dict[str, Any] = {"xpath": xpath}
    if "name" in element.attributes:
        entry["name"] = element.attributes["name"]
    entry |= {"path": element.file.path, "line": line, "column": column}
    entry["expansion"] = [call_record(call) for call in element.calls]
    elements.append(entry)
    below: dict[str, int] = {}
    for child in element.children:
        _map(child, xpath, below, elements)


def call_record(call: Call) -> dict[str, Any]:
    """Return the JSON form of a macro call or include; an include has no macro."""
    record: dict[str, Any] = {"path": call.file.path, "line": call.line, "column": call.column}
    record["macro"] = call.macro or None
    if call.arguments:
        record["arguments"] = dict(call.arguments)
    return record
