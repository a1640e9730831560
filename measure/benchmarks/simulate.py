"""``simulate`` against a bare PyBullet loop"""

from __future__ import annotations

import json
import math
import subprocess
import tempfile
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

from urdftool.model.load import load
from urdftool.simulation.engines.pybullet.urdf import NAME
from urdftool.simulation.prepare import prepare
from urdftool.simulation.settings import Settings

from .calls import REPLAY, write_calls
from .robots import FIXTURES, bullet_robots, example
from .table import Pairs, Table, number
from .timing import PYTHON, URDFTOOL, command, in_turn

PEERS = ("pybullet",)
ROBOTS = FIXTURES / "robots"
ABOUT = """\
Whole processes. The **bare loop** loads the same URDF into PyBullet, holds every joint at zero
with a force of 1,000, and takes the same number of steps without checks. **The same calls**
repeats all calls that urdftool makes to PyBullet; it differs from the bare loop for joints that
give way or follow others. Hulls of meshes are cached."""

MESHES = {
    "a1/a1.urdf": "a1, a quadruped with visual meshes",
    "husky/husky.urdf": "husky, a base with a collision mesh",
    "kuka_iiwa/model.urdf": "kuka_iiwa, an arm with collision meshes",
    "laikago/laikago_toes_zup.urdf": "laikago, a quadruped with collision meshes",
    "mini_cheetah/mini_cheetah.urdf": "mini_cheetah, a quadruped with 194,000 triangles",
}

BODIES = {
    "talos_reduced.urdf": "talos, a humanoid of 33 bodies",
    "romeo.urdf": "romeo, one of 56",
    "icub.urdf": "icub, one of 38",
    "tiago.urdf": "tiago, a mobile manipulator of 49",
    "pr2.urdf": "pr2, one of 31",
}
"""Robots with many bodies, many of which interpenetrate at the start."""

BARE = """
import sys, pybullet as p
p.connect(p.DIRECT)
p.setTimeStep(0.002)
p.setPhysicsEngineParameter(numSolverIterations=100)
p.setGravity(0, 0, -9.81)
p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
r = p.loadURDF(sys.argv[1], [0, 0, float(sys.argv[2])], flags=p.URDF_USE_INERTIA_FROM_FILE)
for j in range(p.getNumJoints(r)):
    p.setJointMotorControl2(r, j, p.POSITION_CONTROL, targetPosition=0, force=1000)
for _ in range(int(sys.argv[3])):
    p.stepSimulation()
"""


def rows() -> Iterator[Table | str]:
    """A row for each robot: whole processes."""
    if find_spec("pybullet") is None:
        yield "PyBullet is not installed (it has wheels up to Python 3.11), so this is left out."
        return
    pairs = Pairs("robot", ["bare loop", "the same calls"], extra=["steps"])
    over, most = [], []
    for name, path, options, settings in _robots():
        words = [*URDFTOOL, "-q", "simulate", str(path), *options]
        done = subprocess.run([*words, "--format", "json"], capture_output=True, check=False)
        steps = json.loads(done.stdout)["trials"][0]["steps"]
        with tempfile.TemporaryDirectory() as folder:
            calls = write_calls(path, settings, Path(folder))
            bodies = prepare(load(path), Settings())
            height = bodies.start.translation[2]
            urdf = str(Path(folder) / NAME)
            sides = {
                "urdftool": command(words),
                "bare loop": command([PYTHON, "-c", BARE, urdf, str(height), str(steps)]),
                "the same calls": command([PYTHON, "-c", REPLAY, calls]),
            }
            taken = in_turn(sides, rounds=7, budget=30, label=name)
        same = taken["the same calls"].seconds
        over.append(taken["urdftool"].seconds - same)
        most.append(over[-1] - 0.1 * same)
        pairs.add(name, taken, f"{steps:,}")
    yield pairs.table(
        f"Above the same calls it takes {number(min(over))} to {number(max(over))} s, which is at "
        f"most {number(max(most))} s and a tenth of their time: it reads and checks the "
        "description, prepares it for the engine in a process of its own, looks at contacts as it "
        "goes, and judges."
    )


def _robots() -> Iterator[tuple[str, Path, list[str], Settings]]:
    base, arm = "my_robot/urdf/robot_base.urdf.xacro", "ros2_arm/urdf/robot2_sound.urdf.xacro"
    sloped = Settings(slope=math.radians(0.2))
    yield "mobile base, 5 s", ROBOTS / base, ["--slope", "0.2"], sloped
    yield "arm, unactuated", ROBOTS / arm, ["--limp"], Settings(hold="none")
    known = {"/".join(path.parts[-2:]): path for path in bullet_robots()}
    for name, words in MESHES.items():
        if name in known:
            yield words, known[name], [], Settings()
    for name, words in BODIES.items():
        path = example(name)
        if path is not None:
            yield words, path, [], Settings()
