"""Bad input of ``urdftool edit``: an error with a place, before anything is written."""

import re

import pytest

from tests.edit.robots import ARM, GRIPPER

DOUBLED = ARM.replace('"camera"', '"l_r_"').replace('"tip"', '"r_l_"')
MESH = ARM.replace('<box size="0.1 0.2 0.3"/>', '<mesh filename="part.stl"/>')
FLAT = b"solid x\nfacet normal 0 0 0\nendsolid x\n"
MIMIC = ARM.replace('<limit lower="-1.0"', '<mimic joint="slide"/><limit lower="-1.0"')
LOOP = ARM.replace(
    "</robot>",
    '<gazebo><joint name="close" type="revolute"><parent>wheel</parent><child>camera</child>'
    "<axis><xyz>0 1 0</xyz></axis></joint></gazebo></robot>",
)
TREE_LOOP = ARM.replace('child link="tip"', 'child link="wheel"')
FLOATING = ARM.replace(
    'joint name="shoulder" type="revolute"', 'joint name="shoulder" type="floating"'
)
FREE = GRIPPER.replace('name="stand" type="fixed"', 'name="stand" type="floating"')
COMPUTED = ARM.replace('<joint name="shoulder" type', '<joint name="$(arg p)shoulder" type')
LATIN = ARM.replace('<?xml version="1.0"?>', '<?xml version="1.0" encoding="ISO-8859-1"?>').replace(
    '"tool"', '"schürze"'
)
UNDECLARED = ARM.replace('"tool"', '"schürze"')
CROSSED = ARM.replace(
    '<joint name="shoulder"><hardwareInterface>',
    '<joint name="slide"/><joint name="shoulder"><hardwareInterface>',
)
SIDES = ("--from", "l_", "--to", "r_", "--sides", "add")
HAND = ("HAND", "--to", "tip", "--prefix", "g_")

TABLE = {
    "names of two robots": (
        ARM,
        ("attach", "ROBOT", "HAND", "--to", "tip"),
        "link 'base' is in both",
    ),
    "names of two links": (
        DOUBLED,
        ("mirror", "ROBOT", "--from", "l_", "--to", "r_"),
        "two links would have the name",
    ),
    "names of an image": (
        ARM.replace('"camera"', '"l_camera"')
        .replace('"tip"', '"r_camera"')
        .replace('"camera_mount"', '"l_mount"'),
        ("mirror", "ROBOT", *SIDES),
        "link 'r_camera' exists; --sides replace removes that side",
    ),
    "no link to attach to": (
        ARM,
        ("attach", "ROBOT", "HAND", "--to", "flange"),
        "'flange' does not",
    ),
    "no new root": (ARM, ("root", "ROBOT", "flange"), "link 'flange' does not exist"),
    "no link to cut": (ARM, ("cut", "ROBOT", "flange"), "link 'flange' does not exist"),
    "no link to keep": (
        ARM,
        ("merge-fixed", "ROBOT", "--keep", "flange"),
        "'flange' does not exist",
    ),
    "no joint": (ARM, ("zero", "ROBOT", "elbow=1"), "joint 'elbow' does not exist"),
    "no side": (ARM, ("mirror", "ROBOT", *SIDES), "no link below the root has 'l_' in its name"),
    "no mesh": (MESH, ("mirror", "ROBOT"), "mesh 'part.stl' cannot be mirrored"),
    "a mesh without triangles": (
        MESH.replace("part", "flat"),
        ("mirror", "ROBOT"),
        "mesh 'flat.stl' cannot be mirrored",
    ),
    "a mimic across the cut": (
        MIMIC,
        ("cut", "ROBOT", "tool"),
        "mimics 'slide', which would be cut",
    ),
    "a transmission across the cut": (CROSSED, ("cut", "ROBOT", "tool"), "--drop-references"),
    "a loop, mirrored": (LOOP, ("mirror", "ROBOT"), "joint 'close' closes a loop"),
    "a loop, cut": (LOOP, ("cut", "ROBOT", "camera"), "of which one would be cut"),
    "a loop, with another zero": (LOOP, ("zero", "ROBOT", "follower=1"), "would close elsewhere"),
    "a loop in the tree": (TREE_LOOP, ("root", "ROBOT", "tip"), "the child of two joints"),
    "a floating joint, as root": (
        FLOATING,
        ("root", "ROBOT", "wheel"),
        "floating joint 'shoulder'",
    ),
    "a floating joint, mirrored": (FLOATING, ("mirror", "ROBOT"), "has several positions"),
    "a floating joint, with another zero": (
        FLOATING,
        ("zero", "ROBOT", "shoulder=1"),
        "is floating",
    ),
    "a part on a floating joint": (
        ARM,
        ("attach", "ROBOT", "FREE", *HAND[1:]),
        "would let the attached robot move freely",
    ),
    "a computed name": (COMPUTED, ("prefix", "ROBOT", "l_"), "no prefix can be added to it"),
    "Latin-1, attached": (LATIN, ("attach", "ROBOT", *HAND), "save both robots as UTF-8"),
    "Latin-1 that is not declared": (
        UNDECLARED,
        ("prefix", "ROBOT", "l_"),
        ":34:43: not well-formed XML",
    ),
    "truncated": (ARM[:900], ("sign", "ROBOT", "shoulder"), ""),
    "another format": ("<sdf version='1.9'/>", ("cut", "ROBOT", "a"), ""),
    "a prefix with a space": (ARM, ("prefix", "ROBOT", "a b"), "cannot be a prefix of names"),
}


@pytest.fixture
def paths(write, tmp_path):
    def make(text):
        path = tmp_path / "in" / "arm.urdf"
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(text.encode("latin-1"))
        (path.parent / "flat.stl").write_bytes(FLAT)
        hand, free = write("hand/gripper.urdf", GRIPPER), write("free/gripper.urdf", FREE)
        return {"ROBOT": path, "HAND": hand, "FREE": free}

    return make


@pytest.mark.parametrize("name", TABLE)
def test_nothing_is_written(urdftool, paths, tmp_path, name):
    text, words, message = TABLE[name]
    assert text != ARM or name not in ("no mesh", "truncated")
    known = paths(text)
    out = tmp_path / "out" / "robot.urdf"
    result = urdftool("edit", *(known.get(word, word) for word in words), "-o", out)
    assert result.code == 2, result.out
    assert message in result.err
    assert re.search(r"\.(urdf|stl)(:\d+:\d+)?: ", result.err), result.err
    assert not out.parent.exists()


LATIN_SIDE = re.sub(
    r'"(upper|schürze|wheel|camera|tip|shoulder|slide|follower|\w+_mount)"', r'"l_\1"', LATIN
)
LATIN_OPERATIONS = {
    "prefix": ("prefix", "ROBOT", "l_"),
    "merge-fixed": ("merge-fixed", "ROBOT"),
    "root": ("root", "ROBOT", "wheel"),
    "mirror": ("mirror", "ROBOT"),
    "sides": ("mirror", "ROBOT", *SIDES),
    "zero": ("zero", "ROBOT", "slide=0.1"),
    "sign": ("sign", "ROBOT", "slide"),
    "cut": ("cut", "ROBOT", "wheel"),
    "round": ("round", "ROBOT"),
}


@pytest.mark.parametrize("name", LATIN_OPERATIONS)
def test_names_in_latin_1_are_kept(urdftool, paths, tmp_path, name):
    known = paths(LATIN_SIDE if name == "sides" else LATIN)
    out = tmp_path / "out" / "robot.urdf"
    words = [known.get(word, word) for word in LATIN_OPERATIONS[name]]
    result = urdftool("edit", *words, "-o", out)
    assert result.code == 0, result.err
    data = out.read_bytes()
    assert "schürze".encode("latin-1") in data or b"l_sch&#252;rze" in data
    assert b"\xc3" not in data
    verified = urdftool("verify", known["ROBOT"], out, "--map", out.with_suffix(".map"))
    assert verified.code == 0, verified.out


def test_a_loop_within_the_branch_is_cut(urdftool, paths, tmp_path):
    out = tmp_path / "robot.urdf"
    assert urdftool("edit", "cut", paths(LOOP)["ROBOT"], "upper", "-o", out).code == 0
    assert "close" not in out.read_text()


def test_the_links_of_a_loop_are_not_merged(urdftool, paths, tmp_path):
    out = tmp_path / "robot.urdf"
    assert urdftool("edit", "merge-fixed", paths(LOOP)["ROBOT"], "-o", out).code == 0
    assert '<link name="camera">' in out.read_text()
