"""Materials of visuals: colors and textures as ``UsdPreviewSurface``."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from pxr import Gf, Sdf, Usd, UsdShade

from ...geometry.color import convert_to_linear
from ...model.elements import Link, Material, Robot, Visual
from ...model.materials import find_shown_material
from ..common.assets import find_file
from ..common.naming import UniqueNames, replace_file_name
from ..written import Written
from .names import make_identifier
from .stage import MATERIALS, StageBuilder

Rgba = tuple[float, float, float, float]
Image = Path | bytes

FOLDER = "textures"

_STARTS = {b"\x89PNG": ".png", b"\xff\xd8\xff": ".jpg"}
"""Starts of the image formats that every reader of USD has, and their suffixes."""


@dataclass(frozen=True)
class Look:
    """Appearance of a surface: a color, or an image.

    Attributes:
        name: Name of the material; may be empty.
        rgba: Color, as URDF writes it (sRGB).
        image: Image file, or its content.
    """

    name: str
    rgba: Rgba | None = None
    image: Image | None = None


@dataclass
class MaterialWriter:
    """Writes each material once for each scope.

    Attributes:
        builder: The stage.
        robot: The robot.
        written: Receives images and losses.
        prefix: Path of the folder of the layers relative to that of the images.
    """

    builder: StageBuilder
    robot: Robot
    written: Written
    prefix: str = "./"
    _paths: dict[tuple[Sdf.Path, Look], Sdf.Path] = field(default_factory=dict)
    _names: dict[Sdf.Path, UniqueNames] = field(default_factory=dict)
    _files: dict[Image, str] = field(default_factory=dict)
    _file_names: UniqueNames = field(default_factory=lambda: UniqueNames(fold=True))

    def find_look(self, link: Link, visual: Visual) -> Look | None:
        """Return the appearance that the description gives a visual; None without one."""
        material = find_shown_material(self.robot, link, visual)
        if material is None:
            return None
        image = find_file(self.robot, material.texture) if material.texture else None
        if material.texture and image is None:
            self._report("texture", f"texture '{material.texture}' does not exist", material)
        if image is None and material.color is None:
            return None
        return Look(material.name, material.color, image)

    def bind(self, prim: Usd.Prim, look: Look, scope: Sdf.Path) -> None:
        """Bind a look to a prim; the material is created below the scope."""
        with self.builder.edit_layer(MATERIALS):
            path = self._paths.get((scope, look)) or self._create(look, scope)
            material = UsdShade.Material.Get(self.builder.stage, path)
            UsdShade.MaterialBindingAPI.Apply(prim).Bind(material)

    def _create(self, look: Look, scope: Sdf.Path) -> Sdf.Path:
        stage = self.builder.stage
        stage.DefinePrim(scope, "Scope")
        names = self._names.setdefault(scope, UniqueNames())
        path = scope.AppendChild(
            names.take(make_identifier(look.name or _name_color(look), "material"))
        )
        material = UsdShade.Material.Define(stage, path)
        shader = UsdShade.Shader.Define(stage, path.AppendChild("surface"))
        shader.CreateIdAttr("UsdPreviewSurface")
        shader.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(0.6)
        shader.CreateInput("metallic", Sdf.ValueTypeNames.Float).Set(0.0)
        file = self._add_file(look)
        color = shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f)
        if file:
            source = self._write_texture(path, file)
            color.ConnectToSource(source.ConnectableAPI(), "rgb")
        elif look.rgba is not None:
            color.Set(Gf.Vec3f(*(convert_to_linear(part) for part in look.rgba[:3])))
        if look.rgba is not None and look.rgba[3] < 1 and not file:
            opacity = min(max(look.rgba[3], 0.0), 1.0)
            shader.CreateInput("opacity", Sdf.ValueTypeNames.Float).Set(opacity)
        material.CreateSurfaceOutput().ConnectToSource(shader.ConnectableAPI(), "surface")
        self._paths[scope, look] = path
        return path

    def _write_texture(self, path: Sdf.Path, file: str) -> UsdShade.Shader:
        stage = self.builder.stage
        reader = UsdShade.Shader.Define(stage, path.AppendChild("coordinates"))
        reader.CreateIdAttr("UsdPrimvarReader_float2")
        reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set("st")
        reader.CreateOutput("result", Sdf.ValueTypeNames.Float2)
        texture = UsdShade.Shader.Define(stage, path.AppendChild("texture"))
        texture.CreateIdAttr("UsdUVTexture")
        asset = Sdf.AssetPath(f"{self.prefix}{file}")
        texture.CreateInput("file", Sdf.ValueTypeNames.Asset).Set(asset)
        texture.CreateInput("sourceColorSpace", Sdf.ValueTypeNames.Token).Set("sRGB")
        for wrap in ("wrapS", "wrapT"):
            texture.CreateInput(wrap, Sdf.ValueTypeNames.Token).Set("repeat")
        coordinates = texture.CreateInput("st", Sdf.ValueTypeNames.Float2)
        coordinates.ConnectToSource(reader.ConnectableAPI(), "result")
        texture.CreateOutput("rgb", Sdf.ValueTypeNames.Float3)
        return texture

    def _add_file(self, look: Look) -> str:
        """Add the image of a look to the export; return its path, or nothing."""
        image = look.image
        if image is None:
            return ""
        if image not in self._files:
            self._files[image] = self._place(image)
        return self._files[image]

    def _place(self, image: Image) -> str:
        name = "image" if isinstance(image, bytes) else image.stem
        try:
            data = image if isinstance(image, bytes) else self._read_file(image)
        except OSError:
            data = b""
        suffix = next((end for start, end in _STARTS.items() if data.startswith(start)), "")
        if not suffix:
            shown = "a texture in a mesh file" if isinstance(image, bytes) else str(image)
            text = f"{shown} is neither PNG nor JPEG, or cannot be read; the color is lost"
            self._report("texture", text, self.robot)
            return ""
        file = f"{FOLDER}/{self._file_names.take(replace_file_name(name))}{suffix}"
        self.written.files[file] = data if isinstance(image, bytes) else image
        return file

    def _read_file(self, image: Path) -> bytes:
        if self.robot.source is None:
            return b""
        return self.robot.source.workspace.read_bytes(image)

    def _report(self, code: str, message: str, part: Material | Robot) -> None:
        self.written.report_loss(code, message, part.place, kind="material", name=part.name)


def _name_color(look: Look) -> str:
    if look.image is not None:
        return "image" if isinstance(look.image, bytes) else look.image.stem
    parts = look.rgba or ()
    return "color_" + "".join(f"{round(255 * min(max(part, 0), 1)):02x}" for part in parts)
