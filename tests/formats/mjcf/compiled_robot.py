"""A robot read from MJCF beside MuJoCo's compiled model: frames, masses and mass matrix."""

import mujoco
import numpy as np

from urdftool.model.kinematics import compute_motion
from urdftool.model.pose import make_pose


def matrix(pose):
    made = np.eye(4)
    made[:3, :3], made[:3, 3] = pose.rotation, pose.translation
    return made


def turned(quaternion):
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, np.asarray(quaternion, dtype=float))
    made = np.eye(4)
    made[:3, :3] = rotation.reshape(3, 3)
    return made


def free(seven):
    made = turned(seven[3:])
    made[:3, 3] = seven[:3]
    return made


def body_links(robot):
    """Return the links of the bodies, in the order of MuJoCo."""
    return [link for link in robot.links if not link.is_virtual and link.name != "world"]


class Posed:
    """Frames and columns of the Jacobian of a robot at MuJoCo's ``qpos``."""

    def __init__(self, robot, model, qpos):
        self.robot, self.model, self.qpos = robot, model, qpos
        self.columns, self.armature, self.count = {}, [], 0
        root = robot.tree.root.name
        self.frames = {root: np.eye(4)}
        own = []
        if robot.base is not None and robot.base.is_free:
            self.frames[root] = free(qpos[:7])
            own = self._free(self.frames[root])
            self.armature, self.count = list(model.dof_armature[:6]), 1
        elif robot.base is not None:
            self.frames[root] = matrix(make_pose(robot.base.origin))
        self.columns[root] = list(enumerate(own))
        self.freedom = len(own)
        for joint in robot.joints:
            self._add(joint)

    def _free(self, frame):
        along = [(axis, None) for axis in np.eye(3)]
        return [*along, *((frame[:3, k], frame[:3, 3], None) for k in range(3))]

    def _add(self, joint):
        frame, own = self.frames[joint.parent] @ matrix(make_pose(joint.origin)), []
        if joint.type != "fixed":
            address = self.model.jnt_qposadr[self.count]
            assert self.model.joint(self.count).name in ("", joint.name)
            self.count += 1
            if joint.type == "floating":
                frame = free(self.qpos[address : address + 7])
                own = self._free(frame)
            elif joint.type == "ball":
                frame = frame @ turned(self.qpos[address : address + 4])
                own = [(frame[:3, k], frame[:3, 3], None) for k in range(3)]
            else:
                axis = frame[:3, :3] @ joint.axis.xyz
                slides = joint.type == "prismatic"
                own = [(axis, None) if slides else (axis, frame[:3, 3].copy(), None)]
                frame = frame @ matrix(compute_motion(joint, self.qpos[address]))
            inertia = joint.dynamics.armature if joint.dynamics is not None else None
            self.armature += [inertia or 0.0] * len(own)
        self.frames[joint.child] = frame
        numbered = enumerate(own, self.freedom)
        self.columns[joint.child] = [*self.columns[joint.parent], *numbered]
        self.freedom += len(own)

    def mass_matrix(self):
        whole = np.diag(np.array(self.armature, dtype=float)) if self.armature else np.zeros((0, 0))
        for link in body_links(self.robot):
            if link.inertial is None:
                continue
            frame = self.frames[link.name] @ matrix(make_pose(link.inertial.origin))
            linear, angular = np.zeros((2, 3, self.freedom))
            for column, (axis, *point) in self.columns[link.name]:
                if len(point) == 1:
                    linear[:, column] = axis
                else:
                    angular[:, column] = axis
                    linear[:, column] = np.cross(axis, frame[:3, 3] - point[0])
            tensor = frame[:3, :3] @ np.diag(link.inertial.inertia.moments) @ frame[:3, :3].T
            whole += link.inertial.mass * linear.T @ linear + angular.T @ tensor @ angular
        return whole


def random_positions(model, random):
    positions = model.qpos0.copy()
    for joint in range(model.njnt):
        address, kind = model.jnt_qposadr[joint], mujoco.mjtJoint(model.jnt_type[joint])
        if kind in (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE):
            positions[address] += random.uniform(-1, 1)
            continue
        if kind == mujoco.mjtJoint.mjJNT_FREE:
            positions[address : address + 3] = random.uniform(-1, 1, 3)
            address += 3
        four = random.normal(size=4)
        positions[address : address + 4] = four / np.linalg.norm(four)
    return positions


def differences(robot, path):
    """Return the largest differences of frames [m, 1], masses and mass matrix (relative)."""
    model = mujoco.MjModel.from_xml_path(str(path))
    data, random = mujoco.MjData(model), np.random.default_rng(0)
    links = body_links(robot)
    assert len(links) == model.nbody - 1
    bodies = [frame for frame in robot.frames if frame.kind == "body"]
    written = {frame.link: matrix(make_pose(frame.origin)) for frame in bodies}
    worst = {"frame": 0.0, "mass": 0.0, "matrix": 0.0}
    for positions in (model.qpos0, *(random_positions(model, random) for _ in range(2))):
        data.qpos[:] = positions
        mujoco.mj_forward(model, data)
        posed = Posed(robot, model, positions)
        assert (posed.count, posed.freedom) == (model.njnt, model.nv)
        for number, link in enumerate(links, 1):
            assert model.body(number).name in ("", link.name)
            frame = posed.frames[link.name] @ written.get(link.name, np.eye(4))
            worst["frame"] = max(
                worst["frame"],
                abs(frame[:3, 3] - data.xpos[number]).max(),
                abs(frame[:3, :3].ravel() - data.xmat[number]).max(),
            )
            off = abs(link.mass - model.body_mass[number])
            worst["mass"] = max(worst["mass"], off / max(link.mass, 1e-9))
        if model.nv:
            full = full_matrix(model, data)
            off = abs(posed.mass_matrix() - full).max() / max(1.0, abs(full).max())
            worst["matrix"] = max(worst["matrix"], off)
    return worst


def full_matrix(model, data):
    full = np.zeros((model.nv, model.nv))
    try:
        mujoco.mj_fullM(model, data, full)
    except TypeError:  # before MuJoCo 4
        mujoco.mj_fullM(model, full, data.qM)
    return full
