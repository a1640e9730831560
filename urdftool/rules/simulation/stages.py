"""Check stages of USD."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ..rule import WARNING, Problem, rule


@rule(
    WARNING,
    formats=("usd",),
    evidence="Newton 1.8.0 takes newton:armature 0.1 of a joint that has physxJoint:armature 0.5, "
    "and 0.5 if SchemaResolverPhysx is its first resolver",
)
def contradicting_simulators(robot: Robot) -> Iterator[Problem]:
    """Attributes of a stage for different simulators say the same with different values.

    A stage has armature, friction, damping, velocity limits, inertias and mimic joints once for
    each simulator: ``newton:armature`` and ``physxJoint:armature``. Newton and PhysX each read
    their own, so the robot moves differently in them, and ``urdftool`` reads only the first.
    Velocities and damping of both count by degree; the ``gearing`` of PhysX is the negative of
    Newton's ``mimicCoef1``.
    """
    for one in robot.contradictions:
        part = robot.joint.get(one.name) if one.kind == "joint" else robot.link.get(one.name)
        yield Problem(
            robot if part is None else part,
            f"{one.kind} '{one.name}': {one.shown} contradict each other, so that simulators read "
            "different values; write one value",
            at=one,
            data={"attributes": list(one.values)},
        )
