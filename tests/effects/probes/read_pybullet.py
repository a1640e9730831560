"""Print what PyBullet makes of a URDF file, as JSON, on the last line of the output."""

import json
import sys

import pybullet

JOINTS = {0: "revolute", 1: "prismatic", 2: "spherical", 3: "planar", 4: "fixed", 6: "gear"}
SHAPES = {2: "sphere", 3: "box", 4: "cylinder", 5: "mesh", 6: "plane", 7: "capsule"}


def numbers(values):
    return [float(f"{value:.6g}") for value in values]


def facts(path, flags):
    """Links, joints and shapes of a loaded body."""
    body = pybullet.loadURDF(path, flags=flags)
    links, joints = {}, {}
    root = pybullet.getBodyInfo(body)[0].decode()
    links[root] = link(body, -1)
    for number in range(pybullet.getNumJoints(body)):
        info = pybullet.getJointInfo(body, number)
        joints[info[1].decode()] = {
            "type": JOINTS.get(info[2], str(info[2])),
            "damping": float(f"{info[6]:.6g}"),
            "friction": float(f"{info[7]:.6g}"),
            "lower": float(f"{info[8]:.6g}"),
            "upper": float(f"{info[9]:.6g}"),
            "effort": float(f"{info[10]:.6g}"),
            "velocity": float(f"{info[11]:.6g}"),
            "axis": numbers(info[13]),
            "parent": links_name(body, info[16]),
        }
        links[info[12].decode()] = link(body, number)
    for shape in pybullet.getVisualShapeData(body):
        entry = links[links_name(body, shape[1])]
        kind = {"shape": SHAPES.get(shape[2], str(shape[2])), "size": numbers(shape[3])}
        entry["visuals"].append({**kind, "color": numbers(shape[7])})
    return {"links": links, "joints": joints, "root": root}, body


def links_name(body, number):
    if number < 0:
        return pybullet.getBodyInfo(body)[0].decode()
    return pybullet.getJointInfo(body, number)[12].decode()


def link(body, number):
    found = pybullet.getDynamicsInfo(body, number)
    shapes = [
        {"shape": SHAPES.get(s[2], str(s[2])), "size": numbers(s[3]), "xyz": numbers(s[5])}
        for s in pybullet.getCollisionShapeData(body, number)
    ]
    inertia = {"mass": float(f"{found[0]:.6g}"), "principal": numbers(found[2])}
    if found[5] or found[8:10] != (-1, -1):
        inertia["restitution, damping, stiffness"] = numbers((found[5], *found[8:10]))
    return {**inertia, "friction": float(f"{found[1]:.6g}"), "visuals": [], "collisions": shapes}


def motion(path):
    """Where a force of 1 (N or Nm) takes each joint in 0.1 s and in 2 s, without gravity."""
    pushed, reached = {}, {}
    number = 0
    while True:
        pybullet.resetSimulation()
        pybullet.setTimeStep(0.001)
        body = pybullet.loadURDF(path, useFixedBase=1, flags=pybullet.URDF_USE_INERTIA_FROM_FILE)
        if number >= pybullet.getNumJoints(body):
            return pushed, reached
        for each in range(pybullet.getNumJoints(body)):
            if pybullet.getJointInfo(body, each)[2] in (0, 1):
                pybullet.setJointMotorControl2(body, each, pybullet.VELOCITY_CONTROL, force=0)
        info = pybullet.getJointInfo(body, number)
        if info[2] in (0, 1):
            name = info[1].decode()
            for step in range(2000):
                pybullet.setJointMotorControl2(body, number, pybullet.TORQUE_CONTROL, force=1)
                pybullet.stepSimulation()
                if step == 99:
                    pushed[name] = float(f"{pybullet.getJointState(body, number)[0]:.3g}")
            reached[name] = float(f"{pybullet.getJointState(body, number)[0]:.2g}")
        number += 1


def contacts(path):
    """How many pairs of links of the robot touch where all joints are at zero."""
    pybullet.resetSimulation()
    body = pybullet.loadURDF(path, flags=pybullet.URDF_USE_SELF_COLLISION)
    pybullet.performCollisionDetection()
    return len({(point[3], point[4]) for point in pybullet.getContactPoints(body, body)})


def is_fixed(path):
    """Whether a second of gravity leaves the root where it is."""
    pybullet.resetSimulation()
    pybullet.setGravity(0, 0, -9.81)
    body = pybullet.loadURDF(path)
    before = pybullet.getBasePositionAndOrientation(body)[0][2]
    for _ in range(100):
        pybullet.stepSimulation()
    return abs(pybullet.getBasePositionAndOrientation(body)[0][2] - before) < 1e-6


pybullet.connect(pybullet.DIRECT)
try:
    result, _ = facts(sys.argv[1], 0)
    result = {"outcome": "loads", **result}
    pybullet.resetSimulation()
    from_file, _ = facts(sys.argv[1], pybullet.URDF_USE_INERTIA_FROM_FILE)
    result["with URDF_USE_INERTIA_FROM_FILE"] = {
        name: {key: values[key] for key in ("mass", "principal")}
        for name, values in from_file["links"].items()
    }
    result["pushed"], result["reached"] = motion(sys.argv[1])
    result["contacts"] = contacts(sys.argv[1])
    result["root fixed"] = is_fixed(sys.argv[1])
except pybullet.error as error:
    result = {"outcome": "rejects", "error": str(error)}
print()
print(json.dumps(result))
