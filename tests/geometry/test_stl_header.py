"""Headers of STL files without a library, and their bounds."""

import subprocess
import sys
from pathlib import Path

import pytest

from urdftool.geometry.stl import compute_stl_bounds
from urdftool.geometry.stl_header import is_lfs_pointer, read_stl_header

FIXTURES = Path(__file__).parents[2] / "fixtures" / "meshes"


@pytest.mark.parametrize(
    ("name", "kind", "triangles", "solid", "agrees"),
    [
        ("cube.stl", "binary", 12, False, True),
        ("cube_solid_header.stl", "binary", 12, True, True),
        ("cube_ascii.stl", "ascii", None, True, True),
        ("truncated.stl", "binary", 12, False, False),
        ("huge_claim.stl", "binary", 85899345, False, False),
        ("trailing_bytes.stl", "binary", 10, False, False),
        ("lfs_pointer.stl", "lfs-pointer", None, False, False),
        ("empty.stl", "empty", None, False, False),
    ],
)
def test_kind(name, kind, triangles, solid, agrees):
    facts = read_stl_header(FIXTURES / name)
    assert (facts.kind, facts.triangles) == (kind, triangles)
    assert facts.begins_with_solid == solid
    assert facts.size_agrees == agrees


def test_bounds():
    low, high = compute_stl_bounds(FIXTURES / "millimetres.stl")
    assert low == (-100, -50, -25)
    assert high == (100, 50, 25)
    assert compute_stl_bounds(FIXTURES / "nan.stl") is None
    assert compute_stl_bounds(FIXTURES / "cube_ascii.stl") is None
    assert compute_stl_bounds(FIXTURES / "truncated.stl") is not None


def test_lfs_pointer():
    assert is_lfs_pointer(FIXTURES / "lfs_pointer.stl")
    assert not is_lfs_pointer(FIXTURES / "cube.stl")


def test_nothing_heavy_is_imported():
    code = (
        "import sys, urdftool.geometry.stl_header, urdftool.geometry.penetration;"
        "import urdftool.inertia;"
        "print([m for m in ('numpy', 'trimesh', 'scipy') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
