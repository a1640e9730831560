"""Fixes of names that are there twice, and of comments."""

from __future__ import annotations

import re

from ...source.document import parse
from ..rule import Problem
from .proposal import Around, Proposal, Span, attribute_at, sub, unsafe


def colon_space_in_comment(problem: Problem, around: Around) -> Proposal | None:
    """``-`` for the colon, in all comments of the file."""
    document = around.document
    if document is None:
        return None
    data, spans = document.file.data, []
    for comment in parse(document.file).comments:
        if b"urdftool-ignore" in data[comment.start : comment.end]:
            continue
        for match in re.finditer(rb":(?=\s)", data[comment.start : comment.end]):
            start = comment.start + match.start()
            blank = b"-" if data[start - 1 : start].isspace() else b" -"
            if data[start + 2 : start + 3] == b"-" or data[start - 1 : start] == b"-":
                return None
            spans.append(Span(document.file, start, start + 1, blank))
    return unsafe("write ' - ' for ': ' in comments", *spans) if spans else None


def duplicate_geometry_name(problem: Problem, around: Around) -> Proposal | None:
    """A number behind the second."""
    found = attribute_at(problem)
    if found is None:
        return None
    taken = {shape.name for _, shape in around.robot.shapes}
    name, number = (found[0].get(found[1]) or "").strip(), 2
    while f"{name}_{number}" in taken:
        number += 1
    return unsafe(f"call it '{name}_{number}'", sub(*found, r"(?<=\S)(?=\s*$)", f"_{number}"))
