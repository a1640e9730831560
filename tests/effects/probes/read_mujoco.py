"""Print what MuJoCo makes of a URDF file, as JSON, on the last line of the output."""

import json
import sys

import mujoco

SHAPES = ["plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh"]
JOINTS = ["floating", "spherical", "prismatic", "revolute"]


def numbers(values):
    return [float(f"{value:.9g}") for value in values]


def facts(model):
    """Bodies, joints, shapes and constraints of a compiled model."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    links = {
        name_of(model, mujoco.mjtObj.mjOBJ_BODY, i): {
            "mass": float(f"{model.body_mass[i]:.9g}"),
            "com": numbers(model.body_ipos[i]),
            "principal": numbers(model.body_inertia[i]),
            "position": numbers(data.xpos[i]),
            "shapes": [shape(model, g) for g in range(model.ngeom) if model.geom_bodyid[g] == i],
        }
        for i in range(model.nbody)
    }
    joints = {}
    for j in range(model.njnt):
        dof, low_high = model.jnt_dofadr[j], model.jnt_range[j]
        force = model.jnt_actfrcrange[j]
        joints[name_of(model, mujoco.mjtObj.mjOBJ_JOINT, j)] = {
            "type": JOINTS[model.jnt_type[j]],
            "axis": numbers(model.jnt_axis[j]),
            "limited": bool(model.jnt_limited[j]),
            "lower": float(f"{low_high[0]:.9g}"),
            "upper": float(f"{low_high[1]:.9g}"),
            "effort limited": bool(model.jnt_actfrclimited[j]),
            "effort": float(f"{force[1]:.9g}"),
            "damping": float(f"{model.dof_damping[dof].flat[0]:.9g}"),
            "friction": float(f"{model.dof_frictionloss[dof]:.9g}"),
        }
    kinds = [mujoco.mjtEq(kind).name.removeprefix("mjEQ_").lower() for kind in model.eq_type]
    meshes = {
        name_of(model, mujoco.mjtObj.mjOBJ_MESH, i): int(model.mesh_facenum[i])
        for i in range(model.nmesh)
    }
    found = {"links": links, "joints": joints, "constraints": kinds, "meshes": meshes}
    found["contacts"] = int(data.ncon)
    return {"outcome": "loads", **found, **motion(model)}


def shape(model, geom):
    kind = SHAPES[model.geom_type[geom]]
    found = {
        "shape": kind,
        "size": numbers(model.geom_size[geom]),
        "xyz": numbers(model.geom_pos[geom]),
    }
    found["contact"] = bool(model.geom_contype[geom])
    found["color"] = numbers(model.geom_rgba[geom])
    name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_GEOM, geom)
    return {**found, "name": name} if name else found


def name_of(model, kind, number):
    return mujoco.mj_id2name(model, kind, number) or f"#{number}"


def motion(model):
    """Where a force of 1 (N or Nm) takes each joint in 0.1 s and in 2 s, without gravity."""
    model.opt.gravity[:] = 0
    model.opt.timestep = 0.001
    pushed, reached = {}, {}
    for j in range(model.njnt):
        if model.jnt_type[j] < 2:
            continue
        data = mujoco.MjData(model)
        address = model.jnt_qposadr[j]
        name = name_of(model, mujoco.mjtObj.mjOBJ_JOINT, j)
        for step in range(2000):
            data.qfrc_applied[model.jnt_dofadr[j]] = 1
            mujoco.mj_step(model, data)
            if step == 99:
                pushed[name] = float(f"{data.qpos[address]:.3g}")
        reached[name] = float(f"{data.qpos[address]:.2g}")
    return {"pushed": pushed, "reached": reached}


try:
    result = facts(mujoco.MjModel.from_xml_path(sys.argv[1]))
except ValueError as error:
    result = {"outcome": "rejects", "messages": str(error).splitlines()}
print()
print(json.dumps(result))
