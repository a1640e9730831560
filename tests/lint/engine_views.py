"""A URDF as physics engines load it: kinematics, masses, inertia, collision shapes and limits.

``python -m tests.lint.engine_views ENGINE`` is a process of its own, since PyBullet ends the
process on some robots: each line of its input is the path of a URDF, each line of its output one
JSON object, or ``{"error": …}`` where the engine does not load it.
"""

import json
import math
import os
import select
import subprocess
import sys
from pathlib import Path

ENGINES = ("pinocchio", "pybullet", "mujoco")


def pinocchio_view(path):
    """Joints, frames, limits, masses and shapes, by name."""
    import numpy
    import pinocchio

    try:
        model = pinocchio.buildModelFromUrdf(path, True)
    except ValueError:  # it takes a leader on the way to the root only
        model = pinocchio.buildModelFromUrdf(path)
    view, half = {"name": model.name}, _half(model)
    for number in range(model.njoints):
        name, joint, inertia = model.names[number], model.joints[number], model.inertias[number]
        place = model.jointPlacements[number]
        q = slice(joint.idx_q, joint.idx_q + joint.nq) if number else slice(0, 0)
        v = slice(joint.idx_v, joint.idx_v + joint.nv) if number else slice(0, 0)
        view[f"joint {name}"] = {
            "parent": model.names[model.parents[number]],
            "freedom": [joint.nq, joint.nv],
            "place": [*place.translation, *place.rotation.ravel()],
            "moved": _moved(joint, half) if number else [],
            "mass": inertia.mass,
            "lever": [*(inertia.mass * inertia.lever)],
            "inertia": [*inertia.matrix()[3:, 3:].ravel()],
            "lower": [*model.lowerPositionLimit[q]],
            "upper": [*model.upperPositionLimit[q]],
            "effort": [*model.upperEffortLimit[v]],
            "velocity": [*model.upperVelocityLimit[v]],
            "damping": [*model.upperDryFrictionLimit[v], *model.damping[v]],
        }
    if list(model.mimicking_joints):
        view["mimic"] = [
            [model.names[j] for j in (*model.mimicking_joints, *model.mimicked_joints)],
            *([model.joints[j].scaling, model.joints[j].offset] for j in model.mimicking_joints),
        ]
    for frame in model.frames:
        matrix = frame.placement
        view[f"frame {frame.type} {frame.name}"] = {
            "joint": model.names[frame.parentJoint],
            "place": [*matrix.translation, *matrix.rotation.ravel()],
        }
    try:
        geometry = pinocchio.buildGeomFromUrdf(model, path, pinocchio.GeometryType.COLLISION)
    except Exception as error:
        return view | {"collisions": {"error": str(error)}}
    for item in geometry.geometryObjects:
        item.geometry.computeLocalAABB()
        box = item.geometry.aabb_local
        view[f"collision {item.name}"] = {
            "joint": model.names[item.parentJoint],
            "place": [*item.placement.translation, *item.placement.rotation.ravel()],
            "type": type(item.geometry).__name__,
            "size": [*numpy.ravel(box.min_), *numpy.ravel(box.max_), *item.meshScale],
            "mesh": os.path.basename(item.meshPath),
        }
    return view


def _half(model):
    """A configuration in which every joint with one axis stands at a half."""
    import pinocchio

    q = pinocchio.neutral(model)
    for joint in model.joints:
        if joint.nq == 1:
            q[joint.idx_q] = 0.5
        elif (joint.nq, joint.nv) == (2, 1):
            q[joint.idx_q : joint.idx_q + 2] = math.cos(0.5), math.sin(0.5)
    return q


def _moved(joint, q):
    """Where a joint takes its child, which shows its axis; empty for one that mimics."""
    data = joint.createData()
    try:
        joint.calc(data, q)
    except Exception:
        return []
    return [*data.M.translation, *data.M.rotation.ravel()]


def pybullet_view(path):
    """Joints, limits, masses and shapes by number; inertia as computed and as in the file."""
    import pybullet

    view = {}
    for how, flags in (("computed", 0), ("file", pybullet.URDF_USE_INERTIA_FROM_FILE)):
        client = pybullet.connect(pybullet.DIRECT)
        try:
            body = pybullet.loadURDF(path, flags=flags, physicsClientId=client)
            view |= _pybullet_body(pybullet, body, client, how)
        finally:
            pybullet.disconnect(client)
    return view


def _pybullet_body(pybullet, body, client, how):
    at = {"physicsClientId": client}
    view = {"base": [name.decode() for name in pybullet.getBodyInfo(body, **at)]}
    names = [view["base"][0]]
    for number in range(pybullet.getNumJoints(body, **at)):
        info = pybullet.getJointInfo(body, number, **at)
        link = info[12].decode()
        names.append(link)
        moves = info[2] != pybullet.JOINT_FIXED
        view[f"joint {info[1].decode()}"] = {
            "link": link,
            "parent": info[16],
            "type": info[2],
            "axis": [*info[13]] if moves else [],
            "place": [*info[14], *info[15]],
            "limits": [*info[6:12]] if moves else [],
        }
    for number, name in enumerate(names, -1):
        dynamics = pybullet.getDynamicsInfo(body, number, **at)
        view[f"{how} link {name}"] = {
            "mass": dynamics[0],
            "inertia": [*dynamics[2]],
            "place": [*dynamics[3], *dynamics[4]],
            "contact": [dynamics[1], *dynamics[5:10]],
        }
        view[f"shapes of {name}"] = [
            [shape[2], [*shape[3]], os.path.basename(shape[4].decode()), [*shape[5]], [*shape[6]]]
            for shape in pybullet.getCollisionShapeData(body, number, **at)
        ]
        view[f"box of {name}"] = [*pybullet.getAABB(body, number, **at)]
    return view


def mujoco_view(path):
    """Bodies, joints, geoms and equalities by name."""
    import mujoco
    import numpy

    model = mujoco.MjModel.from_xml_path(path)
    kinds = mujoco.mjtObj

    def name(kind, number):
        return mujoco.mj_id2name(model, kind, number) or f"#{number}"

    view = {}
    for body in range(model.nbody):
        frame = numpy.zeros(9)
        mujoco.mju_quat2Mat(frame, model.body_iquat[body])
        turn = frame.reshape(3, 3)
        view[f"body {name(kinds.mjOBJ_BODY, body)}"] = {
            "parent": name(kinds.mjOBJ_BODY, model.body_parentid[body]),
            "place": [*model.body_pos[body], *model.body_quat[body]],
            "mass": model.body_mass[body],
            "lever": [*(model.body_mass[body] * model.body_ipos[body])],
            "inertia": [*(turn @ numpy.diag(model.body_inertia[body]) @ turn.T).ravel()],
        }
    for joint in range(model.njnt):
        dof = model.jnt_dofadr[joint]
        view[f"joint {name(kinds.mjOBJ_JOINT, joint)}"] = {
            "body": name(kinds.mjOBJ_BODY, model.jnt_bodyid[joint]),
            "type": int(model.jnt_type[joint]),
            "axis": [*model.jnt_axis[joint]],
            "place": [*model.jnt_pos[joint]],
            "range": [int(model.jnt_limited[joint]), *model.jnt_range[joint]],
            "effort": [int(model.jnt_actfrclimited[joint]), *model.jnt_actfrcrange[joint]],
            "damping": [*numpy.ravel(model.dof_damping[dof]), model.dof_frictionloss[dof]],
        }
    geoms = {}
    for geom in range(model.ngeom):
        mesh = model.geom_dataid[geom]
        owner = name(kinds.mjOBJ_BODY, model.geom_bodyid[geom])
        geoms.setdefault(owner, []).append(
            [
                int(model.geom_type[geom]),
                [*model.geom_size[geom], *model.geom_pos[geom], *model.geom_quat[geom]],
                [int(model.geom_contype[geom]), int(model.geom_conaffinity[geom])],
                [*model.geom_friction[geom]],
                _mesh(model, mesh) if mesh >= 0 else [],
            ]
        )
    view |= {f"geoms of {owner}": shapes for owner, shapes in geoms.items()}
    for number in range(model.neq):
        view[f"equality {number}"] = [
            int(model.eq_type[number]),
            [int(model.eq_obj1id[number]), int(model.eq_obj2id[number])],
            [*model.eq_data[number]],
        ]
    return view


def _mesh(model, number):
    """What MuJoCo keeps of a mesh: how many vertices, and the box around them."""
    start, count = model.mesh_vertadr[number], model.mesh_vertnum[number]
    vertices = model.mesh_vert[start : start + count]
    return [int(count), [*vertices.min(axis=0), *vertices.max(axis=0)]]


VIEWS = {"pinocchio": pinocchio_view, "pybullet": pybullet_view, "mujoco": mujoco_view}


def _plain(value):
    """Numbers of any library as JSON has them."""
    if isinstance(value, dict):
        return {key: _plain(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    if isinstance(value, str | int):
        return value
    return float(value)


class Engine:
    """An engine in a process of its own, started again where it died."""

    def __init__(self, name, folder):
        """Start with no process; what engines log is written into the folder."""
        self.name = name
        self.folder = folder
        self.process = None

    def view(self, path, seconds=120):
        """What the engine knows of a URDF, or ``{"error": …}``."""
        if self.process is None:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "tests.lint.engine_views", self.name],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                cwd=self.folder,
                env=os.environ | {"PYTHONPATH": str(Path(__file__).resolve().parents[2])},
                text=True,
            )
        try:
            self.process.stdin.write(f"{path}\n")
            self.process.stdin.flush()
            ready, _, _ = select.select([self.process.stdout], [], [], seconds)
            answer = self.process.stdout.readline() if ready else ""
        except BrokenPipeError:
            answer = ""
        if not answer:
            self.close()
            return {"error": "the engine ended the process, or took too long"}
        return json.loads(answer)

    def close(self):
        """End the process."""
        if self.process is not None:
            self.process.kill()
            self.process.wait()
            self.process.stdout.close()
            self.process = None


def difference(before, after, *, relative=1e-6, absolute=1e-9, where=""):
    """The first thing in which two views differ, in words; empty where they are alike."""
    if isinstance(before, dict) and isinstance(after, dict):
        if before.keys() != after.keys():
            return f"{where}: {sorted(before.keys() ^ after.keys())[:3]} on one side only"
        found = (
            difference(before[key], after[key], relative=relative, where=f"{where} {key}")
            for key in before
        )
        return next((one for one in found if one), "")
    if isinstance(before, list) and isinstance(after, list):
        if len(before) != len(after):
            return f"{where}: {before} → {after}"
        numbers = [one for one in before if isinstance(one, float)]
        scale = max((abs(one) for one in numbers if math.isfinite(one)), default=0.0)
        for one, other in zip(before, after, strict=True):
            if isinstance(one, float) and isinstance(other, float):
                near = abs(one - other) <= absolute + relative * scale
                if not (one == other or near or (math.isnan(one) and math.isnan(other))):
                    return f"{where}: {before} → {after}"
            else:
                inside = difference(one, other, relative=relative, where=where)
                if inside:
                    return inside
        return ""
    if isinstance(before, float) and isinstance(after, int | float):
        return difference([before], [float(after)], relative=relative, where=where)
    return "" if before == after else f"{where}: {before} → {after}"


def main(name):
    """Answer line by line; what engines print themselves goes to nowhere."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    for line in sys.stdin:
        try:
            answer = _plain(VIEWS[name](line.rstrip("\n")))
        except Exception as error:
            answer = {"error": f"{type(error).__name__}: {error}"[:300]}
        answers.write(json.dumps(answer) + "\n")
        answers.flush()


if __name__ == "__main__":
    main(sys.argv[1])
