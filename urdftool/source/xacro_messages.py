"""Explanations of xacro's errors, with remedies."""

from __future__ import annotations

import re
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

from ..suggestions import find_nearest, suggest_name
from .packages import shorten_path
from .xacro_names import TAGS
from .xacro_tree import XacroElement

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from .expansion import Expansion

_UNDEFINED = re.compile(r"name '([^']+)' is not defined")
_UNKNOWN_MACRO = re.compile(r"unknown macro name: (?:xacro:)?(\S+)")
_NO_ARGUMENT = re.compile(r"Undefined substitution argument '?([^\s']+)'?")
_NO_PARAMETERS = re.compile(r"Undefined parameters \[(.*)\]")
_ODD_PARAMETER = re.compile(r'Invalid parameter "([^"]*)"')
_NOT_BOOLEAN = re.compile(r'Xacro conditional "(.*)" evaluated to "(.*)", which is not')
_NO_ATTRIBUTE = re.compile(r"(\S+): missing attribute '([^']+)'")
_FORWARD = re.compile(r"Undefined property to forward: (\S+)")
_NO_BLOCK = re.compile(r'Undefined block "(.*)"')
_TWO_VALUES = re.compile(r"Property attributes .* are mutually exclusive: (.*)")
_MACRO_NAME = re.compile(r"macro names must not contain '\.' \(reserved for namespaces\): (\S+)")
_PROPERTY_NAME = re.compile(r"Property names must (?:be valid|not start).*?: ?(.*)")
_EMPTY_NAME = re.compile(r"(xacro:\w+): empty name")
_SUBSTITUTION = re.compile(r"\$\((env|optenv|find|arg|dirname|anon)\b.*?\[(.*?)\]")
_ODD_CHARACTER = re.compile(r"(Dollar signs|Invalid left parenthesis).*?\[(.*?)\](?!\))")
_SHOWN = 200  # characters of an expression in a message; chosen
_ARGUMENTS = {"env": "NAME", "optenv": "NAME DEFAULT", "find": "PACKAGE", "arg": "NAME"}


def list_causes(error: BaseException) -> list[BaseException]:
    """Return the error and its causes, in all forms in which xacro wraps them."""
    causes: list[BaseException] = []
    todo: list[BaseException | None] = [error]
    while todo:
        cause = todo.pop()
        if cause is not None and cause not in causes:
            causes.append(cause)
            todo.extend((cause.__context__, cause.__cause__, getattr(cause, "exc", None)))
            todo.append(getattr(cause, "error", None))
    return causes


class Failure(NamedTuple):
    """Exception of xacro with its context."""

    error: Exception
    node: XacroElement | None
    failed_text: str | None
    result: Expansion

    @property
    def text(self) -> str:
        """Return the message of xacro on one line."""
        return " ".join(str(self.error).split()) or type(self.error).__name__


class Explanation(NamedTuple):
    """Explanation of a failed expansion."""

    rule: str
    message: str
    data: Mapping[str, Any] = MappingProxyType({})


def explain_failure(failure: Failure) -> Explanation:
    """Return the explanation of a failure, with the rule to which it belongs."""
    error = failure.error
    if isinstance(error, RecursionError) or isinstance(error.__cause__, RecursionError):
        return Explanation(
            "endless-expansion",
            "the expansion does not end, because a macro or property uses itself",
        )
    for speak in (
        _explain_names,
        _explain_macros,
        _explain_blocks,
        _explain_syntax,
        _explain_files,
    ):
        if found := speak(failure):
            return found
    text = re.sub(r"\s*when evaluating expression '(?:.*)'$", "", failure.text)
    text = re.sub(r"^<class '[\w.]+'>: | \(<expression>, line 1\)", "", text)
    reason = str(_unwrap(error))
    if text == f"{reason} {reason}":  # xacro writes what it wraps twice
        text = reason
    if isinstance(_unwrap(error), KeyError):
        text = f"key {text} does not exist"
    return Explanation("expansion-failed", f"{text}{_format_expression(failure.failed_text)}")


def _unwrap(error: Exception) -> object:
    """Return the exception that xacro wrapped."""
    inner: object = getattr(error, "exc", None)
    return error if inner is None else inner


def _explain_names(failure: Failure) -> Explanation | None:
    """Explain undefined names."""
    text, result, failed_text = failure.text, failure.result, failure.failed_text
    if match := _UNKNOWN_MACRO.search(text):
        near = find_nearest(match[1], sorted({*TAGS, *(name for name, _ in _list_macros(result))}))
        hint = f"; did you mean '{near}'?" if near else ""
        data = {"name": match[1], "suggestion": near}
        return Explanation("unknown-macro", f"unknown macro '{match[1]}'{hint}", data)
    if match := _UNDEFINED.search(text):
        hint = _format_expression(failed_text) + _suggest_name(match[1], _collect_names(result))
        return Explanation("undefined-name", f"'{match[1]}' is not defined{hint}")
    if match := _NO_ARGUMENT.search(text):
        name = match[1]
        known = ", ".join(result.arguments) or "none"
        given, near = (
            find_nearest(name, sorted(result.given)),
            find_nearest(name, sorted(result.arguments)),
        )
        hint = f"; did you pass it as '{given}'?" if given else ""
        hint = hint or (f"; did you mean '{near}'?" if near else "")
        data = {"name": name, "suggestion": near, "given": given}
        if failure.node is not None and failure.node.tagName == "robot":
            message = (
                f"xacro argument '{name}' has no value, because xacro expands the attributes of "
                f"<robot> before it reads <xacro:arg>; "
                f"pass {name}:={_find_default(result, name) or 'VALUE'}{hint}"
            )
        else:
            message = (
                f"xacro argument '{name}' has no value and no <xacro:arg> before this element "
                f"(declared: {known}); pass {name}:=VALUE, or declare it with a default{hint}"
            )
        return Explanation("undeclared-arg", message, data)
    if "circular variable definition" in text:
        return Explanation("circular-property", text.split(" Consider ")[0])
    return None


def _find_default(result: Expansion, name: str) -> str:
    """Find the default that an ``<xacro:arg>`` of the file has as text; empty if it has none."""
    text = result.file.data.decode(result.file.encoding, "replace")
    for tag in re.findall(r"<xacro:arg\b[^<>]*>", text):
        found: dict[str, str] = dict(re.findall(r"""(name|default)\s*=\s*["']([^"'$]*)["']""", tag))
        if found.get("name") == name:
            return found.get("default", "")
    return ""


def find_unknown_parameter(error: Exception) -> str:
    """Return the attribute of a macro call without a parameter; empty for other errors."""
    match = _ODD_PARAMETER.search(str(error))
    return match[1] if match else ""


def _explain_macros(failure: Failure) -> Explanation | None:
    """Explain errors of macros and their arguments."""
    text, node = failure.text, failure.node
    macro = node.tagName[6:] if node is not None else "?"
    if match := _NO_PARAMETERS.search(text):
        missing = ", ".join(f"'{name}'" for name in match[1].split(","))
        return Explanation(
            "macro-arguments-mismatch",
            f"macro '{macro}' is called without {missing}, which "
            f"{'have' if ',' in missing else 'has'} no default",
        )
    if match := _ODD_PARAMETER.search(text):
        called = next(iter(getattr(failure.error, "macros", None) or ()), None)
        takes = {name.lstrip("*") for name in getattr(called, "params", ())}
        return Explanation(
            "macro-arguments-mismatch",
            (f"macro '{macro}' has no parameter '{match[1]}'{_suggest_name(match[1], takes)}"),
        )
    if match := _FORWARD.search(text):
        name = match[1]
        return Explanation(
            "macro-arguments-mismatch",
            f"macro '{macro}' forwards property '{name}' ({name}:=^), which is not defined where "
            f'the macro is called; pass {name}="…", or add a default: {name}:=^|VALUE',
        )
    if "Invalid use of macro name 'call'" in text:
        return Explanation(
            "expansion-failed",
            "a macro cannot be named 'call', because <xacro:call> is a xacro element; rename it",
        )
    if match := _MACRO_NAME.search(text):
        return Explanation(
            "expansion-failed",
            f"the name of macro '{match[1]}' contains a dot, which separates a namespace from a "
            f"name; rename it to {match[1].replace('.', '_')}",
        )
    return None


def _explain_blocks(failure: Failure) -> Explanation | None:
    """Explain errors of block parameters."""
    text, node, result = failure.text, failure.node, failure.result
    few = "Not enough blocks" in text
    if node is not None and (few or text.startswith('Unused block "')):
        macro = getattr(failure.error, "macros", [None])[0]
        parameters = [name for name in getattr(macro, "params", ()) if name.startswith("*")]
        given = [f"<{child.tagName}>" for child in _list_children(node)]
        names = ", ".join(f"'{name.lstrip('*')}'" for name in parameters)
        called = node.tagName
        expected = f"macro '{called[6:]}' has {_format_block_parameters(len(parameters))}"
        has = (
            f"{_format_child_elements(len(given))} ({', '.join(given)})"
            if given
            else "no child elements"
        )
        if few:
            rest = ", ".join(f"'{name.lstrip('*')}'" for name in parameters[len(given) :])
            advice = f"add an element for {rest} inside <{called}>"
        elif parameters:
            surplus = ", ".join(given[len(parameters) :])
            advice = f"remove {surplus}, or wrap several elements in one"
        else:
            block = given[0].strip("<>").rpartition(":")[2]
            advice = f'remove it, or add params="*{block}" to the macro and insert it there'
        names = f" ({names})" if parameters else ""
        return Explanation(
            "macro-arguments-mismatch", f"{expected}{names}, but the call has {has}; {advice}"
        )
    if match := _NO_BLOCK.search(text):
        calls = node.calls if node is not None else ()
        inside = next((call.macro for call in calls if call.macro), "")
        blocks = _find_block_parameters(inside, result)
        near = _suggest_name(
            match[1], blocks | {name for _, name, _ in _collect_definitions(result)}
        )
        if not inside:
            return Explanation(
                "undefined-name",
                f"block '{match[1]}' is not defined; define it as <xacro:property "
                f'name="{match[1]}"> with child elements{near}',
            )
        known = ", ".join(sorted(blocks)) or "none"
        return Explanation(
            "undefined-name",
            f"macro '{inside}' has no block parameter '{match[1]}' (block parameters: {known}); "
            f'add params="*{match[1]}"{_suggest_name(match[1], blocks)}',
        )
    return None


def _explain_syntax(failure: Failure) -> Explanation | None:
    """Explain syntax errors."""
    text, error, failed_text = failure.text, failure.error, failure.failed_text
    if match := _NO_ATTRIBUTE.search(text):
        return Explanation("expansion-failed", f"<{match[1]}> has no attribute '{match[2]}'")
    if match := _EMPTY_NAME.search(text):
        return Explanation("expansion-failed", f"<{match[1]}> has an empty name; add a name")
    if match := _TWO_VALUES.search(text):
        return Explanation(
            "expansion-failed",
            f"property '{match[1]}' has more than one of value, default and remove; keep only one",
        )
    if match := _PROPERTY_NAME.search(text):
        name = re.sub(r"\W", "_", match[1]).lstrip("_")
        name = f"p{name}" if not name or name[0].isdigit() else name
        return Explanation(
            "expansion-failed",
            f"'{match[1]}' is not a valid property name, because names start with a letter and "
            f"contain letters, digits and _; rename it to {name}",
        )
    if match := _NOT_BOOLEAN.search(text):
        value = match[2] if match[1] == match[2] else f"{match[1]}, which is {match[2]!r},"
        return Explanation(
            "non-boolean-conditional",
            f"the condition {value} is not a boolean; use true, false, 1, 0 or ${{…}}",
        )
    if any(isinstance(cause, MemoryError) for cause in list_causes(error)):
        return Explanation(
            "endless-expansion",
            f"the expansion requires too much memory{_format_expression(failed_text)}",
        )
    if match := re.search(r"invalid expression: (\$[{(].*)", text):
        return Explanation("unclosed-expression", f"{match[1]} has no closing bracket")
    if match := re.search(r"Unknown substitution command \[(.*?)\]", text):
        return Explanation(
            "bad-substitution-command",
            f"$({match[1]}) is not a substitution of xacro; "
            "use find, arg, env, optenv, dirname, cwd or eval",
        )
    if match := _ODD_CHARACTER.search(text):
        return Explanation(
            "bad-substitution-command",
            f"'{'$' if match[1] == 'Dollar signs' else '('}' is not allowed inside {match[2]}; "
            "use ${…} for a property",
        )
    if match := _SUBSTITUTION.search(text):
        return Explanation(
            "bad-substitution-command",
            f"$({match[2]}) has the wrong number of arguments; "
            f"use $({match[1]} {_ARGUMENTS.get(match[1], '')})",
        )
    if "no attribute '_setitem'" in text:
        return Explanation(
            "expansion-failed",
            "a property at the global scope has no parent scope; remove scope='parent'",
        )
    inner = _unwrap(error)
    if isinstance(inner, SyntaxError) and failed_text:
        return Explanation(
            "expansion-failed",
            f"${{{_shorten(failed_text)}}} is not a Python expression: {inner.msg}",
        )
    return None


def _explain_files(failure: Failure) -> Explanation | None:
    """Explain files that cannot be read."""
    for cause in list_causes(failure.error):
        if isinstance(cause, OSError) and cause.filename:
            reason = (cause.strerror or "cannot be read").lower()
            return Explanation("include-not-found", f"{shorten_path(cause.filename)}: {reason}")
        if type(cause).__module__.startswith("yaml"):
            mark = getattr(cause, "problem_mark", None)
            problem = getattr(cause, "problem", None) or "not valid YAML"
            where = f"{mark.name}:{mark.line + 1}:{mark.column + 1}: " if mark else ""
            return Explanation("expansion-failed", f"{where}not valid YAML: {problem}")
    return None


def _list_children(node: XacroElement) -> Iterator[XacroElement]:
    """Yield the child elements."""
    for child in node.childNodes:
        if isinstance(child, XacroElement):
            yield child


def _format_block_parameters(count: int) -> str:
    names = {0: "no block parameters", 1: "one block parameter"}
    return names.get(count, f"{count} block parameters")


def _format_child_elements(count: int) -> str:
    return "one child element" if count == 1 else f"{count} child elements"


def _shorten(text: str) -> str:
    """Return the part of an expression that a message shows."""
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"


def _format_expression(failed_text: str | None) -> str:
    if not failed_text:
        return ""
    failed_text = _shorten(failed_text)
    return f", in ${{{failed_text}}}" if "$" not in failed_text else f", in {failed_text}"


def _suggest_name(name: str, known: set[str]) -> str:
    return suggest_name(name, sorted(known))


_DEFINED = re.compile(
    r"<xacro:(property|macro|arg)\b[^<>]*?\bname\s*=\s*[\"']([^\"']+)[\"']"
    r"(?:[^<>]*?\bparams\s*=\s*[\"']([^\"']*)[\"'])?"
)


def _list_macros(result: Expansion) -> Iterator[tuple[str, str]]:
    """Yield the defined macros with their parameters as written."""
    for kind, name, parameters in _collect_definitions(result):
        if kind == "macro":
            yield name, parameters


def _find_block_parameters(macro: str, result: Expansion) -> set[str]:
    """Return the block parameters of a macro."""
    name = macro.rpartition(".")[2]
    return {
        block
        for one, parameters in _list_macros(result)
        if one.removeprefix("xacro:") == name
        for block in re.findall(r"(?<!\S)\*{1,2}(\w+)", parameters)
    }


def _collect_names(result: Expansion) -> set[str]:
    names = {name for kind, name, _ in _collect_definitions(result) if kind != "macro"}
    for _, _, parameters in _collect_definitions(result):
        names.update(re.findall(r"(?<![\w$])[*]{0,2}(\w+)", parameters or ""))
    return names


def _collect_definitions(result: Expansion) -> list[tuple[str, str, str]]:
    return [
        found
        for file in result.files.values()
        for found in _DEFINED.findall(file.data.decode(file.encoding, "replace"))
    ]
