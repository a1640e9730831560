"""A problem that a rule found, before it is a finding with settings and effects."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from ..diagnostic import Severity
from ..finding import Site
from ..model.part import Part
from ..source.document import Element
from ..source.location import Place


class Problem:
    """A problem that a rule found.

    Attributes:
        subject: The link, joint, robot or element that has the problem.
        message: One sentence: the fact, its consequence and the remedy.
        at: Its place; the subject's start tag if None.
        hint: The remedy, if the message does not give it.
        severity: Replaces the rule's, if it depends on the case.
        group: The message for several such problems, with ``{count}`` and ``{names}``, for a rule
            that groups them; see the module's docstring.
        cause: The subject of the finding that explains this one, or the subjects whose values
            this one reads; None for the same subject.
        caused_by: Replaces the rule's, if it depends on the case.
        effects: Keys of the rule's effects that hold, if that depends on the case; None for those
            whose key names no case.
        pedantic: Whether it is a case of the rule that is off by default; see ``Rule.pedantic``.
        alike: Key of problems that may be reported as one, if their messages differ in more than
            names and numbers: a text, number, bool or tuple of these.
        data: Values by name for fixes and other programs: texts, numbers and lists of these. No
            code extracts them from the message.
    """

    __slots__ = (
        "alike",
        "at",
        "cause",
        "caused_by",
        "data",
        "effects",
        "group",
        "hint",
        "message",
        "pedantic",
        "severity",
        "subject",
    )

    def __init__(
        self,
        subject: Part | Element,
        message: str,
        *,
        at: Part | Element | Place | None = None,
        hint: str = "",
        severity: Severity | None = None,
        group: str = "",
        cause: Part | Element | Sequence[Part | Element] | None = None,
        caused_by: tuple[str, ...] | None = None,
        effects: Collection[str] | None = None,
        pedantic: bool = False,
        alike: object = None,
        data: Mapping[str, Any] | None = None,
    ) -> None:
        """Store the problem; its place is computed when it is reported."""
        self.subject = subject
        self.message = message
        self.at = at
        self.hint = hint
        self.severity = severity
        self.group = group
        self.cause = cause
        self.caused_by = caused_by
        self.effects = effects
        self.pedantic = pedantic
        self.alike = alike
        self.data: Mapping[str, Any] = data or {}

    @property
    def place(self) -> Place:
        """The bytes of the problem."""
        at = self.subject if self.at is None else self.at
        return at if isinstance(at, Place) else at.place

    @property
    def kind(self) -> str:
        """Tag of the subject, such as ``link``."""
        return self.subject.tag

    @property
    def name(self) -> str:
        """The subject's name; empty if it has none."""
        subject = self.subject
        if isinstance(subject, Part) and subject.xml is None:
            return getattr(subject, "name", "") or ""
        return self.element.attributes.get("name", "")

    @property
    def element(self) -> Element:
        """The element of the subject."""
        return self.subject if isinstance(self.subject, Element) else self.subject.element

    @property
    def owner(self) -> str:
        """Name of the nearest named element around a subject without a name."""
        subject = self.subject
        if isinstance(subject, Part) and subject.xml is None:
            return self.name
        element: Element | None = self.element
        while element is not None:
            name = element.attributes.get("name") or element.attributes.get("reference")
            if name:
                return name
            element = element.parent
        return ""

    @property
    def site(self) -> Site:
        """File and first byte of the subject."""
        return _get_site(self.subject)

    @property
    def cause_sites(self) -> tuple[Site, ...]:
        """File and first byte of each subject whose finding explains this one."""
        cause = self.subject if self.cause is None else self.cause
        return tuple(map(_get_site, cause if isinstance(cause, Sequence) else (cause,)))


def _get_site(subject: Part | Element) -> Site:
    element = subject if isinstance(subject, Element) else subject.xml
    at = subject.place if element is None else element
    return at.file.path, at.start
