"""Step exported stages in Newton and MuJoCo: ``python -m measure.newton_standing [URDF...]``.

Robots of example-robot-data and pybullet_data with a free base are exported by ``export usd`` and
``export mjcf`` without options. The MJCF is stepped in MuJoCo from its key ``home``; the stage in
Newton, on its MuJoCo solver on the processor, from the same pose and joint positions and at the
same step. A line for each robot has the drift of the base in both after 1 s; the last lines count.
A stage says nothing on the solver, so Newton is run with its default, pyramidal cones of friction,
and with elliptic ones, which the MJCF has.
Requires Newton (``pip install 'urdftool[usd-verify]'``); without it, nothing is measured.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from measure.benchmarks.robots import bullet_robots, example_folder, example_robots

SECONDS, CLOSE = 1.0, 0.01
"""Simulated time [s]; difference of two drifts that counts as equal [m]."""

CONES = ("pyramidal", "elliptic")
"""Cones of friction of Newton's solver; the first is its default."""


@dataclass(frozen=True)
class Start:
    """Start of a robot, and where MuJoCo moves it.

    Attributes:
        base: Name of the free body.
        pose: Its position [m] and quaternion (x, y, z, w).
        joints: Joint positions [rad or m] by name.
        timestep: Time step [s].
        motion: Displacement of the base after ``SECONDS`` [m].
    """

    base: str
    pose: np.ndarray
    joints: Mapping[str, float]
    timestep: float
    motion: np.ndarray


def step_mujoco(scene: Path) -> Start | None:
    """Step a scene from its key ``home``; None if its base is not free."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(scene))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    free = np.flatnonzero(model.jnt_type == int(mujoco.mjtJoint.mjJNT_FREE))
    if not len(free):
        return None
    base = int(model.jnt_bodyid[free[0]])
    single = np.flatnonzero(model.jnt_type >= int(mujoco.mjtJoint.mjJNT_SLIDE))
    joints = {model.joint(int(i)).name: float(data.qpos[model.jnt_qposadr[i]]) for i in single}
    pose = np.concatenate([data.xpos[base], np.roll(data.xquat[base], -1)])
    for _ in range(round(SECONDS / model.opt.timestep)):
        mujoco.mj_step(model, data)
    motion = data.xpos[base] - pose[:3]
    return Start(model.body(base).name, pose, joints, float(model.opt.timestep), motion)


def step_newton(stage: Path, start: Start, cone: str) -> np.ndarray:
    """Return the displacement of the base of a stage [m]."""
    import newton
    import warp

    warp.config.quiet = True
    builder = newton.ModelBuilder()
    builder.add_usd(str(stage))
    builder.add_ground_plane()
    model = builder.finalize(device="cpu")
    body, frame = _place(newton, stage, model, start)
    solver = newton.solvers.SolverMuJoCo(model, use_mujoco_cpu=True, cone=cone)
    state, after, control = model.state(), model.state(), model.control()
    newton.eval_fk(model, model.joint_q, model.joint_qd, state)
    for _ in range(round(SECONDS / start.timestep)):
        state.clear_forces()
        solver.step(state, after, control, None, start.timestep)
        state, after = after, state
    end = _matrix(state.body_q.numpy()[body]) @ frame
    return np.asarray(end[:3, 3] - start.pose[:3])


def _place(newton: Any, stage: Path, model: Any, start: Start) -> tuple[int, np.ndarray]:
    """Set the joint positions of a model, which Newton does not read from the stage.

    Returns:
        The free body, and the frame of the base in it, 4 x 4: the base of the MJCF can be a link
        without mass, which is a frame of another body in the stage.
    """
    from pxr import Usd, UsdGeom

    prims = Usd.Stage.Open(str(stage))
    joints = [_name(prims.GetPrimAtPath(path), "joint") for path in model.joint_label]
    positions, places = model.joint_q.numpy(), model.joint_q_start.numpy()
    free = list(model.joint_type.numpy()).index(int(newton.JointType.FREE))
    for place, name in zip(places, joints, strict=False):
        if name in start.joints:
            positions[place] = start.joints[name]
    body = int(model.joint_child.numpy()[free])
    path = model.body_label[body]
    base = next(p for p in prims.Traverse() if _name(p, "link") == start.base)
    cache = UsdGeom.XformCache()
    inner, outer = (
        np.array(cache.GetLocalToWorldTransform(prim)).T
        for prim in (base, prims.GetPrimAtPath(path))
    )
    frame = np.linalg.inv(outer) @ inner
    pose = _matrix(start.pose) @ np.linalg.inv(frame)
    positions[places[free] :][:7] = [*pose[:3, 3], *Rotation.from_matrix(pose[:3, :3]).as_quat()]
    model.joint_q.assign(positions)
    return body, frame


def _name(prim: Any, kind: str) -> str:
    """Return the name that a link or joint has in the description; empty for other prims."""
    return str(prim.GetCustomDataByKey(f"urdf:{kind}") or prim.GetName()) if prim else ""


def _matrix(pose: np.ndarray) -> np.ndarray:
    """Return the 4 x 4 matrix of a position and a quaternion (x, y, z, w)."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = Rotation.from_quat(pose[3:]).as_matrix(), pose[:3]
    return matrix


def try_robot(path: Path) -> tuple[str, Start | None, list[np.ndarray] | str]:
    """Export a robot to both formats; step the MJCF, and the stage with each kind of cone."""
    from urdftool import export_mjcf, export_usd, load

    share = example_folder()
    paths = [path.parent] if share is None else [path.parent, share.parent]
    name = f"{path.parent.name}/{path.stem}"
    with tempfile.TemporaryDirectory() as folder:
        scene, stage = Path(folder, "m_scene.xml"), Path(folder, "m.usda")
        try:
            robot = load(path, package_paths=paths)
            export_mjcf(robot, f"{folder}/m.xml", scene=True, force=True)
            start = step_mujoco(scene)
            if start is None:
                return name, None, ""
            export_usd(robot, stage, force=True)
            return name, start, [step_newton(stage, start, cone) for cone in CONES]
        except Exception as error:
            return name, None, f"{type(error).__name__}: {' '.join(str(error).split())}"


def main(arguments: list[str]) -> int:
    """Print the drift of each robot in both engines, and the counts."""
    parser = argparse.ArgumentParser(prog="python -m measure.newton_standing", description=__doc__)
    parser.add_argument("robots", nargs="*", type=Path, help="Descriptions; default: all.")
    paths = parser.parse_args(arguments).robots or [*example_robots(), *bullet_robots()]
    counts: Counter[str] = Counter()
    with ProcessPoolExecutor(1) as pool:
        for name, start, motions in pool.map(try_robot, paths):
            if start is not None or motions:
                print(f"{name}: {_describe(start, motions, counts)}", flush=True)
    for name, count in counts.items():
        print(f"{name}: {count}")
    return 0


def _describe(start: Start | None, motions: list[np.ndarray] | str, counts: Counter[str]) -> str:
    if start is None or isinstance(motions, str):
        counts["not stepped"] += 1
        return str(motions)[:160]
    counts["stepped in both"] += 1
    text = f"MuJoCo {1000 * float(np.linalg.norm(start.motion)):.1f} mm"
    for cone, motion in zip(CONES, motions, strict=True):
        apart = float(np.linalg.norm(motion - start.motion))
        counts[f"equal within 1 cm, {cone}"] += apart < CLOSE
        drift = float(np.linalg.norm(motion))
        text += f"; {cone} {1000 * drift:.1f} mm, apart {1000 * apart:.1f} mm"
    return text


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
