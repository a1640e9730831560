"""Print what pinocchio makes of a URDF file, as JSON, on the last line of the output."""

import json
import os
import sys

import numpy
import pinocchio


def numbers(values):
    return [float(f"{value:.9g}") for value in values]


def facts(path):
    """Joints, bodies and shapes."""
    model = pinocchio.buildModelFromUrdf(path)
    joints, links = {}, {}
    for i in range(1, model.njoints):
        joint, q, v = model.joints[i], model.idx_qs[i], model.idx_vs[i]
        inertia = model.inertias[i]
        joints[model.names[i]] = {
            "type": joint.shortname(),
            "lower": numbers(model.lowerPositionLimit[q : q + joint.nq]),
            "upper": numbers(model.upperPositionLimit[q : q + joint.nq]),
            "effort": numbers(model.upperEffortLimit[v : v + joint.nv]),
            "velocity": numbers(model.upperVelocityLimit[v : v + joint.nv]),
            "damping": numbers(model.damping[v : v + joint.nv]),
            "friction": numbers(model.upperDryFrictionLimit[v : v + joint.nv]),
        }
        moments = inertia.inertia
        links[model.names[i]] = {
            "mass": float(f"{inertia.mass:.9g}"),
            "com": numbers(inertia.lever),
            "inertia": numbers(moments[numpy.triu_indices(3)]),
        }
    found = {"outcome": "loads", "joints": joints, "links": links, "frames": model.nframes}
    if model.nv:
        mass = pinocchio.crba(model, model.createData(), pinocchio.neutral(model))
        found["smallest eigenvalue of the mass matrix"] = float(
            f"{numpy.linalg.eigvalsh(numpy.triu(mass) + numpy.triu(mass, 1).T)[0]:.4g}"
        )
    for kind in ("visual", "collision"):
        what = getattr(pinocchio.GeometryType, kind.upper())
        try:
            shapes = pinocchio.buildGeomFromUrdf(
                model, path, what, package_dirs=[os.path.dirname(path)]
            )
            found[kind] = [
                {"name": g.name, "shape": type(g.geometry).__name__} for g in shapes.geometryObjects
            ]
        except (ValueError, RuntimeError) as error:
            found[kind] = f"rejects: {error}"
    return found


try:
    result = facts(sys.argv[1])
except (ValueError, RuntimeError) as error:
    result = {"outcome": "rejects", "messages": str(error).splitlines()}
print()
print(json.dumps(result))
