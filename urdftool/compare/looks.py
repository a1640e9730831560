"""Comparison of the appearance of equal visuals: lights, transparency, images."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..errors import UrdftoolError
from ..model.appearance import APPEARANCE, find_unknown_script, get_appearance
from ..model.elements import Geometry, Link, Mesh, Robot, Visual
from ..model.materials import resolve_material
from ..model.settings import Settings
from .difference import Comparison, Difference
from .pair import Pair, locate
from .settings import compare_settings
from .uncompared import COLORED, IMAGES, Uncompared

_FORMATS = ("urdf", "sdf")
"""Formats that have all values of the appearance; URDF in ``<gazebo>``."""


def skip_looks(pair: Pair, comparison: Comparison) -> None:
    """Skip the row of the appearance if one of the formats does not have it."""
    others = sorted(set(pair.formats) - set(_FORMATS))
    if others:
        comparison.skipped["looks"] = f"not read of {' and '.join(name.upper() for name in others)}"


def compare_looks(
    pair: Pair,
    comparison: Comparison,
    links: Sequence[Link],
    visuals: tuple[Visual, Visual],
    *,
    has_color: bool,
) -> None:
    """Compare two visuals of equal geometry."""
    robots = pair.a.robot, pair.b.robot
    sides = list(zip(robots, links, visuals, strict=True))
    names = links[0].name, links[1].name
    scripts = [find_unknown_script(link, visual) for _, link, visual in sides]
    if any(scripts):
        if set(pair.formats) <= set(_FORMATS):
            comparison.record_parts("looks", scripts)
            if scripts[0] != scripts[1]:
                _add(comparison, "looks", names, "material script", scripts, visuals)
        return
    if set(pair.formats) <= set(_FORMATS):
        one, two = (_get_settings(pair, *side) for side in sides)
        rows = [row for row in APPEARANCE if row.name != "diffuse" or not has_color]
        compare_settings(pair, comparison, "looks", "link", names, rows, (one, two), visuals)
    _compare_images(pair, comparison, names, visuals)


def _compare_images(
    pair: Pair, comparison: Comparison, names: tuple[str, str], visuals: tuple[Visual, Visual]
) -> None:
    """Compare the images of two visuals, pixel by pixel where their files differ.

    MJCF and USD have the images in mesh files of URDF and SDF as materials.
    """
    shapes = visuals[0].geometry, visuals[1].geometry
    if is_colored_by_file(pair, shapes):
        skip_file_colors(pair, comparison, "textures", shapes)
        if not set(pair.formats) <= set(_FORMATS):
            return
    sides = list(zip((pair.a.robot, pair.b.robot), visuals, strict=True))
    images = [_find_image(*side) for side in sides]
    if images == [None, None]:
        names_of_files = [_get_texture(*side) for side in sides]
        if pair.formats[0] == pair.formats[1] and names_of_files[0] != names_of_files[1]:
            _add(comparison, "textures", names, "image of a visual", names_of_files, visuals)
        _skip_unread_images(pair, comparison, visuals)
    digests = [None if path is None else pair.meshes.get_digest(path) for path in images]
    comparison.record_parts("textures", *images)
    if digests[0] == digests[1]:
        return
    if None not in images:
        digests = [pair.meshes.get_pixel_digest(path) for path in images if path is not None]
    if digests[0] != digests[1]:
        texts = ["" if path is None else path.name for path in images]
        _add(comparison, "textures", names, "image of a visual", texts, visuals)


def _skip_unread_images(pair: Pair, comparison: Comparison, visuals: tuple[Visual, Visual]) -> None:
    """Record the images of two visuals that no file that can be read has."""
    for robot, visual in zip((pair.a.robot, pair.b.robot), visuals, strict=True):
        material = resolve_material(robot, visual.material)
        if material is not None and material.texture is not None:
            name = material.texture or f"of material '{material.name}'"
            reason = "it is missing or may not be read" if material.texture else "MuJoCo makes it"
            comparison.record_uncompared(Uncompared("textures", IMAGES, name, reason))


def is_colored_by_file(pair: Pair, shapes: tuple[Geometry | None, Geometry | None]) -> bool:
    """Tell whether one of two shapes is a mesh file with colors of its own."""
    sides = zip((pair.a.robot, pair.b.robot), shapes, strict=True)
    return any(pair.meshes.has_own_colors(*side) for side in sides)


def skip_file_colors(
    pair: Pair,
    comparison: Comparison,
    row: str,
    shapes: tuple[Geometry | None, Geometry | None],
) -> None:
    """Record that the colors and images in the files of two meshes are equal, or not compared."""
    robots = pair.a.robot, pair.b.robot
    one, two = shapes
    if isinstance(one, Mesh) and isinstance(two, Mesh):
        if pair.meshes.has_equal_looks(robots, (one, two)):
            comparison.record_parts(row, [one])
            return
    for robot, shape in zip(robots, shapes, strict=True):
        if isinstance(shape, Mesh) and pair.meshes.has_own_colors(robot, shape):
            name = pair.meshes.name_file(robot, shape)
            reason = "the colors and images in the file are not compared"
            comparison.record_uncompared(Uncompared(row, COLORED, name, reason))


def _get_settings(pair: Pair, robot: Robot, link: Link, visual: Visual) -> Settings:
    """Return the appearance of a visual, only what blocks set if both robots are URDF."""
    if pair.formats == ("urdf", "urdf"):
        return visual.appearance
    settings = dict(get_appearance(robot, link, visual))
    if "metalness" not in visual.appearance and _find_image(robot, visual) is None:
        settings.pop("metalness", None)  # of an image that does not exist
    return settings


def _get_texture(robot: Robot, visual: Visual) -> str:
    """Return the texture of a visual as it is written; empty if it has none."""
    material = resolve_material(robot, visual.material)
    return (material.texture or "") if material is not None else ""


def _find_image(robot: Robot, visual: Visual) -> Path | None:
    """Return the image of a visual; None if there is none, or its file does not exist."""
    material = resolve_material(robot, visual.material)
    if material is None or not material.texture or robot.source is None:
        return None
    try:
        path = robot.source.resolve(material.texture)
    except UrdftoolError:
        return None
    return path if path.is_file() else None


def _add(
    comparison: Comparison,
    row: str,
    names: tuple[str, str],
    what: str,
    values: Sequence[str],
    visuals: tuple[Visual, Visual],
) -> None:
    shown = values[0] or "none", values[1] or "none"
    places = locate(visuals[0], None), locate(visuals[1], None)
    comparison.add(Difference(row, "link", names, what, shown, "", float("inf"), places))
