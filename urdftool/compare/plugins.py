"""Comparison of the plugins of Gazebo in URDF and SDF."""

from __future__ import annotations

from ..model.gazebo_plugins import MIMIC_PLUGINS
from ..model.mechanism import MountedPlugin
from ..model.plugins import is_part_of_robot, list_replacements
from .difference import Comparison, Difference
from .pair import Pair, add_presence, locate
from .settings import measure_text

_ROW = "plugins"
_NUMBERS = 1e-9
"""Largest difference of parameters, relative above 1; of their printed digits. Chosen."""

_WITHOUT = {"mjcf": "MJCF", "usd": "USD"}
"""Formats without plugins of Gazebo."""


def compare_plugins(pair: Pair, comparison: Comparison) -> None:
    """Compare library, class and parameters of plugins; those of Gazebo Classic as those of gz."""
    if _ROW not in comparison.tolerances:
        return
    formats = {*pair.formats}
    if formats == {"urdf"}:
        comparison.skipped[_ROW] = "in the row of simulator data"
        return
    without = [name for form, name in _WITHOUT.items() if form in formats]
    if without:
        comparison.skipped[_ROW] = f"not in {' and '.join(without)}"
        return
    one, two = (list(bodies.robot.mounted_plugins) for bodies in (pair.a, pair.b))
    found = _match(one, two)
    for side, other in ((one, two), (two, one)):
        for plugin in list(side):
            for made in list_replacements(plugin):
                for x, y in _match([made], other):
                    found.append((x, y) if side is one else (y, x))
                    side[:] = [p for p in side if p is not plugin]
    for x, y in found:
        _compare(pair, x, y, comparison)
    for number, side in enumerate((one, two)):
        for plugin in side:
            if is_part_of_robot(plugin):
                continue
            name = plugin.name or plugin.library
            add_presence(
                comparison, _ROW, "plugin", "existence", number, plugin, name, plugin.library,
                owners=(plugin.owner, plugin.library),
            )  # fmt: skip


def _match(
    one: list[MountedPlugin], two: list[MountedPlugin]
) -> list[tuple[MountedPlugin, MountedPlugin]]:
    """Remove plugins of the same library, of the same name first, and return them as pairs."""
    found = []
    for same_name in (True, False):
        for x in list(one):
            for y in two:
                if x.library == y.library and (not same_name or x.name == y.name):
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

    is_kept = one.library in MIMIC_PLUGINS or one.name == two.name
    add("class", (one.name, two.name), 0.0 if is_kept else float("inf"))
    for name in dict.fromkeys((*one.settings, *two.settings)):
        texts = [
            "" if value is None else " ".join(str(value.content).split())
            for value in (one.settings.get(name), two.settings.get(name))
        ]
        amount = 0.0 if renamed.get(texts[0]) == texts[1] else measure_text(texts[0], texts[1])
        add(name, (texts[0], texts[1]), amount if amount > _NUMBERS else 0.0, name)
