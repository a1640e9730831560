"""Values that a friction, contact or spring cannot have, in ``<gazebo>`` and ``<contact>``."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ...model.block_elements import list_part_elements
from ...model.elements import Joint, Link, Robot
from ...model.read import number
from ...model.read_settings import list_settings
from ...model.sdf_schema import describe_bounds, describe_kind
from ...model.settings import (
    SURFACE,
    UNBOUNDED,
    Setting,
    describe_rejected,
    get_text,
    list_rows,
)
from ...source.document import Element
from ..rule import ERROR, WARNING, Problem, rule
from ..unexpanded import is_unexpanded

APPLIES_TO = ("gazebo", "contact")

_REJECTED = "gz, gazebo-classic (a negative friction)"
_TAKEN = "gz, gazebo-classic (another value)"
_BULLET = "pybullet (<contact>)"
_STIFFNESS = "pybullet (<contact>, a negative stiffness)"
_NO_NUMBER = "pybullet (<contact>, not a number)"
_NO_VALUE = "pybullet (<contact>, no value)"
_REJECTS = frozenset((_REJECTED, _NO_VALUE))


class _Written(NamedTuple):
    """An element that sets something."""

    part: Link | Joint
    element: Element
    row: Setting
    is_bullet: bool = False


@rule(
    WARNING,
    effects={
        _REJECTED: "reject the model (sdformat 12.3: Error 9)",
        _TAKEN: "take it as written (sdformat 12.3)",
        _BULLET: "takes it as written",
        _STIFFNESS: "takes a stiffness of 2e-16 N/m, which supports nothing",
        _NO_NUMBER: "takes the number with which it begins, or 0 without one",
        _NO_VALUE: "rejects the robot",
    },
)
def setting_out_of_range(robot: Robot) -> Iterator[Problem]:
    """A friction, contact or spring has a value that is physically impossible.

    A friction, stiffness or damping below 0, or a restitution that is not between 0 and 1, adds
    energy or has no meaning: a spring with a negative stiffness pushes the joint away from its
    reference. It is an error where Gazebo rejects the model. Values in ``<contact>`` of a link are
    those of PyBullet, which also takes a text that is not a number, and rejects the robot where the
    attribute ``value`` is absent.
    """
    for written in _list_written(robot):
        text = get_text(written.element)
        value = number(text)
        if written.is_bullet and written.element.get("value") is None:
            yield _report(written, "", (_NO_VALUE,))
            continue
        if value is None:
            if written.is_bullet and not is_unexpanded(text):
                yield _report(written, describe_kind(written.row.kind), (_NO_NUMBER,))
            continue
        least, most = get_range(written.row)
        if not least <= value <= most:
            required = describe_kind(written.row.kind) + describe_bounds(least, most)
            yield _report(written, required, _list_effects(written))


def get_range(row: Setting) -> tuple[float, float]:
    """Return the smallest and largest value that make sense."""
    return row.range if row.bounds == UNBOUNDED else row.bounds


def _list_written(robot: Robot) -> Iterator[_Written]:
    """Yield what sets a number: tags, elements of SDF, and children of ``<contact>``, each once."""
    seen: set[int] = set()
    for one in (*_list_tags(robot), *_list_bullet(robot), *_list_others(robot)):
        if id(one.element) not in seen and one.row.kind == "number":
            seen.add(id(one.element))
            yield one


def _list_tags(robot: Robot) -> Iterator[_Written]:
    parts: list[Link | Joint] = [*robot.links, *robot.joints]
    for part in parts:
        for element in list_part_elements(robot, part):
            for row in list_rows(element.tag):
                yield _Written(part, element, row)


def _list_bullet(robot: Robot) -> Iterator[_Written]:
    rows = [row for row in SURFACE if row.contact]
    for link in robot.links:
        contact = link.find_child_xml("contact")
        for row in rows if contact is not None else ():
            for element in contact.list_children(row.contact) if contact is not None else ():
                yield _Written(link, element, row, is_bullet=True)


def _list_others(robot: Robot) -> Iterator[_Written]:
    """Yield the elements of SDF that the model has; ``invalid-sdf-value`` reports others."""
    for kind, name, rows, settings in list_settings(robot):
        part = {"link": robot.link.get(name), "joint": robot.joint.get(name)}.get(kind)
        for row in rows:
            value = settings.get(row.name)
            if part is not None and value is not None and value.xml is not None:
                yield _Written(part, value.xml, row)


def _list_effects(written: _Written) -> tuple[str, ...]:
    if written.is_bullet:
        return (_STIFFNESS,) if written.row.contact == "stiffness" else (_BULLET,)
    return (_TAKEN,) if written.row.bounds == UNBOUNDED else (_REJECTED,)


def _report(written: _Written, required: str, effects: tuple[str, ...]) -> Problem:
    """Report a value that is not what it has to be; without a requirement, that it is absent."""
    element, part = written.element, written.part
    kind = "link" if isinstance(part, Link) else "joint"
    message = f"{kind} '{part.name}': {element.tag} has no attribute value; write it"
    if required:
        message = describe_rejected((kind, part.name), element.tag, get_text(element), required)
    return Problem(
        part,
        message,
        at=element,
        severity=ERROR if not _REJECTS.isdisjoint(effects) else None,
        effects=effects,
        data={"setting": written.row.name},
    )
