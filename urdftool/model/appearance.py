"""What simulators show of visuals in addition to a color: lights of a material, transparency.

``APPEARANCE`` has a row for each value, as ``settings.py`` for friction. A reader of SDF fills
``Visual.appearance`` with the elements of the visual, that of URDF with those in ``<gazebo>``
blocks of the link; :func:`get_appearance` adds what the color or the named material means.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ..source.document import Element
from .elements import Link, Material, Robot, Visual
from .gazebo_colors import COLORS, Color
from .materials import compute_complement, resolve_material
from .read_settings import read_sdf_settings
from .settings import Rejected, Setting, Settings, Value, add_kinds, get_text

_BLACK = (0.0, 0.0, 0.0, 1.0)
_DARK = (0.0, 0.0, 0.0, 0.0)
_METAL = "material/pbr/metal/"

APPEARANCE = add_kinds("visual", (
    Setting("ambient", "", "material/ambient", _BLACK),
    Setting("diffuse", "", "material/diffuse", _BLACK),
    Setting("specular", "", "material/specular", _BLACK),
    Setting("emissive", "", "material/emissive", _BLACK),
    Setting("shininess", "", "material/shininess", 0.0, kind="number"),
    Setting("lighting", "", "material/lighting", True),
    Setting("double_sided", "", "material/double_sided", False),
    Setting("render_order", "", "material/render_order", 0.0, kind="number"),
    Setting("metalness", "", _METAL + "metalness", 0.5, kind="number"),
    Setting("roughness", "", _METAL + "roughness", 0.5, kind="number"),
    Setting("transparency", "", "transparency", 0.0),
    Setting("cast_shadows", "", "cast_shadows", True),
    Setting("visibility_flags", "", "visibility_flags", 4294967295.0),
    Setting("layer", "", "meta/layer", 0.0, kind="number"),
))  # fmt: skip
"""Values of a visual."""

_OF_MATERIALS = tuple(row for row in APPEARANCE if row.path.startswith("material/"))


def add_appearance(robot: Robot) -> None:
    """Read the appearance that ``<gazebo>`` blocks of a URDF give the visuals of their link.

    A ``<material>`` with children replaces that of URDF, the last of several counts; the elements
    of ``<visual>`` are added to it.
    """
    blocks = robot.block_elements
    for link in robot.links:
        part = ("link", link.name)
        found = _read_blocks(blocks.get(link.name, ()), robot.rejected_settings, part)
        script = _find_block_script(blocks.get(link.name, ()))
        for visual in link.visuals if found or script else ():
            visual.appearance, visual.script = found, script


def _read_blocks(
    elements: Iterable[Element], rejected: list[Rejected], part: tuple[str, str]
) -> Settings:
    settings: Settings = {}
    materials = [element for element in elements if element.tag == "material"]
    if materials and materials[-1].children:
        last = materials[-1]
        rows = [row._replace(path=row.path.removeprefix("material/")) for row in _OF_MATERIALS]
        replaced = (*rows, *(row for row in APPEARANCE if row.name == "transparency"))
        settings = {row.name: Value(last, row.default) for row in replaced}
        settings |= _add_diffuse(read_sdf_settings(last, rows, rejected, part))
    for element in elements:
        if element.tag == "visual":
            settings |= read_sdf_settings(element, APPEARANCE, rejected, part)
    return settings


def _find_block_script(elements: Sequence[Element]) -> str:
    """Return the last script that blocks name for the visuals of a link, of unknown color."""
    names = [name for element in elements if (name := find_script(element))]
    return "" if not names or names[-1] in COLORS else names[-1]


def find_unknown_script(link: Link, visual: Visual) -> str:
    """Return the script of a visual that says an unknown color; empty for none."""
    named = "" if link.gazebo_material in COLORS else link.gazebo_material
    return visual.script or named


def read_sdf_appearance(
    element: Element, rejected: list[Rejected], part: tuple[str, str]
) -> Settings:
    """Return the appearance of a ``<visual>`` of SDF; its own values count above a script."""
    color = COLORS.get(find_script(element))
    named = {} if color is None else convert_color(element, color)
    return named | _add_diffuse(read_sdf_settings(element, APPEARANCE, rejected, part))


def _add_diffuse(settings: Settings) -> Settings:
    """Return settings with the ambient color as diffuse color, if that is not written."""
    ambient = settings.get("ambient")
    return settings if ambient is None else {"diffuse": ambient} | settings


def find_script(element: Element) -> str:
    """Return the name of the script of a ``<visual>`` or ``<material>``; empty for none."""
    material = element if element.tag == "material" else element.find_child("material")
    script = None if material is None else material.find_child("script")
    name = None if script is None else script.find_child("name")
    return "" if name is None else get_text(name)


def get_appearance(robot: Robot, link: Link, visual: Visual) -> Settings:
    """Return everything that Gazebo shows of a visual, also what color and texture mean."""
    if robot.format == "sdf":
        return visual.appearance
    color = COLORS.get(link.gazebo_material)
    if color is not None:
        return convert_color(visual, color) | visual.appearance
    return convert_material(resolve_material(robot, visual.material)) | visual.appearance


def convert_material(own: Material | None) -> Settings:
    """Return the values of a color or texture of URDF, which is lit without a gloss."""
    if own is None or (own.color is None and own.texture is None):
        return {}
    rgba = own.color or (1.0, 1.0, 1.0, 1.0)
    settings: dict[str, Value] = {
        tag: Value(own.provenance, rgba) for tag in ("ambient", "diffuse")
    }
    if rgba[3] < 1.0:
        settings["transparency"] = Value(own.provenance, compute_complement(rgba[3]))
    if own.texture:
        settings["metalness"] = Value(own.provenance, 0.0)
    return settings


def convert_color(at: Element | Visual, color: Color) -> Settings:
    """Return the values of a named material of Gazebo."""
    source = at if isinstance(at, Element) else at.provenance
    found = {
        tag: Value(source, (*getattr(color, tag), color.alpha))
        for tag in ("ambient", "diffuse", "specular")
    }
    if any(color.emissive):
        found["emissive"] = Value(source, (*color.emissive, 1.0))
    if color.alpha < 1.0:
        found["transparency"] = Value(source, compute_complement(color.alpha))
    return found
