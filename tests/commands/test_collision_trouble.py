"""``urdftool collision`` in trouble: full disks, killed workers, odd meshes."""

import json
import os
import resource
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.collision.shapes import l_profile, noisy, stl, turned
from tests.commands.test_collision import robot
from urdftool.collision.compute import Task, try_compute
from urdftool.collision.parallel import compute_all
from urdftool.collision.piece import make_primitive
from urdftool.collision.settings import Settings
from urdftool.errors import UrdftoolError
from urdftool.storage import DiskCache

HULL = Settings(method="hull")


def dies(task, cores=1):
    if task.path.name == "bad.stl":
        os.kill(os.getpid(), signal.SIGKILL)
    return try_compute(task, cores)


def test_a_worker_that_is_killed_is_said_and_the_others_are_done(tmp_path, monkeypatch):
    from urdftool.collision import parallel

    for name in ("good", "bad", "fine"):
        (tmp_path / f"{name}.stl").write_bytes(stl(*l_profile()) + name.encode())
    monkeypatch.setattr(parallel, "try_compute", dies)
    tasks = [Task(tmp_path / f"{name}.stl", settings=HULL) for name in ("bad", "good", "fine")]
    found = compute_all(tasks, DiskCache(None), jobs=2)
    assert isinstance(found[tasks[0]], UrdftoolError)
    assert "killed" in found[tasks[0]].message
    assert [found[task].method for task in tasks[1:]] == ["hull", "hull"]


@pytest.mark.library("scipy")
def test_a_full_disk_leaves_no_half_file(write):
    write("meshes/bracket.stl", stl(*l_profile()))
    write("r.urdf", robot(("a", "meshes/bracket.stl", "")))
    words = ["collision", "r.urdf", "-o", "out.urdf", "--method", "hull", "--cache-dir", "kept"]
    done = subprocess.run(
        [sys.executable, "-m", "urdftool", *words],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},  # it would be cut off, too
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100)),
    )
    assert done.returncode == 2, done.stderr
    assert "cannot be written" in done.stderr
    assert "Traceback" not in done.stderr
    assert not os.path.exists("out.urdf")
    assert not os.path.exists("out_collision")
    assert not [p for p in Path("kept").rglob("*") if p.is_file()]


def bodies(count):
    rng = np.random.default_rng(0)
    boxes = [
        make_primitive("box", (0.02, 0.03, 0.04), turned(rng), rng.uniform(-0.5, 0.5, 3))
        for _ in range(count)
    ]
    points = np.concatenate([box.vertices for box in boxes])
    faces = np.concatenate([box.faces + 8 * n for n, box in enumerate(boxes)])
    return points, faces


@pytest.mark.parametrize(
    "mesh",
    [
        pytest.param(bodies(300), id="300 bodies"),
        pytest.param((l_profile()[0], l_profile()[1][:-1]), id="open"),
        pytest.param(
            (l_profile()[0], l_profile()[1][:, ::-1]), id="inverted", marks=pytest.mark.slow
        ),
        pytest.param(
            (
                np.concatenate([l_profile()[0], l_profile()[0] + [0.2, 0.05, 0]]),
                np.concatenate([l_profile()[1], l_profile()[1] + 12]),
            ),
            id="two at an edge",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            (
                np.concatenate([l_profile()[0], noisy("box", (0.1, 0.1, 0.3))[0]]),
                np.concatenate([l_profile()[1], noisy("box", (0.1, 0.1, 0.3))[1] + 12]),
            ),
            id="through itself",
            marks=pytest.mark.slow,
        ),
    ],
)
@pytest.mark.parametrize(
    "method", ["simplify", *(pytest.param(m, marks=pytest.mark.slow) for m in ("hull", "coacd"))]
)
def test_a_poor_mesh_comes_out(urdftool, write, mesh, method):
    path = write("poor.stl", stl(*mesh))
    done = urdftool("collision", "mesh", path, "--method", method, "-o", "out.stl", "--no-cache")
    assert done.code == 0, done.err
    assert os.path.getsize("out.stl") > 84


def test_sizes_beyond_all_bounds_are_said(urdftool, write):
    write("bracket.stl", stl(*l_profile()))
    huge = robot(("a", "bracket.stl", ""), ("b", 'bracket.stl" scale="1e300 1 1', ""))
    huge = huge.replace("</robot>", shape_of("c", "1e308 1 1") + joint_to("c") + "</robot>")
    write("r.urdf", huge)
    done = urdftool("collision", "r.urdf", "--check", "--no-cache", "-j", "1")
    assert done.code == 2
    assert "link 'c': its box reaches 1e+308 m, which is not measured" in done.err
    done = urdftool("collision", "r.urdf", "-o", "o.urdf", "--no-cache", "-j", "1")
    assert done.code == 2
    assert "e+299 m from its origin; the file or its scale is damaged" in done.err


def test_a_mesh_that_is_not_read_has_no_verdict(urdftool, write):
    """Links that were measured, have no collision, or name a missing mesh are counted apart."""
    bare = shape_of("c", "1 1 1").replace("collision>", "unknown>")
    text = '<robot name="r">' + shape_of("a", "1 1 1") + bare + joint_to("c")
    missing = shape_of("b", "1 1 1").replace('box size="1 1 1"', 'mesh filename="gone.stl"')
    write("r.urdf", text + missing + joint_to("b") + "</robot>")
    done = urdftool("collision", "r.urdf", "--check", "-j", "1")
    assert done.code == 2
    assert "gone.stl: there is no such mesh file" in done.err
    assert "3 links with visuals, 0 with an error above 5.00%, 1 without collision" in done.err
    assert "geometry, 1 not measured" in done.err
    assert [line.split()[:2] for line in done.out.splitlines()[1:]] == [
        *(["a", "ok"], ["c", "BAD"], ["b", "-"]),
    ]
    done = urdftool("collision", "r.urdf", "--check", "-j", "1", "--format", "json")
    links = json.loads(done.out)["results"][0]["links"]
    assert [link["within"] for link in links] == [True, False, None]


def shape_of(name, size):
    shape = f'<geometry><box size="{size}"/></geometry>'
    return f'<link name="{name}"><visual>{shape}</visual><collision>{shape}</collision></link>'


def joint_to(name):
    ends = f'<parent link="a"/><child link="{name}"/>'
    return f'<joint name="to_{name}" type="fixed">{ends}</joint>'
