"""Conversion of failed expansions to errors with a location."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ..errors import UrdftoolError, XacroError
from .location import Place
from .xacro_messages import Failure, explain_failure, find_unknown_parameter, list_causes

if TYPE_CHECKING:
    from .expansion import Expansion
    from .xacro_files import Files
    from .xacro_tree import XacroElement


def explain(
    error: Exception,
    node: XacroElement | None,
    failed_text: str | None,
    result: Expansion,
    files: Files,
) -> UrdftoolError:
    """Convert an error of xacro to a :class:`UrdftoolError`."""
    at = None if node is None else _place(node, failed_text, find_unknown_parameter(error))
    for cause in list_causes(error):
        if isinstance(cause, UrdftoolError) and cause.line is None and at is not None:
            if cause.path is not None:  # unreadable file: report it at the reference
                argument = _suggest_argument(node, result) or _suggest_value(cause.path, result)
                return _make_missing_error(cause.path, cause.message, at, argument, files)
            return type(cause)(
                cause.message,
                at=at,
                notes=cause.notes,
                rule=cause.rule,
                case=cause.case,
                data=cause.data,
            )
        if isinstance(cause, UrdftoolError):
            return cause
    rule, message, data = explain_failure(Failure(error, node, failed_text, result))
    if rule == "include-not-found":
        message += _suggest_argument(node, result) or _suggest_value(message, result)
    if at is None:
        return XacroError(message, path=result.file.path, rule=rule, data=data)
    return XacroError(message, at=at, rule=rule, data=data)


def _suggest_argument(include: XacroElement | None, result: Expansion) -> str:
    """Return advice to set the argument that names an included file, if it was not given."""
    if include is None:
        return ""
    span = include.file.locate_attributes(include.start).get("filename")
    if span is None:
        return ""
    written = include.file.data[span[0] : span[1]].decode(include.file.encoding, "replace")
    names = re.findall(r"\$\(arg\s+([^\s)]+)\s*\)", written)
    missing = [name for name in names if name not in result.given]
    return f"; the file name comes from an xacro argument: pass {missing[0]}:=…" if missing else ""


def _suggest_value(text: str, result: Expansion) -> str:
    """Return advice to set the argument whose default is a folder or file of a missing path."""
    parts = set(re.split(r"[/\\:]", text))
    for argument in result.arguments.values():
        if argument.name not in result.given and argument.default in parts - {""}:
            return (
                f"; '{argument.default}' is the default of xacro argument '{argument.name}': "
                f"pass {argument.name}:=…"
            )
    return ""


def _make_missing_error(
    path: str, reason: str, at: Place, argument: str, files: Files
) -> XacroError:
    """Return the error for a file that cannot be read, with the nearest existing name."""
    missing, right = files.suggest_path(path)
    reason = f"folder {missing} does not exist" if missing else reason
    hint = f"; did you mean '{right}'?" if right else ""
    return XacroError(
        f"{path}: {reason}{hint}{argument}",
        at=at,
        rule="include-not-found",
        data={"file": path, "suggestion": right or None},
    )


def _place(node: XacroElement, failed_text: str | None, odd: str) -> Place:
    """Return the span of the unknown attribute or of the one that failed; else of the element."""
    if (odd or node.tagName == "xacro:include") and not failed_text:
        span = node.file.locate_attributes(node.start).get(odd or "filename")
        return node.place if span is None else Place(node.file, *span, node.calls)
    if failed_text:
        for name, span in node.file.locate_attributes(node.start).items():
            written = node.file.data[span[0] : span[1]].decode(node.file.encoding, "replace")
            if failed_text in written[len(name) :]:
                return Place(node.file, *span, node.calls)
    return node.place
