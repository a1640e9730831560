"""The names of what an export to SDF may lose or change, and what each means."""

from __future__ import annotations

LOSSES = {
    "axis": "an axis of length zero says no direction; the joint is fixed (`--force`)",
    "calibration": "`<calibration>` stays as a comment",
    "capsule": "SDF before 1.8 has no capsule; other shapes stand in",
    "contact": "contact values of a link without collision do nothing",
    "contact-sensor": "a contact sensor watches a collision that is not there",
    "element": "an element in a `<gazebo>` block is no SDF; it stays as a comment",
    "extension": "a tag of a `<gazebo>` block is of another kind of thing; it is left out",
    "floating": "a floating joint is a free link without a joint",
    "frame": "SDF 1.6 has no frames; the name of a lumped link is gone",
    "frame-id": "SDF before 1.12 cannot name the frame of a sensor's messages",
    "inertia": "no body has such moments; the nearest possible ones are written",
    "joint-extension": "what is said of a fixed joint that became a frame is left out",
    "joint-type": "an unknown type of joint; it is fixed (`--force`)",
    "limit": "a limit is not what it says: negative, zero, exchanged, or missing",
    "link": "a link that cannot stand alone became a frame of its neighbour",
    "link-flag": "gravity, damping or self-collision of a lumped link is not spread to the whole",
    "mass": "a moving link without mass gets 1e-12 kg",
    "material": "a material script of Gazebo Classic that gz cannot run",
    "mesh": "a mesh is missing, and its shape left out (`--force`)",
    "mimic": "SDF before 1.11 cannot say which joint follows; it is free",
    "name": "SDF does not allow a name, or it is taken; another is given",
    "planar": "a planar joint is two that slide and one that turns",
    "plugin": "a plugin of Gazebo Classic was translated, or has no successor",
    "reference": "a `<gazebo>` block refers to nothing",
    "repeated": "a tag is set twice; the last holds",
    "ros2-control": "`<ros2_control>` is read from robot_description, not from SDF",
    "safety": "`<safety_controller>` stays as a comment",
    "sensor": "a sensor's type was translated, or the target does not have it",
    "shape": "a shape that cannot be written is left out (`--force`)",
    "texture": "a texture is missing, or has no place for the script that Classic needs",
    "transmission": "a transmission stays as a comment",
    "world": "what the root link `world` has is left out; it is the world itself",
}
"""By the name after ``lossy-``. With ``--force`` each defect passed is one too, by its own name."""
