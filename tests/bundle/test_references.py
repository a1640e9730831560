import pytest

from tests.bundle import files
from urdftool.bundle.references import find_references, rewrite_references


def written(suffix, data):
    return [reference.written for reference in find_references(suffix, data)]


@pytest.mark.parametrize(
    ("line", "name"),
    [
        ("map_Kd a.png", "a.png"),
        ("map_Kd -s 1 1 1 -o 0.5 0 a b.png", "a b.png"),
        ("  bump -bm 0.5 12.png", "12.png"),
        ("map_Kd -clamp on tex/a.png \r", "tex/a.png"),
    ],
)
def test_images_of_materials_follow_their_options(line, name):
    assert written(".mtl", f"newmtl m\n{line}\nKd 1 1 1\n".encode()) == [name]


def test_only_images_of_collada_are_references():
    data = files.dae("../a%20b&amp;c.png")
    assert written(".dae", data) == ["../a%20b&c.png"]
    changed = rewrite_references(".dae", data, {"../a%20b&c.png": "a_b.png"})
    assert changed == files.dae("a_b.png")


@pytest.mark.parametrize("suffix", [".gltf", ".glb"])
def test_buffers_and_images_of_gltf(suffix):
    document, rest = files.gltf_document("deep/x.bin", "y.png"), b"\4\0\0\0BIN\0abcd"
    data = document if suffix == ".gltf" else files.glb(document, rest)
    found = find_references(suffix, data)
    assert [(r.written, r.kind, r.size) for r in found] == [
        ("deep/x.bin", "buffer", 12),
        ("y.png", "image", None),
    ]
    changed = rewrite_references(suffix, data, {"deep/x.bin": "x.bin", "y.png": "y.png"})
    assert written(suffix, changed) == ["x.bin", "y.png"]
    if suffix == ".glb":
        assert changed.endswith(rest)
        assert int.from_bytes(changed[8:12], "little") == len(changed)


def test_unchanged_references_keep_the_bytes():
    data = files.gltf_document("x.bin", "y.png")
    assert rewrite_references(".gltf", data, {"x.bin": "x.bin"}) is data


@pytest.mark.parametrize("suffix", [".gltf", ".glb"])
@pytest.mark.parametrize("data", [b"", b"glTF", b"[]", b'{"buffers": 3}', b'{"images": [1]}'])
def test_damaged_gltf_has_no_references(suffix, data):
    assert find_references(suffix, data) == []
    assert find_references(suffix, files.glb(data)) == []
