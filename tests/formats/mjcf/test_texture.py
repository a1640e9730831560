"""Images: a PNG that MuJoCo reads, whatever is in the file; converted once."""

import struct
from io import BytesIO
from zlib import compress, crc32

import pytest

from urdftool.formats.mjcf import texture
from urdftool.formats.mjcf.texture import SIGNATURE, get_png

from .robots import link, robot

PIXELS = bytes([200, 100, 50]) * 4


def chunk(kind, content):
    return (
        struct.pack(">I", len(content)) + kind + content + struct.pack(">I", crc32(kind + content))
    )


def image(*between, color=2, row=PIXELS, data=None):
    """A PNG of 4 × 4 pixels with chunks between its head and its data."""
    head = struct.pack(">IIBBBBB", 4, 4, 8, color, 0, 0, 0)
    data = compress((b"\0" + row) * 4) if data is None else data
    parts = [chunk(b"IHDR", head), *between, chunk(b"IDAT", data), chunk(b"IEND", b"")]
    return SIGNATURE + b"".join(parts)


WRONG = [
    chunk(b"sBIT", b"\x08" * 4),
    chunk(b"tEXt", b"\0\0\0"),
    chunk(b"gAMA", b"\0"),
    chunk(b"tRNS", b"\0"),
    chunk(b"sRGB", b"\0\0\0"),
]


@pytest.mark.parametrize("bad", WRONG, ids=lambda c: c[4:8].decode())
def test_ancillary_chunks_are_dropped(bad):
    assert get_png(image(bad)) == image()


def test_what_changes_the_picture_is_kept():
    clear, space = chunk(b"tRNS", b"\0\1" * 3), chunk(b"sRGB", b"\0")
    palette = chunk(b"PLTE", bytes(range(12)))
    assert get_png(image(clear)) == image(clear)
    assert get_png(image(chunk(b"pHYs", bytes(9)), space)) == image(space)
    row = bytes([0, 1, 2, 3])
    assert get_png(image(palette, color=3, row=row)) == image(palette, color=3, row=row)


def test_what_is_not_an_image_is_none(tmp_path):
    pytest.importorskip("PIL")
    assert get_png(b"not an image") is None
    assert get_png(SIGNATURE + b"cut") is None
    assert get_png(tmp_path / "absent.png") is None


def encoded(mode, kind):
    pillow = pytest.importorskip("PIL.Image")
    target = BytesIO()
    pillow.new(mode, (8, 8), 77).save(target, kind)
    return target.getvalue()


@pytest.mark.parametrize(("mode", "kind", "color"), [("RGB", "JPEG", 2), ("RGBA", "TGA", 6)])
def test_another_format_is_converted_once(monkeypatch, tmp_path, mode, kind, color):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    data = encoded(mode, kind)
    first = get_png(data)
    assert first[25] == color  # as many channels as there were
    monkeypatch.setattr(texture, "_convert_png_bytes", None)
    assert get_png(data) == first


@pytest.mark.library("mujoco")
@pytest.mark.parametrize(("data", "code"), [(image(*WRONG), 0), (image(data=b"no zlib stream"), 2)])
def test_a_model_is_written_if_mujoco_compiles_it(urdftool, write, tmp_path, data, code):
    (tmp_path / "picture.png").write_bytes(data)
    shape = (
        '<visual><geometry><box size="1 1 1"/></geometry><material name="m">'
        '<texture filename="picture.png"/></material></visual>'
    )
    path = write("r.urdf", robot(link("a", shape)))
    done = urdftool("export", "mjcf", path, "-o", tmp_path / "out")
    assert done.code == code
    assert (tmp_path / "out").exists() == (code == 0)
    assert ("MuJoCo does not compile the export, so nothing is written" in done.err) == (code == 2)
