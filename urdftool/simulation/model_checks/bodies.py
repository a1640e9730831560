"""Checks of rigid bodies: collision geometry, mass, inertia and size that a run depends on."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...mechanics.tensor import (
    ZERO_TENSOR,
    SymmetricTensor,
    consistency,
    principal_moments,
)
from ...model.elements import Geometry, Link, Mesh, Robot
from ...rules.inertia.density import mass_out_of_line
from ...source.location import Place
from ..extent import measure_extent
from ..fault import Fault
from ..mesh_cache import outermost_points
from ..rigid_bodies import RigidBody, link_mass_properties
from ..run import Run
from ..shapes import is_without_extent
from .mass_distribution import check_mass_distribution, has_shapes


def check_bodies(robot: Robot, run: Run) -> Iterator[Fault]:
    """Report collision geometry, mass and inertia that are missing or impossible in the file."""
    bodies = run.bodies
    if not any(body.shapes for body in bodies.bodies):
        yield Fault(
            "nothing-touches",
            "no link has a <collision>: nothing of the robot can touch the floor",
            robot.place,
            cause="give each link a <collision>",
            rule="missing-collision",
            fails=not bodies.fixed_base,
        )
    yield from _without_extent(robot, run)
    yield from _massless_bodies(robot, run)
    told = {body.name for body in bodies.bodies if not body.mass}
    for number, body in enumerate(bodies.bodies):
        if number == 0 and bodies.fixed_base:
            continue
        if body.properties is not None and is_impossible(
            body.properties.tensor, run.thresholds.tensor_excess
        ):
            told.add(body.name)
            yield from _inconsistent_inertia(robot, run, body)
        for name in body.links:
            yield from check_mass_distribution(robot, robot.link[name], run)
    yield from _mass_out_of_line(robot, run)
    yield from _massless_links(robot, run)
    yield from _oversized_collisions(robot, run)
    yield from _oversized_visuals(robot, run)
    for difference in run.recording.read_back:
        if difference.name in told:
            continue
        part = robot.link.get(difference.name) or robot.joint.get(difference.name)
        yield Fault(
            "read-otherwise",
            f"{difference.what} of {difference.kind} '{difference.name}' is {difference.said} in "
            f"the file, and the engine took {difference.got}",
            None if part is None else part.place,
            difference.kind,
            difference.name,
        )


def _without_extent(robot: Robot, run: Run) -> Iterator[Fault]:
    """Report collisions of length zero, which are left out, as the exporters do."""
    for name in (name for body in run.bodies.bodies for name in body.links):
        for collision in robot.link[name].collisions:
            if is_without_extent(collision):
                yield Fault(
                    "no-extent",
                    f"a collision of link '{name}' has a length of zero and is left out",
                    collision.place,
                    "link",
                    name,
                    rule="non-positive-dimension",
                    fails=False,
                )


def _massless_bodies(robot: Robot, run: Run) -> Iterator[Fault]:
    bodies = run.bodies
    by_name = {body.name: body for body in bodies.bodies}
    loads = {body.parent for body in bodies.bodies if body.mass}
    moving = []
    for number, body in enumerate(bodies.bodies):
        if body.mass or (number == 0 and bodies.fixed_base):
            continue
        if number == 0:
            yield Fault(
                "no-mass",
                f"the root, link '{body.name}', weighs nothing",
                robot.link[body.name].place,
                "link",
                body.name,
                f"it has no <inertial> with a mass; {_mass_taken(run, body)}: give it one, or fix "
                "it to the world with --fixed-base",
                "massless-root-body",
            )
        elif number in loads or any(has_shapes(robot, name) for name in body.links):
            moving.append(body.name)
    if moving:
        more = f" and {len(moving) - 1} more" if len(moving) > 1 else ""
        yield Fault(
            "no-mass",
            f"link '{moving[0]}'{more} on a moving joint weigh{'s' * (not more)} nothing",
            robot.link[moving[0]].place,
            "link",
            moving[0],
            f"it has no <inertial> with a mass; {_mass_taken(run, by_name[moving[0]])}",
            "massless-moving-body",
        )


def _mass_out_of_line(robot: Robot, run: Run) -> Iterator[Fault]:
    """Report the one link whose mass alone is several times too large, as lint finds it."""
    for problem in mass_out_of_line.check(robot):
        link = problem.subject
        assert isinstance(link, Link)
        body = next((body for body in run.bodies.bodies if link.name in body.links), None)
        if body is None or (body.parent < 0 and run.bodies.fixed_base):
            continue
        place = problem.at if isinstance(problem.at, Place) else link.place
        yield Fault(
            "mass-out-of-line",
            problem.message,
            place,
            "link",
            link.name,
            rule="mass-out-of-line",
        )


def _massless_links(robot: Robot, run: Run) -> Iterator[Fault]:
    """Report links without mass that are a good part of their rigid body or the robot.

    The mass of a link without shapes counts for those of its body that have some and no mass: so
    are inertials kept out of a root. A neighbour with shapes of its own has its own mass only.
    """
    bodies, bounds = run.bodies, run.thresholds
    extents = {
        name: measure_extent(robot, name)
        for body in bodies.bodies
        if body.mass and any(_is_massless_shape(robot, name) for name in body.links)
        for name in body.links
        if has_shapes(robot, name)
    }
    if not any(_is_massless_shape(robot, name) for name in extents):
        return
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
        if any(robot.link[name].visuals for name in body.links):  # others only help to collide
            hollow = [name for name in hollow if robot.link[name].visuals]
        if not hollow or (number == 0 and bodies.fixed_base):
            continue
        bare = sum(robot.link[name].mass for name in body.links if not has_shapes(robot, name))
        if bare > bounds.hollow_density * sum(extents[name].volume for name in hollow):
            continue
        whole = sum(extents[name].volume for name in body.links if name in extents)
        for name in hollow:
            volume = extents[name].volume
            solid = bool(robot.link[name].collisions)  # what is only seen may be a cover
            if volume > bounds.massless_share * whole > 0 or (
                solid and volume > bounds.massless_part * everything
            ):
                yield Fault(
                    "no-mass",
                    f"link '{name}' weighs nothing and is {volume / whole:.0%} of its rigid body, "
                    f"of which the rest weighs {body.mass:.3g} kg",
                    robot.link[name].place,
                    "link",
                    name,
                    "it has a shape and no <inertial> with a mass",
                    "missing-inertial",
                )


def _is_massless_shape(robot: Robot, name: str) -> bool:
    """Tell whether a link has a shape and no mass."""
    return not robot.link[name].mass and has_shapes(robot, name)


def is_impossible(tensor: SymmetricTensor, excess: float) -> bool:
    """Tell whether a tensor is physically inconsistent.

    Args:
        tensor: About the center of mass [kg·m²].
        excess: How far it may exceed the triangle inequality [1].
    """
    found = consistency(tensor)
    return found.size == 0 or found.negativity > 1e-9 or found.excess > excess / (1 + excess)


def _inconsistent_inertia(robot: Robot, run: Run, body: RigidBody) -> Iterator[Fault]:
    """Report the link that makes the tensor of its body physically inconsistent."""
    bad = [
        link
        for link in (robot.link[name] for name in body.links)
        if (own := link_mass_properties(link)) is not None
        and is_impossible(own.tensor, run.thresholds.tensor_excess)
    ]
    link = max(bad, key=lambda link: link.mass) if bad else robot.link[body.name]
    own = link_mass_properties(link)
    tensor = own.tensor if bad and own is not None else ZERO_TENSOR
    low, middle, high = principal_moments(tensor)
    taken = _tensor_taken(run, body)
    if high <= 0 and low >= 0:
        said = f"is zero, and it weighs {body.mass:.4g} kg"
        why = f"nothing resists its turning; {taken}"
        rule = "zero-inertia"
    elif low < -1e-9 * abs(high):
        said = f"has a principal moment of {low:.3g} kg·m²"
        why = f"every principal moment is above zero; {taken}"
        rule = "inertia-not-positive-definite"
    else:
        said = f"breaks the triangle inequality: {high:.3g} > {low:.3g} + {middle:.3g} kg·m²"
        why = f"no body has such a tensor; {taken}"
        rule = "inertia-triangle-inequality"
    part = link.inertial.inertia or link.inertial if link.inertial is not None else link
    yield Fault(
        "impossible-inertia",
        f"the inertia of link '{link.name}' {said}",
        part.place,
        "link",
        link.name,
        why,
        rule,
    )


def _mass_taken(run: Run, body: RigidBody) -> str:
    """Say what the engine that ran did with a body without mass."""
    engine = run.recording.capabilities
    for part in run.recording.read_back:
        if part.name == body.name and part.what == "mass":
            return f"{engine.title} simulated a mass of {part.got}"
    if body.parent < 0 and engine.holds_massless_root:
        return f"{engine.title} holds such a root where it starts"
    return f"{engine.title} simulated it with none, or next to none"


def _tensor_taken(run: Run, body: RigidBody) -> str:
    """Say what the engine that ran took instead of an inconsistent tensor."""
    engine = run.recording.capabilities.title
    for part in run.recording.read_back:
        if part.name == body.name and part.what == "principal moments":
            return f"{engine} simulated principal moments of {part.got}"
    return f"{engine} simulated it as written"


def _oversized_collisions(robot: Robot, run: Run) -> Iterator[Fault]:
    bodies, bounds = run.bodies, run.thresholds
    sizes: dict[str, list[float]] = {}
    for body in bodies.bodies:
        for shape in body.shapes:
            low, high = shape.bounds()
            sizes.setdefault(shape.link, []).append(float((high - low).max()))
    largest = {name: max(found) for name, found in sizes.items()}
    for name, size in largest.items():
        others = [value for other, value in largest.items() if other != name]
        link = robot.link[name]
        volume = measure_extent(robot, name, only_collisions=True).volume
        thin = link.mass and volume and link.mass / volume < bounds.thinnest_density
        ratio = bounds.largest_part_ratio
        far = others and size > ratio * float(np.median(others))
        if size > bounds.largest_part and (thin or far):
            yield Fault(
                "too-large",
                f"a collision of link '{name}' is {size:,.0f} m large",
                link.collisions[0].place,
                "link",
                name,
                *_scale_advice(link.collisions[0].geometry),
            )


def _oversized_visuals(robot: Robot, run: Run) -> Iterator[Fault]:
    """Report visual meshes in millimeters on a robot that collides in meters."""
    bodies, bounds = run.bodies, run.thresholds
    least = max(bounds.largest_part, bounds.largest_part_ratio * bodies.size)
    if not bodies.size:
        return
    for name in (name for body in bodies.bodies for name in body.links):
        for visual in robot.link[name].visuals:
            mesh = visual.geometry
            if not isinstance(mesh, Mesh):
                continue
            points = outermost_points(robot, mesh)
            if points is None:
                continue  # what is only seen need not be there
            edges = points.max(axis=0) - points.min(axis=0)
            if (size := float(edges.max())) > least:
                yield Fault(
                    "too-large",
                    f"what is seen of link '{name}' is {size:,.0f} m large, and the robot "
                    f"{bodies.size:.3g} m",
                    mesh.place,
                    "link",
                    name,
                    *_scale_advice(mesh),
                )
                break


def _scale_advice(geometry: Geometry | None) -> tuple[str, str]:
    """Explain how to correct a shape in millimeters; return the lint rule, too."""
    if not isinstance(geometry, Mesh):
        return "it is in millimetres; sizes are in metres", ""
    right = " ".join(f"{factor / 1000:g}" for factor in geometry.scale)
    if geometry.scale == (1.0, 1.0, 1.0):
        why = f'its mesh is in millimetres; scale it with <mesh scale="{right}">'
        return why, "mesh-in-millimetres"
    return f'it is a thousand times too large by its scale; write <mesh scale="{right}">', ""
