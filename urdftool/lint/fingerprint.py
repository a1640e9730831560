"""Identity of a finding that does not depend on line numbers."""

from __future__ import annotations

from ..finding import Finding


def fingerprint(finding: Finding) -> str:
    """Return 16 hexadecimal digits of the rule, kind and name of the element, and its attributes.

    Lines, whitespace and the order of attributes are ignored, so that edits elsewhere in the file
    keep the fingerprint. That of a group covers its members, so a group with a new member is a new
    finding.
    """
    from hashlib import sha256

    words = [finding.rule, finding.kind, finding.name, *_written(finding)]
    if finding.members:
        words = [finding.rule, *sorted(map(fingerprint, finding.members))]
    return sha256("\0".join(words).encode("utf-8", "surrogateescape")).hexdigest()[:16]


def _written(finding: Finding) -> list[str]:
    """Return the attributes of the tag at the location of a finding, or the text there."""
    file, start, end, _ = finding.place
    data = file.data[start:end]
    spans = file.attribute_spans(start) if data.startswith(b"<") else {}
    pieces = [file.data[a:b] for _, (a, b) in sorted(spans.items())] or [data]
    return [" ".join(piece.decode(file.encoding, "replace").split()) for piece in pieces]
