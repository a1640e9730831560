"""Vertices that no triangle has are no part of a mesh, whichever reader measures it."""

import base64
import json
import struct

import numpy as np
import pytest

from urdftool.geometry.convex_points import read_convex_points
from urdftool.geometry.load import load_mesh

TETRAHEDRON = [(0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.1, 0.0), (0.0, 0.0, 0.1)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
FAR = (5.0, 5.0, 5.0)
POINTS = [FAR, *TETRAHEDRON, FAR]
CORNERS = [tuple(corner + 1 for corner in face) for face in FACES]


def _obj(faces, *more):
    lines = [f"v {x} {y} {z}" for x, y, z in POINTS]
    return "\n".join([*lines, *faces, *more, ""]).encode()


def _dae():
    numbers = " ".join(f"{value}" for point in POINTS for value in point)
    # each corner has a vertex and a normal, and a triangle of the first geometry is a polygon
    corners = " ".join(f"{corner} 0" for face in CORNERS for corner in face)
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
  <source id="p"><float_array id="pa" count="{3 * len(POINTS)}">{numbers}</float_array>
    <technique_common><accessor source="#pa" count="{len(POINTS)}" stride="3">
      <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
    </accessor></technique_common></source>
  <source id="n"><float_array id="na" count="3">0 0 1</float_array>
    <technique_common><accessor source="#na" count="1" stride="3">
      <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
    </accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <triangles count="{len(CORNERS)}"><input semantic="VERTEX" source="#v" offset="0"/>
    <input semantic="NORMAL" source="#n" offset="1"/><p>{corners}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="x"><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>""".encode()


def _ply():
    points = [f"{x} {y} {z}" for x, y, z in POINTS]
    faces = ["3 " + " ".join(map(str, face)) for face in CORNERS]
    head = f"""ply
format ascii 1.0
element vertex {len(points)}
property float x
property float y
property float z
element face {len(faces)}
property list uchar int vertex_indices
end_header
"""
    return (head + "\n".join([*points, *faces, ""])).encode()


def _gltf(kind, code):
    points = b"".join(struct.pack("<3f", x, z, -y) for x, y, z in POINTS)  # with Y up
    rows = struct.pack(f"<12{kind}", *(corner for face in CORNERS for corner in face))
    data = base64.b64encode(points + rows).decode()
    flat = list(zip(*[struct.unpack_from("<3f", points, 12 * i) for i in range(6)], strict=True))
    box = {"min": [min(axis) for axis in flat], "max": [max(axis) for axis in flat]}
    accessor = {"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3", **box}
    return json.dumps(
        {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [
                accessor,
                {"bufferView": 1, "componentType": code, "count": 12, "type": "SCALAR"},
            ],
            "bufferViews": [
                {"buffer": 0, "byteLength": len(points)},
                {"buffer": 0, "byteOffset": len(points), "byteLength": len(rows)},
            ],
            "buffers": [
                {
                    "byteLength": len(points) + len(rows),
                    "uri": f"data:application/octet-stream;base64,{data}",
                }
            ],
        }
    ).encode()


PLAIN = ["f " + " ".join(str(corner + 1) for corner in face) for face in CORNERS]
RICH = ["f " + " ".join(f"{corner + 1}/7/9" for corner in face) for face in CORNERS]
BACKWARD = ["f " + " ".join(str(corner - len(POINTS)) for corner in face) for face in CORNERS]
FILES = {
    "plain.obj": _obj(PLAIN),
    "rich.obj": _obj(RICH, *["vt 0 0"] * 7, *["vn 0 0 1"] * 9),
    "backward.obj": _obj(BACKWARD, "v 9 9 9"),
    "continued.obj": _obj([PLAIN[0].replace(" 3", " \\\n3"), *PLAIN[1:]]),
    "lines.obj": _obj(PLAIN, "l 1 2", "p 6"),
    "mesh.dae": _dae(),
    "mesh.ply": _ply(),
    "short.gltf": _gltf("H", 5123),
    "int.gltf": _gltf("I", 5125),
    "byte.gltf": _gltf("B", 5121),
}


@pytest.mark.parametrize("name", FILES)
def test_only_vertices_of_triangles_count(tmp_path, name):
    path = tmp_path / name
    path.write_bytes(FILES[name])
    found = read_convex_points(path)
    assert found is not None
    np.testing.assert_allclose((found.low, found.high), ((0, 0, 0), (0.1, 0.1, 0.1)), atol=1e-6)
    mesh = load_mesh(path)
    assert len(mesh.vertices) <= 12
    np.testing.assert_allclose(mesh.vertices.max(axis=0), (0.1, 0.1, 0.1), atol=1e-6)
    assert len(mesh.faces) == 4


def test_an_obj_without_faces_has_no_outline(tmp_path):
    path = tmp_path / "points.obj"
    path.write_bytes(_obj([]))
    assert read_convex_points(path) is None


def test_a_stray_vertex_changes_no_finding(tmp_path, urdftool):
    """As in the COLLADA file of a shoulder whose collision was said to span half as much again."""
    mesh = '<geometry><mesh filename="mesh.dae"/></geometry>'
    (tmp_path / "mesh.dae").write_bytes(_dae())
    (tmp_path / "r.urdf").write_text(
        f'<robot name="r"><link name="a"><collision>{mesh}</collision><visual><geometry>'
        '<box size="0.05 0.05 0.05"/></geometry></visual></link></robot>'
    )
    select = ("--select", "collision-much-larger-than-visual", "--no-cache")
    assert urdftool("lint", tmp_path / "r.urdf", *select).out == ""
