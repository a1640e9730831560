"""Print what Newton makes of a URDF file, as JSON, on the last line of the output."""

import json
import sys
import warnings

import newton
import numpy
import warp

warp.config.quiet = True


def number(value):
    return float(f"{value:.6g}")


def facts(path):
    """Bodies after the repair of inertias, joints and shapes."""
    builder = newton.ModelBuilder()
    builder.add_urdf(path)
    model = builder.finalize(device="cpu")
    masses, tensors = model.body_mass.numpy(), model.body_inertia.numpy()
    links = {}
    for index, label in enumerate(builder.body_label):
        links[label.rpartition("/")[2]] = {
            "mass": number(masses[index]),
            "com": [number(part) for part in builder.body_com[index]],
            "principal": [number(part) for part in numpy.linalg.eigvalsh(tensors[index])],
            "shapes": [shape(builder, i) for i in builder.body_shapes[index]],
        }
    joints = {
        label.rpartition("/")[2]: joint(builder, i) for i, label in enumerate(builder.joint_label)
    }
    return {"outcome": "loads", "links": links, "joints": joints}


def joint(builder, index):
    ends = [*builder.joint_qd_start, builder.joint_dof_count]
    first, last = ends[index : index + 2]
    found = {"type": newton.JointType(builder.joint_type[index]).name.lower()}
    for name in ("limit_lower", "limit_upper", "effort_limit", "velocity_limit", "damping"):
        values = [number(value) for value in getattr(builder, f"joint_{name}")[first:last]]
        found[name] = values
    leader = builder.joint_mimic_joint[index]
    if leader >= 0:
        found["follows"] = builder.joint_label[leader].rpartition("/")[2]
    return found


def shape(builder, index):
    kind = builder.shape_type[index]
    return {
        "shape": newton.GeoType(kind).name.lower(),
        "size": [number(part) for part in builder.shape_scale[index]],
        "contact": bool(builder.shape_flags[index] & newton.ShapeFlags.COLLIDE_SHAPES),
    }


with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("ignore")
    warnings.simplefilter("always", newton.NewtonWarning)
    warnings.simplefilter("always", UserWarning)
    try:
        result = facts(sys.argv[1])
    except Exception as error:
        result = {"outcome": "rejects", "messages": [f"{type(error).__name__}: {error}"]}
said = [str(warning.message) for warning in caught]
result["messages"] = [*result.get("messages", ()), *said]
print()
print(json.dumps(result))
