"""Fixes of the findings of one description: proposals of rules converted to source edits."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from typing import Any, NamedTuple

from ..diagnostic import Fix, Replacement
from ..extras import find_missing_library
from ..finding import Finding, Site
from ..model.elements import Robot
from ..rules import get_rule
from ..rules.fix import FixContext, OutsideError, Proposal, RefusedError
from ..rules.rule import GAZEBO, Problem
from ..rules.table import FIXES
from ..source.comments import list_comments
from ..source.description import Description
from ..source.document import Document
from .fingerprint import get_fact
from .fix_settle import Settler
from .options import Options
from .outcome import Report


class Origin(NamedTuple):
    """Origin of a finding: the problem, and the checked file for rules that check files."""

    problem: Problem
    document: Document | None


DOUBTED_SIZES = frozenset(("mesh-in-millimeters", "mesh-scaled-twice", "mesh-scale-outlier"))
"""Rules that question the size of a mesh; if one reports, no mass is computed from meshes."""


def add_fixes(
    report: Report,
    findings: Sequence[Finding],
    origins: Mapping[int, Origin],
    robot: Robot | None,
    description: Description,
    options: Options,
) -> None:
    """Add fixes to findings, before the instances of a macro are merged.

    An exception in a fixer is a bug of urdftool: it is recorded in ``failed_rules``, and other
    fixes continue.
    """
    groups: dict[tuple[Any, ...], list[Finding]] = {}
    open_findings = {(finding.code, finding.site) for finding in findings}
    for finding in findings:
        if finding.code in FIXES and not (
            _is_waiting(finding, origins.get(id(finding)), open_findings)
            or _is_for_one_generation(finding, report.targets)
        ):
            place = finding.location
            key: tuple[Any, ...] = (finding.code, place.path, place.start, place.end)
            key = key if place.calls else (*key, *get_fact(finding))
            groups.setdefault(key, []).append(finding)
    if not groups:
        return
    settler = Settler(description)
    context = FixContext(robot or Robot(description.document.root), description, report.targets)
    if not any(finding.code in DOUBTED_SIZES for finding in findings):
        context.compute_inertia = options.compute_inertia
    for group in groups.values():
        name = group[0].code
        try:
            proposals = [
                _get_proposal(finding, origins.get(id(finding)), context) for finding in group
            ]
            whole = [proposal for proposal in proposals if proposal is not None]
            if len(whole) < len(proposals) or not whole:
                continue
            replacements, rewrites = settler.settle(whole), settler.get_rewrites(whole)
        except OutsideError as error:
            report.outside.append((group[0], str(error)))
            continue
        except RefusedError as error:
            report.not_fixed.append((group[0], str(error)))
            continue
        except Exception as error:
            library = find_missing_library(error)
            if library is not None:
                report.skipped_fixes[name] = library
                continue
            report.failed_rules[name] = f"its fix: {type(error).__name__}: {error}"
            continue
        if replacements or rewrites:
            safe = all(proposal.safe for proposal in whole) and not _deletes_comments(replacements)
            group[0].fixes = (Fix(safe, whole[0].message, replacements, rewrites),)


def _is_waiting(
    finding: Finding, origin: Origin | None, open_findings: Container[tuple[str, Site | None]]
) -> bool:
    """Tell whether a fix would compute with values of which another finding is open."""
    doubting = get_rule(finding.code).rests_on + (finding.cause.rules if finding.cause else ())
    sites = origin.problem.cause_sites if origin is not None else ()
    return any((rule, site) in open_findings for rule in doubting for site in sites)


def _is_for_one_generation(finding: Finding, targets: frozenset[str]) -> bool:
    """Tell whether a fix is for one of two generations of Gazebo that both are targets."""
    return targets.issuperset(GAZEBO) and get_rule(finding.code).on in (
        ("gz",),
        ("gazebo-classic",),
    )


def _deletes_comments(replacements: Sequence[Replacement]) -> bool:
    """Tell whether the replacements delete comments of the user, which makes a fix unsafe."""
    kept = b"".join(replacement.data for replacement in replacements)
    for place, _ in replacements:
        deleted = place.file.data[place.start : place.end]
        for begin, end in list_comments(deleted):
            comment = deleted[begin:end]
            is_ours = comment[4:].lstrip().startswith(b"urdftool-")
            if not is_ours and comment not in kept:
                return True
    return False


def _get_proposal(finding: Finding, origin: Origin | None, context: FixContext) -> Proposal | None:
    """Return the fix that the rule of a finding proposes.

    Findings without an origin concern files that could not be expanded; only fixes of files
    apply to them.
    """
    if (origin is None) != FIXES[finding.code].of_file:
        return None
    make = get_rule(finding.code).make_fix
    assert make is not None, finding.code
    if origin is None:
        return make(finding, context)
    context.document, context.severity = origin.document, finding.severity
    return make(origin.problem, context)
