"""Why a robot does not come to rest."""

from __future__ import annotations

import numpy as np

from .engines.registry import alternatives
from .fault import listed
from .run import Run

OFF = 0.05
"""How far from where it is held a joint is that gives way [rad, m]."""

MOVES = 1e-3
"""How fast a joint is that moves [rad/s, m/s]."""

CREEPS = 0.01
"""How far something goes that creeps, as a part of the robot's size [1/s]."""

TURNS = 0.05
"""How fast it turns at most [rad/s]."""

FULL = 0.99
"""The part of its effort that a joint uses which could use no more."""


def why_moving(run: Run, drift: float) -> str:
    """The most probable reason, of a root that moved so far along the plane [m]."""
    recording, joints = run.recording, run.bodies.joints
    moves = np.abs(recording.rates[-1]) > MOVES
    loose = [j for j in joints if j.name not in run.bodies.held and not j.leader]
    if any(moves[recording.joints.index(joint.name)] for joint in loose):
        damped = any(joint.damping or joint.friction for joint in loose)
        which = f"joint '{loose[0].name}'" if len(loose) == 1 else f"{len(loose)} of its joints"
        it, its = ("it", "its") if len(loose) == 1 else ("them", "their")
        brake = f"has not stopped {it} yet" if damped else "is zero"
        return f"nothing holds {which}, and {its} damping {brake}"
    swinging = [joint.name for column, joint in enumerate(joints) if is_swinging(run, column)]
    if swinging:
        does = "swing about where they are" if len(swinging) > 1 else "swings about where it is"
        return f"joint {listed(swinging)} {does} held"
    weak = [j.name for column, j in enumerate(joints) if moves[column] and _gives(run, column)]
    if weak:
        them = "them" if len(weak) > 1 else "it"
        return f"joint {listed(weak)} may use less effort than it takes to hold {them}"
    if not run.bodies.nailed and drift > run.bodies.size:
        return "it rolls or slides along the floor"
    velocities = np.abs(np.nan_to_num(recording.velocities[-1]))
    slow = velocities[:, :3].max() < CREEPS * run.bodies.size and velocities[:, 3:].max() < TURNS
    engine = recording.capabilities
    if slow and engine.creeps:
        other = alternatives(engine.name, lambda known: not known.creeps)
        advice = f": {other} has others" if other else ""
        return f"it creeps, which may be the engine's contacts{advice}"
    return "parts push against each other, or it rolls"


def _gives(run: Run, column: int) -> bool:
    """Whether a held joint uses the effort that it may and is not where it is held."""
    recording, joint = run.recording, run.bodies.joints[column]
    if joint.name not in recording.targets or not joint.effort:
        return False
    off = float(recording.positions[-1, column]) - recording.targets[joint.name]
    used = float(recording.efforts[-1, column])
    return abs(off) > OFF and abs(used) > FULL * joint.effort


def is_swinging(run: Run, column: int) -> bool:
    """Whether a held joint moves to and fro with all the effort that it may use, to the end."""
    recording, joint = run.recording, run.bodies.joints[column]
    last = np.nan_to_num(recording.efforts[len(recording.times) // 2 :, column])
    if joint.name not in recording.targets or not joint.effort:
        return False
    most = FULL * joint.effort
    moves = abs(float(recording.rates[-1, column])) > 1e-3
    return bool(moves and last.min() < -most and last.max() > most)
