"""``simulate`` against a bare PyBullet loop"""

from __future__ import annotations

import json
import subprocess
import tempfile
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

from urdftool.model.load import load
from urdftool.simulation.prepare import prepare
from urdftool.simulation.settings import Settings
from urdftool.simulation.urdf import write_folder

from .robots import FIXTURES, bullet_robots
from .table import Pairs, Table, number
from .timing import PYTHON, URDFTOOL, command, in_turn

PEERS = ("pybullet",)
ROBOTS = FIXTURES / "robots"
ABOUT = """\
Whole processes; the loop loads the same URDF into PyBullet, holds the joints and takes the same
number of steps, and looks at nothing. The hulls of meshes are kept from an earlier run."""

MESHES = {
    "a1/a1.urdf": "a1, a quadruped that is seen in meshes",
    "husky/husky.urdf": "husky, a base that collides in one",
    "kuka_iiwa/model.urdf": "kuka_iiwa, an arm that collides in meshes",
    "laikago/laikago_toes_zup.urdf": "laikago, a quadruped that does, too",
    "mini_cheetah/mini_cheetah.urdf": "mini_cheetah, one of 194,000 triangles",
}

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
    pairs = Pairs("robot", ["bare loop"], extra=["steps"])
    over = []
    for name, path, options in _robots():
        words = [*URDFTOOL, "-q", "simulate", str(path), *options]
        done = subprocess.run([*words, "--format", "json"], capture_output=True, check=False)
        steps = json.loads(done.stdout)["trials"][0]["steps"]
        with tempfile.TemporaryDirectory() as folder:
            bodies = prepare(load(path), Settings())
            urdf = write_folder(bodies, Path(folder))
            height = bodies.start.translation[2]
            bare = command([PYTHON, "-c", BARE, urdf, str(height), str(steps)])
            sides = {"urdftool": command(words), "bare loop": bare}
            taken = in_turn(sides, rounds=7, budget=15, label=name)
        over.append(taken["urdftool"].seconds - taken["bare loop"].seconds)
        pairs.add(name, taken, f"{steps:,}")
    yield pairs.table(
        f"Above the bare loop it takes {number(min(over))} to {number(max(over))} s: it reads and "
        "checks the description, prepares it for the engine in a process of its own, looks at "
        "contacts as it goes, and judges."
    )


def _robots() -> Iterator[tuple[str, Path, list[str]]]:
    yield "mobile base, 5 s", ROBOTS / "my_robot/urdf/robot_base.urdf.xacro", ["--slope", "0.2"]
    yield "arm, limp", ROBOTS / "ros2_arm/urdf/robot2_sound.urdf.xacro", ["--limp"]
    known = {"/".join(path.parts[-2:]): path for path in bullet_robots()}
    for name, words in MESHES.items():
        if name in known:
            yield words, known[name], []
