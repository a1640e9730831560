"""Files of motion planners that contain the spheres of a robot.

cuRobo reads ``collision_spheres`` from the YAML file that ``kinematics.collision_spheres`` of its
robot configuration names (https://curobo.org/tutorials/1_robot_configuration.html). pyroki takes a
table of centers and radii by link (``RobotCollision.from_sphere_decomposition``).
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..model.pose import make_pose
from .compute import Result, Task
from .links import LinkPlan


def collect_planner_spheres(
    plans: Sequence[LinkPlan], results: Mapping[Task, Result]
) -> dict[str, list[tuple[tuple[float, ...], float]]]:
    """Return center [m], in the frame of the link, and radius [m] of each sphere, by link."""
    planner_spheres: dict[str, list[tuple[tuple[float, ...], float]]] = {}
    for item in plans:
        for use in item.uses:
            if use.task is None:
                continue
            pose = make_pose(use.shape.origin)
            rotation, shift = np.array(pose.rotation), np.array(pose.translation)
            for piece in results[use.task].pieces:
                if piece.kind == "sphere":
                    center = rotation @ piece.center + shift
                    rounded = tuple(round(float(value), 6) + 0.0 for value in center)
                    spheres = planner_spheres.setdefault(item.link.name, [])
                    spheres.append((rounded, _round_up(piece.size[0])))
    return planner_spheres


def _round_up(radius: float) -> float:
    return float(np.ceil(radius * 1e6 + 1) / 1e6)  # covers the rounding of the center, too


def format_curobo_yaml(spheres: Mapping[str, Sequence[tuple[tuple[float, ...], float]]]) -> str:
    """Format spheres as ``collision_spheres`` of a robot configuration of cuRobo."""
    lines = ["# collision geometry by urdftool", "collision_spheres:"]
    for link, some in spheres.items():
        lines.append(f"  {json.dumps(link)}:")
        for center, radius in some:
            xyz = ", ".join(f"{value:.6f}" for value in center)
            lines.append(f"    - center: [{xyz}]")
            lines.append(f"      radius: {radius:.6f}")
    return "\n".join(lines) + "\n"


def format_pyroki_json(spheres: Mapping[str, Sequence[tuple[tuple[float, ...], float]]]) -> str:
    """Format spheres as pyroki's ``RobotCollision.from_sphere_decomposition`` expects them.

    The result is JSON, which is YAML, too.
    """
    table: dict[str, Any] = {
        link: {
            "centers": [list(center) for center, _ in some],
            "radii": [radius for _, radius in some],
        }
        for link, some in spheres.items()
    }
    return json.dumps(table, indent=1) + "\n"
