"""Verification that an edited source is the same robot except for the inertia to change."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from ..errors import SourceError, UrdftoolError
from ..mechanics.spatial_inertia import SpatialInertia, link_inertia
from ..model.elements import Link, Robot
from ..model.read import read_robot
from ..source import edit
from ..source.description import is_xacro
from ..source.document import Document, Element, parse
from ..source.location import SourceFile
from .fill import Filling, fill
from .link_review import LinkReview
from .masses import Masses
from .requirements import is_consistent


def plan_checked_filling(
    robot: Robot, found: Sequence[LinkReview], masses: Masses, *, single: bool = False
) -> tuple[Filling, dict[str, bytes]]:
    """Plan edits as :func:`fill` does, verify them, and return the new content of each file.

    If an argument of a macro call also affects other elements, the plan is repeated without editing
    arguments.

    Raises:
        SourceError: The edits would change more than they should.
    """
    assert robot.source is not None
    files = {file.path: file for file in robot.source.files}
    problem = ""
    for through_calls in (True, False):
        filling = fill(robot, found, masses, single=single, through_calls=through_calls)
        edited = {path: edit.apply(files[path], edits) for path, edits in filling.edits.items()}
        problem = check_filling(robot, filling, edited)
        if not problem:
            return filling, edited
    raise SourceError(f"is not written: {problem}", path=robot.source.path)


def check_filling(robot: Robot, filling: Filling, edited: Mapping[str, bytes]) -> str:
    """Verify an edited source; return the problem, or an empty string.

    The edited text is parsed and expanded with the edited includes; then each element is compared
    with the original.
    """
    assert robot.source is not None
    try:
        for path, data in edited.items():
            parse(SourceFile(path, data))
        root = _read(robot, edited).root
    except UrdftoolError as error:
        return f"the edited text cannot be read: {error}"
    names = {link_edits.link.name for link_edits in filling.written}
    before = list(_list_outside(robot.source.document.root, names))
    after = list(_list_outside(root, names))
    if before != after:
        changed = next(
            (a for a, b in zip(after, before, strict=False) if a != b), after[-1:] or "its end"
        )
        return f"the edit would change more than inertia: {changed}"
    links = read_robot(root).link
    for link_edits in filling.written:
        link = links.get(link_edits.link.name)
        if link is None or not _has(link, link_edits.result, exact=not link_edits.item.missing):
            return f"link '{link_edits.link.name}' would not have the computed inertia"
    return ""


def _read(robot: Robot, edited: Mapping[str, bytes]) -> Document:
    description = robot.source
    assert description is not None
    main = description.files[0]
    file = SourceFile(main.path, edited.get(main.path, main.data))
    if not is_xacro(file):
        return parse(file)
    from ..source.expand import expand_xacro

    finder = description.packages
    packages = finder.with_workspace(finder.files.get_with_overlay(edited))
    return expand_xacro(file, description.arguments, packages).make_document()


def _list_outside(
    root: Element, names: set[str]
) -> Iterator[tuple[str, tuple[tuple[str, str], ...], str]]:
    """Yield every element except the inertials of the named links."""
    todo = [root]
    while todo:
        element = todo.pop()
        yield element.tag, tuple(sorted(element.attributes.items())), element.text
        children = element.children
        if element.tag == "link" and element.get("name") in names:
            children = [child for child in children if child.tag != "inertial"]
        todo.extend(reversed(children))


def _has(link: Link, meant: SpatialInertia, *, exact: bool) -> bool:
    """Tell whether a link's inertia is consistent and, if ``exact``, equal to the intended one."""
    inertial = link.inertial
    if inertial is None or inertial.mass is None or inertial.inertia is None:
        return False
    written = link_inertia(link)
    if not is_consistent(written, tolerance=1e-6):
        return False
    if not exact:
        return True
    size = max(map(abs, meant.tensor))
    return math.isclose(written.mass, meant.mass, rel_tol=1e-9) and all(
        abs(one - other) <= 1e-9 * size
        for one, other in zip(written.tensor, meant.tensor, strict=True)
    )
