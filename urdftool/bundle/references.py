"""Files that a mesh file refers to: images, OBJ materials and glTF buffers."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Iterator, Mapping
from typing import Any, Literal, NamedTuple
from urllib.parse import quote, unquote

from ..geometry.reference_patterns import INIT_FROM, MAP, MTLLIB
from ..source.escape import escape, unescape

Kind = Literal["image", "material", "buffer"]


class Reference(NamedTuple):
    """Reference of a mesh file to another file.

    Attributes:
        written: The reference, without XML escapes.
        kind: Kind of the file.
        size: Required size of a buffer [bytes]; None for other kinds.
    """

    written: str
    kind: Kind
    size: int | None = None


_IMAGES, _IMAGES_END = b"<library_images", b"</library_images"
_GLB_HEAD = struct.Struct("<4sIIII")
_JSON_CHUNK = 0x4E4F534A
"""Type of the first chunk of a GLB file: the letters JSON (glTF 2.0, section 4.4.3)."""

_LISTS: tuple[tuple[str, Kind], ...] = (("buffers", "buffer"), ("images", "image"))


class _Span(NamedTuple):
    start: int
    end: int
    reference: Reference


def has_references(suffix: str) -> bool:
    """Tell whether files of a suffix may refer to other files."""
    return suffix in _SPANS or suffix in (".gltf", ".glb")


def find_references(suffix: str, data: bytes) -> list[Reference]:
    """Return the references of a mesh or material file, each once; none if it is damaged."""
    if suffix in _SPANS:
        found = [span.reference for span in _SPANS[suffix](data)]
    elif suffix in (".gltf", ".glb"):
        found = [reference for _, reference in _list_entries(_parse_gltf(suffix, data))]
    else:
        found = []
    return list(dict.fromkeys(found))


def rewrite_references(suffix: str, data: bytes, names: Mapping[str, str]) -> bytes:
    """Replace references of a mesh or material file; return the same bytes if none changes."""
    if all(old == new for old, new in names.items()):
        return data
    if suffix in _SPANS:
        pieces, end = [], 0
        for span in _SPANS[suffix](data):
            new = names.get(span.reference.written, span.reference.written)
            pieces += [data[end : span.start], _encode(suffix, new)]
            end = span.end
        return b"".join((*pieces, data[end:]))
    document = _parse_gltf(suffix, data)
    for entry, reference in _list_entries(document):
        renamed = names.get(reference.written, reference.written)
        if renamed != reference.written:
            entry["uri"] = quote(renamed)
    text = json.dumps(document, separators=(",", ":")).encode()
    return text if suffix == ".gltf" else _replace_document(data, text)


def list_readings(written: str) -> list[str]:
    """Return the paths that a reference may mean: as written, and percent-decoded."""
    plain = written.strip().replace("\\", "/")
    if plain.startswith("file://"):
        plain = plain.removeprefix("file://")
    return list(dict.fromkeys((plain, unquote(plain))))


def is_embedded(written: str) -> bool:
    """Tell whether a reference contains its data."""
    return written.startswith("data:")


def _encode(suffix: str, name: str) -> bytes:
    return (escape(quote(name)) if suffix == ".dae" else name).encode()


def _find_obj_spans(data: bytes) -> Iterator[_Span]:
    at = data.find(b"mtllib")
    while at >= 0:  # an expression that looks at each line takes a second for 50 MB
        line = data.rfind(b"\n", 0, at) + 1
        match = MTLLIB.match(data, line)
        if match is not None:
            yield _Span(match.start(1), match.end(1), Reference(_decode(match[1]), "material"))
        end = data.find(b"\n", at)
        at = -1 if end < 0 else data.find(b"mtllib", end)


def _find_mtl_spans(data: bytes) -> Iterator[_Span]:
    for match in MAP.finditer(data):
        yield _Span(match.start(1), match.end(1), Reference(_decode(match[1]), "image"))


def _find_dae_spans(data: bytes) -> Iterator[_Span]:
    start = data.find(_IMAGES)
    while start >= 0:
        end = data.find(_IMAGES_END, start)
        if end < 0:
            return
        for match in INIT_FROM.finditer(data, start, end + len(_IMAGES_END)):
            name = unescape(_decode(match[1]))
            yield _Span(match.start(1), match.end(1), Reference(name, "image"))
        start = data.find(_IMAGES, end)


_SPANS: Mapping[str, Callable[[bytes], Iterator[_Span]]] = {
    ".obj": _find_obj_spans,
    ".mtl": _find_mtl_spans,
    ".dae": _find_dae_spans,
}


def _decode(data: bytes) -> str:
    return data.decode("utf-8", "replace")


def _parse_gltf(suffix: str, data: bytes) -> dict[str, Any]:
    """Return the JSON document of a glTF file; an empty one if it is damaged."""
    if suffix == ".glb":
        if len(data) < _GLB_HEAD.size:
            return {}
        *_, length, kind = _GLB_HEAD.unpack_from(data)
        data = data[_GLB_HEAD.size : _GLB_HEAD.size + length] if kind == _JSON_CHUNK else b""
    try:
        document = json.loads(data)
    except (ValueError, RecursionError):
        return {}
    return document if isinstance(document, dict) else {}


def _replace_document(data: bytes, text: bytes) -> bytes:
    """Return a GLB file with another JSON document."""
    magic, version, _, length, kind = _GLB_HEAD.unpack_from(data)
    rest = data[_GLB_HEAD.size + length :]
    text += b" " * (-len(text) % 4)
    size = _GLB_HEAD.size + len(text) + len(rest)
    return _GLB_HEAD.pack(magic, version, size, len(text), kind) + text + rest


def _list_entries(document: dict[str, Any]) -> Iterator[tuple[dict[str, Any], Reference]]:
    """Yield the buffers and images of a glTF document that are files of their own."""
    for key, kind in _LISTS:
        entries = document.get(key)
        for entry in entries if isinstance(entries, list) else ():
            uri = entry.get("uri") if isinstance(entry, dict) else None
            if isinstance(uri, str) and uri and not is_embedded(uri):
                size = entry.get("byteLength") if kind == "buffer" else None
                yield entry, Reference(uri, kind, size if isinstance(size, int) else None)
