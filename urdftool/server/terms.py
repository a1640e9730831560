"""What the elements and attributes of URDF mean: units, defaults (URDF specification)."""

from __future__ import annotations

from ..model.link import COMPONENTS

ELEMENTS: dict[str, str] = {
    "robot": "a robot: links, connected by joints to a tree",
    "link": "a rigid body, or a coordinate frame if it has no mass and no geometry",
    "inertial": "mass, center of mass and inertia tensor of a link",
    "mass": "mass of the link [kg]",
    "inertia": "inertia tensor [kg·m²] about the center of mass, in the inertial frame",
    "visual": "geometry that is displayed",
    "collision": "geometry for contact",
    "origin": "pose in the frame of the element around it; of a joint: in the parent link",
    "geometry": "one shape",
    "box": "box, centered at the origin",
    "cylinder": "cylinder along z, centered at the origin",
    "sphere": "sphere, centered at the origin",
    "capsule": "cylinder along z with half a sphere at each end",
    "mesh": "surface from a file",
    "material": "color or texture; by its name alone, that of a material elsewhere in the file",
    "color": "color of the material",
    "texture": "image of the material",
    "joint": "connection of a child link to its parent link",
    "parent": "parent link of the joint",
    "child": "child link of the joint; the joint is at its origin",
    "axis": "axis of motion in the joint frame",
    "limit": "limits of position, velocity and effort",
    "dynamics": "damping and friction of the joint",
    "mimic": "the joint follows another one",
    "safety_controller": "limits of a controller of the PR2",
    "calibration": "reference positions of the joint",
}
"""Meaning of each element."""

ATTRIBUTES: dict[tuple[str, str], str] = {
    ("mass", "value"): "mass [kg], above 0",
    ("origin", "xyz"): "position [m]; default 0 0 0",
    ("origin", "rpy"): "roll, pitch, yaw [rad] about the fixed axes x, y, z in this order; "
    "default 0 0 0",
    ("box", "size"): "whole lengths along x, y, z [m]",
    ("cylinder", "radius"): "radius [m]",
    ("cylinder", "length"): "whole length along z [m]",
    ("sphere", "radius"): "radius [m]",
    ("capsule", "radius"): "radius [m]",
    ("capsule", "length"): "length of the cylinder along z [m], without the ends",
    ("mesh", "filename"): "file: `package://NAME/PATH`, `file://PATH`, or a relative path",
    ("mesh", "scale"): "factors along x, y, z; default 1 1 1",
    ("color", "rgba"): "red, green, blue, opacity: each 0 to 1",
    ("texture", "filename"): "image file",
    ("joint", "type"): "`revolute`, `continuous`, `prismatic`, `fixed`, `floating` or `planar`",
    ("axis", "xyz"): "direction, of length 1; default 1 0 0",
    ("limit", "lower"): "lower position [rad; m for prismatic]; default 0",
    ("limit", "upper"): "upper position [rad; m for prismatic]; default 0",
    ("limit", "effort"): "maximum effort [N·m; N for prismatic]; required",
    ("limit", "velocity"): "maximum velocity [rad/s; m/s for prismatic]; required",
    ("dynamics", "damping"): "viscous damping [N·m·s/rad; N·s/m for prismatic]; default 0",
    ("dynamics", "friction"): "static friction [N·m; N for prismatic]; default 0",
    ("mimic", "joint"): "joint that this one follows: position = multiplier · other + offset",
    ("mimic", "multiplier"): "factor; default 1",
    ("mimic", "offset"): "offset [rad; m for prismatic]; default 0",
    **{
        ("inertia", name): f"element {name[1:]} of the inertia tensor [kg·m²]"
        for name in COMPONENTS
    },
}
"""Meaning, unit and default of attributes."""
