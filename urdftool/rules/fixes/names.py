"""Fixes of names, comments, and of the SRDF beside a robot."""

from __future__ import annotations

import re

from ...source.document import parse
from ..rule import Problem
from .proposal import Around, Proposal, Span, attribute_at, meant, put, safe, sub, unsafe
from .tree import renamed_link


def colon_space_in_comment(problem: Problem, around: Around) -> Proposal | None:
    """``-`` for the colon, in all comments of the file."""
    document = around.document
    if document is None:
        return None
    data, spans = document.file.data, []
    for comment in parse(document.file).comments:
        if b"urdftool-ignore" in data[comment.start : comment.end]:
            continue
        for match in re.finditer(rb": ", data[comment.start : comment.end]):
            start = comment.start + match.start()
            blank = b"-" if data[start - 1 : start].isspace() else b" -"
            if data[start + 2 : start + 3] == b"-" or data[start - 1 : start] == b"-":
                return None
            spans.append(Span(document.file, start, start + 1, blank))
    return unsafe("write ' - ' for ': ' in comments", *spans) if spans else None


def invalid_frame_name(problem: Problem, around: Around) -> Proposal | None:
    """Without slash and blanks, here and where it is named; many have a cause elsewhere."""
    if "; write '" not in problem.message:
        return None
    link = around.link(problem)
    new = problem.message.rpartition("; write '")[2].partition("'")[0]
    if not new or new in around.robot.link or new in around.robot.joint:
        return None
    changes = list(renamed_link(around.robot.element, link.name, new))
    return unsafe(f"call it '{new}', here and where it is named", *changes)


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


def srdf_robot_name(problem: Problem, around: Around) -> Proposal | None:
    """The robot's."""
    name = around.robot.name
    if not name:
        return None
    return safe(f"write '{name}'", put(problem.element, "name", name))


def srdf_unknown_link(problem: Problem, around: Around) -> Proposal | None:
    """The link that was meant."""
    return _rename(problem)


def srdf_unknown_joint(problem: Problem, around: Around) -> Proposal | None:
    """The joint that was meant."""
    return _rename(problem)


def _rename(problem: Problem) -> Proposal | None:
    found = attribute_at(problem)
    name = meant(problem, found[0].get(found[1]) or "") if found is not None else ""
    if found is None or not name:
        return None
    return unsafe(f"write '{name}'", put(*found, name))
