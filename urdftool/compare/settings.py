"""Comparison of friction, contact, springs and flags."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping

from ..model.elements import Link, Robot
from ..model.numbers import describe_content, number
from ..model.part import Part
from ..model.settings import (
    ALL_OF_JOINTS,
    ALL_OF_LINKS,
    ALL_SURFACE,
    OF_ROBOT,
    Content,
    Setting,
    Settings,
    Value,
)
from .difference import Comparison, Difference, describe_change
from .joints import JointMatch, measure
from .pair import Match, Pair, locate
from .references import compare_references
from .tolerance import is_same


def compare_surfaces(
    pair: Pair,
    comparison: Comparison,
    names: tuple[str, str],
    settings: tuple[Settings, Settings],
    parts: tuple[Part, Part],
) -> None:
    """Compare friction and contact of two collisions of links.

    The friction in the second direction counts where both have it: MJCF and USD have one value for
    both directions, of which an export writes the first.
    """
    rows = [
        row for row in ALL_SURFACE if row.name != "second_friction" or _is_shared(pair, settings)
    ]
    compare_settings(pair, comparison, "surface", "link", names, rows, settings, parts)


def _is_shared(pair: Pair, settings: tuple[Settings, Settings]) -> bool:
    """Tell whether the friction in the second direction of two collisions is compared."""
    by_direction = {"urdf", "sdf"}.issuperset(pair.formats)
    return by_direction or all("second_friction" in one for one in settings)


def compare_robot_flags(pair: Pair, comparison: Comparison) -> None:
    """Compare the settings of whole robots; that of ``static`` in the base, if both write it."""
    robots = pair.a.robot, pair.b.robot
    settings = robots[0].settings, robots[1].settings
    names = robots[0].name, robots[1].name
    base = [row for row in OF_ROBOT if row.name == "static"]
    rows = [row for row in OF_ROBOT if row.name != "static"]
    if set(pair.formats) == {"urdf", "sdf"}:
        compare_settings(pair, comparison, "base", "robot", names, base, settings, robots)
    compare_settings(pair, comparison, "link flags", "robot", names, rows, settings, robots)


def compare_flags(pair: Pair, match: Match, comparison: Comparison) -> None:
    """Compare the settings of the links of two bodies."""
    for x, y in pair.match_members(match.one, match.two):
        links = pair.a.robot.link[x], pair.b.robot.link[y]
        settings = links[0].settings, links[1].settings
        compare_settings(
            pair, comparison, "link flags", "link", (x, y), ALL_OF_LINKS, settings, links
        )


def compare_joint_settings(
    pair: Pair, match: JointMatch, sign: float, comparison: Comparison
) -> None:
    """Compare the settings and references of a joint; the rest of a spring only of a spring."""
    one, two, _ = match
    settings = _turn(one.settings, 1.0), _turn(two.settings, sign)
    names = one.name, two.name
    sprung = one.spring is not None or two.spring is not None
    rows = [row for row in ALL_OF_JOINTS if sprung or row.name != "spring_reference"]
    compare_settings(pair, comparison, "joint physics", "joint", names, rows, settings, (one, two))
    compare_references(pair, (one, two), sign, comparison)


def _turn(settings: Settings, sign: float) -> Settings:
    """Return the settings of a joint with the opposite axis for a negative sign."""
    rest = settings.get("spring_reference")
    if sign > 0 or rest is None or isinstance(rest.content, tuple | str):
        return settings
    return settings | {"spring_reference": type(rest)(rest.provenance, -rest.content)}


def compare_settings(
    pair: Pair,
    comparison: Comparison,
    row: str,
    kind: str,
    names: tuple[str, str],
    rows: Iterable[Setting],
    settings: tuple[Settings, Settings],
    owners: tuple[Part, Part],
) -> None:
    """Compare the values of the rows of a table that two parts have."""
    if row not in comparison.tolerances:
        return
    for setting, (x, y), parts in _list_values(rows, settings):
        what = setting.name.replace("_", " ")
        if not setting.path and not setting.mjcf:
            continue
        if not all(_has(form, setting) for form in pair.formats):
            if x != setting.default or y != setting.default:
                comparison.record_not_comparable(row, f"{what}: not in every format")
            continue
        places = locate(parts[0], owners[0]), locate(parts[1], owners[1])
        amount = measure_content(x, y)
        values: tuple[object, object] = describe_content(x), describe_content(y)
        comparison.add(Difference(row, kind, names, what, values, setting.unit, amount, places))


def _list_values(
    rows: Iterable[Setting], settings: tuple[Settings, Settings]
) -> Iterator[tuple[Setting, tuple[Content, Content], tuple[Value | None, Value | None]]]:
    """Yield the settings that one of two parts has, both values, and those that are written.

    The value of a missing one is that which SDF has without it.
    """
    for setting in rows:
        parts = settings[0].get(setting.name), settings[1].get(setting.name)
        if parts != (None, None):
            x, y = (setting.default if part is None else part.content for part in parts)
            yield setting, (x, y), parts


def compare_written_settings(
    a: Robot, b: Robot, tolerance: float, renamed: Mapping[str, str]
) -> Iterator[Difference]:
    """Yield the differences of settings of links and joints that both robots have.

    Nothing of two URDF, of which the elements of their blocks are compared.
    """
    if a.xml is not None and b.xml is not None:
        return
    for x in a.links:
        link = b.link.get(renamed.get(x.name, x.name))
        if link is not None:
            yield from _compare_written_link(x, link, tolerance)
    for joint in a.joints:
        other = b.joint.get(renamed.get(joint.name, joint.name))
        if other is not None:
            part, settings = ("joint", other.name), (joint.settings, other.settings)
            yield from _compare_written("joint physics", part, ALL_OF_JOINTS, settings, tolerance)


def _compare_written_link(x: Link, y: Link, tolerance: float) -> Iterator[Difference]:
    """Yield the differences of settings of a link and of its collisions, by name or number."""
    part, settings = ("link", y.name), (x.settings, y.settings)
    yield from _compare_written("link flags", part, ALL_OF_LINKS, settings, tolerance)
    sides = [{c.name or str(i): c.surface for i, c in enumerate(e.collisions, 1)} for e in (x, y)]
    for name in dict.fromkeys((*sides[0], *sides[1])):
        settings, about = (sides[0].get(name, {}), sides[1].get(name, {})), f"collision {name}: "
        yield from _compare_written("surface", part, ALL_SURFACE, settings, tolerance, about)


def _compare_written(
    row: str,
    part: tuple[str, str],
    rows: Iterable[Setting],
    settings: tuple[Settings, Settings],
    tolerance: float,
    about: str = "",
) -> Iterator[Difference]:
    for setting, values, sides in _list_values(rows, settings):
        if not is_same(*values, tolerance):
            what = about + setting.name.replace("_", " ")
            yield describe_change(row, *part, what, values, sides, setting.unit)


def _has(form: str, setting: Setting) -> bool:
    """Tell whether a format has a setting."""
    return bool(getattr(setting, form, setting.path))


def measure_content(x: Content, y: Content) -> float:
    """Return how far two values are apart, relative above 1; infinite for unequal texts."""
    if isinstance(x, tuple) and isinstance(y, tuple):
        if len(x) != len(y):
            return math.inf
        return max((abs(a - b) for a, b in zip(x, y, strict=True)), default=0.0)
    if isinstance(x, str) and isinstance(y, str):
        return measure_text(x, y)
    if isinstance(x, tuple | str) or isinstance(y, tuple | str):
        return 0.0 if x == y else math.inf
    if isinstance(x, bool) or isinstance(y, bool):
        return 0.0 if bool(x) == bool(y) else math.inf
    return measure(x, y)


def measure_text(x: str, y: str) -> float:
    """Return how far the numbers of two texts are apart; infinite for other unequal texts."""
    if x == y:
        return 0.0
    one, two = ([number(word) for word in text.split()] for text in (x, y))
    if len(one) != len(two) or not one:
        return math.inf
    return max(
        math.inf if a is None or b is None else measure(a, b) for a, b in zip(one, two, strict=True)
    )
