"""The command lines that are recorded, with the robots they read."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from ..benchmarks.robots import FIXTURES, bullet_robots, example_robots, options_of

ROBOTS = FIXTURES / "robots"
DEMO = ROBOTS / "demo_arm" / "urdf" / "arm.urdf.xacro"
ARM = ROBOTS / "demo_arm" / "urdf" / "arm_sound.urdf.xacro"
WHEELS = ROBOTS / "two_wheels" / "two_wheels.urdf"
MOBILE = ROBOTS / "my_robot" / "urdf" / "mobile_manipulator.urdf.xacro"
MIRA = ROBOTS / "mira_description" / "urdf" / "mira.urdf"
ROS2 = ROBOTS / "ros2_arm" / "urdf" / "robot2.urdf.xacro"
LASER = ROBOTS / "laser_bot" / "urdf" / "laser_bot.urdf.xacro"

EXAMPLES = ("panda.urdf", "go2.urdf", "talos_reduced.urdf", "tiago.urdf", "ur5_robot.urdf")
BULLET = ("r2d2.urdf", "husky.urdf", "laikago.urdf", "racecar.urdf", "model.urdf")
"""Names of robots that all commands are run on; lint takes every robot there is."""


class Command(NamedTuple):
    """One command line.

    Attributes:
        name: Name of its folder in the record, which no other command has.
        arguments: Without the program. Files it writes have relative paths.
    """

    name: str
    arguments: list[str]


def _named(paths: list[Path], names: tuple[str, ...]) -> list[Path]:
    found = (next((path for path in paths if path.name == name), None) for name in names)
    return [path for path in found if path is not None]


def _on_robot(path: Path) -> Iterator[tuple[str, list[str]]]:
    """List the command lines for one robot: the command's name, and its arguments."""
    robot = [str(path), *options_of(path)]
    yield "lint-sarif", ["lint", *robot, "--no-cache", "--format", "sarif", "--exit-zero"]
    yield "lint-text", ["lint", *robot, "--no-cache", "--all"]
    yield "info", ["info", *robot, "--format", "json"]
    yield "graph", ["graph", *robot, "-o", "robot.json"]
    yield "inertia", ["inertia", "robot", *robot, "--format", "json"]
    yield "sdf", ["export", "sdf", *robot, "-o", "model", "--verify", "--format", "json"]
    yield "mjcf", ["export", "mjcf", *robot, "-o", "model", "--verify", "--format", "json"]
    for engine in ("pybullet", "mujoco"):
        options = ["--engine", engine, "--seed", "1", "--trials", "2", "--no-cache"]
        yield f"simulate-{engine}", ["simulate", *robot, *options, "--format", "json"]


def commands() -> Iterator[Command]:
    """List every command line, for what is installed."""
    examples, bullet = example_robots(), bullet_robots()
    for path in [ARM, MOBILE, MIRA, *_named(bullet, BULLET), *_named(examples, EXAMPLES)]:
        for name, arguments in _on_robot(path):
            yield Command(f"{name}-{path.name.partition('.')[0]}", arguments)
    lint = ["--no-cache", "--exit-zero", "--format", "json"]
    yield Command("lint-fixtures", ["lint", str(FIXTURES), *lint])
    fixes = ["--no-cache", "--fix-meshes", "--unsafe-fixes", "--diff"]
    yield Command("fix-fixtures", ["lint", str(FIXTURES), *fixes])
    for name, paths in (("examples", examples), ("bullet", bullet)):
        if paths:
            given = [*map(str, paths), *options_of(paths[0])]
            yield Command(f"lint-{name}", ["lint", *given, *lint])
            yield Command(f"fix-{name}", ["lint", *given, *fixes])
    for path in (DEMO, MOBILE, ROS2, LASER):
        name = path.name.partition(".")[0]
        robot = [str(path)]
        yield Command(f"expand-{name}", ["expand", *robot, "-o", "out.urdf"])
        yield Command(f"source-map-{name}", ["expand", *robot, "--source-map", "map.json"])
        yield Command(f"info-text-{name}", ["info", *robot])
        yield Command(f"srdf-{name}", ["srdf", *robot, "-o", "robot.srdf"])
        yield Command(f"graph-text-{name}", ["graph", *robot, "-o", "robot.gv"])
        yield Command(f"inertia-text-{name}", ["inertia", "robot", *robot])
        yield Command(
            f"fill-{name}", ["inertia", "robot", *robot, "--all", "--write", "-o", "out.urdf"]
        )
        yield Command(f"mjcf-fused-{name}", ["export", "mjcf", *robot, "-o", "model", "--fuse"])
        yield Command(f"lint-targets-{name}", ["lint", *robot, "--no-cache", "--target", "gz"])
    yield Command("lint-two-wheels", ["lint", str(WHEELS), "--no-cache", "--all"])
    yield Command("diff", ["diff", str(DEMO), str(ARM), "--format", "json"])
    yield Command("edit", ["edit", "root", str(ARM), "tool0", "--format", "json"])
    yield Command("verify", ["verify", str(DEMO), str(ARM), "--format", "json"])
    yield Command("list-rules", ["lint", "--list-rules"])
    cube = str(FIXTURES / "meshes" / "cube.stl")
    yield Command("mesh-inertia", ["inertia", "mesh", cube, "--mass", "1", "--format", "json"])
    for method in ("hull", "auto", "primitive"):
        options = ["--method", method, "--no-cache", "--format", "json"]
        yield Command(f"collision-{method}", ["collision", str(ARM), "-o", "out.urdf", *options])
    yield Command("collision-check", ["collision", str(MIRA), "--check", "--format", "json"])
    yield Command("picture", ["view", str(ARM), "--picture", "arm.png", "--size", "320x240"])
    both = ["--engine", "both", "--seed", "1", "--no-cache", "--format", "json"]
    yield Command("simulate-both", ["simulate", str(MOBILE), *both])
