"""Colors and textures of prims."""

from __future__ import annotations

from hashlib import sha256
from pathlib import PurePosixPath

from pxr import Ar, Gf, Sdf, Usd, UsdGeom, UsdPhysics, UsdShade

from ...diagnostic import Severity
from ...geometry.color import convert_to_srgb
from ...model.elements import Material
from ...model.settings import Settings, Value
from .read_mesh import MeshFolder
from .read_stage import Context, convert_float

_COLORS = ("diffuseColor", "diffuse_color_constant", "base_color")
"""Inputs of UsdPreviewSurface, of OmniPBR (MDL) and of MaterialX surfaces."""

_TEXTURES = ("diffuse_texture",)
"""Inputs of OmniPBR that name an image."""

_DIGITS = 6
"""Digits of a color after the point, which 32-bit floats have."""

_OPACITIES = ("opacity", "opacity_constant")


def read_material(
    context: Context, prim: Usd.Prim, folder: MeshFolder, *, has_coordinates: bool
) -> Material | None:
    """Return the color or texture of a prim or of a subset of faces; None without one."""
    bound, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()
    surface = _find_surface(bound) if bound else None
    if surface is None:
        return _read_display_color(context, prim)
    written, name = context.get_written(bound.GetPrim()), bound.GetPrim().GetName()
    color, image = _read_color(surface)
    if image is not None:
        texture = _store_image(context, image, folder) if has_coordinates else ""
        if texture:
            return Material(written, name, None, texture)
        what = "textures whose image is not found, or of shapes without texture coordinates"
        context.report_loss("texture", f"{what}, are not read", bound.GetPrim(), Severity.INFO)
    if color is None:
        return None
    alpha = _read_number(surface, _OPACITIES)
    red, green, blue = (encode_color(float(part)) for part in color)
    return Material(written, name, (red, green, blue, 1.0 if alpha is None else alpha))


def read_surface(context: Context, prim: Usd.Prim) -> Settings:
    """Return friction and restitution of the physics material of a collider."""
    bound, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial("physics")
    own = bound.GetPrim() if bound else None
    if own is None or not own.HasAPI(UsdPhysics.MaterialAPI):
        return {}
    found: Settings = {}
    for name, attribute in (("friction", "dynamicFriction"), ("restitution", "restitution")):
        value = context.get_value(own, f"physics:{attribute}")
        if value is not None:
            content = convert_float(value)
            found[name] = Value(context.get_written(own, f"physics:{attribute}"), content)
    if "friction" in found:  # the same in each direction
        found["second_friction"] = found["friction"]
    still = context.get_value(own, "physics:staticFriction")
    if still is not None and still != context.get_value(own, "physics:dynamicFriction"):
        text = "friction at rest (staticFriction) other than in motion is not read"
        context.report_loss("friction", text, own, Severity.INFO)
    return found


def _find_surface(material: UsdShade.Material) -> UsdShade.Shader | None:
    """Return the shader of the surface of a material, in USD or MDL."""
    for contexts in ([], ["mdl"], ["mtlx"]):
        surface, _, _ = (
            material.ComputeSurfaceSource(contexts) if contexts else material.ComputeSurfaceSource()
        )
        if surface:
            return surface
    return None


def _read_color(surface: UsdShade.Shader) -> tuple[Gf.Vec3f | None, Sdf.AssetPath | None]:
    """Return the color of a surface, and its image; connections are followed."""
    for name in _TEXTURES:
        image = _get_value(surface, name)
        if isinstance(image, Sdf.AssetPath) and image.path:
            return _get_color(surface, _COLORS), image
    for name in _COLORS:
        source = surface.GetInput(name)
        for attribute in UsdShade.Utils.GetValueProducingAttributes(source) if source else ():
            shader = UsdShade.Shader(attribute.GetPrim())
            if UsdShade.Utils.GetType(attribute.GetName()) != UsdShade.AttributeType.Output:
                continue
            image = _get_value(shader, "file")
            if isinstance(image, Sdf.AssetPath) and image.path:
                return _get_color(shader, ("fallback",)), image
    return _get_color(surface, _COLORS), None


def _get_color(shader: UsdShade.Shader, names: tuple[str, ...]) -> Gf.Vec3f | None:
    values = (_get_value(shader, name) for name in names)
    return next(
        (Gf.Vec3f(*value[:3]) for value in values if isinstance(value, (Gf.Vec3f, Gf.Vec4f))), None
    )


def _get_value(shader: UsdShade.Shader, name: str) -> object:
    """Return the value of an input, or of the input that it is connected to; None without one."""
    source = shader.GetInput(name)
    for attribute in UsdShade.Utils.GetValueProducingAttributes(source) if source else ():
        if UsdShade.Utils.GetType(attribute.GetName()) == UsdShade.AttributeType.Input:
            return attribute.Get()
    return None


def _read_number(surface: UsdShade.Shader, names: tuple[str, ...]) -> float | None:
    values = (_get_value(surface, name) for name in names)
    return next((float(value) for value in values if isinstance(value, float)), None)


def _read_display_color(context: Context, prim: Usd.Prim) -> Material | None:
    """Return the constant ``displayColor`` of a shape without a material; None without one."""
    shape = UsdGeom.Gprim(prim)
    if not shape:
        return None
    colors = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance("displayColor").Get()
    if not colors or len(colors) != 1:
        return None
    opacities = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance("displayOpacity").Get()
    alpha = float(opacities[0]) if opacities and len(opacities) == 1 else 1.0
    red, green, blue = (encode_color(float(part)) for part in colors[0])
    name = "color_" + "".join(f"{round(255 * part):02x}" for part in (red, green, blue, alpha))
    written = context.get_written(prim, "primvars:displayColor")
    return Material(written, name, (red, green, blue, alpha))


def _store_image(context: Context, image: Sdf.AssetPath, folder: MeshFolder) -> str:
    """Return the path of an image, which is copied out of a package; empty if it is not found."""
    found = image.resolvedPath
    if not found:
        return ""
    if not Ar.IsPackageRelativePath(found):
        return str(found)
    context.layers.files.check(found)
    asset = Ar.GetResolver().OpenAsset(Ar.ResolvedPath(found))
    if not asset:
        return ""
    content = bytes(asset.GetBuffer())
    name = PurePosixPath(Ar.SplitPackageRelativePathInner(found)[1]).name
    return folder.store_file(f"{sha256(content).hexdigest()[:8]}-{name}", content)


def encode_color(value: float) -> float:
    """Convert linear light to a component of an sRGB color."""
    return round(convert_to_srgb(value), _DIGITS)
