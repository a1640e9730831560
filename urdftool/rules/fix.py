"""What a fix is made of: changes to elements, as they are after expansion.

Changes are said of the robot's elements. Where in the source they are made, and whether they may
be, is worked out from what the elements know of their origin.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

from ...finding import Remake, Severity
from ...model.elements import Joint, Link, Robot
from ...source.description import Description
from ...source.document import Document, Element
from ...source.edit import Source, literal, parsed
from ...source.location import Place, SourceFile
from ..fix_table import Weigh
from ..rule import Problem
from ..words import fold
from ..xml.vocabulary_table import meant as the_word_for

Lines = tuple[str, ...]
"""An element to be written: its lines, each level of it indented by one tab."""


class Change(NamedTuple):
    """One change to one element.

    Attributes:
        kind: ``set``, ``unset``, ``rename`` (an attribute), ``retag``, ``text``, ``remove``,
            ``insert`` (a child, last), ``first`` (a child, first), ``after``, ``replace``,
            ``sub`` (in an attribute as it is written), ``sub-text``.
        element: The element.
        name: The attribute.
        value: Its new value, the new tag or text; what a pattern becomes.
        pattern: What is replaced by ``sub``.
        blocks: The elements that come.
    """

    kind: str
    element: Element
    name: str = ""
    value: str = ""
    pattern: str = ""
    blocks: tuple[Lines, ...] = ()

    @property
    def what(self) -> tuple[Any, ...]:
        """All of it but the element."""
        return self.kind, self.name, self.value, self.pattern, self.blocks


class RefusedError(Exception):
    """A change that is not made; its text says why."""


class Span(NamedTuple):
    """Bytes of a file that become others, where no element is concerned."""

    file: SourceFile
    start: int
    end: int
    data: bytes


@dataclass(frozen=True)
class Proposal:
    """What mends a problem.

    Attributes:
        safe: As :class:`~urdftool.finding.Fix`.
        message: What is done, in words.
        changes: All of them are made, or none.
    """

    safe: bool
    message: str
    changes: tuple[Change | Span | Remake, ...]


@dataclass
class Around:
    """What there is to know of the robot.

    Attributes:
        robot: The robot.
        description: The description with its files.
        targets: The active targets.
        document: The file of the source, for rules that look at each.
        weigh: As in the options; None where inertia is not to be computed from meshes.
        severity: How much the finding matters.
    """

    robot: Robot
    description: Description
    targets: frozenset[str]
    document: Document | None = None
    weigh: Weigh | None = None
    severity: Severity = Severity.ERROR

    _nearby: list[Any] | None = None

    def nearby(self, look: Callable[[Around], list[Any]]) -> list[Any]:
        """The files around the description, listed once."""
        if self._nearby is None:
            self._nearby = look(self)
        return self._nearby

    @cached_property
    def texts(self) -> str:
        """All texts of the robot's elements, where plugins and sensors name things."""
        return "\n".join(one.text for one in self.robot.element.walk() if one.text)

    def joint(self, problem: Problem) -> Joint:
        """The joint a problem is about."""
        assert isinstance(problem.subject, Joint)
        return problem.subject

    def link(self, problem: Problem) -> Link:
        """The link a problem is about."""
        assert isinstance(problem.subject, Link)
        return problem.subject


def safe(message: str, *changes: Change | Span | Remake) -> Proposal:
    """A proposal of a safe fix."""
    return Proposal(True, message, changes)


def unsafe(message: str, *changes: Change | Span | Remake) -> Proposal:
    """A proposal of an unsafe fix."""
    return Proposal(False, message, changes)


def put(element: Element, name: str, value: str) -> Change:
    """Give an attribute a value."""
    return Change("set", element, name, value)


def drop(element: Element, name: str) -> Change:
    """Take an attribute away."""
    return Change("unset", element, name)


def rename(element: Element, name: str, new: str) -> Change:
    """Call an attribute otherwise."""
    return Change("rename", element, name, new)


def retag(element: Element, tag: str) -> Change:
    """Call an element otherwise."""
    return Change("retag", element, value=tag)


def say(element: Element, text: str) -> Change:
    """Give an element without children another text."""
    return Change("text", element, value=text)


def remove(element: Element) -> Change:
    """Take an element away."""
    return Change("remove", element)


def insert(parent: Element, *lines: str) -> Change:
    """Put an element into another, as the last of its children."""
    return Change("insert", parent, blocks=(lines,))


def first(parent: Element, *lines: str) -> Change:
    """Put an element into another, in front of its children."""
    return Change("first", parent, blocks=(lines,))


def after(element: Element, *lines: str) -> Change:
    """Put an element behind another."""
    return Change("after", element, blocks=(lines,))


def replace(element: Element, *blocks: Lines) -> Change:
    """Put elements in the place of another."""
    return Change("replace", element, blocks=blocks)


def sub(element: Element, name: str, pattern: str, new: str) -> Change:
    """Replace what a pattern finds in an attribute as it is written, expressions and all."""
    return Change("sub", element, name, new, pattern)


def sub_text(element: Element, pattern: str, new: str) -> Change:
    """The same in the text of an element."""
    return Change("sub-text", element, value=new, pattern=pattern)


def attribute_at(problem: Problem, root: Element | None = None) -> tuple[Element, str] | None:
    """The element and attribute that a problem points at; None where it points at neither."""
    found = element_at(problem, root)
    if found is None:
        return None
    start = problem.place.start
    for name, span in found.file.attribute_spans(found.start).items():
        if span[0] == start:
            return found, name
    return None


def element_at(problem: Problem, root: Element | None = None) -> Element | None:
    """The element whose start tag a problem points into."""
    at = problem.at
    if isinstance(at, Element):
        return at
    if at is not None and not isinstance(at, Place):
        return at.element
    place = problem.place
    around = problem.element if root is None else root
    for element in around.walk():
        if element.file is place.file and element.start <= place.start < place.end:
            if place.start < element.file.tag_end(element.start) and element.calls == place.calls:
                return element
    return None


_MEANT = re.compile(r"did you mean '([^']*)'\?")
_WRITE = re.compile(r"; write '?<?([^\s'<>,;]+?)>?'?(?:$|[,;])")


def meant(problem: Problem, wrong: str) -> str:
    """What a message asks whether it was meant; empty where it does not, or it is far-fetched.

    For a fix it must be nearer than for a question: a slip or two, and none in a digit.

    Args:
        problem: What says so.
        wrong: What is written.
    """
    match = _MEANT.search(problem.message)
    if match is None:
        return ""
    right = match[1]
    if fold(right) == fold(wrong):
        return right
    if re.findall(r"\d+", right) != re.findall(r"\d+", wrong):
        return ""
    return right if the_word_for(wrong, [right]) else ""


def to_write(problem: Problem) -> str:
    """The one word that a message says to write; empty where it says no such thing."""
    match = _WRITE.search(problem.message)
    return match[1] if match else ""


def figures(values: Iterable[float], digits: int = 9) -> str:
    """Numbers as text: no more digits than wanted, and no ``-0``."""
    return " ".join(f"{value + 0.0:.{digits}g}" for value in values)


def quote(text: str) -> str:
    """Text for an attribute in double quotes, or between tags."""
    for plain, written in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ('"', "&quot;")):
        text = text.replace(plain, written)
    return text


def written(element: Element, name: str) -> str:
    """An attribute as it is written, expressions and all: for what is put beside it."""
    raw = source_of(element.file).elements.get(element.start)
    return (literal(raw, name) if raw is not None else None) or element.get(name) or ""


def is_computed(element: Element, name: str = "name") -> bool:
    """Whether an attribute comes from an expression, so that it is another with other arguments."""
    return "$" in written(element, name)


def may_vary(element: Element) -> bool:
    """Tell whether other arguments may put other children into an element than it has now."""
    raw = source_of(element.file).elements.get(element.start)
    return raw is None or any(one.tag.startswith("xacro:") for one in raw.walk())


def is_always_there(element: Element) -> bool:
    """Tell whether an element is there whatever the arguments are, and once."""
    raw = source_of(element.file).elements.get(element.start)
    if raw is None or any(call.macro for call in element.calls):
        return False
    parent = raw.parent
    while parent is not None and not parent.tag.startswith("xacro:"):
        parent = parent.parent
    return parent is None


def stands_in(inner: Element, outer: Element) -> bool:
    """Whether an element is written inside another, and not put there by a call."""
    raw = source_of(outer.file).elements.get(outer.start)
    return raw is not None and inner.file is outer.file and raw.start <= inner.start < raw.end


def depends_on_a_call(element: Element, *parts: str) -> bool:
    """Whether an element comes from a macro, and what is in it from the arguments of its call.

    Args:
        element: The element.
        parts: Tags of what matters in it, with all below them.
    """
    if not any(call.macro for call in element.calls):
        return False
    for child in element.children:
        if parts and child.tag not in parts:
            continue
        for one in child.walk():
            if not stands_in(one, element) or any(is_computed(one, n) for n in one.attributes):
                return True
    return False


def same(a: Element, b: Element) -> bool:
    """Whether two elements say the same."""
    return (
        (a.tag, a.attributes, a.text.split()) == (b.tag, b.attributes, b.text.split())
        and len(a.children) == len(b.children)
        and all(map(same, a.children, b.children))
    )


def lines_of(element: Element) -> Iterator[str]:
    """An element as it is written, comments and expressions and all, for one that comes elsewhere.

    The elements in it are indented by tabs, as many as they are deep.
    """
    source = source_of(element.file)
    raw = source.elements[element.start]
    text = element.file.data[raw.start : raw.end].decode(element.file.encoding)
    own = len((source.indentation(raw) or b"").expandtabs(8))
    step = len(source.step.expandtabs(8)) or 2
    head, *rest = text.splitlines()
    yield head
    for line in rest:
        bare = line.lstrip()
        if bare:
            deep = len(line[: len(line) - len(bare)].expandtabs(8)) - own
            yield "\t" * max(0, round(deep / step)) + bare


@lru_cache(maxsize=8)
def source_of(file: SourceFile) -> Source:
    """A file as it is written, parsed once for all that ask.

    Raises:
        SourceError: It is in an encoding that is not edited.
    """
    return parsed(file)
