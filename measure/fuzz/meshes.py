"""Damaged mesh files: counts that lie, indices beyond, numbers that are none, and plain noise."""

from __future__ import annotations

import re
import shutil

from measure.benchmarks.robots import FIXTURES

from .damage import NUMBERS, _cut, _flip, _insert, _truncate

FOLDER = FIXTURES / "meshes"
SUFFIXES = (".stl", ".obj", ".dae", ".ply", ".glb", ".gltf")
_NUMBER = re.compile(rb"(?<![\w.])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.])")
_HUGE = (b"-1", b"0", b"4294967295", b"2147483648", b"99999999999999999999", b"1e30", b"7")
_NAME = re.compile(rb"(?:id|name|source|url)=\"([^\"]*)\"|(?:usemtl|mtllib|[og]) (\S+)")
_NAMES = (b"\x1b[31mred", b"../../etc/passwd", b"#", b"", b"x" * 3000, b"\xff\xfe", b"a b")


def copied_mesh(dice, into):
    """A copy of the folder of meshes, one file of which is drawn and damaged; its path."""
    target = into / "meshes"
    shutil.copytree(FOLDER, target, copy_function=shutil.copyfile)
    path = dice.choice(sorted(p for p in target.iterdir() if p.suffix in SUFFIXES))
    path.write_bytes(damaged_mesh(path.read_bytes(), dice))
    if dice.random() < 0.1:
        other = path.with_suffix(dice.choice(SUFFIXES))
        path = path.rename(other)
    return path


def damage_some(folder, dice):
    """Damage one mesh below a folder, where there is any."""
    found = sorted(p for p in folder.rglob("*") if p.suffix.lower() in SUFFIXES)
    if found:
        path = dice.choice(found)
        path.write_bytes(damaged_mesh(path.read_bytes(), dice))


def damaged_mesh(data, dice):
    """The bytes of a mesh file after one to three kinds of damage."""
    for _ in range(dice.choice((1, 1, 2, 3))):
        data = dice.choice(_KINDS)(data, dice)
    return data


def _count(data, dice):
    """Another number of triangles in the head of a binary STL, or of a chunk of glTF."""
    at = dice.choice((80, 12, 8, 4))
    claim = dice.choice((0, 1, 3, 0xFFFF, 0x7FFFFFFF, 0xFFFFFFFF)).to_bytes(4, "little")
    return data[:at] + claim + data[at + 4 :]


def _word(data, dice):
    """Four bytes that are NaN, infinite or huge, where numbers of a binary file stand."""
    at = 4 * dice.randrange(len(data) // 4 + 1)
    value = dice.choice((b"\0\0\xc0\x7f", b"\0\0\x80\x7f", b"\xff\xff\x7f\x7f", b"\0\0\0\0"))
    return data[:at] + value + data[at + 4 :]


def _number(data, dice):
    found = list(_NUMBER.finditer(data))
    if not found:
        return _word(data, dice)
    match = dice.choice(found)
    return data[: match.start()] + dice.choice(NUMBERS + _HUGE) + data[match.end() :]


def _named(data, dice):
    found = list(_NAME.finditer(data))
    if not found:
        return _flip(data, dice)
    match = dice.choice(found)
    start, end = match.span(1 if match[1] is not None else 2)
    return data[:start] + dice.choice(_NAMES) + data[end:]


def _repeated(data, dice):
    """A piece of the file many times."""
    at = dice.randrange(len(data) + 1)
    return data[:at] + data[at : at + dice.choice((1, 50, 500))] * dice.choice((2, 100)) + data[at:]


_KINDS = (_count, _word, _number, _number, _named, _repeated, _cut, _truncate, _insert, _flip)
