"""Dropped on a plane, every joint held: MuJoCo on the export, PyBullet on the source."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import mujoco
from mjcf_robots import example_folder, example_robots, export

from urdftool.formats.mjcf.joint import get_bounds
from urdftool.model.elements import Robot

ROBOTS = (
    "a1", "go1", "go2", "b1", "solo12", "laikago", "hyq_no_sensors", "tiago", "pr2", "baxter",
    "anymal", "iris", "anymal-kinova", "quadrotor_base", "b1-z1", "talos_reduced", "centauro",
)  # fmt: skip
SECONDS = 4.0
ABOVE = 0.01

FALL = """
import json, sys, pybullet as p
p.connect(p.DIRECT)
p.setGravity(0, 0, -9.81)
p.setAdditionalSearchPath(sys.argv[2])
held = json.loads(sys.argv[5])
shape = p.createCollisionShape(p.GEOM_PLANE)
p.createMultiBody(0, shape)
body = p.loadURDF(sys.argv[1], [0, 0, 0], flags=p.URDF_USE_INERTIA_FROM_FILE)
for joint in range(p.getNumJoints(body)):
    name, kind = p.getJointInfo(body, joint)[1:3]
    if kind != p.JOINT_FIXED:
        value = held.get(name.decode(), 0)
        p.resetJointState(body, joint, value)
        p.setJointMotorControl2(body, joint, p.POSITION_CONTROL, value, force=1e5)
p.performCollisionDetection()
low = min(p.getAABB(body, i)[0][2] for i in range(-1, p.getNumJoints(body))
          if p.getCollisionShapeData(body, i))
local = p.invertTransform(*p.getDynamicsInfo(body, -1)[3:5])
def height():
    return p.multiplyTransforms(*p.getBasePositionAndOrientation(body), *local)[0][2]
start = height() - low + float(sys.argv[3])
position, turn = p.getBasePositionAndOrientation(body)
raised = [position[0], position[1], position[2] + start - height()]
p.resetBasePositionAndOrientation(body, raised, turn)
for _ in range(int(240 * float(sys.argv[4]))):
    p.stepSimulation()
print("JSON" + json.dumps([start, height()]))
"""


def table(folder: Path, only: str) -> str:
    """The height of the root above the plane at rest, in both."""
    rows = ["| robot | PyBullet [m] | MuJoCo [m] | apart [mm] |", "|---|---|---|---|"]
    found = [path for path in example_robots(folder) if path.stem in ROBOTS and only in path.stem]
    for number, path in enumerate(found):
        made = export(
            path, folder / str(number), {"example-robot-data": example_folder().parent},
            base="free", actuators="none",
        )  # fmt: skip
        held = _held(made.robot) if made.robot is not None else {}
        expected = _in_pybullet(path, folder, held)
        if expected is None or made.model is None or made.robot is None:
            rows.append(f"| {path.stem} | - | - | {made.message or 'PyBullet does not load it'} |")
            continue
        start, rest = expected
        print(path.stem, start, rest, file=sys.stderr)
        height = _in_mujoco(made.model, made.robot.tree.roots[0].name, start, held)
        apart = abs(height - rest) * 1000
        rows.append(f"| {path.stem} | {rest:.4f} | {height:.4f} | {apart:.2f} |")
    return "\n".join(rows)


def _held(robot: Robot) -> dict[str, float]:
    """Each joint at zero, or at the bound that is nearest to it."""
    found = {}
    for joint in robot.moving_joints:
        low, high = get_bounds(joint) or (0.0, 0.0)
        found[joint.name] = min(max(0.0, low), high) if low <= high else 0.0
    return found


def _in_pybullet(path: Path, folder: Path, held: dict[str, float]) -> tuple[float, float] | None:
    """Where the root starts and where it comes to rest; package URIs are made paths."""
    text = path.read_text(encoding="utf-8", errors="replace")
    copy = folder / f"pybullet_{path.name}"
    parent = str(example_folder().parents[1])
    copy.write_text(text.replace("package://", parent + "/"), encoding="utf-8")
    command = [
        sys.executable,
        "-c",
        FALL,
        str(copy),
        parent,
        str(ABOVE),
        str(SECONDS),
        json.dumps(held),
    ]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode:
        print(path.stem, run.returncode, run.stderr[-300:], file=sys.stderr)
    line = next((line[4:] for line in run.stdout.splitlines() if line.startswith("JSON")), None)
    return None if line is None else tuple(json.loads(line))


def _in_mujoco(model: Path, root: str, start: float, at: dict[str, float]) -> float:
    spec = mujoco.MjSpec.from_file(str(model))
    floor = spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1])
    # stiff: at MuJoCo's defaults light feet under a heavy body sink in by millimetres
    floor.priority, floor.solref, floor.solimp = 1, [0.004, 1], [0.99, 0.999, 0.001, 0.5, 2]
    spec.option.timestep = 0.001
    for joint in spec.joints:
        if joint.type in (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE):
            held = spec.add_equality(type=mujoco.mjtEq.mjEQ_JOINT, name1=joint.name)
            held.objtype = mujoco.mjtObj.mjOBJ_JOINT
            held.solref = [0.004, 1]
            held.data[0] = at.get(joint.name, 0.0)
    compiled = spec.compile()
    data = mujoco.MjData(compiled)
    free = compiled.jnt_qposadr[0]
    data.qpos[free + 2] = start
    for name, value in at.items():
        if mujoco.mj_name2id(compiled, mujoco.mjtObj.mjOBJ_JOINT, name) >= 0:
            data.joint(name).qpos = value
    while data.time < SECONDS:
        mujoco.mj_step(compiled, data)
    return float(data.body(root).xpos[2])
