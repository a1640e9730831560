"""The visuals of a link that are drawn, each once."""

from __future__ import annotations

from .elements import Link, Material, Robot, Visual
from .materials import UNCOLORED, resolve_material
from .pose import make_pose
from .shapes import has_equal_values

Look = tuple[tuple[float, float, float, float] | None, str | None]
"""Color and image of a material."""

_PLAIN: Look = (None, None)


def list_drawn_once(robot: Robot, link: Link) -> list[Visual]:
    """List the visuals of a link without those that repeat another one.

    A geom of MJCF that collides and is drawn often repeats a visual. Of visuals with equal shapes
    at equal poses, one of each color is kept; one without a color only if no other has one.
    """
    kept: list[tuple[Visual, Look]] = []
    placed: dict[object, list[int]] = {}
    for visual in link.visuals:
        own = _get_own_look(robot, visual.material)
        near = placed.setdefault(make_pose(visual.origin).translation, [])
        looks = {n: kept[n][1] for n in near if _repeats(visual, kept[n][0])}
        plain = [number for number, look in looks.items() if look == _PLAIN]
        if plain:
            kept[plain[0]] = kept[plain[0]] if own == _PLAIN else (visual, own)
        elif not looks or (own != _PLAIN and own not in looks.values()):
            near.append(len(kept))
            kept.append((visual, own))
    return [visual for visual, _ in kept]


def _get_own_look(robot: Robot, material: Material | None) -> Look:
    """Return color and image of a material; none for what its format takes without one."""
    full = resolve_material(robot, material)
    if full is None or (full.color == UNCOLORED.get(robot.format) and not full.texture):
        return _PLAIN
    return full.color, full.texture


def _repeats(one: Visual, other: Visual) -> bool:
    """Tell whether two visuals have the same shape at the same pose, and no other settings."""
    return (
        has_equal_values(one.geometry, other.geometry)
        and make_pose(one.origin) == make_pose(other.origin)
        and not one.appearance
        and not other.appearance
    )
