"""Materials of COLLADA files: the color or image that a primitive is shown with."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple
from urllib.parse import unquote, urlsplit
from xml.etree.ElementTree import Element

_SHADERS = ("phong", "lambert", "blinn", "constant")


class Appearance(NamedTuple):
    """Diffuse color, image, and the number of the texture coordinates that place the image."""

    rgba: tuple[float, float, float, float] | None = None
    image: Path | None = None
    uv_set: str | None = None


class Materials:
    """Materials of a COLLADA file, by the bindings of instances."""

    def __init__(self, root: Element, space: str, path: Path) -> None:
        """Store the file."""
        self._root = root
        self._space = space
        self._path = path
        self._shaders: dict[Element, Element | None] = {}
        self._parameters: dict[Element, dict[str, Element]] = {}
        self._bindings: dict[Element, dict[str, Element]] = {}
        self._appearances: dict[Element, Appearance] = {}
        self._named = {
            (element.tag[len(space) :], element.get("id")): element
            for element in root.iter()
            if element.get("id") and element.tag[len(space) :] in ("material", "effect", "image")
        }

    def has_broken_binding(self) -> bool:
        """Tell whether an instance binds a material that lacks its properties or its image."""
        bindings = self._root.iter(f"{self._space}instance_material")
        by_target = {binding.get("target"): binding for binding in bindings}
        return any(map(self._is_broken, by_target.values()))

    def _is_broken(self, binding: Element) -> bool:
        shader = self._find_shader(binding)
        texture = self._find_texture(shader) if shader is not None else None
        return shader is None or (
            texture is not None and self._find_image(self._find_effect(binding), texture) is None
        )

    def _find_texture(self, shader: Element) -> Element | None:
        return shader.find(f"{self._space}diffuse/{self._space}texture")

    def find_bindings(self, instance: Element) -> Mapping[str, Element]:
        """Return the ``<instance_material>`` elements of an instance, by symbol."""
        if instance not in self._bindings:
            path = "/".join(
                self._space + name
                for name in ("bind_material", "technique_common", "instance_material")
            )
            self._bindings[instance] = {
                element.get("symbol") or "": element for element in instance.iterfind(path)
            }
        return self._bindings[instance]

    def read_appearance(self, binding: Element | None) -> Appearance:
        """Return what a binding shows; nothing for None and a broken material."""
        if binding is None:
            return Appearance()
        if binding not in self._appearances:
            self._appearances[binding] = self._read_appearance(binding)
        return self._appearances[binding]

    def _read_appearance(self, binding: Element) -> Appearance:
        shader = self._find_shader(binding)
        if shader is None:
            return Appearance()
        color = shader.find(f"{self._space}diffuse/{self._space}color")
        if color is not None:
            values = [float(word) for word in (color.text or "").split()]
            values += [0.0] * (3 - len(values)) + [1.0]
            return Appearance(rgba=(values[0], values[1], values[2], values[3]))
        texture = self._find_texture(shader)
        if texture is None:
            return Appearance()
        image = self._find_image(self._find_effect(binding), texture)
        if image is None:
            return Appearance()
        uv_set = self._find_uv_set(binding, texture.get("texcoord"))
        return Appearance(image=self._read_image_path(image), uv_set=uv_set)

    def _find_effect(self, binding: Element) -> Element | None:
        material = self._named.get(("material", (binding.get("target") or "")[1:]))
        used = material.find(f"{self._space}instance_effect") if material is not None else None
        return (
            self._named.get(("effect", (used.get("url") or "")[1:])) if used is not None else None
        )

    def _find_shader(self, binding: Element) -> Element | None:
        """Return the element with the properties of a bound material; None if it is broken."""
        effect = self._find_effect(binding)
        if effect is None:
            return None
        if effect not in self._shaders:
            self._shaders[effect] = self._find_shader_of(effect)
        return self._shaders[effect]

    def _find_shader_of(self, effect: Element) -> Element | None:
        technique = effect.find(f"{self._space}profile_COMMON/{self._space}technique")
        shaders = (
            technique.find(self._space + name) if technique is not None else None
            for name in _SHADERS
        )
        return next((shader for shader in shaders if shader is not None), None)

    def _find_uv_set(self, binding: Element, channel: str | None) -> str | None:
        """Return the number of the texture coordinates that are bound to a channel."""
        for element in binding.iterfind(f"{self._space}bind_vertex_input"):
            if element.get("semantic") == channel:
                return element.get("input_set") or "0"
        return None

    def _find_image(self, effect: Element | None, texture: Element) -> Element | None:
        """Return the image of a texture, which leads to it by a sampler and a surface."""
        name = texture.get("texture") or ""
        parameters = self._list_parameters(effect) if effect is not None else {}
        for names in ("sampler2D/source", "surface/init_from"):
            parameter = parameters.get(name)
            path = "/".join(self._space + part for part in names.split("/"))
            link = parameter.find(path) if parameter is not None else None
            name = (link.text or "").strip() if link is not None else name
        return self._named.get(("image", name))

    def _list_parameters(self, effect: Element) -> dict[str, Element]:
        """Return the ``<newparam>`` elements of an effect by ``sid``."""
        if effect not in self._parameters:
            elements = effect.iter(f"{self._space}newparam")
            self._parameters[effect] = {element.get("sid") or "": element for element in elements}
        return self._parameters[effect]

    def _read_image_path(self, image: Element) -> Path | None:
        source = image.find(f"{self._space}init_from")
        uri = (source.text or "").strip() if source is not None else ""
        if not uri:
            return None
        # images are named by URIs, in practice also by Windows paths
        name = unquote(urlsplit(uri).path) if uri.startswith("file:") else uri
        return self._path.parent / unquote(name).replace("\\", "/")
