"""Results of the cache: whole, or absent."""

import json

import numpy as np
import pytest

from tests.conftest import FIXTURES
from urdftool.collision.compute import MEASURES, Task, compute, parse_result
from urdftool.geometry.plain_form import decode_triangles, encode_triangles
from urdftool.storage import join_parts, split_parts


@pytest.fixture(scope="module")
def result():
    return compute(Task(FIXTURES / "meshes" / "cube.obj"))


def test_a_result_is_read_as_it_was_written(result):
    assert set(result.measures) == set(MEASURES)
    again = parse_result(result.as_bytes())
    assert again.as_bytes() == result.as_bytes()


FORGERIES = (
    ("pieces", [{"kind": "os.system"}]),
    ("pieces", [{"kind": "mesh", "vertices": [[0, 0, 0]], "faces": [[0, 0, 9]]}]),
    ("pieces", [{"kind": "mesh", "vertices": [[float("nan"), 0, 0]], "faces": []}]),
    ("pieces", [{"kind": "box", "size": [], "rotation": [], "center": []}]),
    ("pieces", 7),
    ("measures", {}),
    ("measures", []),
    ("before", {"triangles": "x", "vertices": 1}),
    ("notes", [7]),
    ("seconds", []),
)


@pytest.mark.parametrize(("name", "value"), FORGERIES)
def test_a_forged_result_is_refused(result, name, value):
    table = json.loads(result.as_bytes())
    with pytest.raises(ValueError, match=r"."):
        parse_result(json.dumps({**table, name: value}).encode())


@pytest.mark.parametrize(
    "data", [b"", b"[" * 99_999, b"[]\n", b"7\n", b"[0,[-1,1]]\n", b"[0,[2]]\n1"]
)
def test_damaged_parts_are_refused(data):
    assert split_parts(join_parts({"a": 1}, [b"", b"x\n"])) == ({"a": 1}, [b"", b"x\n"])
    with pytest.raises(ValueError, match=r"."):
        split_parts(data)


def test_triangles_have_only_points_that_exist():
    points, faces = np.zeros((3, 3)), np.array([[0, 1, 2]])
    assert decode_triangles(*encode_triangles(points, faces))[1].tolist() == [[0, 1, 2]]
    for wrong in (faces + 1, faces - 1):
        with pytest.raises(ValueError, match="does not exist"):
            decode_triangles(*encode_triangles(points, wrong))
    with pytest.raises(ValueError, match="not finite"):
        decode_triangles(*encode_triangles(points + np.nan, faces))
