"""Codes of the losses of an export to SDF, with their meaning."""

from __future__ import annotations

LOSSES = {
    "axis": "an axis of length zero has no direction; the joint is exported as fixed (`--force`)",
    "calibration": "`<calibration>` is kept as a comment",
    "capsule": "SDF before 1.8 has no capsule; exported as other shapes",
    "contact": "contact values of a link without collision have no effect",
    "contact-sensor": "a contact sensor names a collision that does not exist",
    "element": "an element in a `<gazebo>` block is not SDF; it is kept as a comment",
    "extension": (
        "a tag of a `<gazebo>` block applies to another kind of element; it is not exported"
    ),
    "floating": "a floating joint becomes a free link without a joint",
    "frame": "SDF 1.6 has no frames; the name of a lumped link is lost",
    "frame-id": "SDF before 1.12 cannot express the frame of a sensor's messages",
    "gltf-axes": (
        "a glTF with Y up is rotated by its pose, since Gazebo does not convert the axes "
        "of the file"
    ),
    "inertia": "physically inconsistent inertia; `--fix-inertia` decides what is written",
    "joint-extension": "settings of a fixed joint that became a frame are not exported",
    "joint-type": "an unknown joint type; the joint is exported as fixed (`--force`)",
    "limit": "a limit is negative, zero, swapped or missing",
    "link": "a link that SDF cannot express alone became a frame of its neighbor",
    "link-flag": "gravity, damping or self-collision of a lumped link is not spread to the whole",
    "mass": "a moving link without mass gets 1e-12 kg",
    "material": "a material script of Gazebo Classic that gz cannot run",
    "mesh": "a mesh is missing, and its shape left out (`--force`)",
    "mesh-format": "a mesh is in a format that the target does not read; its URI is still written",
    "mimic": (
        "SDF before 1.11, or a joint without an axis, cannot express mimic; the joint moves freely"
    ),
    "name": "SDF does not allow a name, or it is taken; the part is renamed",
    "planar": "a planar joint becomes two prismatic joints and a revolute one",
    "plugin": "a plugin of Gazebo Classic was translated, or has no successor",
    "reference": "a `<gazebo>` block refers to an unknown name",
    "repeated": "a tag is set twice; the last one is used",
    "ros2-control": "`<ros2_control>` is read from robot_description, not from SDF",
    "safety": "`<safety_controller>` is kept as a comment",
    "sensor": "a sensor's type was translated, or the target does not have it",
    "shape": "a shape that cannot be exported is dropped (`--force`)",
    "texture": "a texture is missing, or there is no folder for the script that Classic requires",
    "transmission": "a transmission is kept as a comment",
    "world": (
        "inertial, visuals and collisions of the root link `world` are not exported; it is "
        "the world itself"
    ),
}
"""By the code after ``lossy-``. Defects skipped with ``--force`` keep their own code."""
