"""Shapes and meshes at the command line."""

import json
import math
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import jsonschema
import pytest

from tests.conftest import FIXTURES, ROOT

MESHES = FIXTURES / "meshes"
SCHEMA = json.loads((ROOT / "docs" / "schemas" / "inertia.json").read_text())

SHAPES = {
    "box": ["--size", "1", "1", "0.5"],
    "cylinder": ["--radius", "0.06", "--length", "0.09"],
    "sphere": ["--radius", "0.06"],
    "capsule": ["--radius", "0.06", "--length", "0.09"],
    "ellipsoid": ["--radii", "0.1", "0.2", "0.3"],
    "cone": ["--radius", "0.06", "--length", "0.09"],
}


def six(text):
    inertia = ET.fromstring(text).find("inertia")
    return {name: float(value) for name, value in inertia.attrib.items()}


def test_the_base_of_the_small_head(urdftool):
    done = urdftool("inertia", "cylinder", "--mass", "0.18", "--radius", "0.06", "--length", "0.09")
    assert done.code == 0
    assert done.out == (
        "<inertial>\n"
        '  <origin xyz="0 0 0" rpy="0 0 0"/>\n'
        '  <mass value="0.18"/>\n'
        '  <inertia ixx="0.0002835" ixy="0" ixz="0" iyy="0.0002835" iyz="0" izz="0.000324"/>\n'
        "</inertial>\n"
    )
    assert "ixx 0.0002835, iyy 0.0002835, izz 0.000324" in done.err


def test_the_large_box(urdftool):
    done = urdftool("inertia", "box", "--mass", "1024", "--size", "1", "1", "0.5")
    assert "ixx 106.667, iyy 106.667, izz 170.667" in done.err
    assert list(six(done.out).values()) == [106.667, 0, 0, 106.667, 0, 170.667]


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("amount", [("--mass", "2"), ("--density", "700")])
def test_every_shape_has_its_json(urdftool, name, amount):
    done = urdftool("inertia", name, *amount, *SHAPES[name], "--format", "json")
    found = json.loads(done.out)
    jsonschema.validate(found, SCHEMA)
    assert found["shape"] == name
    assert found["mass"] == pytest.approx(found["density"] * found["volume"], rel=5e-6)


@pytest.mark.parametrize("name", ["box", "cylinder", "sphere"])
def test_a_hollow_shape_resists_more_than_a_solid_one(urdftool, name):
    solid = urdftool("inertia", name, "--mass", "2", *SHAPES[name])
    hollow = urdftool("inertia", name, "--mass", "2", *SHAPES[name], "--thickness", "0.01")
    assert six(hollow.out)["izz"] > six(solid.out)["izz"]
    done = urdftool(
        "inertia", name, "--mass", "2", *SHAPES[name], "--thickness", "0.01", "--format", "json"
    )
    jsonschema.validate(json.loads(done.out), SCHEMA)


def test_end_plates_of_a_tube(urdftool):
    words = ("inertia", "cylinder", "--mass", "2", *SHAPES["cylinder"], "--thickness", "0.001")
    assert six(urdftool(*words, "--closed").out)["izz"] < six(urdftool(*words).out)["izz"]


def test_moved_and_turned(urdftool):
    quarter = str(math.pi / 2)
    place = ("--origin-xyz", "0.1", "-0.2", "0.3", "--origin-rpy", quarter, "0", "0")
    done = urdftool("inertia", "box", "--mass", "3", "--size", "1", "2", "3", *place)
    root = ET.fromstring(done.out)
    assert root.find("origin").get("xyz") == "0.1 -0.2 0.3"
    found = six(done.out)
    assert (found["ixx"], found["iyy"], found["izz"]) == (3.25, 1.25, 2.5)
    assert {found[name] for name in ("ixy", "ixz", "iyz")} == {0}


def test_about_the_origin_by_the_parallel_axis_theorem(urdftool):
    done = urdftool(
        *("inertia", "sphere", "--mass", "2", "--radius", "0.5"),
        *("--origin-xyz", "1", "2", "0", "--format", "json"),
    )
    about = json.loads(done.out)["inertia_about_origin"]
    own = 0.4 * 2 * 0.25
    assert about["ixx"] == pytest.approx(own + 2 * 4)
    assert about["iyy"] == pytest.approx(own + 2 * 1)
    assert about["izz"] == pytest.approx(own + 2 * 5)
    assert about["ixy"] == pytest.approx(-2 * 2)


def test_sdf_and_mjcf(urdftool):
    words = ("inertia", "cone", "--mass", "2", "--radius", "0.1", "--length", "0.4")
    sdf = ET.fromstring(urdftool(*words, "--format", "sdf").out)
    assert sdf.findtext("pose") == "0 0 -0.1 0 0 0"
    assert float(sdf.findtext("inertia/izz")) == pytest.approx(0.006)
    mjcf = ET.fromstring(urdftool(*words, "--format", "mjcf").out)
    assert mjcf.get("pos") == "0 0 -0.1"
    assert [float(v) for v in mjcf.get("diaginertia").split()][2] == pytest.approx(0.006)
    turned = (*words, "--origin-rpy", "0.3", "0.2", "0.1")
    mjcf = ET.fromstring(urdftool(*turned, "--format", "mjcf").out)
    sdf = ET.fromstring(urdftool(*turned, "--format", "sdf").out)
    order = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
    assert mjcf.get("fullinertia").split() == [sdf.findtext(f"inertia/{name}") for name in order]


def test_a_table(urdftool):
    words = ("inertia", "box", "--mass", "1024", "--size", "1", "1", "0.5", "--format", "table")
    assert "106.667 106.667 170.667" in urdftool(*words).out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["sphere", "--mass", "1", "--radius", "0"], "radius of a sphere is 0 m"),
        (["sphere", "--mass", "-1", "--radius", "1"], "mass of a sphere is -1"),
        (["sphere", "--mass", "nan", "--radius", "1"], "mass of a sphere is nan"),
        (["sphere", "--mass", "1", "--radius", "inf"], "radius of a sphere is inf"),
        (["sphere", "--density", "0", "--radius", "1"], "density of a sphere is 0"),
        (
            ["sphere", "--mass", "1e308", "--radius", "1e308"],
            "too large for floating-point numbers",
        ),
        (
            ["sphere", "--density", "1", "--radius", "1e-150"],
            "too large for floating-point numbers",
        ),
        (["sphere", "--mass", "1", "--density", "1", "--radius", "1"], "exclude each other"),
        (["sphere", "--mass", "1"], "--radius"),
        (["sphere", "--radius", "1"], "--mass"),
        (["box", "--mass", "1", "--size", "1", "1"], "--size"),
        (["box", "--mass", "1", "--size", "1", "1", "-1"], "size of a box is -1 m"),
        (["box", "--mass", "1", "--size", "1", "1", "1", "--thickness", "0.6"], "at most"),
        (["cylinder", "--mass", "1", "--radius", "1", "--length", "1", "--closed"], "--thickness"),
        (["sphere", "--mass", "1", "--radius", "1", "--origin-rpy", "nan", "0", "0"], "finite"),
        (["sphere", "--mass", "heavy", "--radius", "1"], "not a valid float"),
        (["sphere", "--mass", "1", "--radius", "1", "--format", "yaml"], "--format"),
        (["spere"], "did you mean 'sphere'"),
        (["arm.urdf"], "urdftool inertia robot arm.urdf"),
        ([], "box, cylinder"),
        (["mesh", "cube.stl"], "--mass"),
        (["mesh", "nowhere.stl", "--mass", "1"], "no such mesh file"),
        (["mesh", str(MESHES / "empty.stl"), "--mass", "1"], "empty"),
        (["mesh", str(MESHES / "truncated.stl"), "--mass", "1"], "truncated"),
        (["mesh", str(MESHES / "huge_claim.stl"), "--mass", "1"], "truncated"),
        (["mesh", str(MESHES / "lfs_pointer.stl"), "--mass", "1"], "git lfs pull"),
        (["mesh", str(MESHES / "flat.stl"), "--mass", "1"], "no volume"),
        (["mesh", str(MESHES / "nan.stl"), "--mass", "1"], "NaN"),
        (["mesh", str(MESHES / "cube.mtl"), "--mass", "1"], "not a mesh format"),
        (["mesh", str(MESHES / "cube.stl"), "--mass", "0"], "above zero"),
        (["mesh", str(MESHES / "cube.stl"), "--mass", "1", "--density", "2"], "exclude"),
        (["mesh", str(MESHES / "cube.stl"), "--mass", "1", "--scale", "0"], "other than zero"),
        (["mesh", str(MESHES / "cube.stl"), "--mass", "1", "--scale", "1", "2"], "--scale"),
        (["mesh", str(MESHES / "cube.stl"), "--mass", "1", "--scale", "x"], "--scale"),
    ],
)
def test_bad_input_is_one_message(urdftool, words, said):
    done = urdftool("inertia", *words)
    assert done.code == 2
    assert done.out == ""
    assert said in done.err
    assert "bug" not in done.err
    assert "Traceback" not in done.err


@pytest.mark.parametrize("form", ["urdf", "sdf", "mjcf", "xacro", "json", "table"])
def test_a_mesh_in_every_form(urdftool, form):
    done = urdftool("inertia", "mesh", MESHES / "cube.stl", "--density", "1000", "--format", form)
    assert done.code == 0
    if form == "json":
        found = json.loads(done.out)
        jsonschema.validate(found, SCHEMA)
        assert (found["mass"], found["method"]) == (1000, "exact")
    elif form != "table":
        ET.fromstring(f'<r xmlns:xacro="http://www.ros.org/wiki/xacro">{done.out}</r>')


def test_scale_and_shell_of_a_mesh(urdftool):
    words = ("inertia", "mesh", MESHES / "cube.stl", "--density", "1000", "--format", "json")
    small = json.loads(urdftool(*words, "--scale", "0.1").out)
    assert small["mass"] == 1
    flat = json.loads(urdftool(*words, "--scale", "0.1", "0.2", "-0.3").out)
    assert flat["mass"] == 6
    assert flat["inertia"]["ixx"] == pytest.approx(6 * (0.04 + 0.09) / 12)
    shell = json.loads(urdftool(*words, "--surface").out)
    jsonschema.validate(shell, SCHEMA)
    assert (shell["area"], shell["mass"]) == (6, 6000)
    # a hollow cube of thin walls: m a² · 5/18
    assert shell["inertia"]["ixx"] == pytest.approx(6000 * 5 / 18, rel=5e-6)


def test_what_is_not_closed_is_said(urdftool):
    done = urdftool("inertia", "mesh", MESHES / "open_box.stl", "--mass", "1")
    assert done.code == 0
    assert "not reliable" in done.err
    assert "Holes closed" in done.err


def test_a_result_goes_to_a_file_and_never_to_the_mesh(urdftool, write):
    mesh = write("cube.stl", (MESHES / "cube.stl").read_bytes())
    assert urdftool("inertia", "mesh", mesh, "--mass", "1", "-o", "cube.xml").code == 0
    done = urdftool("inertia", "mesh", mesh, "--mass", "1", "-o", mesh)
    assert done.code == 2
    assert (MESHES / "cube.stl").read_bytes() == Path(mesh).read_bytes()


LIGHT = """
import sys
from urdftool import cli
cli.call(sys.argv[1:])
print("LOADED", *(n for n in ("trimesh", "scipy", "numpy", "rich", "lxml")
                  if n in sys.modules))
"""


@pytest.mark.parametrize(
    ("words", "loaded"),
    [
        (["inertia", "--help"], []),
        (["inertia", "box", "--help"], []),
        (["inertia", "mesh", "--help"], []),
        (["inertia", "robot", "--help"], []),
        (["inertia", "sphere", "--mass", "1", "--radius", "1"], []),
        (["inertia", "macros"], []),
        (["inertia", "robot", str(FIXTURES / "robots" / "ten_links.urdf")], ["numpy"]),
    ],
)
def test_light_forms_stay_light(words, loaded):
    done = subprocess.run(
        [sys.executable, "-c", LIGHT, *words], capture_output=True, text=True, check=False
    )
    assert done.stdout.splitlines()[-1].split()[1:] == loaded
