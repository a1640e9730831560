"""Conversion of changes to source edits, with checks of their permission.

One element of the source may be many elements of the robot: an element in a macro appears once for
each call. It is edited only if all of its instances need the same change. Values computed by an
expression are not overwritten, and files outside the package of the description are not edited.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from itertools import pairwise

from ..diagnostic import FileRewrite, Replacement
from ..errors import SourceError
from ..rules.fix import Change, OutsideError, Proposal, RefusedError, Span
from ..source import edit
from ..source.description import Description
from ..source.document import STDIN, Element
from ..source.escape import escape, unescape
from ..source.location import Place, SourceFile
from ..source.packages import shorten_path

_QUOTES = {"&quot;": '"', "&apos;": "'"}


class Settler:
    """Converter of element changes of one description to edits of its source."""

    def __init__(self, description: Description) -> None:
        """Index the elements by their location in the source."""
        self.description = description
        self.main = description.files[0].path
        self.sources: dict[str, edit.Source] = {}
        self.users: dict[tuple[str, int], list[Element]] = {}
        self.expanded: set[int] = set()
        for element in description.document.root.walk():
            self.users.setdefault((element.file.path, element.start), []).append(element)
            self.expanded.add(id(element))

    def settle(self, proposals: Sequence[Proposal]) -> tuple[Replacement, ...]:
        """Return the replacements for the proposals of one finding, one proposal for each instance.

        Raises:
            RefusedError: The source cannot be edited in that way.
        """
        spans = [c for p in proposals for c in p.changes if isinstance(c, Span)]
        found = [self._make_span(span) for span in dict.fromkeys(spans)]
        by_element: dict[int, tuple[Element, dict[tuple[object, ...], Change]]] = {}
        for proposal in proposals:
            for change in proposal.changes:
                if isinstance(change, Change):
                    element = change.element
                    _, by_part = by_element.setdefault(id(element), (element, {}))
                    by_part[change.what] = change
        done: set[tuple[str, int]] = set()
        for element, by_part in by_element.values():
            site = element.file.path, element.start
            if id(element) in self.expanded:
                for user in self.users[site]:
                    if list(by_element.get(id(user), (None, {}))[1]) != list(by_part):
                        raise RefusedError(
                            "its source is also used elsewhere, where it must not "
                            f"change in this way ({user.describe()})"
                        )
            if site not in done:
                done.add(site)
                for change in by_part.values():
                    found += self._list_edits(change)
        found.sort(key=lambda r: (r.place.path, r.place.start, r.place.end))
        for one, other in pairwise(found):
            if one.place.path == other.place.path and other.place.start < one.place.end:
                raise RefusedError("its parts overlap")
        return tuple(found)

    def get_rewrites(self, proposals: Sequence[Proposal]) -> tuple[FileRewrite, ...]:
        """Return the files that the proposals of one finding rewrite.

        Raises:
            RefusedError: A file is outside the package of the description.
        """
        found = [c for p in proposals for c in p.changes if isinstance(c, FileRewrite)]
        for rewrite in found:
            self._check_inside(rewrite.path)
        return tuple(dict.fromkeys(found))

    def _make_span(self, span: Span) -> Replacement:
        self._check_file(span.file)
        return Replacement(Place(span.file, span.start, span.end), span.data)

    def _list_edits(self, change: Change) -> Iterator[Replacement]:
        element = change.element
        source = self._get_source(element.file)
        raw = source.elements.get(element.start)
        if raw is None or raw.tag != element.tag:
            raise RefusedError("it is not a separate element in the source")
        for one in _edit_element(source, raw, change):
            yield Replacement(Place(element.file, one.start, one.end), one.text)

    def _get_source(self, file: SourceFile) -> edit.Source:
        if file.path not in self.sources:
            self._check_file(file)
            try:
                self.sources[file.path] = edit.parse_source(file)
            except SourceError as error:
                raise RefusedError(error.message) from None
        return self.sources[file.path]

    def _check_file(self, file: SourceFile) -> None:
        """Check that a file belongs to the package, and that its encoding supports edits."""
        if file.path != STDIN and file.path not in self.sources:
            with self.description.workspace.open(file.path) as stream:
                if stream.read(4).startswith((b"\xff\xfe", b"\xfe\xff", b"\0\0\xfe\xff")):
                    raise RefusedError("it is in UTF-16 or UTF-32; save it as UTF-8")
        if file.path != self.main:
            self._check_inside(file.path)

    def _check_inside(self, file: str) -> None:
        files, packages = self.description.workspace, self.description.packages
        root = files.resolve_links(packages.own[1] if packages.own else packages.file.parent)
        if self.main == STDIN or not files.resolve_links(file).startswith(root + os.sep):
            raise OutsideError(f"{file}, outside of {shorten_path(root)}")


def _edit_element(source: edit.Source, raw: Element, change: Change) -> Iterator[edit.Edit]:
    """Yield the edits that apply one change to an element as written."""
    kind, name, value = change.kind, change.name, change.value
    if kind == "set":
        written = edit.read_literal(raw, name)
        if written is None and change.element.get(name) is not None:
            raise RefusedError(f"{name} is computed")
        if written is not None and "$" in written:
            raise RefusedError(f'{name}="{written}" is computed')
        yield edit.set_attribute(source, raw, name, value)
    elif kind == "sub":
        written = edit.read_literal(raw, name) or ""
        new = re.sub(change.pattern, value, written)
        if new == written:
            raise RefusedError(f'{name}="{written}" is computed')
        yield edit.set_attribute(source, raw, name, new)
    elif kind == "unset":
        yield _remove_attribute(source, raw, name)
    elif kind == "rename":
        begin, _ = _collect_spans(raw, name)
        yield edit.Edit(begin, begin + len(name.encode()), value.encode())
    elif kind == "retag":
        yield from _rename_tag(source, raw, value)
    elif kind in ("text", "sub-text"):
        yield _replace_text(source, raw, change)
    elif kind == "remove":
        yield _remove_element(source, raw)
    elif kind == "replace":
        yield edit.replace_element(source, raw, change.blocks)
    else:
        parent, behind = raw, raw.children[-1] if raw.children and kind == "insert" else None
        if kind == "after":
            if raw.parent is None:
                raise RefusedError("nothing can be inserted after it")
            parent, behind = raw.parent, raw
        for lines in change.blocks:
            ascii_lines = [line.encode("ascii", "xmlcharrefreplace").decode() for line in lines]
            yield edit.insert_child(source, parent, ascii_lines, after=behind)


def _collect_spans(raw: Element, name: str) -> tuple[int, int]:
    span = raw.file.locate_attributes(raw.start).get(name)
    if span is None:
        raise RefusedError(f"{name} is not in the source")
    return span


def _remove_attribute(source: edit.Source, raw: Element, name: str) -> edit.Edit:
    """Return the edit that removes an attribute and the whitespace before it."""
    begin, end = _collect_spans(raw, name)
    data = source.file.data
    while data[begin - 1 : begin].isspace():
        begin -= 1
    return edit.Edit(begin, end, b"")


def _remove_element(source: edit.Source, raw: Element) -> edit.Edit:
    """Return the edit that removes an element; a comment after it moves to its place."""
    made = edit.remove_element(source, raw)
    data = source.file.data
    if made.end == raw.end and source.get_indentation(raw) is not None:
        blanks = re.compile(rb"[ \t]*(?=<!--)").match(data, raw.end)
        if blanks is not None:
            return edit.Edit(made.start, blanks.end(), b"")
    return made


def _rename_tag(source: edit.Source, raw: Element, tag: str) -> Iterator[edit.Edit]:
    data, old, new = source.file.data, raw.tag.encode(), tag.encode()
    yield edit.Edit(raw.start + 1, raw.start + 1 + len(old), new)
    tag_end = source.file.find_tag_end(raw.start)
    if data[tag_end - 2 : tag_end] != b"/>":
        close = data.rfind(b"</", 0, raw.end) + 2
        yield edit.Edit(close, close + len(old), new)


def _replace_text(source: edit.Source, raw: Element, change: Change) -> edit.Edit:
    """Return the edit that replaces the text of an element, keeping surrounding whitespace."""
    data = source.file.data
    begin, end = source.file.find_tag_end(raw.start), data.rfind(b"</", 0, raw.end)
    inner = data[begin:end]
    if data[begin - 2 : begin] == b"/>" or b"<" in inner:
        raise RefusedError("it is not written as plain text")
    written = unescape(inner.decode(source.file.encoding), _QUOTES)
    if change.kind == "sub-text":
        new = re.sub(change.pattern, change.value, written)
    elif "$" in written:
        raise RefusedError(f"'{written.strip()}' is computed")
    else:
        stripped = written.strip()
        head, _, tail = written.partition(stripped) if stripped else (written, "", "")
        new = head + change.value + tail
    if new == written:
        raise RefusedError(f"'{written.strip()}' is computed")
    return edit.Edit(begin, end, escape(new).encode("ascii", "xmlcharrefreplace"))
