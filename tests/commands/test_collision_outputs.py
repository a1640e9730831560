"""What ``urdftool collision`` may not write over is refused before it writes anything."""

import os
from pathlib import Path

import pytest

from tests.collision.shapes import l_profile, noisy, stl
from tests.commands.test_collision import robot

HULL = ("--method", "hull", "--no-cache")


@pytest.fixture
def arm(write):
    """A robot with a mesh and a texture, in the folder of its own."""
    write("arm/bracket.stl", stl(*l_profile()))
    write("arm/skin.png", b"\x89PNG")
    skin = '<material name="skin"><texture filename="skin.png"/></material>\n  </visual>'
    text = robot(("a", "bracket.stl", "")).replace("</visual>", skin)
    return write("arm/arm.urdf", text)


def nothing_else(folder="."):
    return sorted(os.listdir(folder)) == ["arm"] and sorted(os.listdir("arm")) == [
        "arm.urdf",
        "bracket.stl",
        "skin.png",
    ]


@pytest.mark.parametrize("words", [("-o", "out.urdf"), ("--check",)])
def test_a_picture_in_the_place_of_an_input_is_refused_first(urdftool, arm, words):
    done = urdftool("collision", arm, *words, "--picture", "arm/skin.png", *HULL)
    assert (done.code, done.out) == (2, "")
    assert "is read as an input" in done.err
    assert nothing_else()


def test_a_picture_of_a_mesh_in_its_place_is_refused_first(urdftool, write):
    mesh = write("box.stl", stl(*noisy("box", (0.3, 0.2, 0.1))))
    os.symlink("box.stl", "box.png")
    before = Path(mesh).read_bytes()
    done = urdftool("collision", "mesh", mesh, "-o", "out.stl", "--picture", "box.png", *HULL)
    assert done.code == 2
    assert "is read as an input" in done.err
    assert sorted(os.listdir(".")) == ["box.png", "box.stl"]
    assert Path(mesh).read_bytes() == before


@pytest.mark.parametrize(
    ("output", "word"),
    [
        ("arm/arm.urdf", "is read as an input"),
        ("arm", "wants to end in .urdf"),
        ("folder.urdf", "is a folder"),
        ("out.stl", "wants to end in .urdf"),
    ],
)
def test_an_output_that_cannot_be_is_refused_before_the_work(
    urdftool, arm, output, word, monkeypatch
):
    from urdftool.commands import collision_robot

    if output.startswith("folder"):
        Path(output).mkdir()
    monkeypatch.setattr(collision_robot, "_compute", lambda *_: pytest.fail("it was computed"))
    done = urdftool("collision", arm, "-o", output, *HULL)
    assert done.code == 2
    assert word in done.err
    assert not Path("arm/arm_collision").exists()


@pytest.mark.parametrize("words", [("-o", "out.urdf"), ("--in-place",)])
def test_pieces_never_replace_the_meshes_that_are_seen(urdftool, arm, words):
    before = Path("arm/bracket.stl").read_bytes()
    done = urdftool("collision", arm, *words, "--mesh-dir", "arm", "--overwrite", *HULL)
    assert done.code == 2
    assert "is read as an input" in done.err
    assert Path("arm/bracket.stl").read_bytes() == before
    assert nothing_else()


def test_pieces_of_before_are_replaced(urdftool, arm):
    words = ("collision", arm, "--in-place", *HULL)
    assert urdftool(*words).code == 0
    first = Path("arm/arm.urdf").read_bytes()
    done = urdftool(*words, "--max-vertices", "8")
    assert done.code == 0, done.err
    assert Path("arm/arm.urdf").read_bytes() == first
