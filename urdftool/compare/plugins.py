"""Comparison of the plugins of Gazebo in URDF and SDF, in sensors, too."""

from __future__ import annotations

from collections.abc import Iterator, Set

import numpy as np

from ..mechanics.reference import Array, get_origin_matrix
from ..model.elements import Robot
from ..model.gazebo_plugins import MIMIC_PLUGINS
from ..model.mechanism import MountedPlugin
from ..model.numbers import parse_numbers
from ..model.part import ZERO, Origin
from ..model.plugins import is_part_of_robot, list_replacements, normalize_class
from .bodies import Bodies
from .difference import EXISTENCE, Comparison, Difference
from .pair import Pair, add_presence, locate
from .settings import measure_text

_ROW = "plugins"
_NUMBERS = 1e-9
"""Largest difference of parameters, relative above 1; of their printed digits. Chosen."""

_PLACES = 1e-6
"""Largest distance [m] and angle [rad] of the places of plugins; of printed digits. Chosen."""

_PLACE = ("bodyName", "xyzOffset", "rpyOffset")
"""Parameters of plugins for Gazebo Classic that name a link and a pose in it."""

_WITHOUT = frozenset(("mjcf", "usd"))
"""Formats without plugins of Gazebo."""


def compare_plugins(pair: Pair, comparison: Comparison) -> None:
    """Compare library, class and parameters of plugins; those of Gazebo Classic as those of gz."""
    if _ROW not in comparison.tolerances:
        return
    formats = {*pair.formats}
    if formats == {"urdf"}:
        comparison.skipped[_ROW] = "in the row of simulator data"
        return
    if without := sorted(form.upper() for form in formats & _WITHOUT):
        comparison.skipped[_ROW] = f"not in {' and '.join(without)}"
        return
    one, two = (list(_list_plugins(bodies.robot, formats)) for bodies in (pair.a, pair.b))
    found = _match(one, two, ("library", "name"), ("library",))
    for side, other in ((one, two), (two, one)):
        for plugin in list(side):
            for made in list_replacements(plugin):
                for x, y in _match([made], other, ("library", "name"), ("library",)):
                    found.append((x, y) if side is one else (y, x))
                    side[:] = [p for p in side if p is not plugin]
    found += _match(one, two, ("owner", "name"))
    for x, y in found:
        _compare(pair, x, y, comparison)
    for number, side in enumerate((one, two)):
        for plugin in side:
            if is_part_of_robot(plugin):
                continue
            name = plugin.name or plugin.library
            add_presence(
                comparison, _ROW, "plugin", EXISTENCE, number, plugin, name, plugin.library,
                owners=(plugin.owner, plugin.library),
            )  # fmt: skip


def _list_plugins(robot: Robot, formats: Set[str]) -> Iterator[MountedPlugin]:
    """Yield the plugins; those in sensors of two SDF are compared as elements of the sensors."""
    yield from robot.mounted_plugins
    if formats != {"sdf"}:
        yield from robot.sensor_plugins


def _match(
    one: list[MountedPlugin], two: list[MountedPlugin], *keys: tuple[str, ...]
) -> list[tuple[MountedPlugin, MountedPlugin]]:
    """Remove plugins that are equal in the attributes of a key, and return them as pairs."""
    found = []
    for key in keys:
        for x in list(one):
            for y in two:
                if all(getattr(x, name) == getattr(y, name) for name in key):
                    found.append((x, y))
                    one[:] = [plugin for plugin in one if plugin is not x]
                    two[:] = [plugin for plugin in two if plugin is not y]
                    break
    return found


def _compare(pair: Pair, one: MountedPlugin, two: MountedPlugin, comparison: Comparison) -> None:
    """Compare class and parameters; names of links and joints may be those of the other robot."""
    renamed = {**pair.joints, **pair.links}
    names = one.name or one.library, two.name or two.library
    owners = (one.owner, two.owner, one.library, two.library)

    def add(what: str, values: tuple[object, object], amount: float, name: str = "") -> None:
        places = locate(one.settings.get(name), one), locate(two.settings.get(name), two)
        comparison.add(
            Difference(_ROW, "plugin", names, what, values, "", amount, places, owners=owners)
        )

    same_class = normalize_class(one.name) == normalize_class(two.name)
    is_kept = one.library in MIMIC_PLUGINS or same_class
    add("library", (one.library, two.library), 0.0 if one.library == two.library else float("inf"))
    add("class", (one.name, two.name), 0.0 if is_kept else float("inf"))
    moved = _PLACE if _is_same_place(pair, one, two) else ()
    for name in dict.fromkeys((*one.settings, *two.settings)):
        if name in moved:
            continue
        texts = [
            "" if value is None else " ".join(str(value.content).split())
            for value in (one.settings.get(name), two.settings.get(name))
        ]
        amount = 0.0 if renamed.get(texts[0]) == texts[1] else measure_text(texts[0], texts[1])
        add(name, (texts[0], texts[1]), amount if amount > _NUMBERS else 0.0, name)


def _is_same_place(pair: Pair, one: MountedPlugin, two: MountedPlugin) -> bool:
    """Tell whether two plugins measure one point of a body, in the frames of other links of it.

    Gazebo Classic merges links, and moves what names them.
    """
    here, there = _find_place(pair.a, one), _find_place(pair.b, two)
    if here is None or there is None:
        return False
    (body, pose), (other, found) = here, there
    matched, frame = pair.frames.get(body, ("", np.eye(4)))
    return matched == other and bool(np.abs(pose - frame @ found).max() <= _PLACES)


def _find_place(bodies: Bodies, plugin: MountedPlugin) -> tuple[str, Array] | None:
    """Return the body of the link that a plugin names, and the pose there; None for none."""
    texts = {name: str(value.content) for name, value in plugin.settings.items()}
    link, *offsets = (texts.get(name, "") for name in _PLACE)
    body = bodies.body_of.get(link)
    if body is None:
        return None
    xyz, rpy = (parse_numbers(text, 3) or ZERO for text in offsets)
    origin = Origin(plugin.provenance, xyz, rpy)  # type: ignore[arg-type]
    return body, bodies.by_name[body].members[link] @ get_origin_matrix(origin)
