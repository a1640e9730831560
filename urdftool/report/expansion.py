"""What there is to say of an expansion: files, arguments, warnings, a make rule, a source map."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from ..source.document import Element, parse, read_file
from ..source.location import Call
from ..suggestions import did_you_mean
from .json_text import json_text

if TYPE_CHECKING:
    from ..source.expansion import Expansion


def files_read(expansion: Expansion) -> list[str]:
    """The files that were read, the description first."""
    return list(dict.fromkeys([expansion.file.path, *expansion.files, *expansion.dependencies]))


def warnings(expansion: Expansion, given: Mapping[str, str]) -> list[str]:
    """A line for each warning: xacro's own, and arguments that nothing declares."""
    lines = []
    for warned in dict.fromkeys(expansion.warnings):
        where = str(warned.place) if warned.place else expansion.file.path
        lines.append(f"{where}: warning: {' '.join(warned.message.split())}")
    return lines + unknown_arguments(expansion.file.path, given, expansion)


def unknown_arguments(
    path: str, given: Mapping[str, str], expansion: Expansion | None
) -> list[str]:
    """A line for each argument that nothing declares.

    Args:
        path: Of the description.
        given: Values for its arguments.
        expansion: What xacro did; None for plain URDF, which has no arguments.
    """
    lines = []
    known = {} if expansion is None else expansion.arguments
    for name in given:
        used = expansion is not None and f"$(arg {name})" in _sources(expansion)
        if name not in known and not used:
            hint = did_you_mean(name, known, 0.6) or f"; declared: {', '.join(known) or 'none'}"
            lines.append(
                f"{path}: warning: no <xacro:arg> declares '{name}', so {name}:=… has no effect"
                f"{hint}"
            )
    return lines


def _sources(expansion: Expansion) -> str:
    return "".join(f.data.decode(f.encoding, "replace") for f in expansion.files.values())


def argument_list(expansion: Expansion) -> str:
    """``name:=default`` lines, in the order they are declared."""
    return "".join(f"{a.name}:={a.default}\n" for a in expansion.arguments.values())


def make_rule(target: str, files: Iterable[str]) -> str:
    """A rule that makes a target depend on files, with an empty rule for each of them.

    The empty rules keep make going when an include has been removed.
    """
    escaped = [_escape(name) for name in files]
    rules = "".join(f"\n{name}:\n" for name in escaped[1:])
    return f"{_escape(target)}: " + " \\\n  ".join(escaped) + "\n" + rules


def _escape(path: str) -> str:
    for plain, written in (("$", "$$"), ("#", "\\#"), (" ", "\\ ")):
        path = path.replace(plain, written)
    return path


def stale(expansion: Expansion, committed: str) -> str:
    """How a committed URDF differs from the expansion, as a unified diff; empty if it does not.

    Comments and layout do not count.
    """
    from difflib import unified_diff

    written = _lines(parse(read_file(committed)).root)
    wanted = _lines(expansion.document().root)
    return "".join(
        line + "\n"
        for line in unified_diff(written, wanted, committed, "expanded", lineterm="", n=2)
    )


def _lines(element: Element, indent: str = "") -> list[str]:
    """An element as lines that are equal where the XML is."""
    attributes = "".join(
        f' {name}="{value}"'
        for name, value in sorted(element.attributes.items())
        if name != "xmlns:xacro"
    )
    text = " ".join(element.text.split())
    if not element.children:
        end = f">{text}</{element.tag}>" if text else "/>"
        return [f"{indent}<{element.tag}{attributes}{end}"]
    lines = [f"{indent}<{element.tag}{attributes}>{text}"]
    for child in element.children:
        lines.extend(_lines(child, indent + "  "))
    lines.append(f"{indent}</{element.tag}>")
    return lines


def source_map(expansion: Expansion) -> str:
    """Where each element came from, as JSON: its XPath, file, line, column and calls."""
    elements: list[dict[str, Any]] = []
    _map(expansion.document().root, "", {}, elements)
    table = {"version": 1, "source": expansion.file.path, "elements": elements}
    return json_text(table, 1) + "\n"


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
    """A macro call or include as JSON has it; an include has no macro."""
    record: dict[str, Any] = {"path": call.file.path, "line": call.line, "column": call.column}
    record["macro"] = call.macro or None
    if call.arguments:
        record["arguments"] = dict(call.arguments)
    return record
