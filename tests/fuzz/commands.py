"""The command lines that are tried, by name. ``IN`` is the robot, ``OUT`` the folder of outputs."""

from __future__ import annotations

COMMANDS = {
    "expand": (["expand", "IN", "-o", "OUT/a.urdf"], ["expand", "IN", "--deps"]),
    "lint": (
        ["lint", "IN"],
        ["lint", "IN", "--format", "sarif"],
        ["lint", "IN", "--format", "github"],
        ["lint", "IN", "--format", "html", "--output-file", "OUT/a.html"],
        ["lint", "IN", "--target", "gz", "--target", "mujoco", "--format", "junit"],
    ),
    "lint --fix": (
        ["lint", "IN", "--fix", "--unsafe-fixes"],
        ["lint", "IN", "--unsafe-fixes", "--diff"],
    ),
    "inertia": (
        ["inertia", "robot", "IN"],
        ["inertia", "robot", "IN", "--density", "1000", "--write", "-o", "OUT/a.urdf"],
        ["inertia", "robot", "IN", "--lump", "--format", "json"],
    ),
    "collision": (
        ["collision", "IN", "--method", "hull", "-o", "OUT/a.urdf", "-j", "1", "--no-cache"],
        ["collision", "IN", "--check", "-j", "1", "--no-cache"],
    ),
    "graph": (
        ["graph", "IN", "-o", "OUT/a.svg", "--style", "detailed", "--lint"],
        ["graph", "IN", "-o", "OUT/a.mmd"],
        ["graph", "IN", "-o", "-"],
        ["graph", "IN"],
    ),
    "info": (["info", "IN"], ["info", "IN", "--format", "json"]),
    "diff": (["diff", "IN", "ORIGINAL"], ["diff", "ORIGINAL", "IN", "--format", "markdown"]),
    "export sdf": (
        ["export", "sdf", "IN", "-o", "OUT/model", "--verify"],
        ["export", "sdf", "IN", "-o", "OUT/a.sdf", "--target", "gazebo-classic", "--force"],
    ),
    "export mjcf": (
        ["export", "mjcf", "IN", "-o", "OUT/model", "--scene"],
        ["export", "mjcf", "IN", "-o", "OUT/a.xml", "--verify", "--force"],
    ),
    "simulate": (["simulate", "IN", "--duration", "1"],),
    "view": (["view", "IN", "--picture", "OUT/a.png", "--size", "80x60"],),
}
