"""A robot of twelve meshes on one core, on two, and from the cache.

``python -m measure.benchmarks.collision_speed``: the three are run in turn, five times; medians of
the whole commands' seconds, and of the processor time that they and all their workers took, which
says on a busy machine whether two processes do more work than one.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

import numpy as np

from tests.collision.shapes import finer, l_profile, noisy, stl

TURNS = 5
LINK = """  <link name="{name}">
    <visual><geometry><mesh filename="{name}.stl"/></geometry></visual>
  </link>
"""
JOINT = """  <joint name="to_{name}" type="fixed"><parent link="m0"/><child link="{name}"/></joint>
"""


def meshes() -> list[tuple[np.ndarray, np.ndarray]]:
    """Twelve different ones: brackets, which are cut, bent shells, and noisy round parts."""
    made = []
    for number in range(4):
        vertices, faces = l_profile()
        for _ in range(4):
            vertices, faces = finer(vertices, faces)
        made.append((vertices * (1, 1 + 0.1 * number, 1 + 0.2 * number), faces))
        vertices, faces = noisy("sphere", (0.1,), noise=0.001, seed=number)
        bent = vertices + np.outer(vertices[:, 0] ** 2, (0, 0, 6.0 + number))
        made.append((bent, faces))
        made.append(noisy("cylinder", (0.05, 0.2 + 0.02 * number), noise=0.002, seed=number))
    return made


def write_robot(folder: Path) -> Path:
    """Write the robot and its meshes."""
    names = []
    for number, mesh in enumerate(meshes()):
        names.append(f"m{number}")
        (folder / f"m{number}.stl").write_bytes(stl(*mesh))
    links = "".join(LINK.format(name=name) for name in names)
    joints = "".join(JOINT.format(name=name) for name in names[1:])
    robot = folder / "twelve.urdf"
    robot.write_text(f'<robot name="twelve">\n{links}{joints}</robot>\n', "utf-8")
    return robot


def taken(robot: Path, *words: str) -> tuple[float, float]:
    """Seconds by the clock and of all processors that a run takes."""
    command = [sys.executable, "-m", "urdftool", "-q", "collision", str(robot)]
    command += ["-o", str(robot.with_name("out.urdf")), "--max-error", "0.02", *words]
    begin = time.perf_counter()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    seconds = time.perf_counter() - begin
    child.returncode = os.waitstatus_to_exitcode(status)
    assert child.returncode == 0
    return seconds, usage.ru_utime + usage.ru_stime


def main(turns: int) -> None:
    """Print the medians."""
    with tempfile.TemporaryDirectory() as name:
        robot = write_robot(Path(name))
        kept = ("--cache-dir", str(Path(name) / "cache"))
        sides = {
            "-j 1": ("--no-cache", "-j", "1"),
            "-j 2": ("--no-cache", "-j", "2"),
            "from the cache": kept,
        }
        taken(robot, *kept)
        runs: dict[str, list[tuple[float, float]]] = {side: [] for side in sides}
        for _ in range(turns):
            for side, words in sides.items():
                runs[side].append(taken(robot, *words))
    wall = {side: median(seconds for seconds, _ in run) for side, run in runs.items()}
    work = {side: median(seconds for _, seconds in run) for side, run in runs.items()}
    for side in sides:
        print(f"{side:15} {wall[side]:6.2f} s, {work[side]:6.2f} s of processors")
    faster = wall["-j 1"] / wall["-j 2"]
    more = work["-j 2"] / work["-j 1"]
    print(f"two are {faster:.2f} times faster and take {more:.2f} times the processor time")
    load = os.getloadavg()[0]
    print(f"load {load:.1f} on {os.cpu_count()} cores")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else TURNS)
