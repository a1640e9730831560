"""Tables of a benchmark, as Markdown, and what they say in a sentence."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from .timing import MEGABYTE, Taken


@dataclass
class Table:
    """A table with what it means.

    Attributes:
        head: Its columns; the first is at the left, numbers at the right.
        rows: Its cells.
        reading: Paragraphs below it.
    """

    head: Sequence[str]
    rows: list[Sequence[str]] = field(default_factory=list)
    reading: list[str] = field(default_factory=list)

    def __str__(self) -> str:
        lines = [self.head, ["---", *["---:"] * (len(self.head) - 1)], *self.rows]
        text = "\n".join(f"| {' | '.join(map(_cell, line))} |" for line in lines)
        return "\n\n".join([text, *self.reading])


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")


@dataclass
class Pairs:
    """Ours beside others: seconds, peak of memory, and how many times as long ours takes.

    Attributes:
        what: The head of the first column.
        peers: Names of the others.
        extra: Heads of columns before the times.
    """

    what: str
    peers: Sequence[str]
    extra: Sequence[str] = ()
    rows: list[tuple[str, Sequence[str], Mapping[str, Taken]]] = field(default_factory=list)

    def add(self, what: str, taken: Mapping[str, Taken], *extra: str) -> None:
        """One more row; ``taken`` has a key ``urdftool`` and one for each other."""
        self.rows.append((what, extra, taken))

    def ratios(self, peer: str) -> list[float]:
        """Our time over the other's, in the rows where both did it."""
        both = [(taken["urdftool"], taken[peer]) for _, _, taken in self.rows if peer in taken]
        return [a.seconds / b.seconds for a, b in both if not a.why and not b.why]

    def table(self, *reading: str) -> Table:
        """As a table; ratios above 1, where ours is the slower, are bold."""
        head = [self.what, *self.extra, "urdftool"]
        for peer in self.peers:
            head += [peer, "ratio"]
        made = Table(head)
        failures: dict[str, None] = {}
        for what, extra, taken in self.rows:
            ours = taken["urdftool"]
            cells = [what, *extra, cell(ours)]
            for peer in self.peers:
                theirs = taken.get(peer)
                cells += [cell(theirs), ratio(ours, theirs)]
                if theirs is not None and theirs.why:
                    failures[f"{peer}, {what}: {theirs.why}"] = None
            if ours.why:
                failures[f"urdftool, {what}: {ours.why}"] = None
            made.rows.append(cells)
        said = [self.verdict(peer) for peer in self.peers]
        made.reading = [" ".join(text for text in (*said, *reading) if text)]
        if failures:
            made.reading.append("\n".join(f"- {_plain(text)}" for text in failures))
        return made

    def verdict(self, peer: str) -> str:
        """Who is faster, in a sentence."""
        ratios = self.ratios(peer)
        if not ratios:
            return ""
        faster = [value for value in ratios if value <= 1]
        slower = [value for value in ratios if value > 1]
        parts = []
        if faster:
            parts.append(f"faster in {len(faster)} of {len(ratios)} rows ({_times(faster)})")
        if slower:
            parts.append(f"slower in {len(slower)} of {len(ratios)} ({_slow(slower)})")
        return f"Compared with {peer}: {', '.join(parts)}."


def _plain(text: str) -> str:
    return text.replace("<", "\\<").replace("*", "\\*").replace("_", "\\_")


def _times(ratios: Sequence[float]) -> str:
    one, other = sorted((1 / min(ratios), 1 / max(ratios)))
    return f"{number(one)} to {number(other)} times" if len(ratios) > 1 else f"{number(one)} times"


def _slow(ratios: Sequence[float]) -> str:
    one, other = min(ratios), max(ratios)
    return f"{number(one)} to {number(other)} times" if len(ratios) > 1 else f"{number(one)} times"


def cell(taken: Taken | None) -> str:
    """``0.21 s, 36 MB``."""
    if taken is None:
        return "–"
    if taken.why:
        return "failed" if "stopped" not in taken.why else taken.why.removeprefix("stopped ")
    return f"{number(taken.seconds)} s, {taken.peak / MEGABYTE:.0f} MB"


def ratio(ours: Taken, theirs: Taken | None) -> str:
    """Ours over theirs."""
    if theirs is None or theirs.why or ours.why:
        return "–"
    value = ours.seconds / theirs.seconds
    return f"**{number(value)}**" if value > 1 else number(value)


def number(value: float) -> str:
    """Two or three significant figures."""
    for bound, digits in ((0.0995, 3), (9.95, 2), (99.5, 1)):
        if value < bound:
            return f"{value:.{digits}f}"
    return f"{value:,.0f}"
