"""Identity of a finding: one that does not depend on the location, and one for files of users."""

from __future__ import annotations

import re

from ..diagnostic import freeze
from ..finding import Finding
from ..rules.old_names import get_first_name

Fact = tuple[object, ...]


def get_fact(finding: Finding) -> Fact:
    """Return what is equal for findings that report the same: rule, object and data.

    The message is not part of it. A location is compared by the caller.
    """
    return finding.code, finding.kind, finding.name, finding.owner, freeze(finding.data)


def get_word(finding: Finding) -> bytes:
    """Return the name of the element or attribute at the location; empty if there is none."""
    file, start, end, _ = finding.location
    match = _WORD.match(file.data, start, end)
    return match[0] if match else b""


_WORD = re.compile(rb"<?[\w:.-]+")


def compute_fingerprint(finding: Finding) -> str:
    """Compute 16 hexadecimal digits of the rule, kind and name of the element, and its attributes.

    Lines, whitespace and the order of attributes are ignored, so that edits elsewhere in the file
    keep the fingerprint, and a renamed rule counts by its first name. That of a group covers its
    members, so a group with a new member is a new finding.
    """
    from hashlib import sha256

    rule = get_first_name(finding.code)
    words = [rule, finding.kind, finding.name, *_get_source_attributes(finding)]
    if finding.members:
        words = [rule, *sorted(map(compute_fingerprint, finding.members))]
    return sha256("\0".join(words).encode("utf-8", "surrogateescape")).hexdigest()[:16]


def _get_source_attributes(finding: Finding) -> list[str]:
    """Return the attributes of the tag at the location of a finding, or the text there."""
    file, start, end, _ = finding.location
    data = file.data[start:end]
    spans = file.locate_attributes(start) if data.startswith(b"<") else {}
    pieces = [file.data[a:b] for _, (a, b) in sorted(spans.items())] or [data]
    return [" ".join(piece.decode(file.encoding, "replace").split()) for piece in pieces]
