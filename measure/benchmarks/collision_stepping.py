"""How fast engines step: ``python -m measure.benchmarks.collision_stepping FILE...``, as a table.

A file is a robot, or a mesh, which becomes a robot of one free link. Its visual meshes as
collisions stand beside what ``auto`` makes of them. Of a mesh of a body that moves MuJoCo takes the
hull when it compiles the model, and so does PyBullet when it loads it, unless ``concave="yes"`` is
written, when it tests triangle by triangle; all three are timed. The robot falls on the ground,
limp, and settles for two seconds, or as far as eight seconds of processor time reach; then a step's
processor time is taken, and that of loading the file: medians of three turns, the variants one
after the other. Words that are no files are options of ``urdftool collision``.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

import numpy as np

from urdftool.collision.mesh_files import encode_mesh
from urdftool.collision.piece import make_mesh_piece
from urdftool.collision.surface import read_surface
from urdftool.model.elements import Mesh
from urdftool.model.load import load

TURNS = 3

BULLET = """
import json, sys, time, pybullet as p
p.connect(p.DIRECT)
p.setTimeStep(0.002)
p.setGravity(0, 0, -9.81)
ground = p.createCollisionShape(p.GEOM_BOX, halfExtents=[50, 50, 1])
p.createMultiBody(0, ground, basePosition=[0, 0, -1])
flags = p.URDF_USE_INERTIA_FROM_FILE | p.URDF_USE_SELF_COLLISION_EXCLUDE_PARENT
begin = time.process_time()
body = p.loadURDF(sys.argv[1], [0, 0, float(sys.argv[2])], flags=flags)
load = time.process_time() - begin
for joint in range(p.getNumJoints(body)):
    p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, force=0)
def steps(most, seconds):
    begin = time.process_time()
    for done in range(1, most + 1):
        p.stepSimulation()
        if time.process_time() - begin > seconds:
            break
    return (time.process_time() - begin) / done
steps(1000, 8)
seconds = steps(300, 3)
contacts = len(p.getContactPoints(body))
print("STEP " + json.dumps([seconds, contacts, load]))
"""

MUJOCO = """
import json, sys, time, mujoco
begin = time.process_time()
model = mujoco.MjModel.from_xml_path(sys.argv[1])
load = time.process_time() - begin
model.opt.timestep = 0.002
data = mujoco.MjData(model)
def steps(most, seconds):
    begin = time.process_time()
    for done in range(1, most + 1):
        mujoco.mj_step(model, data)
        if time.process_time() - begin > seconds:
            break
    return (time.process_time() - begin) / done
steps(1000, 8)
seconds = steps(300, 3)
print("STEP " + json.dumps([seconds, data.ncon, load]))
"""

ROBOT = """<robot name="part">
  <link name="part">
    <inertial>
      <origin xyz="{center}"/><mass value="1"/>
      <inertia ixx="{xx}" ixy="0" ixz="0" iyy="{yy}" iyz="0" izz="{zz}"/>
    </inertial>
    <visual><geometry><mesh filename="{mesh}"/></geometry></visual>
  </link>
</robot>
"""


def of_one_link(mesh: Path, folder: Path) -> Path:
    """A robot of one link with the inertia of the mesh's box, at 1 kg."""
    surface = read_surface(mesh)
    stl = folder / "part.stl"
    stl.write_bytes(encode_mesh([make_mesh_piece(surface.vertices, surface.faces)], ".stl"))
    x, y, z = np.ptp(surface.vertices, axis=0) ** 2 / 12
    center = " ".join(f"{v:.6g}" for v in surface.vertices.mean(axis=0))
    robot = folder / "part.urdf"
    robot.write_text(
        ROBOT.format(center=center, xx=y + z, yy=x + z, zz=x + y, mesh="part.stl"), "utf-8"
    )
    return robot


def with_visuals_as_collisions(source: Path, target: Path, *, concave: bool) -> int:
    """Write the robot with its visual meshes, as STL files, as collisions; their triangles."""
    from lxml import etree

    robot = load(source)
    # without its declaration: some say version 0.0, which lxml refuses
    root = etree.fromstring(re.sub(rb"^\s*<\?xml.*?\?>", b"", source.read_bytes()))
    attributes = {"concave": "yes"} if concave else {}
    triangles = 0
    for link, element in zip(robot.links, root.findall("link"), strict=True):
        for old in element.findall("collision"):
            element.remove(old)
        for number, visual in enumerate(link.visuals):
            if not isinstance(visual.geometry, Mesh):
                continue
            surface = read_surface(
                robot.source.resolve(visual.geometry.filename), visual.geometry.scale
            )
            triangles += len(surface.faces)
            name = f"{link.name}_{number}.stl".replace("/", "_")
            piece = make_mesh_piece(surface.vertices, surface.faces)
            (target.parent / name).write_bytes(encode_mesh([piece], ".stl"))
            collision = etree.SubElement(element, "collision", attributes)
            if visual.origin is not None:
                etree.SubElement(collision, "origin", dict(visual.origin.element.attributes))
            geometry = etree.SubElement(collision, "geometry")
            etree.SubElement(geometry, "mesh", filename=name)
        for visual in element.findall("visual"):
            element.remove(visual)
    target.write_bytes(etree.tostring(root))
    return triangles


def urdftool(*words: object) -> None:
    command = [sys.executable, "-m", "urdftool", "-q", *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr)


Run = tuple[float, int, float]


def step(code: str, *words: object) -> Run:
    """Seconds a step, contacts, and seconds to load; not a number where the engine dies."""
    command = [sys.executable, "-c", code, *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    found = done.stdout.rpartition("STEP ")[2]
    if done.returncode or not found:
        sys.stderr.write(done.stderr)
        return float("nan"), 0, float("nan")
    seconds, contacts, load = json.loads(found.splitlines()[0])
    return seconds, contacts, load


def rows(path: Path, options: list[str]) -> list[str]:
    """A line an engine."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if path.suffix.lower() not in (".urdf", ".xacro"):
            source = of_one_link(path, folder)
        else:
            source = folder / "source.urdf"
            skips = [w for link in load(path).links for w in ("--skip-link", link.name)]
            urdftool("collision", path, "-o", source, "--uri", "relative", *skips)
        hulls, concave, ours = (folder / f"{n}.urdf" for n in ("hulls", "concave", "ours"))
        triangles = with_visuals_as_collisions(source, hulls, concave=False)
        with_visuals_as_collisions(source, concave, concave=True)
        urdftool("collision", source, "-o", ours, "--replace-primitives", *options)
        pieces = sum(len(link.collisions) for link in load(ours).links)
        for robot in (hulls, ours):
            words = ("--base", "free", "--scene", "--force", "--actuators", "none")
            urdftool("export", "mjcf", robot, "-o", folder / f"{robot.stem}_mjcf", *words)
        height = height_of(source)
        runs: dict[str, list[Run]] = {}
        for turn in range(TURNS):
            for robot in (hulls, concave, ours):
                print(f"{path.name}: turn {turn + 1}, {robot.stem}", file=sys.stderr)
                found = step(BULLET, robot, height)
                runs.setdefault(f"bullet {robot.stem}", []).append(found)
            for robot in (hulls, ours):
                found = step(MUJOCO, folder / f"{robot.stem}_mjcf" / "scene.xml")
                runs.setdefault(f"mujoco {robot.stem}", []).append(found)
    lines = []
    for label, before, after in (
        ("PyBullet, concave", "bullet concave", "bullet ours"),
        ("PyBullet, hulls", "bullet hulls", "bullet ours"),
        ("MuJoCo, hulls", "mujoco hulls", "mujoco ours"),
    ):
        theirs, own = (median(run[0] for run in runs[key]) for key in (before, after))
        load_theirs, load_own = (median(run[2] for run in runs[key]) for key in (before, after))
        lines.append(
            f"| {path.name} | {triangles:,} | {pieces} | {label} "
            f"| {theirs * 1e6:,.0f} µs ({runs[before][-1][1]}) "
            f"| {own * 1e6:,.0f} µs ({runs[after][-1][1]}) | {theirs / own:.1f} "
            f"| {load_theirs:.2f} s | {load_own:.2f} s |"
        )
    return lines


def height_of(robot: Path) -> float:
    """A height [m] of the root at which all of it is above the ground."""
    from urdftool.collision.check import convert_shape
    from urdftool.model.kinematics import link_poses

    read = load(robot)
    low = 0.0
    for link in read.links:
        pose = link_poses(read)[link.name]
        for visual in link.visuals:
            for piece in convert_shape(read, visual):
                placed = piece.transform(np.array(pose.rotation), np.array(pose.translation))
                low = min(low, float(placed.vertices[:, 2].min()))
    return 0.01 - low


def main(words: list[str]) -> None:
    """Print the table."""
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    files = [word for word in words if Path(word).is_file()]
    options = [word for word in words if word not in files]
    print("| robot | visual triangles | pieces | engine | step | ours | ratio | load | ours |")
    print("|---|---|---|---|---|---|---|---|---|")
    for word in files:
        print("\n".join(rows(Path(word), options)), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
