"""The command lines that are tried, by name.

``IN`` is the robot, ``ORIGINAL`` what it was before its damage, ``FOLDER`` where both are,
``MESH`` a damaged mesh, ``YAML`` damaged controllers, ``OUT`` the folder of outputs.
"""

from __future__ import annotations

ONE = ("-j", "1", "--no-cache")

COMMANDS = {
    "expand": (
        ["expand", "IN", "-o", "OUT/a.urdf", "--source-map", "OUT/a.json"],
        ["expand", "IN", "--deps"],
        ["expand", "IN", "--list-args"],
        ["expand", "IN", "--check", "ORIGINAL"],
        ["expand", "IN", "-o", "OUT/a.urdf", "--depfile", "OUT/a.d"],
    ),
    "lint": (
        ["lint", "IN"],
        ["lint", "IN", "--format", "sarif"],
        ["lint", "IN", "--format", "github"],
        ["lint", "IN", "--format", "html", "--output-file", "OUT/a.html"],
        ["lint", "IN", "--target", "gz", "--target", "mujoco", "--format", "junit"],
        ["lint", "IN", "--format", "concise", "--write-baseline", "OUT/a.json"],
        ["lint", "IN", "--statistics", "--extend-select", "ALL"],
    ),
    "lint FOLDER": (
        ["lint", "FOLDER", "-j", "1"],
        ["-v", "lint", "FOLDER", "-j", "2", "--format", "json"],
    ),
    "lint --fix": (
        ["lint", "IN", "--fix", "--unsafe-fixes"],
        ["lint", "IN", "--unsafe-fixes", "--diff"],
    ),
    "inertia robot": (
        ["inertia", "robot", "IN"],
        ["inertia", "robot", "IN", "--density", "1000", "--write", "-o", "OUT/a.urdf"],
        ["inertia", "robot", "IN", "--lump", "--format", "json"],
        ["inertia", "robot", "IN", "--all", "--total-mass", "9", "--write", "-o", "OUT/a.urdf"],
    ),
    "inertia mesh": (
        ["inertia", "mesh", "MESH", "--density", "1000"],
        ["inertia", "mesh", "MESH", "--mass", "2", "--format", "json", "--scale", "-0.001"],
        ["inertia", "mesh", "MESH", "--surface", "--density", "3", "-o", "OUT/a.xml"],
    ),
    "collision": (
        ["collision", "IN", "--method", "hull", "-o", "OUT/a.urdf", *ONE],
        ["collision", "IN", "--check", *ONE],
        ["collision", "IN", "-o", "OUT/a.urdf", "--max-error", "0.1", "--time-limit", "2", *ONE],
    ),
    "collision mesh": (
        ["collision", "mesh", "MESH", "-o", "OUT/a.stl", "--no-cache", "--method", "hull"],
        ["collision", "mesh", "MESH", "-o", "OUT/a.obj", "--no-cache", "--time-limit", "2"],
        ["collision", "mesh", "MESH", "--no-cache", "--method", "simplify", "--format", "json"],
        ["collision", "mesh", "MESH", "--no-cache", "--method", "primitive"],
    ),
    "graph": (
        ["graph", "IN", "-o", "OUT/a.svg", "--style", "detailed", "--lint"],
        ["graph", "IN", "-o", "OUT/a.mmd"],
        ["graph", "IN", "-o", "-"],
        ["graph", "IN"],
        ["graph", "IN", "-o", "OUT/a.json", "--fold-fixed"],
    ),
    "info": (["info", "IN"], ["info", "IN", "--format", "json"]),
    "diff": (
        ["diff", "IN", "ORIGINAL"],
        ["diff", "ORIGINAL", "IN", "--format", "markdown"],
        ["diff", "ORIGINAL", "IN", "--format", "json", "-o", "OUT/a.json"],
    ),
    "export sdf": (
        ["export", "sdf", "IN", "-o", "OUT/model", "--verify"],
        ["export", "sdf", "IN", "-o", "OUT/a.sdf", "--target", "gazebo-classic", "--force"],
        ["export", "sdf", "IN", "-o", "OUT/model", "--world", "--fixed-joints", "lump", "--force"],
    ),
    "export mjcf": (
        ["export", "mjcf", "IN", "-o", "OUT/model", "--scene"],
        ["export", "mjcf", "IN", "-o", "OUT/a.xml", "--verify", "--force"],
        ["export", "mjcf", "IN", "-o", "OUT/model", "--fix-inertia", "box", "--force"],
    ),
    "simulate": (
        ["simulate", "IN", "--duration", "1"],
        ["simulate", "IN", "--duration", "0.5", "--engine", "mujoco", "--format", "json"],
        ["simulate", "IN", "--duration", "0.5", "--controllers", "YAML"],
        ["simulate", "IN", "--duration", "0.5", "--sweep", "--plot", "OUT/a.png"],
    ),
    "simulate --fleet": (
        ["simulate", "--fleet", "IN", "ORIGINAL", "--duration", "0.2", "-j", "1"],
        [
            *("simulate", "--fleet", "IN", "ORIGINAL", "--duration", "0.2", "-j", "2"),
            *("--engine", "mujoco", "--junit", "OUT/a.xml"),
        ],
    ),
    "view": (
        ["view", "IN", "--picture", "OUT/a.png", "--size", "80x60"],
        ["view", "IN", "--contact-sheet", "OUT/a.png", "--size", "40x30", "--show", "both"],
    ),
}
