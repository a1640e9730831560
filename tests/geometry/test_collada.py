"""COLLADA scenes: all kinds of primitives, nodes, skins and texture coordinates."""

import numpy as np
import pytest

from urdftool.errors import MeshError
from urdftool.geometry.convex_points import read_convex_points
from urdftool.geometry.load import load_mesh

SOURCE = """<source id="{0}"><float_array id="{0}a" count="{1}">{2}</float_array>
<technique_common><accessor source="#{0}a" count="1" stride="{3}"/></technique_common></source>"""
PENTAGON = "0 0 0  2 0 0  3 2 0  1 3 0  -1 2 0  9 9 9"
VERTEX = '<input semantic="VERTEX" source="#v" offset="0"/>'


def write(path, primitive, scene='<node><instance_geometry url="#g"/></node>', library=""):
    path.write_text(
        '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">'
        f'<library_geometries><geometry id="g"><mesh>{SOURCE.format("p", 18, PENTAGON, 3)}'
        f"{SOURCE.format('t', 12, '0 0 1 0 1 1 0 1 0 0 0 0', 2)}"
        '<vertices id="v"><input semantic="POSITION" source="#p"/>'
        '<input semantic="TEXCOORD" source="#t"/></vertices>'
        f"{primitive}</mesh></geometry></library_geometries>{library}"
        f'<library_visual_scenes><visual_scene id="s">{scene}</visual_scene>'
        '</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>'
    )
    return path


FAN = [[0, 1, 2], [0, 2, 3], [0, 3, 4]]
STRIP = [[0, 1, 2], [3, 2, 1], [2, 3, 4]]
PRIMITIVES = {
    "triangles": (f"<triangles>{VERTEX}<p>0 1 2 0 2 3 0 3 4</p></triangles>", FAN),
    "polylist": (f"<polylist>{VERTEX}<vcount>5</vcount><p>0 1 2 3 4</p></polylist>", FAN),
    "polygons": (f"<polygons>{VERTEX}<p>0 1 2</p><p>0 2 3 4</p></polygons>", FAN),
    "trifans": (f"<trifans>{VERTEX}<p>0 1 2 3 4</p></trifans>", FAN),
    "tristrips": (f"<tristrips>{VERTEX}<p>0 1 2 3 4</p></tristrips>", STRIP),
    "short polygons": (
        f"<polylist>{VERTEX}<vcount>2 3 1 4</vcount><p>4 4 0 1 2 4 0 2 3 4</p></polylist>",
        FAN,
    ),
}


@pytest.mark.parametrize("name", PRIMITIVES)
def test_all_primitives_become_triangles(tmp_path, name):
    text, faces = PRIMITIVES[name]
    mesh = load_mesh(write(tmp_path / "m.dae", text))
    assert mesh.faces.tolist() == faces
    assert mesh.parts[0].uv.shape == (3, 3, 2)
    assert mesh.parts[0].uv[0].tolist() == [[0, 0], [1, 0], [1, 1]]
    points = read_convex_points(tmp_path / "m.dae")
    assert (points.low, points.high) == ((-1, 0, 0), (3, 3, 0))


def test_transforms_of_nested_nodes_are_applied_in_order(tmp_path):
    scene = (
        '<node><translate>1 0 0</translate><rotate>0 0 1 90</rotate><node id="n">'
        '<scale>2 1 1</scale><instance_geometry url="#g"/></node><instance_node url="#n"/></node>'
    )
    mesh = load_mesh(write(tmp_path / "m.dae", PRIMITIVES["triangles"][0], scene))
    assert len(mesh.faces) == 6
    np.testing.assert_allclose(mesh.vertices[1], [1, 4, 0], atol=1e-12)


def test_a_skin_is_read_in_its_bind_shape(tmp_path):
    controllers = (
        '<library_controllers><controller id="c"><skin source="#g"><bind_shape_matrix>'
        "1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix></skin></controller>"
        "</library_controllers>"
    )
    scene = '<node><instance_controller url="#c"/></node>'
    mesh = load_mesh(write(tmp_path / "m.dae", PRIMITIVES["polylist"][0], scene, controllers))
    assert [note.code for note in mesh.notes] == ["collada-skin"]
    assert mesh.vertices[:, 0].min() == 4
    assert read_convex_points(tmp_path / "m.dae").low == (4, 0, 0)


@pytest.mark.parametrize(
    ("primitive", "scene", "words"),
    [
        (
            f"<polylist>{VERTEX}<vcount>9</vcount><p>0 1 2</p></polylist>",
            None,
            "cut into triangles",
        ),
        (f"<polylist>{VERTEX}<vcount>-3</vcount><p>0 1 2</p></polylist>", None, "cut into"),
        (f"<triangles>{VERTEX}<p>0 1 7</p></triangles>", None, "vertex 7 of 6"),
        (f"<triangles>{VERTEX}<p>0 1 two</p></triangles>", None, "cannot be read"),
        (f"<triangles>{VERTEX}<p>0 1</p></triangles>", None, "cannot be read"),
        (PRIMITIVES["triangles"][0], '<node id="n"><instance_node url="#n"/></node>', "256 deep"),
        (PRIMITIVES["triangles"][0], "<node><skew>1 0 0 0 1 0 0</skew></node>", "<skew>"),
    ],
)
def test_a_damaged_scene_is_one_error(tmp_path, primitive, scene, words):
    path = write(tmp_path / "m.dae", primitive, *([] if scene is None else [scene]))
    with pytest.raises(MeshError, match=words):
        load_mesh(path)
    assert read_convex_points(path) is None


def test_nodes_that_multiply_are_counted(tmp_path):
    nodes = "".join(
        f'<node id="n{i}"><instance_node url="#n{i + 1}"/><instance_node url="#n{i + 1}"/></node>'
        for i in range(60)
    )
    path = write(tmp_path / "m.dae", PRIMITIVES["triangles"][0], nodes)
    with pytest.raises(MeshError, match="more than the limit of 100000"):
        load_mesh(path)
