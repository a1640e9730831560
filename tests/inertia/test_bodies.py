"""A scaled body follows from the unscaled one; the Python function; processes."""

import numpy as np
import pytest

import urdftool
from tests.conftest import FIXTURES
from urdftool.errors import MeshError, UrdftoolError
from urdftool.geometry.load import load_mesh
from urdftool.inertia.bodies import integrate_mesh_body
from urdftool.inertia.estimate import estimate_mass_properties
from urdftool.inertia.polyhedron import compute_shell_moments

MESHES = FIXTURES / "meshes"


@pytest.mark.parametrize("name", ["sphere.stl", "cube.obj", "two_cubes.stl", "cavity.stl"])
@pytest.mark.parametrize("scale", [(1, 1, 1), (0.001, 0.001, 0.001), (2, -3, 0.5), (-1, -1, -1)])
def test_scaling_the_body_is_loading_the_mesh_scaled(name, scale):
    found = integrate_mesh_body(MESHES / name).scale(scale)
    mesh = load_mesh(MESHES / name, scale)
    meant = estimate_mass_properties(mesh.vertices, mesh.faces, density=1.0).properties
    assert found.unit.mass == pytest.approx(meant.mass, rel=1e-12)
    assert found.unit.com == pytest.approx(meant.com, rel=1e-12, abs=1e-12)
    size = np.abs(meant.inertia).max()
    assert found.unit.inertia / size == pytest.approx(meant.inertia / size, rel=1e-10, abs=1e-12)
    used = mesh.vertices[np.unique(mesh.faces)]
    assert found.lower == pytest.approx(used.min(axis=0))
    assert found.upper == pytest.approx(used.max(axis=0))


def test_a_shell_scales_with_its_area():
    mesh = load_mesh(MESHES / "cube.obj", (2, -2, 2))
    meant = compute_shell_moments(mesh.vertices, mesh.faces).with_density(1.0)
    found = integrate_mesh_body(MESHES / "cube.obj", surface=True).scale((2, -2, 2))
    assert found.unit.mass == pytest.approx(meant.mass)
    assert found.unit.inertia == pytest.approx(meant.inertia)
    with pytest.raises(UrdftoolError, match="equal factors"):
        integrate_mesh_body(MESHES / "cube.obj", surface=True).scale((1, 2, 3))


def robot(tmp_path, shapes, inertial=""):
    path = tmp_path / "r.urdf"
    path.write_text(f'<robot name="r"><link name="a">{inertial}{shapes}</link></robot>')
    return urdftool.load(path)


BOX = "<{0}><geometry><box size='1 1 0.5'/></geometry></{0}>"
MESH = "<{0}><geometry><mesh filename='{1}'/></geometry></{0}>"


def test_compute_inertia(tmp_path):
    link = robot(tmp_path, BOX.format("visual")).link["a"]
    found = urdftool.compute_inertia(link, mass=1024)
    assert np.diag(found.inertia) == pytest.approx([320 / 3, 320 / 3, 512 / 3])
    assert urdftool.compute_inertia(link, density=2048).mass == pytest.approx(1024)
    with pytest.raises(UrdftoolError, match="no collision"):
        urdftool.compute_inertia(link, mass=1, source="collision")
    with pytest.raises(UrdftoolError, match="not both"):
        urdftool.compute_inertia(link, mass=1, density=1)
    with pytest.raises(UrdftoolError, match="no mass"):
        urdftool.compute_inertia(link)
    with pytest.raises(UrdftoolError, match="use collision or visual"):
        urdftool.compute_inertia(link, mass=1, source="looks")


def test_compute_inertia_takes_the_mass_that_is_written(tmp_path):
    written = "<inertial><mass value='12'/></inertial>"
    link = robot(tmp_path, BOX.format("collision"), written).link["a"]
    assert urdftool.compute_inertia(link).inertia[2, 2] == pytest.approx(2)


def test_compute_inertia_falls_back_where_a_mesh_is_missing(tmp_path):
    (tmp_path / "cube.stl").write_bytes((MESHES / "cube.stl").read_bytes())
    shapes = MESH.format("collision", "gone.stl") + MESH.format("visual", "cube.stl")
    link = robot(tmp_path, shapes).link["a"]
    assert urdftool.compute_inertia(link, density=5).mass == pytest.approx(5)
    with pytest.raises(UrdftoolError, match="no such mesh"):
        urdftool.compute_inertia(link, density=5, source="collision")


def test_an_unreadable_mesh_names_its_file():
    with pytest.raises(MeshError) as caught:
        integrate_mesh_body(MESHES / "flat.stl")
    assert str(caught.value).startswith(str(MESHES / "flat.stl"))
