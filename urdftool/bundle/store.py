"""Files of a bundle: names, references between files, converted meshes, each content once."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import MeshError
from ..geometry.stl_header import read_stl_header
from ..source.description import GltfUp
from .author_paths import drop_author_paths
from .collect import Asset, AssetKind, Collection
from .layout import Layout
from .limits import Limits
from .manifest import compute_digest
from .references import rewrite_references

if TYPE_CHECKING:
    from ..geometry.mesh import Array, Mesh
    from .mesh_formats import MeshFormat
    from .reduce import Reduced

Content = bytes | Path


_TARGETS: dict[str, MeshFormat] = {"stl": "stl", "glb": "glb", "gltf": "glb", "dae": "dae"}
"""Formats of reduced meshes that keep theirs; others become OBJ."""


@dataclass(frozen=True)
class Conversion:
    """Conversion of meshes to another format."""

    target: MeshFormat
    accepts: Callable[[Path], bool]
    gltf_up: GltfUp = "y"


@dataclass
class Reduction:
    """What the limits changed of a file.

    Attributes:
        bytes: Size of the source [bytes].
        triangles: Number of triangles before and after; None for an image.
        error: Distance of the two surfaces, as a fraction of the diagonal of the bounding box.
        pixels: Width and height of the largest image before and after; None for none.
    """

    bytes: int
    triangles: tuple[int, int] | None = None
    error: float | None = None
    pixels: tuple[tuple[int, int], tuple[int, int]] | None = None


@dataclass
class Stored:
    """Files of a bundle, each content once.

    Attributes:
        places: Path in the bundle by asset.
        visual_places: Path of the reduced mesh, by asset that is also collision geometry.
        reductions: What the limits changed, by path.
        contents: Content by path.
        digests: SHA-256 of each content, by path.
        sources: Source files by path.
        losses: What a converted mesh lost, by asset.
        failed: Why a mesh was not converted, by asset.
        unreached: Number of triangles of a mesh that has more than the limit, by asset.
        large_images: Why an image, or one in a mesh, is larger than the limit, by asset.
        missing: References to files that the source does not have, as written in the bundle, by
            path.
    """

    places: dict[Asset, str] = field(default_factory=dict)
    visual_places: dict[Asset, str] = field(default_factory=dict)
    reductions: dict[str, Reduction] = field(default_factory=dict)
    contents: dict[str, Content] = field(default_factory=dict)
    digests: dict[str, str] = field(default_factory=dict)
    sources: dict[str, list[Path]] = field(default_factory=dict)
    losses: dict[Asset, tuple[str, ...]] = field(default_factory=dict)
    failed: dict[Asset, str] = field(default_factory=dict)
    unreached: dict[Asset, int] = field(default_factory=dict)
    large_images: dict[Asset, str] = field(default_factory=dict)
    missing: dict[str, list[str]] = field(default_factory=dict)


def store_assets(
    found: Collection,
    conversion: Conversion | None = None,
    limits: Limits | None = None,
    progress: Callable[[int, int, str], None] | None = None,
) -> Stored:
    """Assign a path to each file, convert and reduce meshes, and rewrite references between files.

    Without a conversion, meshes stay; without limits, all is kept.
    """
    store = _Store(conversion, limits or Limits())
    for number, asset in enumerate(found.assets.values()):
        if progress is not None:
            progress(number, len(found.assets), asset.path.name)
        store.add(asset)
    return store.stored


class _Store:
    """Files that have a place."""

    def __init__(self, conversion: Conversion | None, limits: Limits) -> None:
        self.stored = Stored()
        self._conversion = conversion
        self._limits = limits
        self._layout = Layout()
        self._by_content: dict[tuple[str, str, str], str] = {}

    def add(self, asset: Asset) -> str:
        """Store a file with those that it refers to; return its path in the bundle."""
        if asset in self.stored.places:
            return self.stored.places[asset]
        if asset.kind == "mesh":
            place = self._add_mesh(asset)
            if place:
                return place
        names = {}
        for written, other in asset.references.items():
            inner = _remove_folders(written) if other is None else Path(self.add(other)).name
            names[written] = inner
        content: Content = asset.path
        if any(old != new for old, new in names.items()):
            content = rewrite_references(asset.suffix, asset.path.read_bytes(), names)
        if asset.suffix == ".dae":
            content = _drop_author_paths(content)
        place = self._put(asset, *self._shrink(asset, content))
        if missing := [names[written] for written, other in asset.references.items() if not other]:
            self.stored.missing[place] = missing
        return place

    def _add_mesh(self, asset: Asset) -> str:
        """Store a mesh that changes; return its path, or "" if it stays as it is."""
        conversion, limits = self._conversion, self._limits
        is_converted = conversion is not None and not conversion.accepts(asset.path)
        is_reduced = limits.reduces_meshes and asset.is_visual
        is_text = limits.is_set and asset.suffix == ".stl" and _is_ascii_stl(asset.path)
        if not (is_converted or is_reduced or is_text):
            return ""
        from ..geometry.load import load_mesh  # imports numpy

        gltf_up = "y" if conversion is None else conversion.gltf_up
        try:
            mesh = load_mesh(asset.path, gltf_up=gltf_up)
        except MeshError as error:
            self.stored.failed[asset] = error.message
            return ""
        reduced = self._reduce(asset, mesh) if is_reduced else None
        target: MeshFormat | None = conversion.target if conversion and is_converted else None
        if reduced is not None:
            place = self._add_converted(
                asset, mesh, target or _TARGETS.get(mesh.format, "obj"), reduced
            )
            if not asset.collides:
                return place
            self.stored.visual_places[asset] = place
            del self.stored.places[asset]
        if target is None and not is_text:
            return ""
        return self._add_converted(asset, mesh, target or "stl", None)

    def _reduce(self, asset: Asset, mesh: Mesh) -> Reduced | None:
        """Reduce a mesh; record whether it has more triangles than the limit."""
        from .reduce import reduce_mesh  # imports scipy

        reduced = reduce_mesh(mesh, self._limits)
        count = len(mesh.faces if reduced is None else reduced.mesh.faces)
        limit = self._limits.max_triangles
        if limit is not None and count > limit:
            self.stored.unreached[asset] = count
        return reduced

    def _shrink(self, asset: Asset, content: Content) -> tuple[Content, Reduction | None]:
        """Return an image, or a mesh file with images, within the limit."""
        limit = self._limits.max_texture
        if limit is None or not (asset.kind == "image" or asset.suffix == ".glb"):
            return content, None
        from .textures import explain_unshrunk, shrink_glb_images, shrink_image

        data = content if isinstance(content, bytes) else content.read_bytes()
        small = (shrink_image if asset.kind == "image" else shrink_glb_images)(data, limit)
        if small is None:
            why = explain_unshrunk(data, limit) if asset.kind == "image" else ""
            if why:
                self.stored.large_images[asset] = why
            return content, None
        return small.data, Reduction(len(data), pixels=(small.before, small.after))

    def _add_converted(
        self, asset: Asset, mesh: Mesh, target: MeshFormat, reduced: Reduced | None
    ) -> str:
        """Store a mesh in a format, reduced or not; return its path in the bundle."""
        from .mesh_formats import describe_losses, encode_glb, encode_stl

        conversion = self._conversion
        shading = None if reduced is None else reduced.normals
        used = mesh if reduced is None else reduced.mesh
        if target in ("obj", "dae"):
            data = self._encode_text(asset, used, target, shading)
        elif target == "glb":
            gltf_up = "y" if conversion is None else conversion.gltf_up
            data = encode_glb(used, gltf_up, asset.list_companions(), shading)
        else:
            data = encode_stl(used)
        if losses := describe_losses(mesh, target):
            self.stored.losses[asset] = losses
        change = None
        if reduced is not None or self._limits.is_set:
            counts = len(mesh.faces), len(used.faces)
            error = 0.0 if reduced is None else reduced.error
            change = Reduction(asset.path.stat().st_size, triangles=counts, error=error)
        if target == "glb" and self._limits.max_texture is not None:
            from .textures import shrink_glb_images

            small = shrink_glb_images(data, self._limits.max_texture)
            if small is not None and change is not None:
                data, change.pixels = small.data, (small.before, small.after)
        return self._put(asset, data, change, f".{target}")

    def _encode_text(
        self, asset: Asset, mesh: Mesh, target: MeshFormat, shading: Array | None
    ) -> bytes:
        """Store the images and materials of a mesh; return it as OBJ or COLLADA."""
        from .mesh_formats import (
            MaterialNames,
            encode_mtl,
            encode_obj,
            get_image_suffix,
            read_image,
        )

        images = {}
        for number, part in enumerate(mesh.parts):
            image = read_image(part, asset.list_companions())
            if image is not None:
                path = part.texture or asset.path
                place = self._put_companion(path, "image", image, get_image_suffix(image))
                images[number] = Path(place).name
        if target == "dae":
            from .collada_file import encode_dae

            return encode_dae(mesh, MaterialNames("", images), shading)
        if not images and all(part.rgba is None for part in mesh.parts):
            return encode_obj(mesh, MaterialNames("", {}), shading)  # the URDF colors it
        library = self._put_companion(
            asset.path, "material", encode_mtl(mesh, MaterialNames("", images)), ".mtl"
        )
        return encode_obj(mesh, MaterialNames(Path(library).name, images), shading)

    def _put_companion(self, path: Path, kind: AssetKind, data: bytes, suffix: str) -> str:
        asset = Asset(path, kind)
        return self._put(asset, *self._shrink(asset, data), suffix)

    def _put(
        self, asset: Asset, content: Content, change: Reduction | None = None, suffix: str = ""
    ) -> str:
        """Store a content unless it is known; return its path in the bundle."""
        digest = compute_digest(content)
        key = (asset.kind, suffix or asset.suffix, digest)
        place = self._by_content.get(key)
        if place is None:
            place = self._by_content[key] = self._layout.place(asset, suffix)
            self.stored.contents[place] = content
            self.stored.digests[place] = digest
        self.stored.places[asset] = place
        if change is not None:
            self.stored.reductions[place] = change
        sources = self.stored.sources.setdefault(place, [])
        if asset.path not in sources:
            sources.append(asset.path)
        return place


def _is_ascii_stl(path: Path) -> bool:
    try:
        return read_stl_header(path).kind == "ascii"
    except OSError:
        return False


def _drop_author_paths(content: Content) -> Content:
    """Return a COLLADA file without absolute paths in its notes; the same if it has none."""
    data = content if isinstance(content, bytes) else content.read_bytes()
    changed = drop_author_paths(data)
    return content if changed == data else changed


def _remove_folders(written: str) -> str:
    """Return the reference to a missing file without the folders, so that it stays inside."""
    name = re.split(r"[/\\]", written.rstrip("/\\"))[-1]
    return written if name == written else name or "missing"
