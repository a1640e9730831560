"""What a rule is: a function that looks at a robot and yields what is wrong with it.

The function's name is the rule's, with hyphens. Its docstring is the rule's page: the first line a
fact, then why it hurts. What it wants to see it names as parameters:

``robot``
    The robot as read (``urdftool.model.elements.Robot``).
``document``
    Each file of the source, unexpanded (``urdftool.source.document.Document``).
``description``
    The description with its files and packages (``urdftool.source.description.Description``).
``targets``
    The active targets, a frozenset of names.

Keyword-only parameters are thresholds; the configuration sets them by name.

Two arguments of the decorator say how findings are reported together:

``group="robot"``
    The findings of the rule about one robot are reported as one, with their count and names;
    ``group="repository"`` does so over all robots of one repository. Each finding stays a fact of
    its own for comments, baselines, fixes and variants. ``Problem(group=…)`` gives the sentence
    for several: ``"{count} links have a visual and no collision: {names}"``. Without a sentence,
    the first message is followed by the other names. Problems of the same severity and effects are
    one finding. Where their sentences differ in more than names and numbers,
    ``Problem(alike=…)`` tells them apart.

``caused_by=("placeholder-inertia",)``
    A finding of one of these rules about the same element explains a finding of this rule, which
    is then listed under it. ``Problem(cause=…)`` names another element to look at, and
    ``Problem(caused_by=…)`` other rules, or none.

``of_motion=True``
    What is found matters only for what can move, such as an inertia that is too large: of a link
    that is fixed to the world, and of a fixed joint, a warning becomes an info. Errors stay,
    because readers reject the robot all the same.

A fix is a function below its rule, ``@zero_axis.fix(UNSAFE)``; see :mod:`urdftool.rules.fix`. It
takes what it needs from ``Problem(data=…)``.

A second function, ``@no_root.full``, is asked by ``lint.validate`` in place of the check, where the
check leaves out what keeps a robot from being used: what another rule reports with its cause.

A file of rules that can find something only in robots with certain elements names these in
``APPLIES_TO``, and is not imported for other robots; ``APPLIES_TO = ()`` where the rules look at
nothing themselves, because readers of files report them. ``FILES`` of a family are its files in
reading order. ``python -m tests.rule_table`` writes what is known without importing rules, from
their decorators, to ``table.py``.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field
from types import FunctionType
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from ..diagnostic import Severity
from ..finding import Scope
from ..model.elements import Part, Robot
from ..source.document import Element
from ..source.location import Place

ERROR, WARNING, INFO = Severity.ERROR, Severity.WARNING, Severity.INFO

TARGETS = ("ros1", "ros2", "gazebo-classic", "gz", "mujoco", "pybullet", "moveit")

GAZEBO = ("gazebo-classic", "gz")
ROS = ("ros1", "ros2")

Check = Callable[..., Iterable["Problem"]]
CheckRobot = Callable[["Robot"], Iterable["Problem"]]

SAFE, UNSAFE, BOTH = "safe", "unsafe", "safe or unsafe"
"""Applicability of the fixes of a rule; ``BOTH`` where it depends on the case."""

if TYPE_CHECKING:
    from .fix import MakeFix, MakeFixOfFile, Proposal

    Make = TypeVar("Make", MakeFix, MakeFixOfFile)
else:
    Make = TypeVar("Make")


class Problem:
    """One thing a rule has found.

    Attributes:
        subject: What it is about: a link, a joint, the robot, or an element.
        message: One sentence: what is wrong, with what would be right.
        at: Where; the subject's start tag if None.
        hint: What would mend it, where the message does not say it.
        severity: Instead of the rule's, where it depends on the case.
        group: The sentence for several such problems, with ``{count}`` and ``{names}``, for a rule
            that groups them; see the module's docstring.
        cause: The element that a finding which explains this one is about; None for the subject.
        caused_by: Instead of the rule's, where it depends on the case.
        effects: Which of the rule's effects hold, by their keys, where that depends on the case;
            None for those whose key names no case.
        alike: What problems that are reported as one have in common, where their sentences differ
            in more than names and numbers: a text, number, bool or tuple of these.
        data: Values that the rule knows, by name, for fixes and other programs: texts, numbers and
            lists of these. Nothing reads them out of the message.
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
        cause: Part | Element | None = None,
        caused_by: tuple[str, ...] | None = None,
        effects: Collection[str] | None = None,
        alike: object = None,
        data: Mapping[str, Any] | None = None,
    ) -> None:
        """Keep what was found; the place is worked out when it is reported."""
        self.subject = subject
        self.message = message
        self.at = at
        self.hint = hint
        self.severity = severity
        self.group = group
        self.cause = cause
        self.caused_by = caused_by
        self.effects = effects
        self.alike = alike
        self.data: Mapping[str, Any] = data or {}

    @property
    def place(self) -> Place:
        """The bytes it is about."""
        at = self.subject if self.at is None else self.at
        return at if isinstance(at, Place) else at.place

    @property
    def kind(self) -> str:
        """``link``, ``joint``, … : the tag of the subject."""
        subject = self.subject
        if isinstance(subject, Part) and subject.xml is None:
            return type(subject).__name__.lower()
        return self.element.tag

    @property
    def name(self) -> str:
        """The subject's name; empty where it has none."""
        subject = self.subject
        if isinstance(subject, Part) and subject.xml is None:
            return getattr(subject, "name", "") or ""
        return self.element.attributes.get("name", "")

    @property
    def element(self) -> Element:
        """The element of the subject."""
        return _element_of(self.subject)

    @property
    def owner(self) -> str:
        """Name of the nearest named element around a subject without a name."""
        element: Element | None = self.element
        while element is not None:
            name = element.attributes.get("name") or element.attributes.get("reference")
            if name:
                return name
            element = element.parent
        return ""

    @property
    def cause_element(self) -> Element:
        """The element that a finding which explains this one is about."""
        return _element_of(self.subject if self.cause is None else self.cause)


def _element_of(subject: Part | Element) -> Element:
    return subject if isinstance(subject, Element) else subject.element


class FixTraits(NamedTuple):
    """Facts about the fix of a rule, known without importing the rule.

    Attributes:
        applicability: ``SAFE``, ``UNSAFE`` or ``BOTH``.
        of_file: Whether it edits the bytes of a file that could not be read or expanded, and takes
            the finding in place of a problem.
        writes_meshes: Whether it writes mesh files, which ``--fix-meshes`` asks for.
        renames: Whether it changes names that other fixes refer to; it is tried apart from them.
    """

    applicability: str
    of_file: bool = False
    writes_meshes: bool = False
    renames: bool = False

    @property
    def option(self) -> str:
        """Options of ``lint`` that apply it: ``--fix --unsafe-fixes``."""
        unsafe = " --unsafe-fixes" if self.applicability == UNSAFE else ""
        return f"--fix{unsafe}" + (" --fix-meshes" if self.writes_meshes else "")

    @property
    def described(self) -> str:
        """Applicability, with the options in parentheses."""
        meshes = " --fix-meshes" if self.writes_meshes else ""
        safe, unsafe = f"(--fix{meshes})", f"(--fix --unsafe-fixes{meshes})"
        if self.applicability == BOTH:
            return f"safe {safe} in some cases, unsafe {unsafe} in others"
        return f"safe {safe}" if self.applicability == SAFE else f"unsafe {unsafe}"


@dataclass
class Rule:
    """A rule, as the engine sees it.

    Attributes:
        name: Such as ``zero-axis``.
        family: Such as ``joint``.
        check: The function.
        severity: How much it matters where no target says otherwise.
        on: Targets it is on for; None means always.
        raised: Severity by target, where it matters more there.
        effects: What a reader does with the defect, by target or reader, with a case in
            parentheses where another case of the same reader differs.
        default: Whether it is on without being selected.
        needs: The names of the parameters it wants.
        thresholds: Its thresholds with their defaults.
        group: What its findings are reported once for; None where each is reported.
        caused_by: Rules whose finding about the same element explains one of this rule.
        of_motion: Whether it matters only for what can move: of a link that is fixed to the world,
            or of a fixed joint, a warning of it is an info.
        make_fix: Proposes changes for a problem, or None where this case is not fixed; None where
            the rule has no fix.
        fix_traits: Facts about that.
        full_check: A check of a robot that reports every case, each at its own part; None where
            ``check`` does.
    """

    name: str
    family: str
    check: Check
    severity: Severity
    on: tuple[str, ...] | None = None
    raised: Mapping[str, Severity] = field(default_factory=dict)
    effects: Mapping[str, str] = field(default_factory=dict)
    default: bool = True
    needs: tuple[str, ...] = ()
    thresholds: Mapping[str, Any] = field(default_factory=dict)
    group: Scope | None = None
    caused_by: tuple[str, ...] = ()
    of_motion: bool = False
    make_fix: Callable[..., Proposal | None] | None = None
    fix_traits: FixTraits | None = None
    full_check: CheckRobot | None = None

    def full(self, check: CheckRobot) -> CheckRobot:
        """Make a function the full check of this rule.

        It takes the robot alone, and leaves out neither the cases that another rule reports with
        their cause nor the parts that one finding of ``lint`` stands for. ``lint.validate`` asks it
        whether a robot can be used.
        """
        self.full_check = check
        return check

    def fix(
        self,
        applicability: str,
        *,
        of_file: bool = False,
        writes_meshes: bool = False,
        renames: bool = False,
    ) -> Callable[[Make], Make]:
        """Make a function the fix of this rule; the arguments are those of :class:`FixTraits`."""

        def register(make: Make) -> Make:
            self.make_fix = make
            self.fix_traits = FixTraits(applicability, of_file, writes_meshes, renames)
            return make

        return register

    @property
    def fact(self) -> str:
        """The first line of its page."""
        return (self.check.__doc__ or "").partition("\n")[0].strip()

    def keys_in(self, keys: Collection[str] | None) -> list[str]:
        """Select the keys of its effects that hold.

        Args:
            keys: Keys of the effects; None for all whose key names no case.
        """
        return [key for key in self.effects if (" (" not in key if keys is None else key in keys)]

    def effects_in(self, keys: Collection[str] | None) -> dict[str, str]:
        """Select the effects with these keys, and leave the case out of them.

        Args:
            keys: Keys of the effects; None for all that hold in every case.
        """
        return {key.partition(" (")[0]: self.effects[key] for key in self.keys_in(keys)}

    def severity_for(self, targets: frozenset[str]) -> Severity:
        """How much it matters for a set of targets."""
        raised = [severity for target, severity in self.raised.items() if target in targets]
        return max([self.severity, *raised])

    def is_on_for(self, targets: frozenset[str]) -> bool:
        """Whether it speaks of any of the targets."""
        return self.on is None or not targets.isdisjoint(self.on)


def holding(effects: Iterable[str], *conditions: str) -> list[str]:
    """Select the keys of effects that hold: those in whose parentheses is no other condition.

    Args:
        effects: Keys such as ``mujoco (in a joint, too many numbers)``.
        conditions: What holds in a case: ``in a joint``.
    """
    found = []
    for key in effects:
        needed = key.partition(" (")[2].removesuffix(")")
        if not needed or set(needed.split(", ")) <= set(conditions):
            found.append(key)
    return found


def rule(
    severity: Severity,
    *,
    on: tuple[str, ...] | None = None,
    raised: Mapping[str, Severity] | None = None,
    effects: Mapping[str, str] | None = None,
    default: bool = True,
    group: Scope | None = None,
    caused_by: tuple[str, ...] = (),
    of_motion: bool = False,
) -> Callable[[Any], Rule]:
    """Make a rule of a function; the arguments are those of :class:`Rule`."""

    def make(check: FunctionType) -> Rule:
        code = check.__code__
        family = check.__module__.split(".")[-2]
        return Rule(
            name=check.__name__.replace("_", "-"),
            family=family,
            check=check,
            severity=severity,
            on=on,
            raised=raised or {},
            effects=effects or {},
            default=default,
            needs=code.co_varnames[: code.co_argcount],
            thresholds=check.__kwdefaults__ or {},
            group=group,
            caused_by=caused_by,
            of_motion=of_motion,
        )

    return make
