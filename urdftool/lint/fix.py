"""What mends the findings of one description: proposals of the rules, as bytes of its source."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from ..extras import missing_library
from ..finding import Finding, Fix, Replacement
from ..model.elements import Robot
from ..rules import get_rule
from ..rules.fix import FixContext, Proposal, RefusedError
from ..rules.rule import Problem
from ..rules.table import FIXES
from ..source.description import Description
from ..source.document import Document
from .fix_settle import Settler
from .outcome import Options, Report


class Origin(NamedTuple):
    """Where a finding came from: the problem, and the file that was looked at, if it was one."""

    problem: Problem
    document: Document | None


DOUBTED_SIZES = frozenset(("mesh-in-millimetres", "mesh-scaled-twice", "mesh-scale-out-of-line"))
"""Rules that doubt how large a mesh is: nothing is weighed by meshes while one of them speaks."""


def add_fixes(
    report: Report,
    findings: Sequence[Finding],
    origins: Mapping[int, Origin],
    robot: Robot | None,
    description: Description,
    options: Options,
) -> None:
    """Give findings their fixes, before the instances of one macro are merged.

    A fixer that breaks is a bug of ours: it is written down with its rule, and the others go on.

    Args:
        report: Where that is written down.
        findings: What was found and is not excused.
        origins: What each came from, by its identity; a file that could not be read has none.
        robot: The robot, if it could be read.
        description: The description.
        options: What the command line says.
    """
    groups: dict[tuple[Any, ...], list[Finding]] = {}
    for finding in findings:
        if finding.rule in FIXES:
            place = finding.place
            key: tuple[Any, ...] = (finding.rule, place.path, place.start, place.end)
            groups.setdefault(key if place.calls else (*key, finding.message), []).append(finding)
    if not groups:
        return
    settler = Settler(description)
    context = FixContext(robot or Robot(description.document.root), description, report.targets)
    if not any(finding.rule in DOUBTED_SIZES for finding in findings):
        context.compute_inertia = options.weigh
    for group in groups.values():
        name = group[0].rule
        try:
            proposals = [_proposal(finding, origins.get(id(finding)), context) for finding in group]
            whole = [proposal for proposal in proposals if proposal is not None]
            if len(whole) < len(proposals) or not whole:
                continue
            replacements, rewrites = settler.settle(whole), settler.rewrites(whole)
        except RefusedError as error:
            report.unmended.append((group[0], str(error)))
            continue
        except Exception as error:
            library = missing_library(error)
            if library is not None:
                report.skipped_fixes[name] = library
                continue
            report.failed_rules[name] = f"its fix: {type(error).__name__}: {error}"
            continue
        if replacements or rewrites:
            safe = all(proposal.safe for proposal in whole) and not _lost_comments(replacements)
            group[0].fix = Fix(safe, whole[0].message, replacements, rewrites)


_COMMENT = re.compile(rb"<!--(?!\s*urdftool-).*?-->", re.DOTALL)


def _lost_comments(replacements: Sequence[Replacement]) -> bool:
    """Whether comments go with what goes: they are the user's, who is asked then."""
    kept = b"".join(replacement.data for replacement in replacements)
    return any(
        comment not in kept
        for place, _ in replacements
        for comment in _COMMENT.findall(place.file.data, place.start, place.end)
    )


def _proposal(finding: Finding, origin: Origin | None, context: FixContext) -> Proposal | None:
    """Ask the rule of a finding for a fix.

    A rule's finding in a file that could not be expanded is fixed by the fixes of files alone.
    """
    if (origin is None) != FIXES[finding.rule].of_file:
        return None
    make = get_rule(finding.rule).make_fix
    assert make is not None, finding.rule
    if origin is None:
        return make(finding, context)
    context.document, context.severity = origin.document, finding.severity
    return make(origin.problem, context)
