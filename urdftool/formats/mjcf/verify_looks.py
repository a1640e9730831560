"""Comparison of the colors and images of visual geometry."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...compare.check import Check
from ...errors import UrdftoolError
from ...geometry.image_file import open_image
from ...geometry.mesh import Part
from ...model.elements import Capsule, Geometry, Link, Mesh, Robot, UnknownShape, Visual
from ...model.materials import find_shown_material
from ...model.shapes import describe_shape
from ..common.losses import DeclaredLosses, list_look_names
from .compiled import Compiled
from .declared_losses import LOOKS, SHAPES
from .verify_meshes import SourceMeshes

Rgba = tuple[float, ...]
Image = Path | bytes

WHITE: Rgba = (1.0, 1.0, 1.0, 1.0)
GREY: Rgba = (0.5, 0.5, 0.5, 1.0)
"""MuJoCo's default color of a geom."""

SINGLE = 1e-6
"""Tolerance of colors, which MuJoCo stores in single precision."""

VISUAL_GROUP = 2
"""Group of geoms that are only seen, by convention of MuJoCo Menagerie."""


@dataclass(frozen=True)
class Look:
    """Appearance of one geom: its color, and its image if it has one."""

    rgba: Rgba
    image: Image | None = None


def check_material(
    robot: Robot, meshes: SourceMeshes, compiled: Compiled, declared: DeclaredLosses
) -> Check:
    """Compare the color and the image of every visual geom."""
    check = Check("materials", "color, image and gloss of visual geometry", SINGLE, is_empty=True)
    model, pictures = compiled.model, Pictures(compiled)
    plain = compiled.get_reference()
    for link in robot.links:
        known = declared.has_for((*LOOKS, *SHAPES), link.name, *list_look_names(link))
        looks = list(_list_looks(robot, meshes, link))
        geoms = list(_list_geoms(compiled, link))
        if len(looks) != len(geoms):
            text = f"link '{link.name}': {len(geoms)} visual geoms, of {len(looks)}"
            check.compare(math.inf, text, known=known)
            continue
        for look, geom in zip(looks, geoms, strict=True):
            material = int(model.geom_matid[geom])
            rgba = model.mat_rgba[material] if material >= 0 else model.geom_rgba[geom]
            off = float(abs(np.array(rgba) - look.rgba).max())
            check.compare(off, f"color of link '{link.name}'", known=known)
            texture = pictures.get_texture(material)
            if (texture >= 0) != (look.image is not None):
                text = "is missing" if look.image is not None else "is not in the description"
                check.compare(math.inf, f"image of link '{link.name}' {text}", known=known)
            elif look.image is not None and not pictures.is_same(texture, look.image):
                check.compare(math.inf, f"image of link '{link.name}' differs", known=known)
            for field in ("emission", "specular", "shininess", "reflectance", "texrepeat"):
                if material >= 0 and robot.format != "mjcf":  # whose gloss is compared as written
                    usual = getattr(plain, f"mat_{field}")[0]
                    off = float(np.max(abs(getattr(model, f"mat_{field}")[material] - usual)))
                    check.compare(off, f"{field} of the material of link '{link.name}'")
    return check


def _list_looks(robot: Robot, meshes: SourceMeshes, link: Link) -> Iterator[Look]:
    """Yield the expected appearance of each geom of a link's visuals, in file order."""
    for visual in link.visuals:
        if not _has_size(visual.geometry):
            continue
        own = _get_own(robot, link, visual)
        if not isinstance(visual.geometry, Mesh):
            yield own
            continue
        mesh = meshes.read(visual.geometry.filename, visual.geometry.scale)
        if mesh is None:
            continue
        parts = dict.fromkeys((part.rgba, _get_part_image(part)) for part in mesh.parts)
        for rgba, image in parts:
            there = image is not None and (isinstance(image, bytes) or os.path.isfile(image))
            if there:
                yield Look(WHITE, image)
            elif rgba is not None:
                yield Look(rgba)
            else:
                yield own


def _list_geoms(compiled: Compiled, link: Link) -> Iterator[int]:
    """Yield the visual geoms of a link, in file order."""
    for geom in compiled.get_geoms(compiled.get_body(link.name)):
        if compiled.model.geom_group[geom] == VISUAL_GROUP:
            yield geom


def _has_size(geometry: Geometry | None) -> bool:
    """Tell whether a shape has a size above zero; a mesh always does."""
    if geometry is None or isinstance(geometry, Mesh | UnknownShape):
        return isinstance(geometry, Mesh)
    lengths = describe_shape(geometry)
    sizes = [
        value for key in ("size", "radii", "radius", "length") for value in lengths.get(key) or ()
    ]
    return isinstance(geometry, Capsule) or (bool(sizes) and min(sizes) > 0)


def _get_own(robot: Robot, link: Link, visual: Visual) -> Look:
    """Return the appearance of a visual by its material, or by Gazebo's if it has none."""
    material = find_shown_material(robot, link, visual)
    if material is None:
        return Look(GREY)
    if material.texture and robot.source is not None:
        try:
            path = robot.source.resolve(material.texture)
        except UrdftoolError:
            path = None
        if path is not None and os.path.isfile(path):
            return Look(WHITE, Path(path))
    return Look(material.color or GREY)


def _get_part_image(part: Part) -> Image | None:
    """Return the image of a part of a mesh with complete texture coordinates."""
    if part.uv is None or not np.all(np.isfinite(part.uv)):
        return None
    return part.texture if part.texture is not None else part.image


class Pictures:
    """Comparison of the images of a compiled model with those of a description."""

    def __init__(self, compiled: Compiled) -> None:
        """Initialize for a compiled model."""
        self._compiled = compiled
        self._read: dict[Image, Any] = {}
        kinds = compiled.mujoco.mjtTextureRole
        self._role = int(kinds.mjTEXROLE_RGB)

    def get_texture(self, material: int) -> int:
        """Return the index of a material's image; -1 for none."""
        model = self._compiled.model
        return int(model.mat_texid[material][self._role]) if material >= 0 else -1

    def is_same(self, texture: int, image: Image) -> bool:
        """Tell whether an image of the model has the same pixels as one of the description."""
        if image not in self._read:
            self._read[image] = self._get_pixels(image)
        expected = self._read[image]
        found = _make_colors(self._compiled.model, texture)
        return expected is not None and np.array_equal(found, expected)

    def _get_pixels(self, image: Image) -> Any:
        """Return red, green and blue of an image, read by MuJoCo if possible, else by Pillow."""
        data = image if isinstance(image, bytes) else image.read_bytes()
        text = "<texture type='2d' name='a' file='a.png'/>"
        try:
            model = self._compiled.mujoco.MjModel.from_xml_string(
                f"<mujoco><asset>{text}</asset></mujoco>", {"a.png": data}
            )
        except ValueError:
            return _get_by_pillow(data)
        return _make_colors(model, 0)


def _get_by_pillow(data: bytes) -> Any:
    """Return red, green and blue of an image that is not a PNG; None if it cannot be read."""
    try:
        with open_image(data) as picture:
            return np.array(picture.convert("RGBA"))[:, :, :3]
    except Exception:  # Pillow raises arbitrary exceptions for damaged files
        return None


def _make_colors(model: Any, texture: int) -> Any:
    height, width = int(model.tex_height[texture]), int(model.tex_width[texture])
    channels, first = int(model.tex_nchannel[texture]), int(model.tex_adr[texture])
    data = model.tex_data[first : first + height * width * channels]
    return data.reshape(height, width, channels)[:, :, :3]
