"""What a failed expansion means, in a sentence with a place."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import UrdftoolError, XacroError
from .location import Place
from .packages import shown_path

if TYPE_CHECKING:
    from .expansion import Expansion
    from .xacro_tree import XacroElement

_UNDEFINED = re.compile(r"name '([^']+)' is not defined")
_UNKNOWN_MACRO = re.compile(r"unknown macro name: (?:xacro:)?(\S+)")
_NO_ARGUMENT = re.compile(r"Undefined substitution argument '?([^\s']+)'?")
_NO_PARAMETERS = re.compile(r"Undefined parameters \[(.*)\]")
_ODD_PARAMETER = re.compile(r'Invalid parameter "([^"]*)"')
_NOT_BOOLEAN = re.compile(r'Xacro conditional "(.*)" evaluated to "(.*)", which is not')
_NO_ATTRIBUTE = re.compile(r"(\S+): missing attribute '([^']+)'")


def explain(
    error: Exception, node: XacroElement | None, failed_text: str | None, result: Expansion
) -> UrdftoolError:
    """An error of xacro as one of ours.

    Args:
        error: What was raised.
        node: The element xacro was at.
        failed_text: The text or expression that could not be evaluated, if it was that.
        result: What was read so far.
    """
    at = None if node is None else _place(node, failed_text)
    for cause in _causes(error):
        if isinstance(cause, UrdftoolError) and cause.line is None and at is not None:
            if cause.path is not None:  # a file that could not be read, named where it is wanted
                return _missing(cause.path, cause.message, at)
            return type(cause)(cause.message, at=at, notes=cause.notes, rule=cause.rule)
        if isinstance(cause, UrdftoolError):
            return cause
    rule, message = _sentence(error, node, failed_text, result)
    if at is None:
        return XacroError(message, path=result.file.path, rule=rule)
    return XacroError(message, at=at, rule=rule)


def _missing(path: str, reason: str, at: Place) -> XacroError:
    """A file that is wanted and cannot be read, with the nearest name that can."""
    from difflib import get_close_matches

    folder, name = os.path.split(path)
    try:
        there = os.listdir(folder or ".")
    except OSError:
        there = []
        missing = next((p for p in reversed(Path(path).parents) if not p.exists()), None)
        reason = f"there is no folder {missing}" if missing else reason
    near = get_close_matches(name, there, 1, 0.75)
    hint = f"; did you mean '{near[0]}'?" if near and near[0] != name else ""
    return XacroError(f"{path}: {reason}{hint}", at=at, rule="include-not-found")


def _causes(error: BaseException) -> list[BaseException]:
    """The error and what it was raised from, in any of the ways xacro wraps them."""
    found: list[BaseException] = []
    todo: list[BaseException | None] = [error]
    while todo:
        cause = todo.pop()
        if cause is not None and cause not in found:
            found.append(cause)
            todo.extend((cause.__context__, cause.__cause__, getattr(cause, "exc", None)))
            todo.append(getattr(cause, "error", None))
    return found


def _place(node: XacroElement, failed_text: str | None) -> Place:
    """The attribute whose value holds the text that failed; the element otherwise."""
    if node.tagName == "xacro:include" and not failed_text:
        span = node.file.attribute_spans(node.start).get("filename")
        return node.place if span is None else Place(node.file, *span, node.calls)
    if failed_text:
        for name, span in node.file.attribute_spans(node.start).items():
            written = node.file.data[span[0] : span[1]].decode(node.file.encoding, "replace")
            if failed_text in written[len(name) :]:
                return Place(node.file, *span, node.calls)
    return node.place


def _sentence(
    error: Exception, node: XacroElement | None, failed_text: str | None, result: Expansion
) -> tuple[str, str]:
    """The rule it is a case of, and the sentence."""
    text = " ".join(str(error).split()) or type(error).__name__
    macro = node.tagName[6:] if node is not None else "?"
    if isinstance(error, RecursionError) or isinstance(error.__cause__, RecursionError):
        return "endless-expansion", "the expansion does not end: a macro or property uses itself"
    if match := _UNKNOWN_MACRO.search(text):
        hint = _nearest(match[1], _macros(result))
        return "unknown-macro", f"unknown macro '{match[1]}'{hint}"
    if match := _UNDEFINED.search(text):
        hint = _in_expression(failed_text) + _nearest(match[1], _known(result))
        return "undefined-name", f"'{match[1]}' is not defined{hint}"
    if match := _NO_ARGUMENT.search(text):
        name = match[1]
        known = ", ".join(result.arguments) or "none"
        return "undeclared-arg", (
            f"the argument '{name}' has no value and no <xacro:arg> before it declares it; "
            f"give {name}:=VALUE, or declare it with a default "
            f"(declared: {known}){_nearest(name, set(result.given), 'was it meant by')}"
        )
    if match := _NO_PARAMETERS.search(text):
        missing = ", ".join(f"'{name}'" for name in match[1].split(","))
        return (
            "macro-arguments-mismatch",
            f"macro '{macro}' is called without {missing}, which has no default",
        )
    if match := _ODD_PARAMETER.search(text):
        return "macro-arguments-mismatch", f"macro '{macro}' has no parameter '{match[1]}'"
    if match := _NO_ATTRIBUTE.search(text):
        return "expansion-failed", f"<{match[1]}> lacks the attribute '{match[2]}'"
    if match := _NOT_BOOLEAN.search(text):
        value = match[2] if match[1] == match[2] else f"{match[1]}, which is {match[2]!r},"
        return (
            "non-boolean-conditional",
            f"the condition {value} is neither true nor false; write true, false, 1, 0 or ${{…}}",
        )
    if isinstance(getattr(error, "exc", None), MemoryError):
        return "endless-expansion", f"needs more memory than there is{_in_expression(failed_text)}"
    if match := re.search(r"invalid expression: (\$[{(].*)", text):
        return "unclosed-expression", f"{match[1]} lacks its closing bracket"
    if match := re.search(r"Unknown substitution command \[(.*?)\]", text):
        return (
            "bad-substitution-command",
            f"$({match[1]}) is no substitution of xacro; "
            "there are find, arg, env, optenv, dirname, cwd and eval",
        )
    if "circular variable definition" in text:
        return "circular-property", text.split(" Consider ")[0]
    if "no attribute '_setitem'" in text:
        return (
            "expansion-failed",
            "a property with scope 'parent' has no parent here; it stands at the global scope",
        )
    for cause in _causes(error):
        if isinstance(cause, OSError) and cause.filename:
            reason = (cause.strerror or "cannot be read").lower()
            return "include-not-found", f"{shown_path(cause.filename)}: {reason}"
        if type(cause).__module__.startswith("yaml"):
            mark = getattr(cause, "problem_mark", None)
            problem = getattr(cause, "problem", None) or "not valid YAML"
            where = f"{mark.name}:{mark.line + 1}:{mark.column + 1}: " if mark else ""
            return "expansion-failed", f"{where}not valid YAML: {problem}"
    text = re.sub(r"\s*when evaluating expression '(?:.*)'$", "", text)
    text = re.sub(r"^<class '[\w.]+'>: | \(<expression>, line 1\)", "", text)
    return "expansion-failed", f"{text}{_in_expression(failed_text)}"


def _in_expression(failed_text: str | None) -> str:
    if not failed_text:
        return ""
    return f", in ${{{failed_text}}}" if "$" not in failed_text else f", in {failed_text}"


def _nearest(name: str, known: set[str], asking: str = "did you mean") -> str:
    from difflib import get_close_matches

    near = get_close_matches(name, known - {name}, 1, 0.7)
    return f"; {asking} '{near[0]}'?" if near else ""


_DEFINED = re.compile(
    r"<xacro:(property|macro|arg)\b[^>]*?\bname\s*=\s*[\"']([^\"']+)[\"']"
    r"(?:[^>]*?\bparams\s*=\s*[\"']([^\"']*)[\"'])?"
)


def _macros(result: Expansion) -> set[str]:
    return {name for kind, name, _ in _definitions(result) if kind == "macro"}


def _known(result: Expansion) -> set[str]:
    names = {name for kind, name, _ in _definitions(result) if kind != "macro"}
    for _, _, parameters in _definitions(result):
        names.update(re.findall(r"(?<![\w$])[*]{0,2}(\w+)", parameters or ""))
    return names


def _definitions(result: Expansion) -> list[tuple[str, str, str]]:
    return [
        found
        for file in result.files.values()
        for found in _DEFINED.findall(file.data.decode(file.encoding, "replace"))
    ]
