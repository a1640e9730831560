"""Check the bodies that an engine loaded: read-back values, missing mass, impossible tensors."""

from __future__ import annotations

from collections.abc import Iterator

from ...diagnostic import Severity
from ...mechanics.tensor import SymmetricTensor, measure_consistency
from ...model.elements import Robot
from ..extent import measure_extent
from ..fault import Fault
from ..rigid_bodies import RigidBody
from ..run import Run
from .mass_distribution import has_shapes


def check_read_back(robot: Robot, run: Run, known: set[str]) -> Iterator[Fault]:
    """Report values that the engine loaded differently from the file."""
    for difference in run.recording.read_back:
        if difference.name in known:
            continue
        part = robot.link.get(difference.name) or robot.joint.get(difference.name)
        yield Fault(
            "engine-readback-mismatch",
            Severity.ERROR,
            f"{run.recording.capabilities.title} loaded {difference.what} = {difference.loaded} "
            f"for {difference.kind} '{difference.name}', but the file specifies "
            f"{difference.specified}",
            None if part is None else part.place,
            difference.kind,
            difference.name,
        )


def find_body(run: Run, link: str) -> RigidBody | None:
    """Return the rigid body that a link is a part of; None if the engine has none."""
    return next((body for body in run.bodies.bodies if link in body.links), None)


def is_held(run: Run, body: RigidBody) -> bool:
    """Tell whether a body is the root of a robot with a fixed base."""
    return run.bodies.fixed_base and body is run.bodies.bodies[0]


def list_massless_bodies(robot: Robot, run: Run) -> list[RigidBody]:
    """List the massless bodies that affect the run: a free root, and parents or shapes."""
    bodies = run.bodies.bodies
    loads = {body.parent for body in bodies if body.mass}
    return [
        body
        for number, body in enumerate(bodies)
        if not body.mass
        and not is_held(run, body)
        and (number == 0 or number in loads or any(has_shapes(robot, name) for name in body.links))
    ]


def list_large_massless_links(robot: Robot, run: Run) -> set[str]:
    """List links without mass that are a large part, by volume, of their rigid body or the robot.

    The mass of a link without shapes counts for the links of its body that have shapes and no mass:
    some files keep the inertial of a root in a separate link.
    """
    found: set[str] = set()
    bodies, bounds = run.bodies, run.thresholds
    extents = {
        name: measure_extent(robot, name)
        for body in bodies.bodies
        if body.mass and any(_is_massless_shape(robot, name) for name in body.links)
        for name in body.links
        if has_shapes(robot, name)
    }
    if not any(_is_massless_shape(robot, name) for name in extents):
        return found
    everything = sum(
        extents[name].volume if name in extents else measure_extent(robot, name).volume
        for body in bodies.bodies
        for name in body.links
        if has_shapes(robot, name)
    )
    for number, body in enumerate(bodies.bodies):
        hollow = [
            name for name in body.links if _is_massless_shape(robot, name) and name in extents
        ]
        if any(robot.link[name].visuals for name in body.links):  # others are helpers for contacts
            hollow = [name for name in hollow if robot.link[name].visuals]
        if not hollow or (number == 0 and bodies.fixed_base):
            continue
        bare = sum(robot.link[name].mass for name in body.links if not has_shapes(robot, name))
        if bare > bounds.hollow_density * sum(extents[name].volume for name in hollow):
            continue
        whole = sum(extents[name].volume for name in body.links if name in extents)
        for name in hollow:
            volume = extents[name].volume
            is_solid = bool(robot.link[name].collisions)  # a visual alone may be a cover
            if volume > bounds.massless_share * whole > 0 or (
                is_solid and volume > bounds.massless_part * everything
            ):
                found.add(name)
    return found


def _is_massless_shape(robot: Robot, name: str) -> bool:
    """Tell whether a link has a shape and no mass."""
    return not robot.link[name].mass and has_shapes(robot, name)


def is_impossible(tensor: SymmetricTensor, excess: float) -> bool:
    """Tell whether a tensor is physically inconsistent.

    Args:
        tensor: About the center of mass [kg·m²].
        excess: Allowed relative violation of the triangle inequality [1].
    """
    found = measure_consistency(tensor)
    return found.size == 0 or found.negativity > 1e-9 or found.excess > excess / (1 + excess)


def describe_simulated_mass(run: Run, body: RigidBody) -> str:
    """Describe what the engine did with a body without mass."""
    engine = run.recording.capabilities
    for part in run.recording.read_back:
        if part.name == body.name and part.what == "mass":
            return f"{engine.title} simulated a mass of {part.loaded}"
    if body.parent < 0 and engine.holds_massless_root:
        return f"{engine.title} fixes such a root at its start pose"
    return f"{engine.title} simulated no mass or a negligible one"


def describe_simulated_tensor(run: Run, body: RigidBody) -> str:
    """Describe what the engine simulated instead of an inconsistent tensor."""
    engine = run.recording.capabilities.title
    for part in run.recording.read_back:
        if part.name == body.name and part.what == "principal moments":
            return f"{engine} simulated principal moments of {part.loaded}"
    return f"{engine} simulated the tensor as written"
