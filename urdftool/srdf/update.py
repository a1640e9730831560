"""Update of the pairs of an existing SRDF by edits of its bytes."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from ..model.semantic import DisabledPair, SemanticDescription
from ..source import edit
from ..source.document import Element
from ..source.location import SourceFile
from .content import REASONS, describe_proof
from .existing import BARE, MISSING, REFUTED, REPEATED, UNKNOWN, UNPROVED, Judgement
from .verdicts import OPEN
from .write import format_pair

_COMMENT = re.compile(rb"[ \t]*<!--\s*(.*?)\s*-->[ \t]*(?=\r?\n)")
_OURS = (b"proved", b"fixed to each other")
_PREFIX = re.compile(r"^(\$\{[^{}]*\}|\$\(arg [^()]*\))(.*)$", re.S)
_REMOVED = (REFUTED, BARE, UNPROVED, UNKNOWN, REPEATED)


@dataclass
class Update:
    """Changes of an SRDF.

    Attributes:
        file: The file.
        data: Its new content.
        removed: Pairs that were removed.
        added: Pairs that were added.
        kept: Pairs that the proof would remove, with the reason why they stay.
        refused: Pairs that cannot be added, with the reason.
    """

    file: SourceFile
    data: bytes = b""
    removed: list[Judgement] = field(default_factory=list)
    added: list[Judgement] = field(default_factory=list)
    kept: list[tuple[Judgement, str]] = field(default_factory=list)
    refused: list[tuple[Judgement, str]] = field(default_factory=list)


def update(content: SemanticDescription, judgements: Iterable[Judgement]) -> Update:
    """Remove the pairs that are not proved, and add those that are.

    Pairs with the reason ``User``, ``Default`` or ``Always``, or with a comment of the user on
    their line, stay. An element of a macro is removed only if none of its expansions stays.
    """
    file = content.element.file
    source = edit.parse_source(file)
    result = Update(file)
    found = list(judgements)
    edits = _remove(source, content, found, result)
    missing = [judgement for judgement in found if judgement.code == MISSING]
    edits += _add(source, content, missing, result, gone={item.start for item in edits})
    result.data = edit.apply(file, edits)
    return result


def _remove(
    source: edit.Source, content: SemanticDescription, found: Sequence[Judgement], result: Update
) -> list[edit.Edit]:
    """Return the edits that remove pairs."""
    expansions: dict[tuple[str, int], int] = {}
    for pair in content.disabled:
        expansions[_locate(pair)] = expansions.get(_locate(pair), 0) + 1
    removable: dict[tuple[str, int], list[Judgement]] = {}
    for judgement in found:
        if judgement.code in _REMOVED:
            removable.setdefault(_locate(judgement.pair), []).append(judgement)
    edits = []
    for place, some in removable.items():
        reason = _explain_kept(source, some[0].pair.element, len(some), expansions[place])
        if reason:
            result.kept += [(judgement, reason) for judgement in some]
        else:
            result.removed += some
            edits.append(_remove_line(source, source.elements[place[1]]))
    return edits


def _locate(pair: DisabledPair) -> tuple[str, int]:
    return pair.element.file.path, pair.element.start


def _explain_kept(source: edit.Source, element: Element, count: int, expansions: int) -> str:
    """Explain why an element stays; empty if it can be removed."""
    if element.file is not source.file:
        return f"it is in {element.file.path}, which is included"
    if count < expansions:
        return "its macro makes other pairs, too, which are needed"
    written = source.elements[element.start]
    comment = _COMMENT.match(source.file.data, written.end)
    if comment is not None and not comment.group(1).startswith(_OURS):
        return "a comment is on its line"
    return ""


def _remove_line(source: edit.Source, element: Element) -> edit.Edit:
    """Remove an element with its line, and with our comment on it."""
    comment = _COMMENT.match(source.file.data, element.end)
    own = source.get_indentation(element)
    if comment is None or own is None:
        return edit.remove_element(source, element)
    end = re.compile(rb"\r?\n").match(source.file.data, comment.end())
    return edit.Edit(element.start - len(own), end.end() if end else comment.end(), b"")


def _add(
    source: edit.Source,
    content: SemanticDescription,
    missing: Sequence[Judgement],
    result: Update,
    *,
    gone: set[int],
) -> list[edit.Edit]:
    """Return the edits that add pairs after the last that stays; ``gone`` are starts of others."""
    own = [pair for pair in content.disabled if pair.element.file is source.file]
    last = source.elements[own[-1].element.start] if own else None
    parent = source.document.root if last is None or last.parent is None else last.parent
    place = _find_place(source, parent, last, gone)
    prefix = _find_prefix(source, own, len(content.disabled))
    lines = []
    for judgement in missing:
        verdict = judgement.verdict
        assert verdict is not None
        one, other = (_write_name(name, prefix) for name in (verdict.link1, verdict.link2))
        if one is None or other is None:
            reason = "its names would depend on a macro or its arguments"
            result.refused.append((judgement, reason))
            continue
        pair = DisabledPair(None, one, other, REASONS[verdict.kind], describe_proof(verdict))
        lines.append(_format_ascii(pair))
        result.added.append(judgement)
    return [edit.insert_child(source, parent, lines, after=place)] if lines else []


def _find_place(
    source: edit.Source, parent: Element, last: Element | None, gone: set[int]
) -> Element | None:
    """Find the last child of an element that stays, up to the last pair if there is one."""
    found = None
    for child in parent.children:
        own = source.get_indentation(child) or b""
        if not {child.start, child.start - len(own)} & gone:
            found = child
        if last is not None and child.start == last.start:
            break
    return found


def _format_ascii(pair: DisabledPair) -> str:
    return format_pair(pair).encode("ascii", "xmlcharrefreplace").decode("ascii")


def _find_prefix(
    source: edit.Source, own: Sequence[DisabledPair], count: int
) -> tuple[str, str] | None:
    """Find the expression that all names begin with, and its value; None if they differ.

    Names without expressions give two empty texts.
    """
    found: set[tuple[str, str]] = set()
    places = {pair.element.start for pair in own}
    if len(places) < len(own) or len(own) < count:
        return None  # a macro is expanded more than once, or another file has pairs
    for pair in own:
        written = source.elements[pair.element.start]
        for attribute, name in (("link1", pair.link1), ("link2", pair.link2)):
            match = _PREFIX.match(edit.read_literal(written, attribute) or "")
            if match is None:
                if "${" in (text := edit.read_literal(written, attribute) or "") or "$(" in text:
                    return None
                found.add(("", ""))
            elif "${" in match[2] or "$(" in match[2] or not name.endswith(match[2]):
                return None
            else:
                found.add((match[1], name[: len(name) - len(match[2])]))
    return found.pop() if len(found) == 1 else ("", "") if not found else None


def _write_name(name: str, prefix: tuple[str, str] | None) -> str | None:
    """Write the name of a link with the expression of the file; None if it does not begin so."""
    if prefix is None or not name.startswith(prefix[1]):
        return None
    return prefix[0] + name[len(prefix[1]) :]


def describe_removal(judgement: Judgement) -> str:
    """Describe why a pair is removed."""
    if judgement.code == UNKNOWN:
        return "a link of it does not exist"
    if judgement.code == REPEATED:
        return "the file has it twice"
    if judgement.verdict is not None and judgement.verdict.kind == OPEN:
        return "it is not proved"
    return "it can touch"
