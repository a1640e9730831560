"""What a finding is known by when lines move: its rule, its element, and what is written there."""

from __future__ import annotations

from ..finding import Finding


def fingerprint(finding: Finding) -> str:
    """Sixteen hexadecimal digits from the rule, the element's kind and name, and its attributes.

    Neither lines nor blanks nor the order of attributes count, so that a finding keeps its
    fingerprint while the file is edited around it. That of a group is made of those of its members,
    so one that has a new member is a new finding.
    """
    from hashlib import sha256

    words = [finding.rule, finding.kind, finding.name, *_written(finding)]
    if finding.members:
        words = [finding.rule, *sorted(map(fingerprint, finding.members))]
    return sha256("\0".join(words).encode("utf-8", "surrogateescape")).hexdigest()[:16]


def _written(finding: Finding) -> list[str]:
    """The attributes of the tag the finding stands at, or the text it underlines."""
    file, start, end, _ = finding.place
    data = file.data[start:end]
    spans = file.attribute_spans(start) if data.startswith(b"<") else {}
    pieces = [file.data[a:b] for _, (a, b) in sorted(spans.items())] or [data]
    return [" ".join(piece.decode(file.encoding, "replace").split()) for piece in pieces]
