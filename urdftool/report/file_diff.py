"""Changes of a file, as ``--diff`` shows them."""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter
from collections.abc import Iterator, Sequence
from difflib import SequenceMatcher
from io import StringIO

NO_FILE = "/dev/null"


def format_file_diff(path: str, before: bytes | None, after: bytes) -> str:
    """Return a unified diff of a text file, or one line for a binary file."""
    if b"\0" in after or b"\0" in (before or b""):
        was = "new" if before is None else f"{len(before)} bytes →"
        return f"binary file {path}: {was} {len(after)} bytes\n"
    old, new = (
        StringIO(data.decode("utf-8", "replace"), newline="\n").readlines()
        for data in (before or b"", after)
    )
    lines = []
    for line in format_unified_lines(old, new, NO_FILE if before is None else path, path):
        lines.append(line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n")
    return "".join(lines)


Opcode = tuple[str, int, int, int, int]


def format_unified_lines(
    old: Sequence[str], new: Sequence[str], before: str, after: str, *, around: int = 3
) -> Iterator[str]:
    """Yield the lines of a unified diff; only the headers have added line ends."""
    matcher: SequenceMatcher[str] = SequenceMatcher(None, [], [])
    matcher.opcodes = _get_opcodes(old, new)  # type: ignore[attr-defined]
    for number, group in enumerate(matcher.get_grouped_opcodes(around)):
        if not number:
            yield f"--- {before}\n"
            yield f"+++ {after}\n"
        first, last = group[0], group[-1]
        yield f"@@ -{_format_range(first[1], last[2])} +{_format_range(first[3], last[4])} @@\n"
        for what, i, j, k, m in group:
            if what == "equal":
                yield from (f" {line}" for line in old[i:j])
                continue
            yield from (f"-{line}" for line in old[i:j])
            yield from (f"+{line}" for line in new[k:m])


def _format_range(start: int, stop: int) -> str:
    """Format a line range of a diff: numbers start at one, a count of one is omitted."""
    length = stop - start
    return f"{start + 1}" if length == 1 else f"{start + (length > 0)},{length}"


def _get_opcodes(old: Sequence[str], new: Sequence[str]) -> list[Opcode]:
    """Return the edit operations, in the form of ``SequenceMatcher.get_opcodes``."""
    result: list[Opcode] = []
    i = k = 0
    for start, other in [*_matches(old, new, 0, len(old), 0, len(new)), (len(old), len(new))]:
        if i < start or k < other:
            what = "replace" if i < start and k < other else "delete" if i < start else "insert"
            result.append((what, i, start, k, other))
        if start < len(old) or other < len(new):
            if result and result[-1][0] == "equal":
                result[-1] = ("equal", result[-1][1], start + 1, result[-1][3], other + 1)
            else:
                result.append(("equal", start, start + 1, other, other + 1))
        i, k = start + 1, other + 1
    return result


def _matches(
    old: Sequence[str], new: Sequence[str], i: int, j: int, k: int, m: int
) -> list[tuple[int, int]]:
    """Return pairs of equal lines in two ranges, in order."""
    matches: list[tuple[int, int]] = []
    while i < j and k < m and old[i] == new[k]:
        matches.append((i, k))
        i, k = i + 1, k + 1
    tail: list[tuple[int, int]] = []
    while i < j and k < m and old[j - 1] == new[m - 1]:
        j, m = j - 1, m - 1
        tail.append((j, m))
    if i < j and k < m:
        anchors = _find_anchors(old, new, i, j, k, m)
        if anchors:
            for start, other in [*anchors, (j, m)]:
                matches += _matches(old, new, i, start, k, other)
                if start < j:
                    matches.append((start, other))
                i, k = start + 1, other + 1
        else:
            matcher = SequenceMatcher(None, old[i:j], new[k:m], autojunk=False)
            for one, other, size in matcher.get_matching_blocks():
                matches += [(i + one + n, k + other + n) for n in range(size)]
    return matches + tail[::-1]


def _find_anchors(
    old: Sequence[str], new: Sequence[str], i: int, j: int, k: int, m: int
) -> list[tuple[int, int]]:
    """Return the longest sequence of lines that are unique on either side and in the same order."""
    here, there = Counter(old[i:j]), Counter(new[k:m])
    place = {line: number for number, line in enumerate(new[k:m], k) if there[line] == 1}
    pairs = [
        (number, place[line])
        for number, line in enumerate(old[i:j], i)
        if here[line] == 1 and line in place
    ]
    ends: list[int] = []  # smallest end of an increasing run of each length
    last: list[int] = []
    before: list[int] = []
    for index, (_, other) in enumerate(pairs):
        length = bisect_left(ends, other)
        ends[length : length + 1] = [other]
        last[length : length + 1] = [index]
        before.append(last[length - 1] if length else -1)
    chain = []
    index = last[-1] if last else -1
    while index >= 0:
        chain.append(pairs[index])
        index = before[index]
    return chain[::-1]
