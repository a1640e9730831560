"""Small files that would fill the memory: each is refused in words, within seconds."""

import struct
import subprocess
import sys
import zipfile
import zlib
from itertools import pairwise

import pytest

from tests.hostile.writers import process

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs resource limits")

MEMORY = 4 << 30
SECONDS = 60

SHAPE = '<{0}><geometry><mesh filename="{1}"/></geometry></{0}>'
INERTIAL = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
WITH_YAML = (
    '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    "<link name=\"${{xacro.load_yaml('{}')['a']}}\"/></robot>"
)
PLY = b"""ply
format %s 1.0
element vertex %d
property float x
property float y
property float z
element face %d
property list %s int vertex_indices
end_header
"""


def png(width, height):
    """An image that says it is large, and is not."""

    def chunk(kind, data):
        return (
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        )

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    data = zlib.compress(bytes(1000))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


def aliases(first, rest):
    """Each line holds the one above it nine times."""
    names = "abcdefghijklm"
    lines = [f"{names[0]}: &{names[0]} {first}"]
    for before, name in pairwise(names):
        lines.append(f"{name}: &{name} " + rest.format(",".join([f"*{before}"] * 9)))
    return "\n".join(lines).encode()


def zae(path):
    """256 MiB of blanks in a few hundred kilobytes."""
    with (
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open("model.dae", "w") as stream,
    ):
        stream.write(b"<COLLADA><!-- ")
        for _ in range(256):
            stream.write(b" " * (1 << 20))
        stream.write(b" --></COLLADA>")


YAML = {
    "aliases.yaml": aliases("[1,1]", "[{}]"),
    "merged.yaml": aliases("{k: 1}", "{{<<: [{}]}}"),
    "deep.yaml": b"a: " + b"[" * 100_000,
    "itself.yaml": b"a: &a [*a]",
    "long.yaml": b"a: &a " + b"x" * 100_000 + b"\nb: [" + b"*a," * 1000 + b"]",
}
MESHES = {
    "many.ply": PLY % (b"ascii", 4_000_000_000, 1, b"uchar") + b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    "binary.ply": PLY % (b"binary_little_endian", 4_000_000_000, 4_000_000_000, b"uchar"),
    "list.ply": PLY % (b"binary_little_endian", 3, 1, b"uint") + bytes(36) + b"\xff" * 4,
    "many.stl": bytes(80) + b"\xff" * 4 + bytes(100),
    "far.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 999999999999\n",
    "sparse.gltf": b'{"asset":{"version":"2.0"},"accessors":[{"componentType":5126,'
    b'"count":4000000000,"type":"VEC3"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":'
    b'[{"mesh":0}],"scenes":[{"nodes":[0]}],"scene":0}',
}


def bounded(command, place):
    """Run a command with little memory; gives its exit code and what it said."""

    def limit():
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))

    pipe = subprocess.PIPE
    child = process(
        command, place, place.parent / "home", stdout=pipe, stderr=pipe, preexec_fn=limit
    )
    out, err = child.communicate(timeout=SECONDS)
    return child.returncode, out.decode(), err.decode()


def robot(place, mesh):
    shapes = SHAPE.format("visual", mesh) + SHAPE.format("collision", mesh)
    text = f'<robot name="r"><link name="a">{INERTIAL}</inertial>{shapes}</link></robot>'
    (place / "r.urdf").write_text(text)


@pytest.mark.parametrize("name", YAML)
@pytest.mark.parametrize("command", ["expand r.xacro", "lint r.xacro --no-cache"])
def test_yaml_of_a_description(tmp_path, name, command):
    (tmp_path / name).write_bytes(YAML[name])
    (tmp_path / "r.xacro").write_text(WITH_YAML.format(name))
    code, out, err = bounded(command.split(), tmp_path)
    assert code == 2
    assert f"{name}:" in out + err
    limits = "the limit of YAML", "alias *", "maximum nesting depth"  # the last one of libyaml
    assert any(word in out + err for word in limits)


def test_lists_of_lists_in_an_expression(tmp_path):
    (tmp_path / "r.xacro").write_text(
        WITH_YAML.replace("xacro.load_yaml('{}')['a']", "[[[1]*1000000]*1000000]").format()
    )
    code, _, err = bounded(["expand", "r.xacro"], tmp_path)
    assert code == 2
    assert "exceeds the limit" in err


@pytest.mark.slow
@pytest.mark.parametrize("name", YAML)
def test_yaml_of_controllers(tmp_path, name):
    (tmp_path / name).write_bytes(YAML[name])
    robot(tmp_path, "absent.stl")
    words = ["simulate", "r.urdf", "--engine", "mujoco", "--controllers", name]
    code, _, err = bounded(words, tmp_path)
    assert code == 2
    assert err.strip()
    assert "Traceback" not in err


@pytest.mark.slow
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize(
    "command", ["inertia mesh NAME --mass 1", "collision mesh NAME --no-cache"]
)
def test_a_mesh_that_announces_too_much(tmp_path, name, command):
    (tmp_path / name).write_bytes(MESHES[name])
    code, _, err = bounded(command.replace("NAME", name).split(), tmp_path)
    assert code == 2
    assert name in err


@pytest.mark.slow
@pytest.mark.parametrize("name", MESHES)
def test_a_robot_with_such_a_mesh(tmp_path, name):
    (tmp_path / name).write_bytes(MESHES[name])
    robot(tmp_path, name)
    for command in ("lint r.urdf --no-cache", "inertia robot r.urdf", "info r.urdf"):
        code, _, err = bounded(command.split(), tmp_path)
        assert code in (0, 1, 2), err
        assert "Traceback" not in err


COLLADA = """<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="2"><input semantic="VERTEX" source="#v" offset="0"/><vcount>{} 3</vcount>
<p>0 1 2 0 1 2</p></polylist></mesh></geometry></library_geometries><library_visual_scenes>
<visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


@pytest.mark.slow
@pytest.mark.parametrize("count", ["-9", "2000000000", "0"])
def test_polygons_of_no_sane_size(tmp_path, count):
    (tmp_path / "m.dae").write_text(COLLADA.format(count))
    code, _, err = bounded(["inertia", "mesh", "m.dae", "--surface", "--density", "1"], tmp_path)
    assert code in (0, 2)
    assert code == 0 or "m.dae" in err
    assert "Traceback" not in err


@pytest.mark.slow
def test_an_archive_is_not_unpacked(tmp_path):
    zae(tmp_path / "bomb.zae")
    robot(tmp_path, "bomb.zae")
    code, _, err = bounded(["inertia", "mesh", "bomb.zae", "--mass", "1"], tmp_path)
    assert (code, "not a mesh format" in err) == (2, True)
    assert bounded(["lint", "r.urdf", "--no-cache"], tmp_path)[0] in (0, 1)


@pytest.mark.slow
@pytest.mark.parametrize(
    "command",
    [
        "view r.urdf --picture a.png --size 64x48",
        "export mjcf r.urdf -o a --verify",
        "export sdf r.urdf -o a",
        "lint r.urdf --no-cache",
    ],
)
def test_an_image_of_3600_megapixels(tmp_path, command):
    (tmp_path / "big.png").write_bytes(png(60_000, 60_000))
    (tmp_path / "r.urdf").write_text(
        f'<robot name="r"><link name="a">{INERTIAL}</inertial><visual><geometry><box size="1 1 1"/>'
        '</geometry><material name="m"><texture filename="big.png"/></material></visual></link>'
        "</robot>"
    )
    code, _, err = bounded(command.split(), tmp_path)
    assert code in (0, 1, 2)
    assert "Traceback" not in err
    if command.startswith("view"):
        assert "cannot be read" in err
