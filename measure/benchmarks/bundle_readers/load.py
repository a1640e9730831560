"""Load descriptions with one reader, each in a process of its own: ``load.py READER``.

Standard input has one description a line; standard output gets one line of JSON for each. It runs
in the environment of the reader and imports nothing of urdftool.
"""

import json
import os
import signal
import sys
from pathlib import Path

SECONDS = 60


def load_mujoco(path):
    import mujoco

    model = mujoco.MjModel.from_xml_path(path)
    return {"mass": float(model.body_mass.sum())}


def load_pybullet(path):
    import pybullet

    pybullet.connect(pybullet.DIRECT)
    body = pybullet.loadURDF(path, useFixedBase=True)
    links = range(-1, pybullet.getNumJoints(body))
    return {"links": len(links)}


def load_pinocchio(path):
    import pinocchio

    model = pinocchio.buildModelFromUrdf(path)
    count = 0
    for kind in (pinocchio.GeometryType.VISUAL, pinocchio.GeometryType.COLLISION):
        folders = [str(Path(path).parent)]
        geometry = pinocchio.buildGeomFromUrdf(model, path, kind, package_dirs=folders)
        count += geometry.ngeoms
    return {"shapes": count}


def load_drake(path):
    from pydrake.geometry import SceneGraph
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
    from pydrake.systems.framework import DiagramBuilder

    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, 0.001)
    Parser(plant).AddModels(path)
    plant.Finalize()
    builder.Build().CreateDefaultContext()
    assert SceneGraph
    return {"links": plant.num_bodies() - 1}


def load_yourdfpy(path):
    import logging

    import yourdfpy

    logging.disable()
    robot = yourdfpy.URDF.load(path, load_collision_meshes=True, build_collision_scene_graph=True)
    for link in robot.robot.links:
        for shape in (*link.visuals, *link.collisions):
            mesh = shape.geometry.mesh if shape.geometry else None
            if mesh is not None and not os.path.isfile(robot._filename_handler(mesh.filename)):
                raise ValueError(f"mesh {mesh.filename} is not found")
    robot.update_cfg([0.0] * robot.num_actuated_joints)
    return {"links": len(robot.robot.links)}


def run(load, path):
    """Load a description in a child process; return its result."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        signal.alarm(SECONDS)
        quiet = os.open(os.devnull, os.O_WRONLY)
        os.dup2(quiet, 1)
        os.dup2(quiet, 2)
        os.chdir("/")
        try:
            answer = {"ok": True, **load(path)}
        except BaseException as error:
            answer = {"ok": False, "why": (str(error) or type(error).__name__)[:300]}
        os.write(write, json.dumps(answer).encode())
        os._exit(0)
    os.close(write)
    with os.fdopen(read, "rb") as stream:
        data = stream.read()
    _, status = os.waitpid(child, 0)
    return json.loads(data) if data else {"ok": False, "why": f"ended with status {status}"}


def main(reader):
    load = globals()[f"load_{reader}"]
    imports = {"pinocchio": "pinocchio", "drake": "pydrake.multibody.parsing"}
    __import__(imports.get(reader, reader))
    out = os.fdopen(os.dup(1), "w")
    for line in sys.stdin:
        out.write(json.dumps({"path": line.strip(), **run(load, line.strip())}) + "\n")
        out.flush()


if __name__ == "__main__":
    main(sys.argv[1])
