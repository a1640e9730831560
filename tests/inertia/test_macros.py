"""The xacro macros, expanded by xacro, give the numbers of the command."""

import xml.etree.ElementTree as ET

import pytest
import xacro

from tests.mechanics.bodies import move
from urdftool.inertia.macros import get_macro_file, get_mass_macro, get_shape_call, get_shape_macro
from urdftool.inertia.rounding import DIGITS, round_properties
from urdftool.inertia.shapes import compute_shape_properties, find_shape
from urdftool.mechanics.spatial_inertia import SpatialInertia
from urdftool.mechanics.tensor import get_components, make_diagonal_tensor, rotate_tensor
from urdftool.model.numbers import round_number
from urdftool.model.pose import rotation_from_rpy

CASES = [
    ("box", {"size": (0.3, 0.7, 1.1)}, {}),
    ("box", {"size": (1, 1, 0.5)}, {}),
    ("box", {"size": (0.3, 0.7, 1.1)}, {"thickness": 0.02}),
    ("cylinder", {"radius": 0.06, "length": 0.09}, {}),
    ("cylinder", {"radius": 0.06, "length": 0.09}, {"thickness": 0.01}),
    ("cylinder", {"radius": 0.06, "length": 0.09}, {"thickness": 0.01, "closed": True}),
    ("sphere", {"radius": 2}, {}),
    ("sphere", {"radius": 0.3}, {"thickness": 0.003}),
    ("capsule", {"radius": 0.1, "length": 0.4}, {}),
    ("ellipsoid", {"radii": (0.1, 0.2, 0.3)}, {}),
    ("cone", {"radius": 0.1, "length": 0.4}, {}),
]


def expanded(tmp_path, body):
    path = tmp_path / "r.xacro"
    path.write_text(f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{body}</robot>')
    root = ET.fromstring(xacro.process_file(str(path)).toxml())
    inertial = root.find(".//inertial")
    xyz, rpy = ([float(v) for v in inertial.find("origin").get(n).split()] for n in ("xyz", "rpy"))
    six = {n: float(v) for n, v in inertial.find("inertia").attrib.items()}
    return float(inertial.find("mass").get("value")), xyz, rpy, six


@pytest.mark.parametrize(("name", "sizes", "more"), CASES)
@pytest.mark.parametrize("whole", [True, False])
def test_macros_equal_the_command(tmp_path, name, sizes, more, whole):
    shape = find_shape(name)
    xyz, rpy = (0.1, -0.2, 0.3), (0.4, -0.5, 0.6)
    call = get_shape_call(shape, sizes, 1.7, **more, xyz=xyz, rpy=rpy)
    if whole:
        (tmp_path / "inertia.xacro").write_text(get_macro_file())
        before = '<xacro:include filename="inertia.xacro"/>'
    else:
        before = get_shape_macro(shape, hollow="thickness" in more)
    mass, at, turned, six = expanded(tmp_path, before + f"<link>{call}</link>")
    alone = compute_shape_properties(shape, sizes, mass=1.7, **more)
    printed = get_components(round_properties(alone).tensor)
    assert {key: round_number(value, DIGITS) for key, value in six.items()} == printed
    moved = move(alone, xyz=xyz, rpy=rpy)
    assert mass == moved.mass == 1.7
    assert at == pytest.approx(moved.com, abs=1e-9)
    tensor = make_diagonal_tensor(six["ixx"], six["iyy"], six["izz"])
    assert rotate_tensor(tensor, rotation_from_rpy(turned)) == pytest.approx(moved.tensor, rel=1e-8)


def test_xyz_and_rpy_may_be_left_out(tmp_path):
    macro = get_shape_macro(find_shape("cone"))
    call = '<xacro:cone_inertia mass="1" radius="0.1" length="0.4"/>'
    _, at, _, _ = expanded(tmp_path, macro + call)
    assert at == [0, 0, -0.1]


def test_a_body_of_any_shape_takes_its_mass(tmp_path):
    tensor = (2.0, 0.1, 0.2, 3.0, 0.3, 4.0)
    macro = get_mass_macro("part", SpatialInertia(2.0, (1.0, 2.0, 3.5), tensor))
    assert expanded(tmp_path, macro)[3] == get_components(tensor)
    heavy = macro.replace("<xacro:part_inertia/>", '<xacro:part_inertia mass="4"/>')
    mass, at, _, six = expanded(tmp_path, heavy)
    assert (mass, at) == (4, [1, 2, 3.5])
    assert six == {n: pytest.approx(v * 2) for n, v in get_components(tensor).items()}
