"""Contents of a glTF file: its JSON tree, buffers, accessors, materials and images."""

from __future__ import annotations

import json
import os
import struct
from base64 import b64decode
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
import numpy.typing as npt

from ..source.access import require_companion
from .color import Rgba, convert_to_srgb
from .limits import MAX_TRIANGLES, check_tree

_TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_COMPRESSIONS = ("KHR_draco_mesh_compression", "EXT_meshopt_compression")

MAX_VALUES = 9 * MAX_TRIANGLES
"""Number of values of all accessors that a file of any size may have: nine per triangle."""

Image = tuple[Path | None, bytes | None]
"""Path of an image file, or the content of an embedded image."""


class GltfFile:
    """File that is read on demand.

    Attributes:
        tree: Its JSON.
        path: Its path; buffers and images are relative to its folder.
        size: Size of the file and its buffers [bytes].
    """

    def __init__(self, path: Path) -> None:
        """Read the JSON, and the binary chunk of a GLB file.

        Raises:
            MeshError: It has too many elements.
            ValueError: It is not a glTF file. A damaged file may also cause LookupError, TypeError,
                AttributeError or struct.error here and in the methods.
        """
        self.path = path
        data = path.read_bytes()
        self.size = len(data)
        self._chunk = b""
        if data[:4] == b"glTF":
            (length,) = struct.unpack_from("<I", data, 12)
            self._chunk = data[20 + length + 8 :]
            data = data[20 : 20 + length]
        check_tree(path, data, b",", b"[", b"{")
        self.tree: Any = json.loads(data)
        self._buffers: dict[int, bytes] = {}
        self._accessors: dict[int, npt.NDArray[Any]] = {}
        self._images: dict[int, Image] = {}
        self._values = 0
        self._image_bytes = 0
        files = {str(one.get("uri", "data:")) for one in self.tree.get("buffers", ())}
        for uri in files:
            if not uri.startswith("data:"):
                file = path.parent / unquote(uri)
                self.size += file.stat().st_size if file.is_file() else 0

    def check_references(self) -> None:
        """Raise ValueError if a referenced file is missing, a device or a pipe."""
        for thing in (*self.tree.get("buffers", ()), *self.tree.get("images", ())):
            uri = str(thing.get("uri", "data:"))
            if not uri.startswith("data:"):
                self._find_file(uri)

    def _find_file(self, uri: str) -> Path:
        file = self.path.parent / unquote(uri)
        if not os.path.isfile(file):  # reading a device or a pipe would not end
            raise ValueError(f"'{uri}' is not a file")
        return require_companion(self.path, file)

    def _read_view(self, number: int) -> memoryview:
        """Return the bytes of a buffer view, without a copy."""
        view = self.tree["bufferViews"][number]
        if any(name in view.get("extensions", {}) for name in _COMPRESSIONS):
            raise ValueError("a buffer view is compressed")
        buffer = view["buffer"]
        if buffer not in self._buffers:
            uri = self.tree["buffers"][buffer].get("uri")
            if uri is None:
                self._buffers[buffer] = self._chunk
            elif uri.startswith("data:"):
                self._buffers[buffer] = b64decode(uri.partition(",")[2])
            else:
                self._buffers[buffer] = self._find_file(uri).read_bytes()
        start, length = view.get("byteOffset", 0), view["byteLength"]
        content = memoryview(self._buffers[buffer])[start : start + length]
        if start < 0 or length < 0 or len(content) != length:
            raise ValueError(f"buffer view {number} ends after its buffer")
        return content

    def is_compressed(self, primitive: Any) -> bool:
        """Tell whether the positions or corners of a primitive are stored by an extension."""
        numbers = (primitive["attributes"]["POSITION"], primitive.get("indices"))
        accessors = [self.tree["accessors"][number] for number in numbers if number is not None]
        views = [
            self.tree["bufferViews"][one["bufferView"]] for one in accessors if "bufferView" in one
        ]
        extensions = {
            name for one in (primitive, *views) for name in one.get("extensions", {}) if name
        }
        is_bare = any("bufferView" not in one and "sparse" not in one for one in accessors)
        return is_bare or not extensions.isdisjoint(_COMPRESSIONS)

    def check_not_compressed(self, primitive: Any) -> None:
        """Raise ValueError if :meth:`is_compressed`."""
        if self.is_compressed(primitive):
            names = " or ".join(primitive.get("extensions", {})) or "no buffer"
            raise ValueError(f"a mesh is stored by {names}")

    def count_elements(self, number: int) -> int:
        """Return the number of elements of an accessor; ValueError if it is negative."""
        count = self.tree["accessors"][number]["count"]
        if not isinstance(count, int) or count < 0:
            raise ValueError(f"an accessor has {count!r} elements")
        return count

    def count_values(self, number: int) -> int:
        """Return the number of values of an accessor; ValueError if it is negative."""
        return self.count_elements(number) * _WIDTHS[self.tree["accessors"][number]["type"]]

    def read_accessor(self, number: int) -> npt.NDArray[Any]:
        """Return the values of an accessor, shape (n, width); normalized ones as floats.

        Raises:
            ValueError: They end after their buffer view, or the accessors have more values than
                their file has bytes.
        """
        if number not in self._accessors:
            self._values += self.count_values(number)
            limit = max(MAX_VALUES, self.size)
            if self._values > limit:
                raise ValueError(
                    f"its accessors have {self._values} values or more, more than the limit of "
                    f"{limit} for a mesh of {self.size} bytes"
                )
            self._accessors[number] = self._read_values(number)
        return self._accessors[number]

    def _read_values(self, number: int) -> npt.NDArray[Any]:
        accessor = self.tree["accessors"][number]
        kind, width = np.dtype(_TYPES[accessor["componentType"]]), _WIDTHS[accessor["type"]]
        count = accessor["count"]
        values: npt.NDArray[Any]
        if "bufferView" in accessor:
            view = self.tree["bufferViews"][accessor["bufferView"]]
            values = _read_rows(
                self._read_view(accessor["bufferView"]),
                kind,
                (count, width),
                accessor.get("byteOffset", 0),
                view.get("byteStride", kind.itemsize * width),
            )
        else:
            values = np.zeros((count, width), kind)
        if "sparse" in accessor:
            values = self._replace_sparse(values.copy(), accessor["sparse"])
        if accessor.get("normalized") and kind.kind in "iu":
            values = np.maximum(values / np.iinfo(kind).max, -1.0)
        return values

    def _replace_sparse(self, values: npt.NDArray[Any], sparse: Any) -> npt.NDArray[Any]:
        """Replace the rows that a sparse accessor stores apart."""
        count, indices, changed = sparse["count"], sparse["indices"], sparse["values"]
        if count > len(values):
            raise ValueError(f"a sparse accessor replaces {count} of {len(values)} elements")
        kind = np.dtype(_TYPES[indices["componentType"]])
        data = self._read_view(indices["bufferView"])
        start = indices.get("byteOffset", 0)
        rows = _read_rows(data, kind, (count, 1), start, kind.itemsize)
        width = values.shape[1]
        values[rows.ravel()] = _read_rows(
            self._read_view(changed["bufferView"]),
            values.dtype,
            (count, width),
            changed.get("byteOffset", 0),
            values.dtype.itemsize * width,
        )
        return values

    def read_material(self, number: int) -> tuple[Rgba | None, Image]:
        """Return the base color of a material in sRGB, and its image."""
        material = self.tree["materials"][number]
        base = material.get("pbrMetallicRoughness", {})
        shiny = material.get("extensions", {}).get("KHR_materials_pbrSpecularGlossiness", {})
        factor = base.get("baseColorFactor", shiny.get("diffuseFactor"))
        rgba: Rgba | None = None
        if factor is not None:
            red, green, blue, alpha = (*(float(value) for value in factor), 1.0)[:4]
            rgba = (convert_to_srgb(red), convert_to_srgb(green), convert_to_srgb(blue), alpha)
        texture = base.get("baseColorTexture")
        source = None
        if texture is not None:
            source = self.tree["textures"][texture["index"]].get("source")
        return rgba, (None, None) if source is None else self._read_image(source)

    def _read_image(self, number: int) -> Image:
        if number not in self._images:
            image = self.tree["images"][number]
            uri = str(image.get("uri", ""))
            self._images[number] = (
                (self.path.parent / unquote(uri), None)
                if uri and not uri.startswith("data:")
                else (None, self._read_embedded_image(image, uri))
            )
        return self._images[number]

    def _read_embedded_image(self, image: Any, uri: str) -> bytes:
        """Return the content of an image; ValueError if images have more bytes than the file."""
        view = None if uri else self._read_view(image["bufferView"])
        self._image_bytes += len(uri) if view is None else len(view)
        if self._image_bytes > self.size:
            raise ValueError("its images overlap: they have more bytes than the file")
        return b64decode(uri.partition(",")[2]) if view is None else bytes(view)


def _read_rows(
    data: memoryview, kind: np.dtype[Any], shape: tuple[int, int], start: int, stride: int
) -> npt.NDArray[Any]:
    """Return rows of values that begin every ``stride`` bytes; a view of the data.

    Raises:
        ValueError: They end after the data.
    """
    count, width = shape
    row = kind.itemsize * width
    if (
        min(start, count) < 0
        or stride < row
        or start + max(count - 1, 0) * stride + row > len(data)
    ):
        raise ValueError("values end after their buffer")
    rows: npt.NDArray[Any] = np.ndarray(shape, kind, data, start, (stride, kind.itemsize))
    return rows
