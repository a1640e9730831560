"""Hostile meshes and images, as data: names of files, and what is in them."""

from __future__ import annotations

import io
import json
import struct
import tarfile
import zipfile
import zlib
from collections.abc import Callable

from tests.hostile.pictures import chunk, png

Files = dict[str, bytes | str]

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\n"
SOLID = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


def stl(count: int, body: bytes, head: bytes = b"") -> bytes:
    """Return a binary STL with an announced count."""
    return head.ljust(80, b"\0") + struct.pack("<I", count) + body


def facet(*numbers: float) -> bytes:
    """Return a facet of a binary STL."""
    return struct.pack("<12fH", *((0.0, 0.0, 1.0, *numbers) + (0.0,) * 12)[:12], 0)


def ascii_stl(number: str, times: int = 1) -> str:
    """Return an ASCII STL with a number in each vertex."""
    vertex = f"vertex {number} 0 0\nvertex 1 {number} 0\nvertex 0 1 {number}\n"
    text = f"facet normal 0 0 1\nouter loop\n{vertex}endloop\nendfacet\n"
    return f"solid a\n{text * times}endsolid a\n"


def tar() -> bytes:
    """Return an archive with a file."""
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w") as archive:
        information = tarfile.TarInfo("passwords")
        information.size = 5
        archive.addfile(information, io.BytesIO(b"12345"))
    return stream.getvalue()


STL: Files = {
    "claim.stl": stl(2**32 - 1, facet(0, 0, 0, 1, 0, 0, 0, 1, 0)),
    "none.stl": stl(0, b""),
    "none_and_more.stl": stl(0, b"x" * 5000),
    "database.stl": b"SQLite format 3\0" + bytes(8000),
    "archive.stl": tar(),
    "nan.stl": stl(1, facet(float("nan"), 0, 0, 1, 0, 0, 0, 1, 0)),
    "infinite.stl": stl(1, facet(float("inf"), 0, 0, 1, 0, 0, 0, 1, 0)),
    "large.stl": stl(4, facet(3e38, 0, 0, -3e38, 1, 0, 0, 3e38, 0) * 4),
    "small.stl": stl(4, facet(1e-45, 0, 0, 0, 1e-45, 0, 0, 0, 1e-45) * 4),
    "same.stl": stl(60_000, facet(0, 0, 0, 1, 0, 0, 0, 1, 0) * 60_000),
    "ascii_nan.stl": ascii_stl("nan"),
    "ascii_large.stl": ascii_stl("1e999"),
    "ascii_digits.stl": ascii_stl("9" * 100_000),
    "ascii_open.stl": "solid a\n" + "facet normal 0 0 1\n" * 100_000,
    "ascii_numbers.stl": "solid a\nfacet normal 0 0 1\nouter loop\nvertex " + "1 " * 500_000,
    "ascii_names.stl": "solid " + "a" * 1_000_000 + "\nendsolid",
    "ascii_solids.stl": "".join(
        ascii_stl("2").replace("solid a", f"solid {n}") for n in range(9999)
    ),
    "empty.stl": b"",
    "text.stl": "root:x:0:0:root:/root:/bin/sh\n",
}

OBJ: Files = {
    "polygon.obj": TRIANGLE + "f" + " 1 2 3" * 300_000 + "\n",
    "corners.obj": "".join(f"v {n} {n * n % 97} 0\n" for n in range(30_000))
    + "f "
    + " ".join(map(str, range(1, 30_001)))
    + "\n",
    "polygons.obj": TRIANGLE + ("f" + " 1 2 3 4" * 500 + "\n") * 500,
    "far.obj": TRIANGLE + "f 1 2 999999999999\n",
    "back.obj": TRIANGLE + "f -1 -2 -999999999999\n",
    "zero.obj": TRIANGLE + "f 0 0 0\n",
    "nan.obj": "v nan 0 0\nv inf 0 0\nv 0 1e999 0\nf 1 2 3\n",
    "digits.obj": f"v {'9' * 100_000} 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "wide.obj": "v " + "1 " * 500_000 + "\nf 1 1 1\n",
    "joined.obj": "v 0 0 0\n" + "f 1 \\\n" * 200_000,
    "materials.obj": TRIANGLE + "".join(f"usemtl m{n}\nf 1 2 3\n" for n in range(20_000)),
    "objects.obj": TRIANGLE + "".join(f"o o{n}\nf 1 2 3\n" for n in range(20_000)),
    "groups.obj": TRIANGLE + "g " + "a " * 200_000 + "\n" + SOLID,
    "libraries.obj": "mtllib " + "a.mtl " * 20_000 + "\n" + TRIANGLE + SOLID,
    "shell.obj": "csh touch @MARK@\ncall @BESIDE@\n" + TRIANGLE + SOLID,
    "library_beside.obj": "mtllib ../beside/secret.mtl\n" + TRIANGLE + SOLID,
    "library_absolute.obj": "mtllib @BESIDE@\n" + TRIANGLE + SOLID,
    "library_device.obj": "mtllib /dev/zero\n" + TRIANGLE + SOLID,
    "two_lines.obj": "v 1\nf 1\n",
    "no_face.obj": TRIANGLE,
    "empty.obj": b"",
    "zeros.obj": bytes(100_000),
}


def with_material(text: str) -> Files:
    """Return an OBJ with a material."""
    faces = "".join(line.replace(" 1", " 1/1") + "\n" for line in SOLID.splitlines())
    return {"a.obj": "mtllib a.mtl\nusemtl m\n" + TRIANGLE + faces, "a.mtl": text}


MAPS = ("map_Ka", "map_Ks", "map_Ns", "map_d", "map_bump", "bump", "disp", "decal", "refl", "norm")
MATERIALS: dict[str, Files] = {
    "map of a device": with_material("newmtl m\nmap_Kd /dev/zero\n"),
    "map of a random device": with_material("newmtl m\nmap_Kd /dev/urandom\n"),
    "map of a picture beside": with_material("newmtl m\nmap_Kd ../beside/secret.png\n"),
    "map of an absolute path": with_material("newmtl m\nmap_Kd @BESIDE@\n"),
    "map of a hidden file": with_material("newmtl m\nmap_Kd .git/config\n"),
    "map with options": with_material("newmtl m\nmap_Kd -s 1 1 1 -o 0 0 0 ../beside/secret.png\n"),
    "all maps": with_material(
        "newmtl m\n" + "".join(f"{name} ../beside/secret.png\n" for name in MAPS)
    ),
    "map of a folder": with_material("newmtl m\nmap_Kd .\n"),
    "map of itself": with_material("newmtl m\nmap_Kd a.mtl\n"),
    "map of a shell": with_material("newmtl m\nmap_Kd |touch @MARK@\n"),
    "many materials": with_material("".join(f"newmtl m{n}\nKd 1 0 0\n" for n in range(50_000))),
    "many colors": with_material("newmtl m\nKd " + "1 " * 500_000),
    "colors that are not numbers": with_material("newmtl m\nKd nan inf 1e999\nNs -1e999\n"),
    "no material": with_material(""),
    "zeros": with_material("\0" * 100_000),
}


def ply(head: str, body: bytes = b"", format: str = "ascii") -> bytes:
    """Return a PLY with a header."""
    return f"ply\nformat {format} 1.0\n{head}end_header\n".encode() + body


XYZ = "property float x\nproperty float y\nproperty float z\n"
LIST = "property list {} int vertex_indices\n"
LITTLE = "binary_little_endian"
POINTS = b"0 0 0\n1 0 0\n0 1 0\n"

PLY: Files = {
    "claim.ply": ply(f"element vertex 4000000000\n{XYZ}element face 1\n{LIST.format('uchar')}"),
    "claim_binary.ply": ply(
        f"element vertex 4000000000\n{XYZ}element face 4000000000\n{LIST.format('uchar')}",
        bytes(40),
        LITTLE,
    ),
    "list.ply": ply(
        f"element vertex 3\n{XYZ}element face 1\n{LIST.format('uint')}",
        bytes(36) + b"\xff" * 4,
        LITTLE,
    ),
    "polygon.ply": ply(
        f"element vertex 3\n{XYZ}element face 1\n{LIST.format('uint')}",
        POINTS + b"300000 " + b"0 1 2 " * 100_000,
    ),
    "negative.ply": ply(f"element vertex -1\n{XYZ}element face -1\n{LIST.format('int')}", POINTS),
    "properties.ply": ply("element vertex 3\n" + "property float x\n" * 50_000, POINTS),
    "elements.ply": ply("".join(f"element e{n} 1\n{XYZ}" for n in range(20_000)), POINTS),
    "comments.ply": ply("comment TextureFile ../beside/secret.png\n" * 1000),
    "texture.ply": ply(
        f"comment TextureFile ../beside/secret.png\nelement vertex 3\n{XYZ}element face 1\n"
        + LIST.format("uchar"),
        POINTS + b"3 0 1 2\n",
    ),
    "nan.ply": ply(
        f"element vertex 3\n{XYZ}element face 1\n{LIST.format('uchar')}",
        b"nan inf 1e999\n1 0 0\n0 1 0\n3 0 1 2\n",
    ),
    "far.ply": ply(
        f"element vertex 3\n{XYZ}element face 1\n{LIST.format('uchar')}",
        POINTS + b"3 0 1 99999999\n",
    ),
    "types.ply": ply("element vertex 3\nproperty object x\nproperty list float float y\n", POINTS),
    "no_end.ply": b"ply\nformat ascii 1.0\n" + b"comment a\n" * 100_000,
    "empty.ply": b"ply\n",
}

DAE_HEAD = (
    '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>'
    '<unit meter="{unit}"/><up_axis>Z_UP</up_axis></asset>{images}<library_geometries>'
    '<geometry id="g"><mesh><source id="p"><float_array id="a" count="{count}">{numbers}'
    '</float_array><technique_common><accessor source="#a" count="{points}" stride="{stride}">'
    '<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>'
    '</accessor></technique_common></source><vertices id="v"><input semantic="POSITION" '
    'source="#p"/></vertices>{faces}</mesh></geometry></library_geometries>{nodes}'
    '<library_visual_scenes><visual_scene id="s">{scene}</visual_scene></library_visual_scenes>'
    '<scene><instance_visual_scene url="#s"/></scene></COLLADA>'
)
DAE_FACES = (
    '<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>'
)
DAE_INSTANCE = '<instance_geometry url="#g"/>'


def dae(**values: str) -> str:
    """Return a COLLADA file with some of its parts replaced."""
    usual = {
        "unit": "1",
        "images": "",
        "count": "9",
        "numbers": "0 0 0 1 0 0 0 1 0",
        "points": "3",
        "stride": "3",
        "faces": DAE_FACES,
        "nodes": "",
        "scene": f"<node>{DAE_INSTANCE}</node>",
    }
    return DAE_HEAD.format(**(usual | values))


def dae_tree(depth: int, width: int) -> str:
    """Return nodes of which each instantiates the one below it several times."""
    nodes = [f'<node id="n0">{DAE_INSTANCE}</node>']
    for n in range(1, depth):
        nodes.append(f'<node id="n{n}">' + f'<instance_node url="#n{n - 1}"/>' * width + "</node>")
    return f"<library_nodes>{''.join(nodes)}</library_nodes>"


def dae_image(path: str) -> str:
    """Return a COLLADA file with a texture."""
    return dae(
        images=f'<library_images><image id="i"><init_from>{path}</init_from></image>'
        '</library_images><library_effects><effect id="e"><profile_COMMON><newparam sid="s">'
        '<surface type="2D"><init_from>i</init_from></surface></newparam><newparam sid="t">'
        '<sampler2D><source>s</source></sampler2D></newparam><technique sid="c"><lambert><diffuse>'
        '<texture texture="t" texcoord="u"/></diffuse></lambert></technique></profile_COMMON>'
        '</effect></library_effects><library_materials><material id="m"><instance_effect url="#e"/>'
        "</material></library_materials>"
    )


def polylist(counts: str, indices: str, number: int) -> str:
    """Return polygons of a COLLADA file."""
    return (
        f'<polylist count="{number}"><input semantic="VERTEX" source="#v" offset="0"/>'
        f"<vcount>{counts}</vcount><p>{indices}</p></polylist>"
    )


DAE: Files = {
    "tree.dae": dae(nodes=dae_tree(11, 10), scene='<node><instance_node url="#n10"/></node>'),
    "instances.dae": dae(scene="<node>" + DAE_INSTANCE * 200_000 + "</node>"),
    "nodes.dae": dae(scene=f"<node>{DAE_INSTANCE}</node>" * 50_000),
    "cycle.dae": dae(
        nodes='<library_nodes><node id="n"><instance_node url="#n"/></node></library_nodes>',
        scene='<node><instance_node url="#n"/></node>',
    ),
    "deep.dae": dae(scene="<node>" * 20_000 + DAE_INSTANCE + "</node>" * 20_000),
    "polygon.dae": dae(faces=polylist("600000", "0 1 2 " * 200_000, 1)),
    "polygons.dae": dae(faces=polylist("2000000000 3", "0 1 2 0 1 2", 2)),
    "negative.dae": dae(faces=polylist("-9 3", "0 1 2 0 1 2", 2)),
    "triangles.dae": dae(faces=DAE_FACES.replace('count="1"', 'count="4000000000"')),
    "claim.dae": dae(count="4000000000", points="4000000000"),
    "stride.dae": dae(stride="0"),
    "negative_stride.dae": dae(stride="-3"),
    "large_stride.dae": dae(stride="4000000000"),
    "nan.dae": dae(numbers="nan inf 1e999 1 0 0 0 1 0"),
    "digits.dae": dae(numbers="9" * 500_000),
    "unit.dae": dae(unit="1e308"),
    "unit_nan.dae": dae(unit="nan"),
    "unit_zero.dae": dae(unit="0"),
    "far.dae": dae(faces=DAE_FACES.replace("0 1 2", "0 1 99999999")),
    "back.dae": dae(faces=DAE_FACES.replace("0 1 2", "-1 -2 -3")),
    "matrix.dae": dae(scene=f"<node><matrix>{'1e308 ' * 16}</matrix>{DAE_INSTANCE}</node>"),
    "foreign.dae": dae(scene='<node><instance_geometry url="../beside/secret.xml#g"/></node>'),
    "foreign_scene.dae": dae().replace('url="#s"', 'url="file://@BESIDE@#s"'),
    "image_beside.dae": dae_image("../beside/secret.png"),
    "image_absolute.dae": dae_image("file://@BESIDE@"),
    "image_device.dae": dae_image("/dev/zero"),
    "entities.dae": '<!DOCTYPE a [<!ENTITY a "aaaaaaaaaa">'
    + "".join(f'<!ENTITY a{n} "{f"&a{n - 1};" * 10}">' for n in range(2, 12)).replace("&a1;", "&a;")
    + "]><COLLADA>&a11;</COLLADA>",
    "external.dae": '<!DOCTYPE a [<!ENTITY a SYSTEM "@BESIDE@">]><COLLADA>&a;</COLLADA>',
    "inputs.dae": dae(
        faces=DAE_FACES.replace(
            "<p>", '<input semantic="VERTEX" source="#v" offset="4000000000"/>' * 9 + "<p>"
        )
    ),
    "attributes.dae": "<COLLADA " + " ".join(f'a{n}="1"' for n in range(100_000)) + "/>",
    "not_closed.dae": "<COLLADA>" * 100_000,
    "empty.dae": "<COLLADA/>",
}


def gltf(**parts: object) -> str:
    """Return a glTF with one triangle and some of its parts replaced."""
    points = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    import base64

    usual = {
        "asset": {"version": "2.0"},
        "buffers": [
            {
                "byteLength": 36,
                "uri": "data:application/octet-stream;base64," + base64.b64encode(points).decode(),
            }
        ],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
        "scene": 0,
    }
    return json.dumps({name: part for name, part in (usual | parts).items() if part is not None})


def accessor(count: int, **more: object) -> dict[str, object]:
    """Return an accessor of vectors."""
    return {"componentType": 5126, "count": count, "type": "VEC3", **more}


SPARSE = {
    "count": 1,
    "indices": {"bufferView": 0, "componentType": 5125},
    "values": {"bufferView": 0},
}


def textured(image: dict[str, object]) -> str:
    """Return a glTF with a texture."""
    return gltf(
        images=[image],
        textures=[{"source": 0}],
        materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    )


def tree(depth: int, width: int) -> list[dict[str, object]]:
    """Return nodes of which each has the next one as a child several times."""
    nodes: list[dict[str, object]] = [{"children": [n + 1] * width} for n in range(depth)]
    return [*nodes, {"mesh": 0}]


GLTF: Files = {
    "sparse.gltf": gltf(accessors=[accessor(33_000_000, sparse=SPARSE)]),
    "sparse_many.gltf": gltf(
        accessors=[accessor(30_000_000, sparse=SPARSE)] * 40,
        meshes=[{"primitives": [{"attributes": {"POSITION": n}} for n in range(40)]}],
    ),
    "zeros.gltf": gltf(accessors=[accessor(33_000_000)]),
    "claim.gltf": gltf(accessors=[accessor(4_000_000_000, bufferView=0)]),
    "negative.gltf": gltf(accessors=[accessor(-3, bufferView=0)]),
    "instances.gltf": gltf(nodes=[{"mesh": 0}] * 200_000, scenes=[{"nodes": list(range(200_000))}]),
    "primitives.gltf": gltf(meshes=[{"primitives": [{"attributes": {"POSITION": 0}}] * 100_000}]),
    "tree.gltf": gltf(nodes=tree(11, 10)),
    "deep.gltf": gltf(nodes=tree(20_000, 1)),
    "cycle.gltf": gltf(nodes=[{"children": [0], "mesh": 0}]),
    "cycles.gltf": gltf(nodes=[{"children": [1]}, {"children": [0], "mesh": 0}]),
    "length.gltf": gltf(buffers=[{"byteLength": 10**12, "uri": "data:,a"}]),
    "no_uri.gltf": gltf(buffers=[{"byteLength": 10**10}]),
    "view.gltf": gltf(bufferViews=[{"buffer": 0, "byteOffset": -99, "byteLength": 10**9}]),
    "stride.gltf": gltf(bufferViews=[{"buffer": 0, "byteLength": 36, "byteStride": 0}]),
    "component.gltf": gltf(
        accessors=[{"bufferView": 0, "componentType": 9, "count": 3, "type": "A"}]
    ),
    "buffer_beside.gltf": gltf(buffers=[{"byteLength": 36, "uri": "../beside/secret.stl"}]),
    "buffer_absolute.gltf": gltf(buffers=[{"byteLength": 36, "uri": "file://@BESIDE@"}]),
    "buffer_device.gltf": gltf(buffers=[{"byteLength": 36, "uri": "/dev/zero"}]),
    "buffer_percent.gltf": gltf(buffers=[{"byteLength": 36, "uri": "%2e%2e/beside/secret.stl"}]),
    "buffer_remote.gltf": gltf(buffers=[{"byteLength": 36, "uri": "http://127.0.0.1:9/a"}]),
    "image_beside.gltf": textured({"uri": "../beside/secret.png"}),
    "image_absolute.gltf": textured({"uri": "file://@BESIDE@"}),
    "image_device.gltf": textured({"uri": "/dev/zero"}),
    "image_view.gltf": textured({"bufferView": 999, "mimeType": "image/png"}),
    "image_data.gltf": textured({"uri": "data:image/png;base64,AAAA"}),
    "matrix.gltf": gltf(nodes=[{"mesh": 0, "matrix": [1e308] * 16}]),
    "nan.gltf": gltf(nodes=[{"mesh": 0, "translation": [float("nan"), float("inf"), 0]}]),
    "targets.gltf": gltf(
        meshes=[
            {"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 0}] * 9999}]}
        ]
    ),
    "draco.gltf": gltf(
        extensionsRequired=["KHR_draco_mesh_compression"],
        extensionsUsed=["KHR_draco_mesh_compression"],
    ),
    "animations.gltf": gltf(animations=[{"channels": [], "samplers": []}] * 50_000),
    "types.gltf": gltf(nodes="a", meshes=7, scenes=None),
    "brackets.gltf": '{"asset":' + "[" * 200_000,
    "number.gltf": '{"asset":{"version":"2.0"},"scene":' + "9" * 100_000 + "}",
    "only_asset.gltf": '{"asset":{"version":"2.0"}}',
    "list.gltf": "[]",
    "claim.glb": b"glTF"
    + struct.pack("<II", 2, 4_000_000_000)
    + struct.pack("<II", 2**31, 0x4E4F534A),
    "chunks.glb": b"glTF" + struct.pack("<II", 2, 800_020) + struct.pack("<II", 0, 0) * 100_000,
    "short.glb": b"glTF\x02\0\0\0",
}


def archive(name: str, megabytes: int) -> bytes:
    """Return a zip file with many zeros."""
    stream = io.BytesIO()
    with (
        zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as packed,
        packed.open(name, "w") as out,
    ):
        for _ in range(megabytes):
            out.write(bytes(1 << 20))
    return stream.getvalue()


ARCHIVES: Files = {
    "bomb.zae": archive("model.dae", 64),
    "bomb.3mf": archive("3D/3dmodel.model", 64),
    "bomb.usdz": archive("a.usda", 64),
    "mesh.step": "ISO-10303-21;",
    "mesh.blend": b"BLENDER",
    "mesh.off": "OFF\n4000000000 4000000000 0\n",
    "mesh.xyz": "0 0 0\n" * 9,
    "mesh.msh": struct.pack("<4i", 2**31 - 1, 2**31 - 1, 0, 2**31 - 1),
    "mesh": "solid a",
    "mesh.stl.gz": zlib.compress(bytes(1000)),
}

MESHES: dict[str, Files] = {
    name: {name: data}
    for files in (STL, OBJ, PLY, DAE, GLTF, ARCHIVES)
    for name, data in files.items()
} | {f"material: {name}": files for name, files in MATERIALS.items()}
"""Hostile meshes by name; the mesh is the first of the files."""


def text_bomb() -> bytes:
    """Return an image with 300 MB of compressed text."""
    packer = zlib.compressobj()
    packed = b"".join(packer.compress(bytes(1 << 20)) for _ in range(300)) + packer.flush()
    good = png(4, 4)
    return good[:33] + chunk(b"zTXt", b"Comment\0\0" + packed) + good[33:]


def bmp(width: int, height: int) -> bytes:
    """Return the head of a BMP image."""
    head = struct.pack("<IiiHHIIiiII", 40, width, height, 1, 24, 0, 0, 0, 0, 0, 0)
    return b"BM" + struct.pack("<IHHI", 54, 0, 0, 54) + head


IMAGES: dict[str, Callable[[], bytes]] = {
    "claim.png": lambda: png(60_000, 60_000, rows=1),
    "wide.png": lambda: png(2_000_000_000, 1, rows=0),
    "large.png": lambda: png(13_000, 13_000),
    "text.png": text_bomb,
    "profile.png": lambda: (
        png(4, 4)[:33] + chunk(b"iCCP", b"a\0\0" + zlib.compress(bytes(100 << 20))) + png(4, 4)[33:]
    ),
    "frames.png": lambda: (
        png(4, 4)[:33] + chunk(b"acTL", struct.pack(">II", 2**31 - 1, 0)) + png(4, 4)[33:]
    ),
    "chunk.png": lambda: png(4, 4)[:33] + struct.pack(">I", 2**31 - 1) + b"tEXt",
    "short.png": lambda: png(400, 400)[:60],
    "head.png": lambda: b"\x89PNG\r\n\x1a\n",
    "claim.jpg": lambda: b"\xff\xd8\xff\xc0\0\x11\x08\xff\xff\xff\xff\x03" + bytes(9) + b"\xff\xd9",
    "claim.bmp": lambda: bmp(2**31 - 1, 2**31 - 1),
    "negative.bmp": lambda: bmp(-(2**31), -(2**31)),
    "claim.tga": lambda: struct.pack("<BBBHHBHHHHBB", 0, 0, 10, 0, 0, 0, 0, 0, 65535, 65535, 32, 0),
    "claim.gif": lambda: b"GIF89a\xff\xff\xff\xff\0\0\0,\0\0\0\0\xff\xff\xff\xff\0\x02\0;",
    "claim.dds": lambda: (
        b"DDS " + struct.pack("<7I", 124, 0x1007, 2**31, 2**31, 0, 0, 0) + bytes(96)
    ),
    "claim.psd": lambda: (
        b"8BPS\0\x01" + bytes(6) + struct.pack(">HIIHH", 3, 300_000, 300_000, 8, 3)
    ),
    "claim.tif": lambda: b"II*\0\x08\0\0\0\x02\0" + struct.pack("<HHII", 256, 4, 1, 2**31) * 2,
    "program.eps": lambda: (
        b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n(%pipe%touch @MARK@) (w) file pop\n"
    ),
    "picture.svg": lambda: (
        b'<svg xmlns="http://www.w3.org/2000/svg"><image href="../beside/secret.png"/></svg>'
    ),
    "text_only.png": lambda: b"root:x:0:0:root:/root:/bin/sh\n",
    "text_only.jpg": lambda: b"root:x:0:0:root:/root:/bin/sh\n",
    "no_suffix": lambda: b"root:x:0:0:root:/root:/bin/sh\n",
    "empty.png": lambda: b"",
}
"""Hostile images by name."""
