"""Files of a bundle: names, references between files, converted meshes, each content once."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import MeshError
from ..source.description import GltfUp
from .collect import Asset, AssetKind, Collection
from .layout import Layout
from .manifest import compute_digest
from .references import rewrite_references

if TYPE_CHECKING:
    from ..geometry.mesh import Mesh
    from .mesh_formats import MeshFormat

Content = bytes | Path


@dataclass(frozen=True)
class Conversion:
    """Conversion of meshes to another format.

    Attributes:
        target: The format.
        accepts: Function that tells whether a mesh file stays as it is.
        gltf_up: Up axis of glTF files.
    """

    target: MeshFormat
    accepts: Callable[[Path], bool]
    gltf_up: GltfUp = "y"


@dataclass
class Stored:
    """Files of a bundle, each content once.

    Attributes:
        places: Path in the bundle by asset.
        contents: Content by path.
        sources: Source files by path.
        losses: What a converted mesh lost, by asset.
        failed: Why a mesh was not converted, by asset.
    """

    places: dict[Asset, str] = field(default_factory=dict)
    contents: dict[str, Content] = field(default_factory=dict)
    sources: dict[str, list[Path]] = field(default_factory=dict)
    losses: dict[Asset, tuple[str, ...]] = field(default_factory=dict)
    failed: dict[Asset, str] = field(default_factory=dict)


def store_assets(found: Collection, conversion: Conversion | None = None) -> Stored:
    """Assign a path to each file, convert meshes, and rewrite references between files.

    Args:
        found: The files.
        conversion: Conversion of meshes; None keeps them.
    """
    store = _Store(conversion)
    for asset in found.assets.values():
        store.add(asset)
    return store.stored


class _Store:
    """Files that have a place."""

    def __init__(self, conversion: Conversion | None) -> None:
        self.stored = Stored()
        self._conversion = conversion
        self._layout = Layout()
        self._by_content: dict[tuple[str, str, str], str] = {}

    def add(self, asset: Asset) -> str:
        """Store a file with those that it refers to; return its path in the bundle."""
        if asset in self.stored.places:
            return self.stored.places[asset]
        conversion = self._conversion
        if asset.kind == "mesh" and conversion is not None and not conversion.accepts(asset.path):
            from ..geometry.load import load_mesh  # imports numpy

            try:
                mesh = load_mesh(asset.path, gltf_up=conversion.gltf_up)
            except MeshError as error:
                self.stored.failed[asset] = error.message
            else:
                return self._add_converted(asset, mesh, conversion)
        names = {}
        for written, other in asset.references.items():
            inner = _remove_folders(written) if other is None else Path(self.add(other)).name
            names[written] = inner
        content: Content = asset.path
        if any(old != new for old, new in names.items()):
            content = rewrite_references(asset.suffix, asset.path.read_bytes(), names)
        return self._put(asset, content)

    def _add_converted(self, asset: Asset, mesh: Mesh, conversion: Conversion) -> str:
        """Store a mesh in another format; return its path in the bundle."""
        from .mesh_formats import describe_losses, encode_glb, encode_stl

        target = conversion.target
        if target == "obj":
            data = self._encode_obj(asset, mesh)
        elif target == "glb":
            data = encode_glb(mesh, conversion.gltf_up)
        else:
            data = encode_stl(mesh)
        if losses := describe_losses(mesh, target):
            self.stored.losses[asset] = losses
        return self._put(asset, data, f".{target}")

    def _encode_obj(self, asset: Asset, mesh: Mesh) -> bytes:
        """Store the images and materials of a mesh; return it as OBJ."""
        from .mesh_formats import (
            MaterialNames,
            encode_mtl,
            encode_obj,
            get_image_suffix,
            read_image,
        )

        images = {}
        for number, part in enumerate(mesh.parts):
            image = read_image(part)
            if image is not None:
                path = part.texture or asset.path
                place = self._put_companion(path, "image", image, get_image_suffix(image))
                images[number] = Path(place).name
        library = self._put_companion(
            asset.path, "material", encode_mtl(mesh, MaterialNames("", images)), ".mtl"
        )
        return encode_obj(mesh, MaterialNames(Path(library).name, images))

    def _put_companion(self, path: Path, kind: AssetKind, data: bytes, suffix: str) -> str:
        return self._put(Asset(path, kind), data, suffix)

    def _put(self, asset: Asset, content: Content, suffix: str = "") -> str:
        """Store a content unless it is known; return its path in the bundle."""
        key = (asset.kind, suffix or asset.suffix, compute_digest(content))
        place = self._by_content.get(key)
        if place is None:
            place = self._by_content[key] = self._layout.place(asset, suffix)
            self.stored.contents[place] = content
        self.stored.places[asset] = place
        sources = self.stored.sources.setdefault(place, [])
        if asset.path not in sources:
            sources.append(asset.path)
        return place


def _remove_folders(written: str) -> str:
    """Return the reference to a missing file without the folders, so that it stays inside."""
    name = re.split(r"[/\\]", written.rstrip("/\\"))[-1]
    return written if name == written else name or "missing"
