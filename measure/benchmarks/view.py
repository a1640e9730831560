"""``view``: from the command to a robot in headless Chromium, and how often a slider moves it."""

from __future__ import annotations

import math
import os
import statistics
import time
from collections.abc import Iterator
from pathlib import Path

from measure.benchmarks.robots import FIXTURES
from tests.viewer import chromium
from tests.viewer.serving import served

ROBOT = FIXTURES / "robots" / "my_robot" / "urdf" / "mobile_manipulator.urdf.xacro"
ROUNDS = 5
SECONDS = 4.0
SLIDER = "[...document.querySelectorAll('[role=slider]')][4]"


def rows() -> Iterator[str]:
    """A row for the time to see the robot, and one for each size of the browser."""
    if chromium.find() is None:
        yield "skipped: needs Chromium (apt-get install chromium)"
        return
    with chromium.chromium() as new_tab:
        starts, meshes = [], []
        for _ in range(ROUNDS):
            begin = time.time()
            with served(ROBOT) as url:
                starts.append(time.time() - begin)
                tab = new_tab()
                tab.open(url)
                tab.until("seen.types.MeshMessage >= 10 && seen.types.ReplayDoneMessage > 0", 60)
                drawn = tab.run("new Promise(r => requestAnimationFrame(() => r(Date.now())))")
                meshes.append(drawn / 1000 - begin)
                tab.close()
        yield (
            f"{ROBOT.name}, 12 links, meshes: address after {statistics.median(starts):.2f} s, "
            f"robot in the browser after {statistics.median(meshes):.2f} s "
            f"(below 4), load {os.getloadavg()[0]:.1f}"
        )
        for size in ((1280, 800), (640, 400)):
            with served(ROBOT, "--no-lint") as url:
                yield _dragged(new_tab(*size), url, size, new_tab.pid)


def _dragged(tab, url, size, pid):
    """What arrives and is drawn while a slider is dragged."""
    tab.open(url)
    tab.until(
        "seen.types.ReplayDoneMessage > 0 && document.querySelectorAll('[role=slider]').length > 4",
        60,
    )
    time.sleep(5)
    x, y = tab.place(SLIDER)
    tab.mouse("mouseMoved", x, y)
    tab.mouse("mousePressed", x, y)
    spent = processor_time(pid)
    before = tab.run("[seen.frames, seen.poses, performance.now()]")
    end = time.monotonic() + SECONDS
    moves = 0
    while time.monotonic() < end:
        tab.mouse("mouseMoved", x + 40 * math.sin(moves / 15), y)
        moves += 1
    after = tab.run("[seen.frames, seen.poses, performance.now()]")
    spent = processor_time(pid) - spent
    tab.mouse("mouseReleased", x, y)
    tab.close()
    frames, poses, span = (b - a for a, b in zip(before, after, strict=True))
    rates = [f"{1000 * count / span:.0f}" for count in (frames, poses, moves)]
    return (
        f"dragged at {size[0]} × {size[1]}, drawn by the processor: {rates[0]} frames and "
        f"{rates[1]} poses a second for {rates[2]} moves (30 of each), "
        f"{1000 * spent / frames:.0f} ms of processor time a frame, load {os.getloadavg()[0]:.1f}"
    )


def processor_time(pid: int) -> float:
    """Seconds of processor time that a process and all below it have spent."""
    parents, spent = {}, {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        number = int(stat.parent.name)
        parents[number] = int(fields[1])
        spent[number] = int(fields[11]) + int(fields[12])
    total, todo = 0, [pid]
    while todo:
        number = todo.pop()
        total += spent.get(number, 0)
        todo += [child for child, parent in parents.items() if parent == number]
    return total / os.sysconf("SC_CLK_TCK")
