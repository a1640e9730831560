"""Findings for terminals: the most severe first, at most a screen for each family of rules."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain

from ..diagnostic import Severity
from ..finding import Finding
from ..rules import FAMILY_OF
from ..rules.table import FIXES
from .counted import format_count
from .findings import format_concise, format_full, format_severity_counts, is_cut

SCREEN = 25
"""Maximum number of lines for one family of rules, unless all are requested. Chosen, no source."""

MANY = 8
"""Findings above which a terminal shows one line for each, and the summary lists rules. Chosen, no
source."""

_RULES = 3  # rules that the summary names; chosen


def sort_by_severity(findings: Iterable[Finding]) -> list[Finding]:
    """Sort findings by file, then by severity, errors first; those of one rule stay together."""
    findings = list(findings)
    first: dict[tuple[str, Severity, str], int] = {}
    for finding in findings:
        key = finding.location.path, finding.severity, finding.code
        first[key] = min(finding.location.start, first.get(key, finding.location.start))

    def weight(finding: Finding) -> tuple[str, int, int, str, int]:
        key = finding.location.path, finding.severity, finding.code
        place = finding.location
        return place.path, -finding.severity, first[key], finding.code, place.start

    return sorted(findings, key=weight)


def format_screen(
    findings: Iterable[Finding],
    style: str,
    *,
    colors: bool = False,
    whole: bool = False,
    cut: bool = False,
) -> Iterator[str]:
    """Yield the lines of findings, sorted by severity.

    Unless ``whole``, a family that needs more lines than a screen gets one line for each finding,
    errors first, and the number of omitted ones.
    """
    shown = sort_by_severity(findings)
    if style == "full":
        blocks = [
            list(format_full([finding], colors=colors, whole=whole, cut=cut)) for finding in shown
        ]
    else:
        blocks = [[line] for line in format_concise(shown, colors=colors, cut=cut)]
    left: dict[str, list[Finding]] = {}
    lengths = [len(block) for block in blocks]
    heads = [_count_headline(*pair) for pair in zip(shown, blocks, strict=True)]
    if not whole:
        families: dict[str, list[int]] = {}
        for number, finding in enumerate(shown):
            families.setdefault(FAMILY_OF.get(finding.code, "lint"), []).append(number)
        for family, numbers in families.items():
            numbers.sort(key=lambda number: (-shown[number].severity, number))
            omitted = _fit(numbers, blocks, heads)
            if omitted:
                left[family] = [shown[number] for number in omitted]
    yield from _join(blocks) if style == "full" else chain.from_iterable(blocks)
    sizes = zip(blocks, heads, lengths, strict=True)
    short = sum(len(block) == head < length for block, head, length in sizes)
    if short:
        what = "1 finding is" if short == 1 else f"{short} findings are"
        yield f"{what} shown in one line; --all shows all details"
    long = sum(map(is_cut, shown)) if cut else 0
    if long:
        what = "1 message is" if long == 1 else f"{long} messages are"
        yield f"{what} cut at …; --all shows all names"
    for family, findings in left.items():
        yield (
            f"{len(findings)} more of {family}: {format_severity_counts(findings)}; --all shows "
            "them"
        )
    if style == "full" and (short or left):
        yield ""


def _count_headline(finding: Finding, block: Sequence[str]) -> int:
    """Count the lines of a block up to the name of the rule, which a long message wraps to."""
    ends = (number for number, line in enumerate(block, 1) if f"[{finding.code}]" in line)
    return next(ends, 1)


def _fit(numbers: Sequence[int], blocks: list[list[str]], heads: Sequence[int]) -> Sequence[int]:
    """Shorten the blocks of a family until they fit; return the omitted ones.

    Args:
        numbers: Indices of the family's blocks, the most severe first.
        blocks: All blocks, modified in place.
        heads: Number of lines of the headline of each block, with the name of its rule.
    """
    if sum(len(blocks[number]) for number in numbers) <= SCREEN:
        return ()
    room = SCREEN if len(numbers) <= SCREEN else SCREEN - 1
    lines = SCREEN - len(numbers)
    for number in numbers[:room]:
        more = len(blocks[number]) - heads[number]
        if more > lines:
            blocks[number] = blocks[number][: heads[number]]
        else:
            lines -= more
    for number in numbers[room:]:
        blocks[number] = []
    return numbers[room:]


def _join(blocks: Iterable[Sequence[str]]) -> Iterator[str]:
    """Join blocks, with a blank line around those of several lines."""
    headlines = False
    for block in blocks:
        if len(block) > 1 and headlines:
            yield ""
        if block:
            headlines = len(block) == 1
        yield from block
    if headlines:
        yield ""


def format_advice(
    findings: Sequence[Finding], single: Sequence[Finding] | None = None
) -> Iterator[str]:
    """Yield the rules with the most findings and their remedies; nothing for few findings.

    Args:
        findings: Findings as they are shown: a group is one.
        single: The same findings before they were grouped, each with its fix; None for no groups.
    """
    if len(findings) <= MANY:
        return
    every = findings if single is None else single
    options = Counter(finding.fix.option for finding in every if finding.fix is not None)
    safe, unsafe = options["--fix"], options["--fix --unsafe-fixes"]
    meshes = options.total() - safe - unsafe
    counts = Counter(finding.code for finding in findings).most_common(_RULES)
    width = max(len(rule) for rule, _ in counts)
    if counts[0][1] > 1:
        yield "rules with the most findings:"
    for rule, count in counts:
        if count == 1:
            break
        if options:
            fixes = [f.fix.option for f in findings if f.code == rule and f.fix is not None]
        else:  # fixes were not computed
            fixes = [FIXES[rule].option] if rule in FIXES else []
        fix = f"{min(fixes, key=len)}, or " if fixes else ""
        yield f"  {count:>4}  {rule:<{width}}  {fix}--ignore {rule}"
    if safe:
        yield f"--fix --diff shows {format_count(safe, 'safe fix', 'safe fixes')}"
    if unsafe:
        what = format_count(unsafe, "unsafe fix", "unsafe fixes")
        if any(_may_have_unsafe_fix(finding) for finding in every):
            what += " or more"  # those that require the inertia of meshes are computed there
        yield f"--fix --unsafe-fixes --diff shows {what}{' as well' if safe else ''}"
    if meshes:
        yield f"--fix-meshes adds {format_count(meshes, 'fix', 'fixes')} of mesh files"


def _may_have_unsafe_fix(finding: Finding) -> bool:
    """Tell whether the rule of a finding without a fix has an unsafe one."""
    known = FIXES.get(finding.code)
    return finding.fix is None and known is not None and "--unsafe-fixes" in known.option
