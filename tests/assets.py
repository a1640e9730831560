"""Small files of meshes and images that an export copies."""

import json
import struct
import zlib

CORNERS = ((0, 0, 0), (1, 0, 0), (0, 1, 0))
DAE = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">{}
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">
0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#a" count="3" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
"""
"""COLLADA of one triangle; ``{}`` is for images."""


def make_png(color=(255, 0, 0)):
    """Return an image of one pixel."""

    def chunk(kind, data):
        return (
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        )

    head = struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0)
    pixels = chunk(b"IDAT", zlib.compress(b"\0" + bytes(color)))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + pixels + chunk(b"IEND", b"")


def make_stl(size=1.0, head=b"urdftool test"):
    """Return a binary STL of one triangle."""
    corners = struct.pack("<12f", 0, 0, 1, *(size * x for point in CORNERS for x in point))
    return head.ljust(80) + struct.pack("<I", 1) + corners + b"\0\0"


def make_gltf(**lists):
    """Return the JSON of a glTF file with a mesh."""
    mesh = {"primitives": [{"attributes": {"POSITION": 0}}]}
    return json.dumps({"asset": {"version": "2.0"}, "meshes": [mesh], **lists}).encode()
