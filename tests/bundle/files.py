"""Small mesh and image files for tests of bundles."""

import struct

from tests.assets import make_gltf, make_png, make_stl

PNG = make_png()
stl = make_stl


def obj(library="arm.mtl"):
    """An OBJ of one triangle with a material."""
    return f"mtllib {library}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl paint\nf 1 2 3\n".encode()


def mtl(image="paint.png"):
    """A material with an image."""
    return f"newmtl paint\nKd 1 0 0\nmap_Kd -s 1 1 1 {image}\n".encode()


def gltf_document(buffer, image, size=12):
    """The JSON of a glTF file with a buffer and an image."""
    return make_gltf(
        buffers=[{"byteLength": size, "uri": buffer}],
        images=[{"uri": image}, {"uri": "data:image/png;base64,AAAA"}],
    )


def glb(document, rest=b""):
    """A GLB file of a JSON document."""
    document += b" " * (-len(document) % 4)
    chunk = struct.pack("<I4s", len(document), b"JSON") + document
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunk) + len(rest)) + chunk + rest


LINK = (
    '<link name="{0}"><visual><geometry><mesh filename="{1}"/></geometry></visual>'
    '<collision><geometry><mesh filename="{2}"/></geometry></collision></link>'
)


def robot(*pairs, extra=""):
    """A robot with a link for each pair of a visual and a collision mesh."""
    links = [LINK.format(f"l{i}", *pair) for i, pair in enumerate(pairs)]
    joints = [
        f'<joint name="j{i}" type="fixed"><parent link="l0"/><child link="l{i}"/></joint>'
        for i in range(1, len(pairs))
    ]
    return f'<robot name="arm">{"".join((*links, *joints, extra))}</robot>\n'


COLORED_DAE = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.01"/><up_axis>Y_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert><diffuse>
<color>0.2 0.4 0.6 1</color></diffuse></lambert></technique></profile_COMMON></effect>
</library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 100 0 0 0 200 0 0 0 300</float_array>
<technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4" material="m"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"><bind_material>
<technique_common><instance_material symbol="m" target="#m"/></technique_common></bind_material>
</instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
"""
"""A tetrahedron of 1, 2 and 3 m in centimeters, with a color."""


def dae(image):
    """The tetrahedron, with an image; the second init_from is the name of a surface."""
    images = (
        f'<library_images><image id="i"><init_from>{image}</init_from></image></library_images>'
    )
    surface = (
        '<newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam>'
        "<technique"
    )
    text = COLORED_DAE.replace("<library_effects>", images + "<library_effects>")
    return text.replace("<technique", surface, 1).encode()
