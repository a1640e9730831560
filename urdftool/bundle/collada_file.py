"""Meshes as COLLADA files, with materials, textures and normals."""

from __future__ import annotations

from collections.abc import Iterator
from xml.sax.saxutils import escape

import numpy as np

from ..drawing.normals import compute_corner_normals
from ..geometry.mesh import Array, Faces, Mesh
from .mesh_formats import GRAY, MaterialNames, number_rows

_HEAD = """<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><contributor><authoring_tool>urdftool</authoring_tool></contributor>
<created>1980-01-01T00:00:00</created><modified>1980-01-01T00:00:00</modified>
<unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>"""
_SAMPLER = """<newparam sid="surface"><surface type="2D"><init_from>image_{0}</init_from></surface>\
</newparam><newparam sid="sampler"><sampler2D><source>surface</source></sampler2D></newparam>"""


def encode_dae(mesh: Mesh, names: MaterialNames, shading: Array | None = None) -> bytes:
    """Encode a mesh as COLLADA in meters, with Z up.

    Parts without a color or image have no material, so that the one of the URDF applies.

    Args:
        mesh: The mesh.
        names: Names of the images.
        shading: Unit normal at each corner, shape (m, 3, 3); None computes them.
    """
    if shading is None:
        shading = compute_corner_normals(mesh.vertices, mesh.faces)
    textured = [n for n, part in enumerate(mesh.parts) if n in names.images and part.uv is not None]
    lines = [_HEAD, "<library_images>"]
    for n in textured:
        image = escape(names.images[n])
        lines.append(f'<image id="image_{n}"><init_from>{image}</init_from></image>')
    lines += ["</library_images>", "<library_effects>"]
    used = [n for n, part in enumerate(mesh.parts) if part.rgba is not None or n in textured]
    for n in used:
        lines += _describe_effect(n, mesh.parts[n].rgba or GRAY, is_textured=n in textured)
    lines += ["</library_effects>", "<library_materials>"]
    for n in used:
        effect = f'<instance_effect url="#effect_{n}"/>'
        lines.append(f'<material id="material_{n}" name="material_{n}">{effect}</material>')
    lines += ["</library_materials>", '<library_geometries><geometry id="mesh"><mesh>']
    lines += _describe_geometry(mesh, shading, used, textured)
    lines += ["</mesh></geometry></library_geometries>", "<library_visual_scenes>"]
    lines += ['<visual_scene id="scene"><node id="node"><instance_geometry url="#mesh">']
    lines.append("<bind_material><technique_common>")
    for n in used:
        lines.append(
            f'<instance_material symbol="material_{n}" target="#material_{n}">'
            '<bind_vertex_input semantic="UVSET0" input_semantic="TEXCOORD" input_set="0"/>'
            "</instance_material>"
        )
    lines.append("</technique_common></bind_material></instance_geometry></node></visual_scene>")
    lines += ["</library_visual_scenes>", '<scene><instance_visual_scene url="#scene"/></scene>']
    return ("\n".join([*lines, "</COLLADA>"]) + "\n").encode()


def _describe_effect(number: int, rgba: tuple[float, ...], *, is_textured: bool) -> Iterator[str]:
    red, green, blue, opacity = rgba
    yield f'<effect id="effect_{number}"><profile_COMMON>'
    color = f"<color>{red:.6g} {green:.6g} {blue:.6g} {opacity:.6g}</color>"
    if is_textured:
        yield _SAMPLER.format(number)
        color = '<texture texture="sampler" texcoord="UVSET0"/>'
    yield f'<technique sid="common"><lambert><diffuse>{color}</diffuse>'
    if opacity < 1:
        yield f'<transparent opaque="A_ONE"><color>1 1 1 {opacity:.6g}</color></transparent>'
        yield "<transparency><float>1</float></transparency>"
    yield "</lambert></technique></profile_COMMON></effect>"


def _describe_geometry(
    mesh: Mesh, shading: Array, used: list[int], textured: list[int]
) -> Iterator[str]:
    normals, normal_of = number_rows(shading)
    yield _describe_source("points", mesh.vertices, "XYZ", 9)
    yield _describe_source("normals", normals, "XYZ", 4)
    texels: dict[int, Faces] = {}
    for n in textured:
        uv = mesh.parts[n].uv
        assert uv is not None
        rows, texels[n] = number_rows(uv)
        yield _describe_source(f"uv_{n}", rows, "ST", 6)
    yield '<vertices id="vertices"><input semantic="POSITION" source="#points"/></vertices>'
    for n, part in enumerate(mesh.parts):
        symbol = f' material="material_{n}"' if n in used else ""
        yield f'<triangles count="{part.count}"{symbol}>'
        yield '<input semantic="VERTEX" source="#vertices" offset="0"/>'
        yield '<input semantic="NORMAL" source="#normals" offset="1"/>'
        shaded = normal_of[part.first : part.first + part.count]
        columns = [mesh.get_part_faces(part), shaded]
        if n in texels:
            yield f'<input semantic="TEXCOORD" source="#uv_{n}" offset="2" set="0"/>'
            columns.append(texels[n])
        numbers = np.stack(columns, axis=-1).reshape(-1).tolist()
        yield f"<p>{' '.join(map(str, numbers))}</p></triangles>"


def _describe_source(name: str, rows: Array, axes: str, digits: int) -> str:
    """Return the source of an array of vectors."""
    values = " ".join(f"{value:.{digits}g}" for value in (rows + 0.0).reshape(-1).tolist())
    params = "".join(f'<param name="{axis}" type="float"/>' for axis in axes)
    return (
        f'<source id="{name}"><float_array id="{name}_array" count="{rows.size}">{values}'
        f'</float_array><technique_common><accessor source="#{name}_array" count="{len(rows)}" '
        f'stride="{len(axes)}">{params}</accessor></technique_common></source>'
    )
