"""Print what Drake makes of a URDF file, as JSON, on the last line of the output."""

import json
import logging
import sys

import numpy
from pydrake.geometry import SceneGraph
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant


def numbers(values):
    return [float(f"{value:.9g}") for value in numpy.atleast_1d(values)]


def facts(path):
    """Joints, bodies and shapes."""
    plant = MultibodyPlant(0.001)
    scene = SceneGraph()
    plant.RegisterAsSourceForSceneGraph(scene)
    index = Parser(plant).AddModels(path)[0]
    links, joints = {}, {}
    for number in plant.GetBodyIndices(index):
        body = plant.get_body(number)
        spatial = body.default_spatial_inertia()
        links[body.name()] = {
            "mass": float(f"{body.default_mass():.9g}"),
            "com": numbers(spatial.get_com()),
            "moments": moments(spatial),
            "visuals": shapes(scene, plant, body, plant.GetVisualGeometriesForBody(body)),
            "collisions": shapes(scene, plant, body, plant.GetCollisionGeometriesForBody(body)),
        }
    for number in plant.GetJointIndices(index):
        joint = plant.get_joint(number)
        entry = {
            "type": joint.type_name(),
            "parent": joint.parent_body().name(),
            "child": joint.child_body().name(),
            "lower": numbers(joint.position_lower_limits()),
            "upper": numbers(joint.position_upper_limits()),
            "velocity": numbers(joint.velocity_upper_limits()),
        }
        for name in ("revolute_axis", "translation_axis"):
            if hasattr(joint, name):
                entry["axis"] = numbers(getattr(joint, name)())
        if hasattr(joint, "default_damping"):
            entry["damping"] = numbers(joint.default_damping())
        joints[joint.name()] = entry
    couplers = plant.num_constraints()
    plant.Finalize()
    motors = [plant.get_joint_actuator(i) for i in plant.GetJointActuatorIndices(index)]
    efforts = {motor.joint().name(): float(f"{motor.effort_limit():.9g}") for motor in motors}
    found = {"outcome": "loads", "links": links, "joints": joints, "constraints": couplers}
    return {**found, "actuators": efforts}


def moments(spatial):
    """The three moments of inertia about the center of mass."""
    about_com = spatial.Shift(spatial.get_com()).CalcRotationalInertia()
    return numbers(about_com.get_moments())


def shapes(scene, plant, body, found):
    inspector = scene.model_inspector()
    return [
        {"name": inspector.GetName(shape), "shape": type(inspector.GetShape(shape)).__name__}
        for shape in found
    ]


logging.basicConfig(stream=sys.stderr, format="%(levelname)s: %(message)s")
try:
    result = facts(sys.argv[1])
except (ValueError, RuntimeError) as error:
    result = {"outcome": "rejects", "messages": str(error).splitlines()}
print()
print(json.dumps(result, allow_nan=True))
