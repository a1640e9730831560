"""Define rules: functions that check a robot and yield problems.

The function's name is the rule's, with hyphens. Its docstring is the rule's page: the first line is
a fact; the consequences and the remedy follow. Its parameters name what it needs:

``robot``
    The robot as read (``urdftool.model.elements.Robot``).
``document``
    Each file of the source, unexpanded (``urdftool.source.document.Document``).
``description``
    The description with its files and packages (``urdftool.source.description.Description``).
``targets``
    The active targets, a frozenset of names.

Keyword-only parameters are thresholds; the configuration sets them by name.

Arguments of the decorator control how findings are reported together:

``group="robot"``
    The findings of the rule about one robot are reported as one, with their count and names;
    ``group="repository"`` does so over all robots of one repository. Comments, baselines, fixes
    and variants still treat each finding by itself. ``Problem(group=…)`` is the message for
    several: ``"{count} links have a visual but no collision: {names}"``. Without it, the other
    names follow the first message. Problems with the same severity, effects and
    ``Problem(alike=…)`` are one finding. Without the argument, more than ``lint.group.FEW``
    warnings or infos of the rule about one robot are one finding, and errors never.

``caused_by=("placeholder-inertia",)``
    A finding of one of these rules about the same element explains a finding of this rule, which
    is then listed under it, and not fixed before it. ``Problem(cause=…)`` names another element, or
    all elements whose values this finding reads, and ``Problem(caused_by=…)`` other rules, or none.

``evidence="…"``
    What shows that the defect does harm, if no effect on a reader does: what was measured, or a
    public report. Effects, judged findings and this text are the table of evidence in
    docs/rules/index.md; a rule on by default needs one of them.

``pedantic="robots without …"``
    Cases of the rule that are off by default, because most findings of this kind were judged as
    noise: ``Problem(pedantic=True)``. ``lint --extend-select RULE`` reports them, and
    ``--extend-select pedantic`` those of all rules, with the rules that are off by default.

``of_motion=True``
    The problem matters only for moving parts, such as an inertia that is too large: for links that
    are fixed to the world, and for fixed joints, a warning becomes an info. Where no joint moves
    and nothing collides, as in a marker, it is off by default. Errors stay, because readers reject
    the robot anyway.

``formats=ANY_FORMAT``
    The rule also applies to robots of other formats: it uses ``element`` of no part, and its
    messages hold in each of them. Effects and fixes are those of URDF, and are left out.

A fix is a function after its rule, ``@zero_axis.fix(UNSAFE)``; see :mod:`urdftool.rules.fix`. It
takes its values from ``Problem(data=…)``.

``lint.validate`` calls a second function, ``@no_root.full``, in place of a check that skips cases
in which a robot cannot be used, because another rule reports these with their cause.

A file of rules that apply only to robots with certain elements lists these in ``APPLIES_TO``, and
is not imported for other robots; ``APPLIES_TO = ()`` if readers of files report the problems
themselves. ``FILES`` of a family lists its files in reading order. ``python -m tests.rule_table``
writes the facts about rules that are known without importing them to ``table.py``.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field
from types import FunctionType
from typing import TYPE_CHECKING, Any, TypeVar

from ..diagnostic import Severity
from ..finding import Scope
from ..source.description_formats import NAMES
from .fix_traits import BOTH as BOTH
from .fix_traits import SAFE as SAFE
from .fix_traits import UNSAFE as UNSAFE
from .fix_traits import FixTraits as FixTraits
from .problem import Problem as Problem

ERROR, WARNING, INFO = Severity.ERROR, Severity.WARNING, Severity.INFO

GAZEBO = ("gazebo-classic", "gz")
ROS = ("ros1", "ros2")

ANY_FORMAT = NAMES
URDF_AND_SDF = ("urdf", "sdf")

Check = Callable[..., Iterable[Problem]]
CheckRobot = Callable[["Robot"], Iterable[Problem]]

if TYPE_CHECKING:
    from ..model.elements import Robot
    from .fix import MakeFix, MakeFixOfFile, Proposal

    Make = TypeVar("Make", MakeFix, MakeFixOfFile)
else:
    Make = TypeVar("Make")


@dataclass
class Rule:
    """A rule for the engine.

    Attributes:
        name: Such as ``zero-axis``.
        family: Such as ``joint``.
        check: The function.
        severity: Severity for targets that are not in ``raised``.
        on: Targets for which it is enabled; None means always.
        raised: Severity by target, if it is higher there.
        effects: Behavior of a reader on the defect, by target or reader, with a case in
            parentheses if another case of the same reader differs.
        default: Whether it is enabled without being selected.
        pedantic: Cases that are off by default, as the end of a sentence; empty if there are none.
        infos: Whether its infos are on by default, where the rule is on: only of rules whose infos
            readers of real robots found useful (measure/precision).
        needs: Names of the parameters that it requires.
        thresholds: Its thresholds with their defaults.
        group: Scope in which its findings are reported as one; None if each is reported.
        caused_by: Rules whose finding about the same element explains one of this rule.
        of_motion: Whether it matters only for moving parts: for a link that is fixed to the world,
            or for a fixed joint, a warning is an info, and off by default for a marker.
        formats: Names of the formats to which it applies.
        evidence: What shows that the defect does harm, in addition to effects; empty if nothing.
        make_fix: Proposes changes for a problem, or None for cases that it does not fix; None if
            the rule has no fix.
        fix_traits: Facts about the fix.
        rests_on: Rules that doubt values from which its fix computes others: the fix waits until
            these report nothing about the subject, as for the rules of ``caused_by``.
        full_check: Check of a robot that reports every case, each at its own part; None if
            ``check`` does so.
    """

    name: str
    family: str
    check: Check
    severity: Severity
    on: tuple[str, ...] | None = None
    raised: Mapping[str, Severity] = field(default_factory=dict)
    effects: Mapping[str, str] = field(default_factory=dict)
    default: bool = True
    pedantic: str = ""
    infos: bool = False
    needs: tuple[str, ...] = ()
    thresholds: Mapping[str, Any] = field(default_factory=dict)
    group: Scope | None = None
    caused_by: tuple[str, ...] = ()
    of_motion: bool = False
    formats: tuple[str, ...] = ("urdf",)
    evidence: str = ""
    make_fix: Callable[..., Proposal | None] | None = None
    fix_traits: FixTraits | None = None
    rests_on: tuple[str, ...] = ()
    full_check: CheckRobot | None = None

    def full(self, check: CheckRobot) -> CheckRobot:
        """Make a function the full check of this rule.

        It takes only the robot. It includes the cases that another rule reports with their cause,
        and all parts that one finding of ``lint`` summarizes. ``lint.validate`` uses it to decide
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
        reveals: bool = False,
        rests_on: tuple[str, ...] = (),
    ) -> Callable[[Make], Make]:
        """Make a function the fix; arguments as in :class:`FixTraits`, and ``rests_on``."""

        def register(make: Make) -> Make:
            self.make_fix = make
            self.fix_traits = FixTraits(applicability, of_file, writes_meshes, renames, reveals)
            self.rests_on = rests_on
            return make

        return register

    @property
    def fact(self) -> str:
        """First line of its page."""
        return (self.check.__doc__ or "").partition("\n")[0].strip()

    def select_keys(self, keys: Collection[str] | None) -> list[str]:
        """Select the keys of the effects that hold.

        Args:
            keys: Keys of the effects; None for all whose key names no case.
        """
        return [key for key in self.effects if (" (" not in key if keys is None else key in keys)]

    def select_effects(self, keys: Collection[str] | None) -> dict[str, str]:
        """Select the effects with these keys, without the case in the key.

        Args:
            keys: Keys of the effects; None for all that hold in every case.
        """
        return {key.partition(" (")[0]: self.effects[key] for key in self.select_keys(keys)}

    def get_severity(self, targets: frozenset[str]) -> Severity:
        """Get the severity for a set of targets."""
        raised = [severity for target, severity in self.raised.items() if target in targets]
        return max([self.severity, *raised])

    def is_enabled_for(self, targets: frozenset[str]) -> bool:
        """Tell whether the rule is enabled for any of the targets."""
        return self.on is None or not targets.isdisjoint(self.on)


def select_holding(effects: Iterable[str], *conditions: str) -> list[str]:
    """Select the keys of effects that hold: without other conditions in parentheses.

    Args:
        effects: Keys such as ``mujoco (in a joint, too many numbers)``.
        conditions: Conditions that a case satisfies: ``in a joint``.
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
    pedantic: str = "",
    infos: bool = False,
    group: Scope | None = None,
    caused_by: tuple[str, ...] = (),
    of_motion: bool = False,
    formats: tuple[str, ...] = ("urdf",),
    evidence: str = "",
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
            pedantic="; ".join(filter(None, (pedantic, "infos")))
            if severity is INFO and not infos
            else pedantic,
            infos=infos,
            needs=code.co_varnames[: code.co_argcount],
            thresholds=check.__kwdefaults__ or {},
            group=group,
            caused_by=caused_by,
            of_motion=of_motion,
            formats=formats,
            evidence=evidence,
        )

    return make
