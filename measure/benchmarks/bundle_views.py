"""Pictures of robots before and after ``urdftool bundle`` with limits, and the sizes of both.

``python -m measure.benchmarks.bundle_views FOLDER --options "--max-error 0.002"`` bundles about 30
robots of example-robot-data, pybullet_data and the corpus, draws 20 views of each and of its
source, and compares them pixel by pixel. ``FOLDER/rows.json`` is that of
``measure.benchmarks.bundle``, or is made.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import urdftool
from urdftool import cli
from urdftool.drawing.camera import Camera, View
from urdftool.drawing.picture import draw, view_of
from urdftool.drawing.shapes import Shapes, read_robot_shapes
from urdftool.model.elements import Mesh, Robot
from urdftool.model.kinematics import link_poses

from .bundle import has_links, load_source, measure

SIZE = (240, 180)
VISIBLE = 0.1
"""Difference of a color, in 0 … 1, from which a pixel counts as different."""


def cameras() -> Iterator[Camera]:
    """Yield 20 viewpoints: ten around the robot, from above and from below the horizon."""
    for elevation in (25.0, -10.0):
        for number in range(10):
            yield Camera(math.radians(36.0 * number), math.radians(elevation))


def read(robot: Robot) -> tuple[Shapes, dict[str, object]]:
    """Return the visual geometry of a robot, and the poses of its links."""
    return read_robot_shapes(robot), dict(link_poses(robot, {}))


def compare(source: Robot, bundle: Robot) -> tuple[float, float, float]:
    """Return the largest values of 20 views.

    Returns:
        Mean difference of all pixels, share of pixels that differ visibly, and difference of a
        color of one pixel, each in 0 … 1.
    """
    (old, poses), (new, other) = read(source), read(bundle)
    corners, _, there = old.transform(poses)
    worst = np.zeros(3)
    for camera in cameras():
        view: View = view_of(corners[np.flatnonzero(there)], camera, SIZE)
        before = draw(old, poses, camera=view, ground=False).astype(np.float64) / 255
        after = draw(new, other, camera=view, ground=False).astype(np.float64) / 255
        off = np.abs(before - after).max(axis=2)
        worst = np.maximum(worst, [off.mean(), (off > VISIBLE).mean(), off.max()])
    return float(worst[0]), float(worst[1]), float(worst[2])


SMALLEST, LARGEST = 2e5, 6e6
"""Sizes of the compared bundles [bytes]; larger robots take minutes each."""


def choose(rows: list[dict[str, object]], count: int) -> list[dict[str, object]]:
    """Return about so many robots with visual meshes, spread evenly over the collections."""
    found = []
    for row in rows:
        if "bundle" not in row or not has_links(str(row["bundle"])):
            continue
        robot = urdftool.load(str(row["bundle"]))
        shapes = [shape.geometry for link in robot.links for shape in link.visuals]
        if SMALLEST < float(str(row["bytes"])) < LARGEST and any(
            isinstance(shape, Mesh) for shape in shapes
        ):
            found.append(row)
    return found[:: max(1, len(found) // count)][:count]


def main(words: list[str]) -> int:
    """Bundle the robots with the options, and print a line for each and the totals."""
    parser = argparse.ArgumentParser(prog="python -m measure.benchmarks.bundle_views")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--options", default="--max-error 0.002 --max-texture 1024")
    parser.add_argument("--count", type=int, default=30)
    arguments = parser.parse_args(words)
    folder = arguments.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    rows = choose(measure(folder, []), arguments.count)
    options = arguments.options.split()
    target = folder / "_".join(options).replace("-", "").replace("/", "")
    totals, worst = np.zeros(3), np.zeros(3)
    for number, row in enumerate(rows):
        out = target / str(number)
        out.parent.mkdir(parents=True, exist_ok=True)
        given = [str(word) for word in row["words"]]  # type: ignore[attr-defined]
        start = time.perf_counter()
        code = cli.call(["-qq", "bundle", str(row["source"]), *given, "-o", str(out), *options])
        seconds = time.perf_counter() - start
        if code:
            print(f"{row['source']}: exit code {code}", flush=True)
            continue
        document = json.loads((out / "bundle.json").read_text("utf-8"))
        size = sum(entry["bytes"] for entry in document["files"])
        values = compare(load_source(row), urdftool.load(out / document["description"]))
        totals += (float(str(row["bytes"])), size, seconds)
        worst = np.maximum(worst, values)
        mean, share, most = (100 * value for value in values)
        print(
            f"{Path(str(row['source'])).name:45} {float(str(row['bytes'])) / 1e6:7.2f} MB -> "
            f"{size / 1e6:7.2f} MB  {seconds:6.1f} s  mean {mean:5.2f} %  visible {share:5.2f} %  "
            f"most {most:5.1f} %",
            flush=True,
        )
    mean, share, most = (100 * value for value in worst)
    print(f"{len(rows)} robots: {totals[0] / 1e6:.1f} MB -> {totals[1] / 1e6:.1f} MB")
    print(f"{totals[2]:.0f} s; worst view: mean {mean:.2f} %, visible {share:.2f} %, {most:.1f} %")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
