"""Appearance of visuals: named materials with a color or a texture, and plain colors."""

from __future__ import annotations

import os
from pathlib import Path

from lxml import etree

from ...errors import SourceError
from ...model.elements import Link, Material, Robot, Visual
from ...model.materials import find_shown_material
from ...model.numbers import format_numbers_text
from ..common.naming import UniqueNames, replace_file_name
from ..written import Written
from .convert import Image, Rgba
from .meshes import MeshPiece
from .texture import get_png


class Materials:
    """The materials and textures that a robot uses.

    Attributes:
        elements: ``<texture>`` and ``<material>`` elements in order of first use.
    """

    def __init__(self, robot: Robot, written: Written, mesh_dir: str) -> None:
        """Begin with no materials."""
        self._written = written
        self._folder = mesh_dir
        self._robot = robot
        self._names = UniqueNames()
        self._files = UniqueNames(fold=True)
        self._used: dict[tuple[str, Rgba | None, Image | None], str] = {}
        self._textures: dict[Image, str | None] = {}
        self.elements: list[etree._Element] = []

    @property
    def has_textures(self) -> bool:
        """Tell whether any image is used."""
        return any(self._textures.values())

    def set_material(
        self, geom: etree._Element, visual: Visual, link: Link, piece: MeshPiece | None
    ) -> None:
        """Set the material or color of a geom.

        Precedence as in RViz: color or image in the mesh file, then the material of the visual,
        then Gazebo's color for the link.
        """
        if piece is not None and piece.texture is not None:
            name = self._get_mesh_material(piece.texture, piece.file, visual)
            if name is not None:
                geom.set("material", name)
                return
        if piece is not None and piece.rgba is not None:
            geom.set("rgba", format_numbers_text(piece.rgba))
            return
        material = find_shown_material(self._robot, link, visual)
        if material is None:
            return
        if material.name or material.texture:
            name = self._get_material(
                material.name, material.color, self._get_image(material), visual
            )
            if name is not None:
                geom.set("material", name)
        elif material.color is not None:
            geom.set("rgba", format_numbers_text(material.color))

    def _get_mesh_material(self, image: Image, mesh: str, visual: Visual) -> str | None:
        """Return the material for an image of a mesh file; None if the image is missing."""
        stem = Path(mesh).stem if isinstance(image, bytes) else image.stem
        if isinstance(image, Path) and not os.path.isfile(image):
            if image not in self._textures:
                self._textures[image] = None
                self._report_image_loss(f"image {image} of {mesh} does not exist", visual, mesh)
            return None
        return self._get_material(stem, None, image, visual, mesh)

    def _report_image_loss(self, message: str, visual: Visual, name: str) -> None:
        self._written.report_loss("texture", message, visual.place, kind="material", name=name)

    def _get_image(self, material: Material) -> Path | None:
        """Return the path of a material's texture; None if it does not exist."""
        if not material.texture or self._robot.source is None:
            return None
        try:
            path = self._robot.source.resolve(material.texture)
        except SourceError as error:
            self._report_texture_loss(material, error.message)
            return None
        if not os.path.isfile(path):
            self._report_texture_loss(material, f"{path} does not exist")
            return None
        return path

    def _report_texture_loss(self, material: Material, why: str) -> None:
        self._written.report_loss(
            "texture",
            f"texture '{material.texture}' of material '{material.name}' is lost: {why}",
            material.place,
            kind="material",
            name=material.name,
        )

    def _get_material(
        self, name: str, color: Rgba | None, image: Image | None, visual: Visual, mesh: str = ""
    ) -> str | None:
        key = (name, color, image)
        if key in self._used:
            return self._used[key]
        texture = self._get_texture(image, visual, mesh) if image is not None else None
        if texture is None and color is None:
            return None
        element = etree.Element("material", name=self._names.take(name or "material"))
        if texture is not None:
            element.set("texture", texture)
        elif color is not None:
            element.set("rgba", format_numbers_text(color))
        self.elements.append(element)
        self._used[key] = element.get("name", "")
        return self._used[key]

    def _read_image(self, image: Image) -> bytes:
        """Return the content of an image; nothing if the description may not read it."""
        if isinstance(image, bytes) or self._robot.source is None:
            return b"" if isinstance(image, Path) else image
        try:
            return self._robot.source.workspace.read_bytes(image)
        except OSError:
            return b""

    def _get_texture(self, image: Image, visual: Visual, mesh: str) -> str | None:
        if image in self._textures:
            return self._textures[image]
        file = f"in {mesh}" if isinstance(image, bytes) else image.name
        stem = Path(mesh).stem if isinstance(image, bytes) else image.stem
        data = get_png(self._read_image(image))
        if data is None:
            named = visual.material.name if visual.material is not None else ""
            self._report_image_loss(
                f"texture {file} is lost: it is no PNG, and Pillow, which converts others, is not "
                "there or cannot read it",
                visual,
                mesh or named,
            )
            self._textures[image] = None
            return None
        name = self._files.take(replace_file_name(stem))
        folder = f"{self._folder}/" if self._folder else ""
        self._written.files[f"{folder}{name}.png"] = data
        self.elements.append(etree.Element("texture", type="2d", name=name, file=f"{name}.png"))
        self._textures[image] = name
        return name
