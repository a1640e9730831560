"""What is kept of mesh files: what was made of them, for as long as they stay the same."""

from __future__ import annotations

import os
import shutil

import numpy as np
import pytest

from tests.conftest import FIXTURES
from urdftool.model.load import load
from urdftool.simulation.hull_cache import HullCache
from urdftool.simulation.prepare import prepare
from urdftool.simulation.settings import Settings
from urdftool.storage import cache_folder

POINTS = np.random.default_rng(0).normal(size=(5, 3))
FACES = np.array([[0, 1, 2], [2, 3, 4]])


@pytest.fixture
def mesh(tmp_path):
    return shutil.copy(FIXTURES / "meshes" / "cube.stl", tmp_path / "cube.stl")


class Maker:
    """Makes two clouds, and counts how often."""

    def __init__(self):
        self.times = 0

    def __call__(self):
        self.times += 1
        return [(POINTS, FACES), (POINTS[:1], FACES[:0])]


def write_robot(folder):
    shutil.copy(FIXTURES / "meshes" / "cube.stl", folder)
    path = folder / "cube.urdf"
    path.write_text(
        '<robot name="cube"><link name="a"><inertial><mass value="1"/>'
        '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
        '<collision><geometry><mesh filename="cube.stl"/></geometry></collision>'
        "</link></robot>"
    )
    return path


def get_or_compute(path, facts, make):
    return HullCache(cache_folder("simulate")).get_or_compute(path, facts, make)


def entries():
    return [path for path in cache_folder("simulate").rglob("*") if len(path.name) == 64]


def test_what_is_kept_is_what_was_made_to_the_bit(mesh):
    make = Maker()
    one, other = (get_or_compute(mesh, ["pieces"], make) for _ in range(2))
    assert make.times == 1
    for (a, b), (c, d) in zip(one, other, strict=True):
        assert a.tobytes() == c.tobytes()
        assert b.tobytes() == d.tobytes()
        assert (a.shape, b.shape) == (c.shape, d.shape)
        assert c.flags.writeable


def test_another_file_scale_or_kind_is_made_anew(mesh):
    make = Maker()
    get_or_compute(mesh, ["pieces", (1, 1, 1)], make)
    get_or_compute(mesh, ["pieces", (2, 1, 1)], make)
    get_or_compute(mesh, ["points", (1, 1, 1)], make)
    with open(mesh, "ab") as stream:
        stream.write(b" ")
    get_or_compute(mesh, ["pieces", (1, 1, 1)], make)
    assert make.times == 4


@pytest.mark.parametrize("harm", ["cut", "empty", "foreign"])
def test_a_damaged_entry_is_made_anew(mesh, harm):
    make = Maker()
    get_or_compute(mesh, [], make)
    (entry,) = entries()
    data = entry.read_bytes()
    entry.write_bytes({"cut": data[:-8], "empty": b"", "foreign": b"x" * 200}[harm])
    assert len(get_or_compute(mesh, [], make)) == 2
    assert make.times == 2


def test_what_is_whole_and_not_ours_is_made_anew(mesh):
    from urdftool.storage import DiskCache

    make = Maker()
    get_or_compute(mesh, [], make)
    (entry,) = entries()
    for data in (b"[[5, 2]]\n", b"nothing", b"[5]\n", b'{"a": 1}\n', b"[[1, 0]]\n" + bytes(25)):
        DiskCache(cache_folder("simulate")).put(entry.name, data)
        assert len(get_or_compute(mesh, [], make)) == 2
    assert make.times == 6


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="wants pipes")
def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe.stl")
    make = Maker()
    get_or_compute(tmp_path / "pipe.stl", [], make)
    get_or_compute(tmp_path / "none.stl", [], make)
    assert make.times == 2
    assert not entries()


def test_a_robot_is_the_same_from_what_is_kept(urdftool):
    robot = FIXTURES / "robots" / "mira_description" / "urdf" / "mira.urdf"
    words = ("-q", "simulate", str(robot), "--format", "json", "--duration", "0.2")
    one = urdftool(*words)
    assert entries()
    other = urdftool(*words)
    assert one == other


def test_where_nothing_can_be_kept_work_goes_on(mesh, monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    (tmp_path / "one.urdf").write_text(
        '<robot name="one"><link name="a"><inertial><mass value="1"/>'
        '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
        '<collision><geometry><mesh filename="cube.stl"/></geometry></collision></link></robot>'
    )
    bodies = prepare(load(tmp_path / "one.urdf"), Settings())
    assert len(bodies.bodies[0].shapes[0].pieces[0]) == 8


def test_where_it_is_kept_can_be_said(mesh, tmp_path):
    make = Maker()
    for _ in range(2):
        HullCache(tmp_path / "here").get_or_compute(mesh, ["pieces"], make)
    assert make.times == 1
    assert [path for path in (tmp_path / "here").rglob("*") if len(path.name) == 64]
    for _ in range(2):
        HullCache(None).get_or_compute(mesh, ["pieces"], make)
    assert make.times == 3
    assert not entries()


@pytest.mark.parametrize("fleet", [(), ("--fleet",)])
def test_the_command_keeps_where_it_is_told(urdftool, tmp_path, fleet):
    robot = write_robot(tmp_path)
    words = ("simulate", robot, *fleet, "--duration", "0.1")
    here = tmp_path / "here"
    assert urdftool(*words, "--no-cache").code in (0, 1)
    assert not entries()
    assert urdftool(*words, "--cache-dir", here).code in (0, 1)
    assert not entries()
    assert [path for path in here.rglob("*") if len(path.name) == 64]
    done = urdftool(*words, "--cache-dir", here, "--no-cache")
    assert done.code == 2
    assert "exclude each other" in done.err
