"""``simulate`` against a bare PyBullet loop that loads the same robot and takes the same steps."""

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

from .timing import PYTHON, URDFTOOL, command, in_turn

ROBOTS = Path(__file__).parents[2] / "fixtures" / "robots"

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


def rows() -> Iterator[str]:
    """A row for each robot: whole processes; at most half a second and a tenth more is wanted."""
    robots = {
        "mobile base, 5 s": (ROBOTS / "my_robot/urdf/robot_base.urdf.xacro", ["--slope", "0.2"]),
        "arm, limp": (ROBOTS / "ros2_arm/urdf/robot2_sound.urdf.xacro", ["--limp"]),
    }
    if find_spec("pybullet_data"):
        import pybullet_data

        robots["a1"] = (Path(pybullet_data.getDataPath()) / "a1/a1.urdf", [])
    for name, (path, options) in robots.items():
        words = [*URDFTOOL, "-q", "simulate", str(path), *options]
        done = subprocess.run([*words, "--format", "json"], capture_output=True, check=False)
        steps = json.loads(done.stdout)["trials"][0]["steps"]
        with tempfile.TemporaryDirectory() as folder:
            bodies = prepare(load(path), Settings())
            urdf = write_folder(bodies, Path(folder))
            height = bodies.start.translation[2]
            bare = [PYTHON, "-c", BARE, str(urdf), str(height), str(steps)]
            medians = in_turn({"ours": command(words), "bare": command(bare)}, rounds=7)
        ours, theirs = medians["ours"].seconds, medians["bare"].seconds
        yield (
            f"{name:<18} {steps:>5} steps   bare {theirs:.3f} s   simulate {ours:.3f} s   "
            f"{ours - theirs:+.3f} s"
        )
