"""Edits that write inertia into the source of a robot.

The source may span several files, and a tag in a macro produces one element per call. A place is
edited only if all its elements require the same change, and a number only where it is a literal: in
the tag itself, or in the argument of the macro call that passes it. Other edits are refused, with
advice on what to change where. A link is edited completely or not at all.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from ..errors import SourceError
from ..model.elements import Robot
from ..source import edit
from ..source.document import STDIN, Element
from ..source.location import Place, SourceFile
from ..source.packages import find_own_package, shorten_path
from .inertia_error import InertiaError
from .link_review import LinkReview
from .masses import Masses
from .requested_edits import LinkEdits, RequestedEdit, determine_edits

_LONGEST_CALL = 60
"""Characters of a call of a macro that a table shows. Chosen, no source."""

_PARAMETER = re.compile(r"\$\{\s*(\w+)\s*\}")


class Site(NamedTuple):
    """A place in the source: file, byte offset of a tag, and an attribute or new child."""

    path: str
    start: int
    what: str


@dataclass(frozen=True)
class Refusal:
    """A link that is not edited, with the reason and the changes to make by hand."""

    link: str
    reason: str
    place: Place
    advice: tuple[tuple[Place, str], ...] = ()


@dataclass
class Filling:
    """Plan of the edits to a robot's source.

    Attributes:
        written: Links whose inertia is added or changed.
        unchanged: Links that are already correct or were not requested.
        refused: Links that require an edit but cannot be edited.
        left: Links whose inertia cannot be computed, with the reason.
        edits: Edits by the path of the file.
        still_wrong: Whether a physically inconsistent inertia remains.
    """

    written: list[LinkEdits] = field(default_factory=list)
    unchanged: list[str] = field(default_factory=list)
    refused: list[Refusal] = field(default_factory=list)
    left: list[Refusal] = field(default_factory=list)
    edits: dict[str, list[edit.Edit]] = field(default_factory=dict)
    still_wrong: bool = False


def fill(
    robot: Robot,
    found: Sequence[LinkReview],
    masses: Masses,
    *,
    single: bool = False,
    through_calls: bool = True,
) -> Filling:
    """Plan the edits that give each reviewed link the inertia that its geometry implies."""
    filling = Filling()
    todo = [
        link_edits
        for item in found
        if (link_edits := _determine_edits(item, filling, masses, robot)) is not None
        and link_edits.edits
    ]
    _Editor(robot, single, through_calls).settle(todo, filling)
    touched = {link_edits.link.name for link_edits in filling.written}
    filling.still_wrong = any(
        item.status == "wrong" and item.link.name not in touched for item in found
    )
    return filling


_NO_GEOMETRY = "it has no geometry of the selected kind"

_REASONS = {
    "box": "its center of mass or inertia does not fit into its geometry",
    "copied": "its inertia is the same about every axis, that of its geometry is not",
    "placeholder": "its inertia is a placeholder",
    "unreadable": "one of its numbers cannot be read",
}
"""Reasons of faults of an inertial that may be physically consistent."""


def _describe_fault(item: LinkReview) -> str:
    """Describe the worst fault of an inertial; an inconsistent one comes first."""
    codes = [fault.code for fault in item.faults]
    known = [_REASONS[code] for code in codes if code in _REASONS]
    return known[0] if len(known) == len(codes) else "its inertial is physically inconsistent"


def _determine_edits(
    item: LinkReview, filling: Filling, masses: Masses, robot: Robot
) -> LinkEdits | None:
    name = item.link.name

    def left(reason: str) -> None:
        filling.left.append(Refusal(name, reason, item.link.place))

    if not masses.recompute and not item.missing:
        filling.unchanged.append(name)
        if item.faults:
            left(f"{_describe_fault(item)}; --all recomputes it")
        elif name in masses.by_link and item.link.mass != masses.by_link[name]:
            if item.link.inertial is None:
                left(_NO_GEOMETRY)
            else:
                left(f"it has a mass of {item.link.mass:g} kg; --all replaces it")
        return None
    if item.body is None:
        if item.link.is_frame:
            filling.unchanged.append(name)
            if name in masses.by_link:
                left(_NO_GEOMETRY)
        else:
            left(_NO_GEOMETRY)
        return None
    if item.body.lacks:
        left(f"its {item.body.source} is incomplete: {item.body.lacks[0].reason}")
        return None
    if item.mass is None or item.implied is None:
        left(f"its mass is unknown; give --mass {name}=KG, --density or --total-mass")
        return None
    if any(fault.code == "unreadable" for fault in item.faults) and not masses.recompute:
        left("one of its numbers cannot be read; --all replaces it")
        return None
    try:
        link_edits = determine_edits(item, recompute=masses.recompute)
    except InertiaError as error:
        left(error.message)
        return None
    if not link_edits.edits:
        filling.unchanged.append(name)
    return link_edits


class _RefusedError(Exception):
    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


class _Editor:
    """Decision on which places of the source may be edited."""

    def __init__(self, robot: Robot, single: bool, through_calls: bool) -> None:
        assert robot.source is not None
        self.description = robot.source
        self.single = single
        self.through_calls = through_calls
        self.main = self.description.files[0].path
        self.sources: dict[str, edit.Source] = {}
        self.users: dict[tuple[str, int], list[Element]] = {}
        for element in self.description.document.root.walk():
            self.users.setdefault((element.file.path, element.start), []).append(element)

    def settle(self, todo: list[LinkEdits], filling: Filling) -> None:
        """Divide the links into written and refused, and create the edits of the former."""
        refused: dict[int, str] = {}
        sites: dict[int, list[tuple[Site, RequestedEdit]]] = {}
        for link_edits in todo:
            try:
                sites[id(link_edits)] = [
                    (self.find_site(request), request) for request in link_edits.edits
                ]
            except (_RefusedError, SourceError) as error:
                refused[id(link_edits)] = str(error)
        while True:
            before = len(refused)
            alive = [link_edits for link_edits in todo if id(link_edits) not in refused]
            changes = self._group_by_site(alive, sites)
            for link_edits in alive:
                for site, request in sites[id(link_edits)]:
                    reason = self._get_conflict(site, request, changes)
                    if reason:
                        refused[id(link_edits)] = reason
            if len(refused) == before:
                break
        for link_edits in todo:
            if id(link_edits) in refused:
                advice = tuple(
                    (_place(request), _describe_edit(request)) for request in link_edits.edits
                )
                filling.refused.append(
                    Refusal(
                        link_edits.link.name, refused[id(link_edits)], link_edits.link.place, advice
                    )
                )
            else:
                filling.written.append(link_edits)
        for site, edits in self._group_by_site(filling.written, sites).items():
            filling.edits.setdefault(site.path, []).append(self._edit(site, edits[0]))

    def _group_by_site(
        self, alive: Sequence[LinkEdits], sites: dict[int, list[tuple[Site, RequestedEdit]]]
    ) -> dict[Site, list[RequestedEdit]]:
        changes: dict[Site, list[RequestedEdit]] = {}
        for link_edits in alive:
            for site, request in sites[id(link_edits)]:
                changes.setdefault(site, []).append(request)
        return changes

    def _get_conflict(
        self, site: Site, request: RequestedEdit, changes: dict[Site, list[RequestedEdit]]
    ) -> str:
        """Return the reason why a place cannot be edited, or an empty string."""
        edits = changes[site]
        if any((other.value, other.lines) != (request.value, request.lines) for other in edits):
            return "it comes from a macro whose other expansions require different numbers"
        having = {id(other.element) for other in edits}
        for user in self.users[request.element.file.path, request.element.start]:
            if id(user) not in having and self._is_same_site(user, request, site):
                return (
                    "its source is also used elsewhere, where it must not change "
                    f"({user.describe()})"
                )
        return ""

    def _is_same_site(self, user: Element, request: RequestedEdit, site: Site) -> bool:
        if request.attribute is None:
            return True
        try:
            return self.find_site(RequestedEdit(user, request.attribute, request.value)) == site
        except _RefusedError:
            return False

    def find_site(self, request: RequestedEdit) -> Site:
        """Find the place in the source where a change must be made.

        Raises:
            _RefusedError: The element or attribute is computed or in a file that may not be edited.
        """
        element = request.element
        source = self._get_source(element.file)
        if element.start not in source.elements:
            raise _RefusedError("it is not a separate element in the source")
        if request.attribute is None:
            return Site(element.file.path, element.start, f"<{request.child}>")
        raw = edit.read_literal(source.elements[element.start], request.attribute)
        if raw is None:
            return Site(element.file.path, element.start, request.attribute)
        calls = [call for call in element.calls if call.macro]
        at, name = Site(element.file.path, element.start, request.attribute), request.attribute
        while "$" in raw:
            passed = _PARAMETER.fullmatch(raw.strip())
            call = calls.pop(0) if calls else None
            tag = None
            if passed and call is not None:
                tag = self._get_source(call.file).elements.get(call.start)
            known = passed is not None and tag is not None and passed[1] in tag.attributes
            if not (known and self.through_calls) or passed is None or call is None or tag is None:
                raise _RefusedError(f'{name}="{raw}" is computed')
            name = passed[1]
            raw = edit.read_literal(tag, name) or ""
            at = Site(call.file.path, call.start, name)
        return at

    def _get_source(self, file: SourceFile) -> edit.Source:
        if file.path not in self.sources:
            self._check_file(file)
            self.sources[file.path] = edit.Source(file)
        return self.sources[file.path]

    def _check_file(self, file: SourceFile) -> None:
        """Raise ``_RefusedError`` for files outside the user's package."""
        if file.path == self.main:
            return
        if self.single:
            raise _RefusedError(f"it is written in {file.path}, which -o OUT does not contain")
        path = self.description.packages.file
        own = find_own_package(path)
        root = str(own[1] if own else path.parent)
        real = os.path.abspath(file.path)
        if self.main == STDIN or not real.startswith(root + os.sep):
            raise _RefusedError(f"it is written in {file.path}, outside of {shorten_path(root)}")

    def _edit(self, site: Site, request: RequestedEdit) -> edit.Edit:
        source = self.sources[site.path]
        element = source.elements[site.start]
        if request.attribute is not None:
            return edit.set_attribute(source, element, site.what, request.value)
        after = element.find_child(request.after) if request.after else None
        if request.after == "mass" and after is None:
            after = element.find_child("origin")
        return edit.insert_child(source, element, request.lines, after=after)


def _place(request: RequestedEdit) -> Place:
    if request.attribute is None:
        return request.element.place
    return request.element.locate_attribute(request.attribute)


def _describe_edit(request: RequestedEdit) -> str:
    """Describe a change, and the macro expansion it is for."""
    call = next((call for call in request.element.calls if call.macro), None)
    if call is None:
        return request.description
    what = call.what if len(call.what) <= _LONGEST_CALL else f"macro '{call.macro}'"
    return f"{request.description} for {call.file.path}:{call.line}:{call.column} ({what})"
