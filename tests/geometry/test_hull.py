"""Convex hulls against closed forms and against Qhull."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from urdftool.geometry.hull import compute_convex_hull, extract_hull_surface

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)


def signed_volume(corners, faces):
    a, b, c = (corners[faces[:, index]] for index in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


def test_points_inside_are_left_out():
    points = np.concatenate([CUBE, 0.1 + 0.8 * np.random.default_rng(0).random((500, 3))])
    hull = compute_convex_hull(points)
    corners, faces = extract_hull_surface(hull)
    assert sorted(map(tuple, corners)) == sorted(map(tuple, CUBE))
    assert len(faces) == 12
    assert hull.volume() == pytest.approx(1.0)


def test_triangles_are_counter_clockwise_seen_from_outside():
    corners, faces = extract_hull_surface(compute_convex_hull(CUBE - 7))
    assert signed_volume(corners, faces) == pytest.approx(1.0)


@pytest.mark.parametrize(
    "points",
    [
        CUBE[:3],
        CUBE * [1, 1, 0],
        CUBE * [1, 0, 0],
        (CUBE * [1, 1, 0]) @ np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0],
        np.zeros((9, 3)),
        np.full((8, 3), np.nan),
        np.zeros((0, 3)),
    ],
)
def test_what_has_no_volume_has_no_hull(points):
    assert compute_convex_hull(points) is None


@pytest.mark.parametrize("size", [1e-6, 1e-3, 1e6])
def test_size_does_not_matter(size):
    assert compute_convex_hull(CUBE * size).volume() == pytest.approx(size**3)


def test_a_thin_plate_has_a_hull():
    assert compute_convex_hull(CUBE * [1, 1, 1e-5]).volume() == pytest.approx(1e-5)


@settings(max_examples=100, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    count=st.integers(5, 300),
    stretch=st.floats(1e-3, 1e3),
    rounded=st.booleans(),
)
def test_as_large_as_that_of_qhull(seed, count, stretch, rounded):
    points = np.random.default_rng(seed).normal(size=(count, 3)) * [1, 1, stretch]
    if rounded:
        points = points.round(1)
    hull = compute_convex_hull(points)
    assume(hull is not None)
    corners, faces = extract_hull_surface(hull)
    other = ConvexHull(points)
    near = 1e-6 * np.ptp(points) * other.area
    assert hull.volume() == pytest.approx(other.volume, rel=1e-9, abs=near)
    assert signed_volume(corners, faces) == pytest.approx(other.volume, rel=1e-9, abs=near)
    beyond = other.equations[:, :3] @ corners.T + other.equations[:, 3:]
    assert beyond.max() < 1e-9 * max(1.0, stretch)


SURFACE = """
import hashlib, numpy as np
from urdftool.geometry.hull import compute_convex_hull, extract_hull_surface
points = np.random.default_rng(5).normal(size=(30000, 3))
points /= np.linalg.norm(points, axis=1)[:, None]
corners, faces = extract_hull_surface(compute_convex_hull(points))
print(len(corners), hashlib.sha256(corners.tobytes() + faces.tobytes()).hexdigest())
"""


def test_it_is_the_same_each_time():
    words = [sys.executable, "-c", SURFACE]
    said = {subprocess.run(words, capture_output=True, text=True).stdout for _ in range(4)}
    assert len(said) == 1
    assert said.pop().startswith("30000 ")


@pytest.mark.skipif(sys.platform != "linux", reason="counts the threads of a process in /proc")
@pytest.mark.parametrize("call", ["compute()", "in_thread(compute)"])
def test_hulls_start_no_threads_which_a_fork_would_wait_for(call):
    program = f"""
import os, threading, time, numpy as np
from urdftool.geometry.hull import compute_convex_hull
before = len(os.listdir("/proc/self/task"))
def compute():
    points = np.random.default_rng(0).normal(size=(60000, 3))
    compute_convex_hull(points / np.linalg.norm(points, axis=1)[:, None])
def in_thread(function):
    thread = threading.Thread(target=function)
    thread.start()
    thread.join()
{call}
assert len(os.sched_getaffinity(0)) == {len(os.sched_getaffinity(0))}
for _ in range(600):  # the system ends a thread after it was joined
    count = len(os.listdir("/proc/self/task")) - before
    if not count:
        break
    time.sleep(0.1)
print(count)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.stdout.strip() == "0", done.stderr
