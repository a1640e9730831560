"""Meshes and textures: where they go, and what they bring along."""

import pytest

from tests.assets import DAE, make_png, make_stl
from urdftool.formats.common.directory import is_ours, write_export
from urdftool.formats.sdf.options import Options
from urdftool.formats.sdf.verify.compare import compare, read_pair
from urdftool.formats.sdf.write import write as export
from urdftool.model.load import load

from .robots import tree

STL = make_stl()
PICTURE = make_png()


def shape(name, kind="visual"):
    return f'<{kind}><geometry><mesh filename="{name}"/></geometry></{kind}>'


def description(write, *shapes, extra=""):
    write("pkg/package.xml", "<package><name>pkg</name></package>")
    inertial = (
        '<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
        "</inertial>"
    )
    text = f'<robot name="r">{extra}<link name="a">{inertial}{"".join(shapes)}</link></robot>'
    return load(write("pkg/urdf/r.urdf", text))


def places(robot, **choices):
    files = export(robot, Options(**choices)).files
    return sorted(name for name in files if not name.startswith("model."))


def test_folders_of_a_package_are_kept(write):
    write("pkg/meshes/visual/x.stl", STL)
    write("pkg/meshes/collision/x.stl", STL)
    robot = description(
        write,
        shape("package://pkg/meshes/visual/x.stl"),
        shape("../meshes/collision/x.stl", "collision"),
    )
    assert places(robot) == ["meshes/collision/x.stl", "meshes/visual/x.stl"]


def test_packages_do_not_mix(write):
    write("pkg/meshes/x.stl", STL)
    write("other/package.xml", "<package><name>other</name></package>")
    write("other/meshes/x.stl", STL)
    robot = description(
        write, shape("package://pkg/meshes/x.stl"), shape("package://other/meshes/x.stl")
    )
    assert places(robot) == ["meshes/other/x.stl", "meshes/pkg/x.stl"]


def test_textures_of_meshes_come_along(write):
    write("pkg/meshes/x.dae", DAE.format("<init_from>../textures/wood.png</init_from>"))
    write("pkg/meshes/y.obj", "mtllib y.mtl\nv 0 0 0\nf 1 1 1\n")
    write("pkg/meshes/y.mtl", "newmtl m\nmap_Kd skin.jpg\n")
    for name in ("textures/wood.png", "meshes/skin.jpg"):
        write(f"pkg/{name}", PICTURE)
    robot = description(
        write, shape("package://pkg/meshes/x.dae"), shape("package://pkg/meshes/y.obj")
    )
    assert places(robot) == [
        "meshes/skin.jpg",
        "meshes/x.dae",
        "meshes/y.mtl",
        "meshes/y.obj",
        "textures/wood.png",
    ]


MATERIAL = '<material name="w"><texture filename="package://pkg/textures/{}"/></material>'
TEXTURED = '<visual><geometry><box size="1 1 1"/></geometry><material name="w"/></visual>'


def test_a_texture_is_a_map_of_the_material(write):
    write("pkg/textures/wood.png", PICTURE)
    robot = description(write, TEXTURED, extra=MATERIAL.format("wood.png"))
    written = export(robot, Options())
    assert b"<albedo_map>meshes/textures/wood.png</albedo_map>" in written.files["model.sdf"]
    assert places(robot) == ["meshes/textures/wood.png"]


def test_a_texture_for_classic_has_a_script(write):
    write("pkg/textures/Wood 1.PNG", PICTURE)
    robot = description(write, TEXTURED, extra=MATERIAL.format("Wood 1.PNG"))
    written = export(robot, Options(target="gazebo-classic", folder="arm"))
    script = tree(written).find("link/visual/material/script")
    assert [e.text for e in script] == [
        "model://arm/materials/scripts",
        "model://arm/materials/textures",
        "r/r_Wood_1",
    ]
    text = written.files["materials/scripts/r.material"]
    assert isinstance(text, bytes)
    assert is_ours(text)
    assert "texture r_Wood_1.png" in text.decode()
    assert places(robot, target="gazebo-classic") == [
        "materials/scripts/r.material",
        "materials/textures/r_Wood_1.png",
    ]
    assert written.losses == []


def test_pictures_of_one_name_do_not_mix(write):
    write("pkg/textures/a/x.png", PICTURE + b"one")
    write("pkg/textures/b/x.png", PICTURE + b"two")
    extra = "".join(
        MATERIAL.format(f"{name}/x.png").replace('"w"', f'"{name}"') for name in ("a", "b")
    )
    visuals = [TEXTURED.replace('"w"', f'"{name}"') for name in ("a", "b")]
    robot = description(write, *visuals, extra=extra)
    written = export(robot, Options(target="gazebo-classic"))
    names = [e.text for e in tree(written).iterfind("link/visual/material/script/name")]
    assert names == ["r/r_x", "r/r_x_2"]


@pytest.mark.parametrize("choices", [{"file": "m.sdf"}, {"uri": "file"}, {"uri": "package"}])
def test_a_script_that_nothing_can_find_is_not_written(write, choices):
    write("pkg/textures/wood.png", PICTURE)
    robot = description(write, TEXTURED, extra=MATERIAL.format("wood.png"))
    written = export(robot, Options(target="gazebo-classic", **choices))
    assert [loss.code for loss in written.losses] == ["lossy-texture"]
    assert tree(written).find("link/visual/material/script") is None
    assert [name for name in written.files if name.startswith("materials/")] == []


@pytest.mark.parametrize("target", ["gz", "gazebo-classic"])
@pytest.mark.parametrize("spoiled", [False, True])
def test_textures_are_verified(write, tmp_path, target, spoiled):
    write("pkg/textures/wood.png", PICTURE)
    robot = description(write, TEXTURED, extra=MATERIAL.format("wood.png"))
    options = Options(target=target, folder="out")
    written = export(robot, options)
    if spoiled:
        (name,) = [name for name in written.files if name.endswith(".png")]
        written.files[name] = b"other"
    write_export(tmp_path / "out", written, single=False)
    pair = read_pair(robot, written, tmp_path / "out" / "model.sdf", options)
    checks = {check.name: check.verdict for check in compare(pair)}
    assert checks["looks"] == "equal"
    assert checks["textures"] == ("differs" if spoiled else "equal")


def test_a_uri_with_too_many_slashes_is_understood(write):
    write("pkg/meshes/x.stl", STL)
    assert places(description(write, shape("package:///pkg/meshes/x.stl"))) == ["meshes/x.stl"]


def test_scales_have_all_their_digits(write):
    write("pkg/meshes/x.stl", STL)
    mesh = shape("package://pkg/meshes/x.stl").replace('stl"', 'stl" scale="0.0254000508 1 -1"')
    model = export(description(write, mesh), Options()).files["model.sdf"]
    assert b"<scale>0.0254000508 1 -1</scale>" in model
