"""Bodies without the physics that a simulation lives on."""

from __future__ import annotations

from collections.abc import Iterator

from ..model.elements import Robot
from .fault import Fault
from .run import Run


def judge_bodies(robot: Robot, run: Run) -> Iterator[Fault]:
    """What is missing or impossible in the file, whatever the engine made of it."""
    bodies = run.bodies.bodies
    if not any(body.shapes for body in bodies):
        yield Fault(
            "nothing-touches",
            "no link has a <collision>: nothing of the robot can touch the floor",
            robot.place,
            cause="give each link a <collision>",
            rule="missing-collision",
        )
    for number, body in enumerate(bodies):
        link = robot.link[body.name]
        if not body.mass and not (number == 0 and run.bodies.nailed):
            what = "the root" if number == 0 else f"link '{body.name}' on a moving joint"
            yield Fault(
                "no-mass",
                f"{what} weighs nothing" + (f" (link '{body.name}')" if number == 0 else ""),
                link.place,
                "link",
                body.name,
                "it has no <inertial>; engines nail such a root to the world, invent a mass, or "
                "drop it",
                "massless-root-body" if number == 0 else "massless-moving-body",
            )
    for difference in run.recording.read_back:
        part = robot.link.get(difference.name) or robot.joint.get(difference.name)
        yield Fault(
            "read-otherwise",
            f"{difference.what} of {difference.kind} '{difference.name}' is {difference.said} in "
            f"the file, and the engine took {difference.got}",
            None if part is None else part.place,
            difference.kind,
            difference.name,
        )
