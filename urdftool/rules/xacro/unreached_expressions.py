"""Rules on errors in macros that are not called, and in branches that are not taken.

The expansion reports errors that it reaches.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...source.description import Description
from ...source.document import Document, Element
from ...source.location import Place
from ..fix import FixContext, Proposal, find_attribute, safe, substitute, substitute_text
from ..rule import ERROR, SAFE, Problem, rule
from ..words import suggest_name

_COMMANDS = ("find", "env", "optenv", "dirname", "arg", "cwd", "eval")
_BAD = re.compile(
    r"(?<!\$)\$\(\s*(?!(?:find|env|optenv|dirname|arg|cwd|eval)(?![\w-]))([\w-]+)[^)]*\)"
)
_OPEN = re.compile(r"(?<!\$)\$(?:\{[^}]*|\([^)]*)$")
_FOR_LAUNCH = {
    "find-pkg-share": "find",
    "find-pkg-prefix": "find",
    "var": "arg",
}


_Match = tuple[Element, re.Match[str], "Place | Element"]


def _find_matches(
    document: Document, description: Description, pattern: re.Pattern[str], quick: bytes
) -> list[_Match]:
    """Return the matches of a pattern in the attributes and texts of a xacro file."""
    if description.expansion is None and description.document.root.tag:
        return []  # not xacro
    return document.memo.get(pattern, lambda: list(_list_matches(document, pattern, quick)))


def _list_matches(document: Document, pattern: re.Pattern[str], quick: bytes) -> Iterator[_Match]:
    if not re.search(quick, document.file.data):
        return
    for element in document.elements:
        for name, value in element.attributes.items():
            match = pattern.search(value) if "$" in value else None
            if match is not None:
                yield element, match, element.locate_attribute(name)
        match = pattern.search(element.text) if "$" in element.text else None
        if match is not None and not element.children:
            yield element, match, element


@rule(
    ERROR,
    effects={
        "xacro": "stops if it expands this: unknown substitution command",
    },
)
def bad_substitution_command(document: Document, description: Description) -> Iterator[Problem]:
    """A substitution command is not in xacro.

    xacro has ``$(find …)``, ``$(arg …)``, ``$(env …)``, ``$(optenv …)``, ``$(dirname)``, ``$(cwd)``
    and ``$(eval …)``. Others, such as ``$(find-pkg-share …)`` and ``$(var …)``, are for launch
    files.
    """
    quick = rb"\$\(\s*(?!(?:find|env|optenv|dirname|arg|cwd|eval)[\s)])\w"
    for element, match, at in _find_matches(document, description, _BAD, quick):
        name = match[1]
        instead = _FOR_LAUNCH.get(name)
        data = {"command": name, "write": instead or ""}
        right = f"; write $({instead} …)" if instead else suggest_name(name, _COMMANDS)
        yield Problem(element, f"xacro has no $({name} …){right}", at=at, data=data)


@bad_substitution_command.fix(SAFE, reveals=True)
def write_command(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the equivalent substitution of xacro."""
    old, name = problem.data["command"], problem.data["write"]
    found = find_attribute(problem)
    if not name:
        return None
    pattern = rf"\$\(\s*{old}(?=\s)"
    if found is not None:
        return safe(f"write $({name} …)", substitute(*found, pattern, f"$({name}"))
    return safe(f"write $({name} …)", substitute_text(problem.element, pattern, f"$({name}"))


@rule(
    ERROR,
    effects={
        "xacro": "stops if it expands this",
    },
)
def unclosed_expression(document: Document, description: Description) -> Iterator[Problem]:
    """An expression is not closed.

    ``${`` requires ``}``, and ``$(`` requires ``)``, in the same value. xacro reports an invalid
    expression.
    """
    quick = rb"\$(?:\{[^}\"'<]*|\([^)\"'<]*)[\"'<]"
    for element, match, at in _find_matches(document, description, _OPEN, quick):
        close = "}" if match[0].startswith("${") else ")"
        yield Problem(element, f"'{match[0][:40]}' is not closed; write '{close}'", at=at)
