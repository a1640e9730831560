"""Describe fixes as changes to elements of the expanded robot.

A fix follows its rule in the same file::

    @zero_axis.fix(UNSAFE)
    def write_z_axis(problem: Problem, context: FixContext) -> Proposal | None:

It takes its values from ``problem.data``, never from the message, and returns None for cases that
it does not fix. Changes name elements of the expanded robot; :mod:`urdftool.lint.fix_settle`
determines their bytes in the source, and whether they may change. Helpers that read the source as
written (:func:`is_computed`, :func:`may_vary`) parse it only when called.

A fix is *safe* if all readers of the robot have the same kinematics, masses, inertia, collision
geometry, limits and control afterwards, or could not read them before;
``tests/lint/test_fix_safe.py`` loads robots before and after. All others are *unsafe*: they add or
remove physical properties, guess the intention, change what one reader loads, or remove comments.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from ..diagnostic import FileRewrite, Severity
from ..finding import Finding
from ..model.elements import Joint, Link, Robot
from ..source.description import Description
from ..source.document import Document, Element
from ..source.escape import escape_attribute as escape_attribute
from ..source.location import Place, SourceFile
from ..workspace import Workspace
from .problem import Problem
from .words import fold

if TYPE_CHECKING:
    from ..mechanics.tensor import SymmetricTensor
    from ..model.elements import Vector

    ComputeInertia = Callable[
        [Robot, Sequence[str]], "dict[str, tuple[float, Vector, SymmetricTensor]]"
    ]
else:
    ComputeInertia = Callable

Lines = tuple[str, ...]
"""Lines of an element to write; each level of nesting is indented by one tab."""


class Change(NamedTuple):
    """One change to one element.

    Attributes:
        kind: ``set``, ``unset``, ``rename`` (an attribute), ``retag``, ``text``, ``remove``,
            ``insert`` (a child, last), ``first`` (a child, first), ``after``, ``replace``,
            ``sub`` (in an attribute as written), ``sub-text``.
        element: The element.
        name: The attribute.
        value: New value, tag or text; the replacement for a pattern.
        pattern: Regular expression of ``sub`` and ``sub-text``.
        blocks: Elements to write.
    """

    kind: str
    element: Element
    name: str = ""
    value: str = ""
    pattern: str = ""
    blocks: tuple[Lines, ...] = ()

    @property
    def what(self) -> tuple[Any, ...]:
        """All fields but the element."""
        return self.kind, self.name, self.value, self.pattern, self.blocks


class RefusedError(Exception):
    """A change cannot be made; the text is the reason."""


class OutsideError(RefusedError):
    """The file to change is outside of the package; the text names both."""


class Span(NamedTuple):
    """Bytes of a file to replace, without reference to an element."""

    file: SourceFile
    start: int
    end: int
    data: bytes


@dataclass(frozen=True)
class Proposal:
    """Changes that fix a problem.

    Attributes:
        safe: As in :class:`~urdftool.finding.Fix`.
        message: Description of the changes: ``write xyz="0 0 1"``.
        changes: All of them are made, or none.
    """

    safe: bool
    message: str
    changes: tuple[Change | Span | FileRewrite, ...]


@dataclass
class FixContext:
    """Information for fixes in addition to the problem.

    Attributes:
        robot: The robot.
        description: The description with its files.
        targets: Active targets.
        document: Source file, for rules that check each file.
        compute_inertia: Computes mass properties of links from their meshes; None if mesh sizes
            are unreliable.
        severity: Severity of the finding.
    """

    robot: Robot
    description: Description
    targets: frozenset[str]
    document: Document | None = None
    compute_inertia: ComputeInertia | None = None
    severity: Severity = Severity.ERROR

    _nearby: list[Any] | None = None

    @property
    def workspace(self) -> Workspace:
        """The reader of the description's files."""
        return self.description.workspace

    def list_nearby(self, look: Callable[[FixContext], list[Any]]) -> list[Any]:
        """List the files near the description; cached."""
        if self._nearby is None:
            self._nearby = look(self)
        return self._nearby

    @cached_property
    def texts(self) -> str:
        """Text of all elements, where plugins and sensors refer to names."""
        return "\n".join(one.text for one in self.robot.element.walk() if one.text)

    def get_joint(self, problem: Problem) -> Joint:
        """Get the joint that a problem is about."""
        assert isinstance(problem.subject, Joint)
        return problem.subject

    def get_link(self, problem: Problem) -> Link:
        """Get the link that a problem is about."""
        assert isinstance(problem.subject, Link)
        return problem.subject


MakeFix = Callable[[Problem, FixContext], Proposal | None]
MakeFixOfFile = Callable[[Finding, FixContext], Proposal | None]


def safe(message: str, *changes: Change | Span | FileRewrite) -> Proposal:
    """Propose a safe fix."""
    return Proposal(True, message, changes)


def unsafe(message: str, *changes: Change | Span | FileRewrite) -> Proposal:
    """Propose an unsafe fix."""
    return Proposal(False, message, changes)


def set_attribute(element: Element, name: str, value: str) -> Change:
    """Set an attribute."""
    return Change("set", element, name, value)


def remove_attribute(element: Element, name: str) -> Change:
    """Remove an attribute."""
    return Change("unset", element, name)


def rename_attribute(element: Element, name: str, new: str) -> Change:
    """Rename an attribute."""
    return Change("rename", element, name, new)


def rename_element(element: Element, tag: str) -> Change:
    """Change the tag of an element."""
    return Change("retag", element, value=tag)


def set_text(element: Element, text: str) -> Change:
    """Set the text of an element without children."""
    return Change("text", element, value=text)


def remove_element(element: Element) -> Change:
    """Remove an element."""
    return Change("remove", element)


def append_child(parent: Element, *lines: str) -> Change:
    """Add an element as the last child of another."""
    return Change("insert", parent, blocks=(lines,))


def prepend_child(parent: Element, *lines: str) -> Change:
    """Add an element as the first child of another."""
    return Change("first", parent, blocks=(lines,))


def insert_after(element: Element, *lines: str) -> Change:
    """Add an element after another."""
    return Change("after", element, blocks=(lines,))


def replace_element(element: Element, *blocks: Lines) -> Change:
    """Replace an element by others."""
    return Change("replace", element, blocks=blocks)


def substitute(element: Element, name: str, pattern: str, new: str) -> Change:
    """Replace matches of a pattern in an attribute as written, expressions included."""
    return Change("sub", element, name, new, pattern)


OUTER_BLANKS = r"^\s+|(?<!\s)\s+$"
"""Pattern of blanks around a value, which reads a long row of blanks inside of it once."""


def substitute_text(element: Element, pattern: str, new: str) -> Change:
    """Replace matches of a pattern in the text of an element as written."""
    return Change("sub-text", element, value=new, pattern=pattern)


def find_attribute(problem: Problem, root: Element | None = None) -> tuple[Element, str] | None:
    """Find the element and attribute that a problem points at.

    Returns:
        None if it points at no attribute.
    """
    found = find_element(problem, root)
    if found is None:
        return None
    start = problem.place.start
    for name, span in found.file.locate_attributes(found.start).items():
        if span[0] == start:
            return found, name
    return None


def find_element(problem: Problem, root: Element | None = None) -> Element | None:
    """Find the element whose start tag a problem points into.

    Args:
        problem: The problem.
        root: Element to search; that of the problem's subject if None.
    """
    at = problem.at
    if isinstance(at, Element):
        return at
    if at is not None and not isinstance(at, Place):
        return at.element
    place = problem.place
    around = problem.element if root is None else root
    if place.start >= place.end:
        return None
    nearest: Element | None = None
    least = -1
    for element in around.walk():  # tags do not overlap: only the last one before can contain it
        if least < element.start <= place.start and element.file is place.file:
            if element.calls == place.calls:
                nearest, least = element, element.start
    if nearest is None or place.start >= nearest.file.find_tag_end(least):
        return None
    return nearest


def remove_sign(problem: Problem, _context: object = None) -> Proposal | None:
    """Propose to remove the minus sign of the attribute that a problem points at."""
    found = find_attribute(problem)
    if found is None:
        return None
    element, name = found
    text = (element.get(name) or "").strip().removeprefix("-")
    return unsafe(f'write {name}="{text}"', set_attribute(element, name, text))


def get_suggestion(problem: Problem, wrong: str) -> str:
    """Get the name that a rule suggests (``data["suggestion"]``), if it is close enough."""
    right: str = problem.data.get("suggestion", "")
    return right if right and is_close_enough(right, wrong) else ""


def write_suggestion(problem: Problem, _context: object = None) -> Proposal | None:
    """Write the suggested name into the attribute or text that a problem points at."""
    found = find_attribute(problem)
    if found is not None:
        name = get_suggestion(problem, found[0].get(found[1]) or "")
        return unsafe(f"write {name}", set_attribute(*found, name)) if name else None
    element = find_element(problem)
    name = get_suggestion(problem, element.text.strip()) if element is not None else ""
    if element is None or not name:
        return None
    return unsafe(f"write {name}", set_text(element, name))


def append_number(problem: Problem, taken: Container[str | None]) -> Proposal | None:
    """Append a number to the name that a problem points at."""
    found = find_attribute(problem)
    if found is None:
        return None
    name, number = (found[0].get(found[1]) or "").strip(), 2
    while f"{name}_{number}" in taken:
        number += 1
    change = substitute(*found, r"(?<=\S)(?=\s*$)", f"_{number}")
    return unsafe(f"rename it to '{name}_{number}'", change)


def is_close_enough(right: str, wrong: str) -> bool:
    """Tell whether a suggested word is close enough for a fix.

    It must be closer than for a question: at most two typos, and none in a digit.
    """
    from .xml.vocabulary_table import suggest_word

    if fold(right) == fold(wrong):
        return True
    return re.findall(r"\d+", right) == re.findall(r"\d+", wrong) and bool(
        suggest_word(wrong, [right])
    )


def write_inside(
    finding: Finding, old: str, new: str, *, harmless: bool = False
) -> Proposal | None:
    """Replace a word that occurs once in the bytes of a finding's place."""
    place, file = finding.location, finding.location.file
    written = file.data[place.start : place.end]
    if written.count(old.encode()) != 1:
        return None
    start = place.start + written.index(old.encode())
    span = Span(file, start, start + len(old.encode()), new.encode())
    return Proposal(harmless, f"write {new}", (span,))


def format_numbers(values: Iterable[float], digits: int = 9) -> str:
    """Format numbers with a maximum of significant digits, and without ``-0``."""
    return " ".join(f"{value + 0.0:.{digits}g}" for value in values)


def _find_as_written(element: Element) -> Element | None:
    """Return an element in the source without expansion; None if it is not written there."""
    from ..source.edit import parse_source

    return parse_source(element.file).elements.get(element.start)


def get_written_value(element: Element, name: str) -> str:
    """Get an attribute as written, expressions included."""
    from ..source.edit import read_literal

    raw = _find_as_written(element)
    return (read_literal(raw, name) if raw is not None else None) or element.get(name) or ""


def get_written_text(element: Element) -> str:
    """Get the text of an element as written, expressions included."""
    raw = _find_as_written(element)
    return (raw.text if raw is not None else element.text).strip()


def is_computed(element: Element, name: str = "name") -> bool:
    """Tell whether an attribute comes from an expression, which arguments may change."""
    return "$" in get_written_value(element, name)


def may_vary(element: Element) -> bool:
    """Tell whether other arguments may give an element other children."""
    raw = _find_as_written(element)
    return raw is None or any(one.tag.startswith("xacro:") for one in raw.walk())


def is_always_there(element: Element) -> bool:
    """Tell whether an element exists exactly once for all arguments."""
    raw = _find_as_written(element)
    if raw is None or any(call.macro for call in element.calls):
        return False
    parent = raw.parent
    while parent is not None and not parent.tag.startswith("xacro:"):
        parent = parent.parent
    return parent is None


def is_written_inside(inner: Element, outer: Element) -> bool:
    """Tell whether an element is written inside another, not inserted by a macro call."""
    raw = _find_as_written(outer)
    return raw is not None and inner.file is outer.file and raw.start <= inner.start < raw.end


def depends_on_arguments(element: Element, *parts: str) -> bool:
    """Tell whether an element comes from a macro, and its content from the call's arguments.

    Args:
        element: The element.
        parts: Tags of the children that matter, with their descendants; all children if none.
    """
    if not any(call.macro for call in element.calls):
        return False
    for child in element.children:
        if parts and child.tag not in parts:
            continue
        for one in child.walk():
            if not is_written_inside(one, element):
                return True
            if any(is_computed(one, name) for name in one.attributes):
                return True
    return False


def are_equal_elements(a: Element, b: Element) -> bool:
    """Tell whether two elements have the same tag, attributes, text and children."""
    return (
        (a.tag, a.attributes, a.text.split()) == (b.tag, b.attributes, b.text.split())
        and len(a.children) == len(b.children)
        and all(map(are_equal_elements, a.children, b.children))
    )


def get_written_lines(element: Element) -> Iterator[str]:
    """Get the lines of an element as written, comments and expressions included.

    Yields:
        Lines, indented by one tab per level.
    """
    from ..source.edit import parse_source

    source = parse_source(element.file)
    raw = source.elements[element.start]
    text = element.file.data[raw.start : raw.end].decode(element.file.encoding)
    own = len((source.get_indentation(raw) or b"").expandtabs(8))
    step = len(source.step.expandtabs(8)) or 2
    head, *rest = text.splitlines()
    yield head
    for line in rest:
        bare = line.lstrip()
        if bare:
            deep = len(line[: len(line) - len(bare)].expandtabs(8)) - own
            yield "\t" * max(0, round(deep / step)) + bare
