"""glTF scenes: modes, sparse and normalized accessors, compression, damaged trees."""

import json
import struct
from base64 import b64encode

import numpy as np
import pytest

from urdftool.errors import MeshError
from urdftool.geometry.convex_points import read_convex_points
from urdftool.geometry.load import load_mesh

POINTS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (9, 9, 9)]
FLOAT, BYTE, SHORT = 5126, 5121, 5122


def write(path, primitive, *, accessors=(), data=b"", **more):
    positions = b"".join(struct.pack("<3f", *point) for point in POINTS)
    rows = bytes([0, 1, 2, 3])
    content = positions + rows + data
    uri = "data:application/octet-stream;base64," + b64encode(content).decode()
    tree = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(content), "uri": uri}],
        "bufferViews": [
            {"buffer": 0, "byteLength": 60},
            {"buffer": 0, "byteOffset": 60, "byteLength": 4},
            {"buffer": 0, "byteOffset": 64, "byteLength": len(data)},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": FLOAT, "count": 5, "type": "VEC3"},
            {"bufferView": 1, "componentType": BYTE, "count": 4, "type": "SCALAR"},
            *accessors,
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, **primitive}]}],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
    }
    path.write_text(json.dumps({**tree, **more}))
    return path


@pytest.mark.parametrize(
    ("mode", "faces"),
    [(5, [[0, 1, 2], [3, 2, 1]]), (6, [[0, 1, 2], [0, 2, 3]])],
    ids=["strip", "fan"],
)
def test_strips_and_fans_become_triangles(tmp_path, mode, faces):
    mesh = load_mesh(write(tmp_path / "m.gltf", {"mode": mode}), gltf_up="z")
    assert mesh.faces.tolist() == faces
    assert read_convex_points(tmp_path / "m.gltf", "z").high == (2, 2, 0)


def test_lines_are_no_surface(tmp_path):
    path = write(tmp_path / "m.gltf", {"mode": 1})
    with pytest.raises(MeshError, match="no faces"):
        load_mesh(path)
    assert read_convex_points(path) is None


def test_sparse_accessors_replace_rows(tmp_path):
    sparse = {
        "count": 1,
        "indices": {"bufferView": 2, "componentType": BYTE},
        "values": {"bufferView": 2, "byteOffset": 4},
    }
    accessor = {"bufferView": 0, "componentType": FLOAT, "count": 5, "type": "VEC3"}
    path = write(
        tmp_path / "m.gltf",
        {"attributes": {"POSITION": 2}, "mode": 6},
        accessors=[{**accessor, "sparse": sparse}],
        data=bytes(4) + struct.pack("<3f", 0, 0, -7),
    )
    assert load_mesh(path, gltf_up="z").vertices[0].tolist() == [0, 0, -7]
    assert read_convex_points(path, "z").low == (0, 0, -7)


def test_normalized_integers_are_divided_by_their_range(tmp_path):
    path = write(
        tmp_path / "m.gltf",
        {"attributes": {"POSITION": 2}, "mode": 6},
        accessors=[
            {
                "bufferView": 2,
                "componentType": SHORT,
                "normalized": True,
                "count": 4,
                "type": "VEC3",
            }
        ],
        data=struct.pack("<12h", 0, 0, 0, 32767, 0, 0, 32767, -32768, 0, 0, 32767, 0),
    )
    np.testing.assert_allclose(load_mesh(path, gltf_up="z").vertices[2], [1, -1, 0])


def test_a_compressed_mesh_has_its_declared_box_alone(tmp_path):
    accessor = {"componentType": FLOAT, "count": 4, "type": "VEC3"}
    path = write(
        tmp_path / "m.gltf",
        {
            "attributes": {"POSITION": 2},
            "extensions": {"KHR_draco_mesh_compression": {"bufferView": 2}},
        },
        accessors=[{**accessor, "min": [0, 0, 0], "max": [1, 2, 3]}],
    )
    with pytest.raises(MeshError, match="KHR_draco_mesh_compression"):
        load_mesh(path)
    assert read_convex_points(path, "z").high == (1, 2, 3)


@pytest.mark.parametrize(
    "more",
    [
        {"nodes": [{"children": [0], "mesh": 0}]},
        {"nodes": [{"mesh": 0, "matrix": [1, 2, 3]}]},
        {"nodes": [{"mesh": 5}]},
        {"scenes": [{"nodes": [-1]}]},
        {"bufferViews": [{"buffer": 0, "byteLength": 600}] * 3},
        {"buffers": [{"byteLength": 5, "uri": "none.bin"}]},
    ],
    ids=["cycle", "matrix", "mesh", "root", "view", "buffer"],
)
def test_a_damaged_tree_is_one_error_or_ends(tmp_path, more):
    path = write(tmp_path / "m.gltf", {"mode": 6}, **more)
    if "children" in str(more):
        assert len(load_mesh(path).faces) == 4  # the node, and once more as its child
        return
    with pytest.raises(MeshError, match="cannot be read"):
        load_mesh(path)
    assert read_convex_points(path) is None
