"""What ``urdftool collision`` writes and keeps: nothing over an input, nothing by chance."""

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
    assert "is an input" in done.err
    assert nothing_else()


def test_a_picture_of_a_mesh_in_its_place_is_refused_first(urdftool, write):
    mesh = write("box.stl", stl(*noisy("box", (0.3, 0.2, 0.1))))
    os.symlink("box.stl", "box.png")
    before = Path(mesh).read_bytes()
    done = urdftool("collision", "mesh", mesh, "-o", "out.stl", "--picture", "box.png", *HULL)
    assert done.code == 2
    assert "is an input" in done.err
    assert sorted(os.listdir(".")) == ["box.png", "box.stl"]
    assert Path(mesh).read_bytes() == before


@pytest.mark.parametrize(
    ("output", "word"),
    [
        ("arm/arm.urdf", "is an input"),
        ("arm", ".urdf"),
        ("folder.urdf", "is a folder"),
        ("out.stl", ".urdf"),
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
    assert "is an input" in done.err
    assert Path("arm/bracket.stl").read_bytes() == before
    assert nothing_else()


def test_pieces_of_before_are_replaced(urdftool, arm):
    words = ("collision", arm, "--in-place", *HULL)
    assert urdftool(*words).code == 0
    first = Path("arm/arm.urdf").read_bytes()
    done = urdftool(*words, "--max-vertices", "8")
    assert done.code == 0, done.err
    assert Path("arm/arm.urdf").read_bytes() == first


def test_links_whose_meshes_cannot_be_used_are_named(urdftool, write):
    write("box.stl", stl(*noisy("box", (0.3, 0.2, 0.1))))
    write("bad.stl", b"")
    links = (("a", "box.stl", ""), ("left hand", "bad.stl", ""), ("c", "bad.stl", ' scale="2 2 2"'))
    done = urdftool("collision", write("r.urdf", robot(*links)), "-o", "out.urdf", *HULL)
    assert done.code == 2
    assert "--skip-link 'left hand' --skip-link c" in done.err


def test_a_robot_without_meshes_is_said_to_have_none(urdftool, write):
    path = write("r.urdf", '<robot name="r"><link name="a"/></robot>')
    done = urdftool("collision", path, "-o", "out.urdf", *HULL)
    assert done.code == 0
    assert "no link has a mesh" in done.err


@pytest.mark.parametrize("way", ["robot", "mesh"])
def test_what_comes_of_a_killed_coacd_is_said_and_not_kept(urdftool, write, monkeypatch, way):
    from urdftool import isolated

    killer = "import os, signal; os.kill(os.getpid(), signal.SIGKILL)"
    popen = isolated.subprocess.Popen
    monkeypatch.setattr(
        isolated.subprocess,
        "Popen",
        lambda words, **more: popen([words[0], "-c", killer], **more),
    )
    mesh = write("bracket.stl", stl(*l_profile()))
    options = ("--method", "coacd", "--cache-dir", "kept", "-o")
    if way == "mesh":
        done = urdftool("collision", "mesh", mesh, *options, "out.stl")
    else:
        path = write("r.urdf", robot(("a", mesh, "")))
        done = urdftool("collision", path, *options, "out.urdf", "-j", "1")
    assert done.code == 0, done.err
    assert "CoACD was killed, probably out of memory" in done.err
    assert [file for _, _, files in os.walk("kept") for file in files] == []
