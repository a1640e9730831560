from pathlib import Path

import pytest

from urdftool.bundle.collect import Asset
from urdftool.bundle.layout import Layout, make_portable


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("Link-1 (copy).v2", "Link_1_copy_v2"),
        ("Größe", "Groe"),
        ("con", "con_"),
        ("手", "unnamed"),
        ("a" * 200, "a" * 80),
    ],
)
def test_names_are_portable(text, name):
    assert make_portable(text) == name


def places(*paths):
    layout = Layout()
    kinds = {".png": "image", ".mtl": "material"}
    return [layout.place(Asset(Path(p), kinds.get(Path(p).suffix, "mesh"))) for p in paths]


def test_stems_of_meshes_are_distinct_without_regard_to_case():
    assert places("/p/visual/Link.dae", "/p/collision/link.STL", "/q/collision/LINK.obj") == [
        "meshes/Link.dae",
        "meshes/link_collision.stl",
        "meshes/LINK_collision_1.obj",
    ]


def test_materials_keep_the_stem_of_their_mesh():
    assert places("/p/a.obj", "/p/a.mtl", "/q/a.mtl", "/r/q/a.mtl", "/q/a.png") == [
        "meshes/a.obj",
        "meshes/a.mtl",
        "meshes/a_q.mtl",
        "meshes/a_q_r.mtl",
        "meshes/a.png",
    ]
