"""``python -m measure.benchmarks.simulate_joined [NAME ...]``: collisions put into a neighbour.

In each robot of ``pybullet_data`` and ``example-robot-data`` (whose name has one of some words, if
there are any) the collision of a link is moved to the middle of that of the link above it, and half
the way, and the robot judged as it starts. One link stands for those of its name on other sides or
with other numbers.
"""

from __future__ import annotations

import re
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from measure.benchmarks.simulate_robots import robots
from urdftool.errors import UrdftoolError
from urdftool.model.elements import Origin, Robot
from urdftool.model.kinematics import link_poses
from urdftool.model.load import load
from urdftool.model.pose import Pose
from urdftool.simulation.checks.contact import check_contacts
from urdftool.simulation.checks.final_state import measure_final_state
from urdftool.simulation.checks.interpenetration import get_overlap_depth
from urdftool.simulation.checks.thresholds import Thresholds
from urdftool.simulation.engines import driver
from urdftool.simulation.engines.pybullet.urdf import write_folder
from urdftool.simulation.engines.pybullet.world import import_pybullet
from urdftool.simulation.prepare import prepare
from urdftool.simulation.recording import GROUND, Array
from urdftool.simulation.rigid_bodies import RigidBody
from urdftool.simulation.run import Run
from urdftool.simulation.settings import Settings

SETTINGS = Settings(duration=0.002)
MOVED = 0.1
"""Of its own size, by which a collision is moved at least to be counted."""

FEW = 5
"""Bodies of a robot in which links of one name are all tried."""

SIDES = re.compile(
    r"(?i)left|right|front|rear|back|hind|(?<![a-z])[lrfhb]{1,2}(?=_)|_[lrfhb]{1,2}(?![a-z])"
    r"|^[lr](?=[a-z])|\d"
)


def started(robot: Robot) -> Run:
    """A robot after its first step, in this process."""
    bodies = prepare(robot, SETTINGS)
    with tempfile.TemporaryDirectory() as folder:
        write_folder(bodies, Path(folder))
        recording = driver.run("pybullet", bodies, SETTINGS, Path(folder), Thresholds())
    import_pybullet().disconnect()
    return Run(SETTINGS, bodies, recording)


def misplaced(robot: Robot, run: Run) -> set[str]:
    """Links whose collision is said to be misplaced into another."""
    faults = check_contacts(robot, run, measure_final_state(run))
    return {fault.name for fault in faults if fault.is_warning and fault.code == "interpenetration"}


def planted(robot: Robot, link: str, shift: Array) -> set[str] | None:
    """What is said when a link's collision is moved in its frame; None if it is in no other."""
    whole = [(collision, collision.origin) for collision in robot.link[link].collisions]
    for collision, origin in whole:
        new = Origin(collision.element) if origin is None else replace(origin)
        x, y, z = (np.array(new.xyz) + shift).tolist()
        new.xyz = (x, y, z)
        collision.origin = new
    try:
        run = started(robot)
        depth = max(
            (
                contact.depth
                for contact in run.recording.start_contacts
                if contact.other != GROUND and link in (contact.one, contact.other)
            ),
            default=0.0,
        )
        return misplaced(robot, run) if depth > get_overlap_depth(run.start) else None
    finally:
        for collision, origin in whole:
            collision.origin = origin


def plantings(robot: Robot, run: Run) -> Iterator[tuple[str, float, Array]]:
    """Links, parts of the way, and by how much their collisions move."""
    bodies = run.bodies.bodies
    poses = link_poses(robot, run.bodies.positions)
    kinds = set()
    for body in bodies:
        above = body.parent
        while above >= 0 and not bodies[above].shapes:
            above = bodies[above].parent
        for link in {shape.link for shape in body.shapes} if above >= 0 else set():
            kind = SIDES.sub("", link)
            if kind in kinds and len(bodies) > FEW:
                continue
            kinds.add(kind)
            here, size = _middle(body, poses[body.name], link)
            there, _ = _middle(bodies[above], poses[bodies[above].name])
            shift = np.array(poses[link].rotation).T @ (there - here)
            for part in (1.0, 0.5):
                if np.linalg.norm(part * shift) > MOVED * size:
                    yield link, part, part * shift


def _middle(body: RigidBody, pose: Pose, link: str | None = None) -> tuple[Array, float]:
    boxes = [shape.bounds() for shape in body.shapes if link in (None, shape.link)]
    low, high = max(boxes, key=lambda box: float(np.prod(box[1] - box[0])))
    x, y, z = ((low + high) / 2).tolist()
    return np.array(pose.transform((x, y, z))), float((high - low).max())


def main(words: list[str]) -> None:
    """A line for each robot, and what passed."""
    found: Counter[float] = Counter()
    tried: Counter[float] = Counter()
    for name, path in robots():
        if words and not any(word in name for word in words):
            continue
        try:
            robot = load(path)
            run = started(robot)
        except UrdftoolError:
            continue
        sound = misplaced(robot, run)
        passed = []
        for link, part, shift in plantings(robot, run):
            said = planted(robot, link, shift)
            if said is None:
                continue
            tried[part] += 1
            found[part] += bool(link in said or said - sound)
            if not (link in said or said - sound):
                passed.append(f"{link} ({part:g})")
        print(f"{name}: unplanted {sorted(sound) or 'none'}; passed {passed or 'none'}", flush=True)
    print(", ".join(f"{found[part]} of {tried[part]} at {part:g} of the way" for part in tried))


if __name__ == "__main__":
    main(sys.argv[1:])
