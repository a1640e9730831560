"""Parameters that MoveIt reads: joint limits, kinematics solvers, limits of Pilz."""

from __future__ import annotations

from ...model.elements import Joint
from ...model.start import list_initial_positions
from ..states import get_default_position, is_within
from .configuration import Configuration
from .yaml_text import Commented, Tree, Value

RAMP = 0.5
"""Time to reach the velocity limit at the guessed acceleration [s]; chosen, no source."""

VELOCITY = 1.0
"""Guessed velocity limit of a joint without one [rad/s, m/s]; chosen, no source."""

FULL_POSE = 6
"""Least number of joints with which a chain reaches poses of any orientation."""

LEAST_JOINTS = 3
"""Least number of joints of a chain that gets a solver; chosen, no source."""

CARTESIAN_LIMITS: Tree = {
    "cartesian_limits": {
        "max_trans_vel": 1.0,
        "max_trans_acc": 2.25,
        "max_trans_dec": -5.0,
        "max_rot_vel": 1.57,
    }
}
"""Limits for Pilz [m/s, m/s², m/s², rad/s], the values of MoveIt's Setup Assistant."""


def make_joint_limits(configuration: Configuration) -> Tree:
    """Make the content of ``joint_limits.yaml``: velocities of the description, accelerations."""
    limits = {joint.name: _make_limits(joint) for joint in configuration.active_joints}
    return {
        "default_velocity_scaling_factor": 0.1,
        "default_acceleration_scaling_factor": 0.1,
        "joint_limits": limits,
    }


def _make_limits(joint: Joint) -> Tree:
    written = joint.get_magnitude("velocity") or 0.0
    has = 0.0 < written < float("inf")
    velocity = written if has else VELOCITY
    guess = "guess: the description has no velocity limit"
    acceleration = float(f"{velocity / RAMP:.6g}")
    return {
        "has_velocity_limits": True,
        "max_velocity": float(velocity) if has else Commented(velocity, guess),
        "has_acceleration_limits": True,
        "max_acceleration": Commented(acceleration, "guess: URDF has no acceleration limits"),
    }


def make_kinematics(configuration: Configuration) -> Tree:
    """Make the content of ``kinematics.yaml``: a solver for each chain."""
    found: dict[str, Tree] = {}
    for name, group in configuration.groups.items():
        count = len(configuration.list_group_joints(group))
        if len(group.chains) == 1 and not group.groups and count >= LEAST_JOINTS:
            found[name] = _make_solver(count)
    return found


def _make_solver(count: int) -> Tree:
    solver: dict[str, Value] = {
        "kinematics_solver": "kdl_kinematics_plugin/KDLKinematicsPlugin",
        "kinematics_solver_search_resolution": 0.005,
        "kinematics_solver_timeout": 0.05,
    }
    if count < FULL_POSE:
        comment = f"{count} joints do not reach every orientation"
        solver["position_only_ik"] = Commented(True, comment)
    return solver


def make_initial_positions(configuration: Configuration) -> Tree:
    """Make the content of ``initial_positions.yaml``, where mock hardware starts."""
    robot = configuration.robot
    known = list_initial_positions(robot)
    found: dict[str, float] = {}
    for joint in configuration.active_joints:
        value = known.get(joint.name)
        if value is None or not is_within(robot, joint.name, value):
            value = get_default_position(robot, joint)
        found[joint.name] = float(value or 0.0)
    return {"initial_positions": found}
