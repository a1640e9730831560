"""Meshes and textures: where they go, and what they bring along."""

import struct

from urdftool.formats.sdf.options import Options
from urdftool.formats.sdf.write import write as export
from urdftool.model.load import load

STL = b"\0" * 80 + struct.pack("<I", 0)


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
    write("pkg/meshes/x.dae", "<COLLADA><init_from>../textures/wood.png</init_from></COLLADA>")
    write("pkg/meshes/y.obj", "mtllib y.mtl\n")
    write("pkg/meshes/y.mtl", "newmtl m\nmap_Kd skin.jpg\n")
    for name in ("textures/wood.png", "meshes/skin.jpg"):
        write(f"pkg/{name}", b"picture")
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


def test_a_texture_is_a_map_of_the_material(write):
    write("pkg/textures/wood.png", b"picture")
    material = '<material name="w"><texture filename="package://pkg/textures/wood.png"/></material>'
    visual = '<visual><geometry><box size="1 1 1"/></geometry><material name="w"/></visual>'
    robot = description(write, visual, extra=material)
    written = export(robot, Options())
    assert b"<albedo_map>meshes/textures/wood.png</albedo_map>" in written.files["model.sdf"]
    assert places(robot) == ["meshes/textures/wood.png"]
    classic = export(robot, Options(target="gazebo-classic"))
    assert [loss.rule for loss in classic.losses] == ["lossy-texture"]


def test_a_uri_with_too_many_slashes_is_understood(write):
    write("pkg/meshes/x.stl", STL)
    assert places(description(write, shape("package:///pkg/meshes/x.stl"))) == ["meshes/x.stl"]


def test_scales_have_all_their_digits(write):
    write("pkg/meshes/x.stl", STL)
    mesh = shape("package://pkg/meshes/x.stl").replace('stl"', 'stl" scale="0.0254000508 1 -1"')
    model = export(description(write, mesh), Options()).files["model.sdf"]
    assert b"<scale>0.0254000508 1 -1</scale>" in model
