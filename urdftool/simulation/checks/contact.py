"""Check contacts: ground penetration, interpenetration, and missing contact geometry."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from ...diagnostic import Severity
from ...geometry.link_extent import get_shape_points
from ...model.elements import Box, Capsule, Cylinder, Geometry, Mesh, Robot, Sphere, Visual
from ...model.pose import Pose, make_pose
from ..element_names import name_element
from ..extent import compute_bounding_box, get_shape_corners
from ..fault import Fault
from ..overlap import tessellate_primitive_triangles
from ..recording import GROUND, Array
from ..run import Run
from ..shapes import compute_lowest_height
from .final_state import FinalState
from .interpenetration import check_interpenetration


def check_contacts(robot: Robot, run: Run, state: FinalState) -> Iterator[Fault]:
    """Report penetration, and links that should make contact with the ground and do not."""
    yield from _report_spawn_penetration(robot, run)
    yield from check_interpenetration(robot, run)
    if not state.fell and run.recording.ended != "lost":
        yield from _report_ground_penetration(robot, run)
        reported = {fault.name: fault for fault in _report_missing_contact(robot, run)}
        reported |= {
            fault.name: fault
            for fault in _report_submerged_visuals(robot, run)
            if fault.name not in reported
        }
        yield from reported.values()
        yield from (f for f in _report_unlike_copies(robot, run, state) if f.name not in reported)


def _get_ground_depth(run: Run) -> float:
    """Return the depth of a contact with the ground that is reported [m]."""
    return max(run.thresholds.ground_depth * run.bodies.size, run.thresholds.contact_depth)


def _report_spawn_penetration(robot: Robot, run: Run) -> Iterator[Fault]:
    for contact in run.recording.start_contacts:
        if contact.other == GROUND and contact.depth > _get_ground_depth(run):
            if run.bodies.fixed_base and contact.one in run.bodies.bodies[0].links:
                continue
            yield Fault(
                "spawn-penetration",
                Severity.ERROR,
                f"link '{contact.one}' starts {contact.depth:.3g} m below the ground",
                robot.link[contact.one].place,
                "link",
                contact.one,
                "the root is fixed to the world at this pose"
                if run.bodies.fixed_base
                else "--height places the root too low",
            )


def _report_ground_penetration(robot: Robot, run: Run) -> Iterator[Fault]:
    grounded = [contact for contact in run.recording.contacts if contact.other == GROUND]
    deepest = max(grounded, key=lambda contact: contact.depth, default=None)
    if deepest is not None and deepest.depth > _get_ground_depth(run):
        yield Fault(
            "ground-penetration",
            Severity.ERROR,
            f"link '{deepest.one}' penetrates the ground by {deepest.depth:.3g} m",
            robot.link[deepest.one].place,
            "link",
            deepest.one,
            "its contact is too soft (<kp>), or the robot is too heavy for its contacts",
            "missing-contact-parameters",
        )


def _report_missing_contact(robot: Robot, run: Run) -> Iterator[Fault]:
    """Report visuals on or below the ground whose link has no contact geometry."""
    if not any(body.shapes for body in run.bodies.bodies):
        return  # no-collision-geometry is reported
    parents = {body.parent for body in run.bodies.bodies}
    for number, body in enumerate(run.bodies.bodies):
        seen = [name for name in body.links if robot.link[name].visuals]
        if not seen or (number == 0 and run.bodies.fixed_base):
            continue
        pose = run.end.get_pose(number)
        gap = run.thresholds.ground_gap
        highest = gap
        if body.shapes:
            seen = [name for name in seen if not robot.link[name].collisions]
            highest = -_get_ground_depth(run)
            if number not in parents:  # a foot of a leg that may make contact itself
                turn, at = np.array(pose.rotation), np.array(pose.translation)
                highest = min(
                    gap,
                    compute_lowest_height(body.shapes, turn, at) - run.thresholds.foot_protrusion,
                )
        for name in seen:
            points = _collect_visual_points(robot, name, get_shape_points)
            if not len(points):
                continue
            place = pose @ body.places[name]
            heights = points @ np.array(place.rotation[2]) + place.translation[2]
            least = float(heights.min())
            if least < highest:
                where = "on" if least > -gap else f"{-least:.3g} m below"
                yield Fault(
                    "missing-contact-geometry",
                    Severity.ERROR,
                    f"link '{name}' is {where} the ground but has no "
                    f"{name_element(robot, '<collision>')}",
                    robot.link[name].place,
                    "link",
                    name,
                    "this wheel or foot makes no contact; the load is carried by its neighbors",
                    "missing-collision",
                )


def _report_submerged_visuals(robot: Robot, run: Run) -> Iterator[Fault]:
    """Report visuals below the ground that the collision geometry of their link does not reach."""
    least = _get_ground_depth(run)
    for number, body in enumerate(run.bodies.bodies):
        if number == 0 and run.bodies.fixed_base:
            continue
        pose = run.end.get_pose(number)
        turn, at = np.array(pose.rotation), np.array(pose.translation)
        for name in body.links:
            shapes = [shape for shape in body.shapes if shape.link == name]
            if not shapes or compute_lowest_height(shapes, turn, at) < -least:
                continue  # ground-penetration is reported
            place = pose @ body.places[name]
            box = compute_bounding_box(robot, robot.link[name].visuals)
            if box is None or _compute_lowest_corner(box, place) >= -least:
                continue
            points = _collect_visual_points(robot, name, get_shape_corners)
            heights = points @ np.array(place.rotation[2]) + place.translation[2]
            low, high = float(heights.min()), float(heights.max())
            if -low > least and -low > run.thresholds.submerged_visual * (high - low):
                bounds = [shape.get_bounds() for shape in shapes]
                size = max(float((upper - lower).max()) for lower, upper in bounds)
                small = size < run.thresholds.small_collision * float(
                    (points.max(axis=0) - points.min(axis=0)).max()
                )
                yield Fault(
                    "missing-contact-geometry",
                    Severity.ERROR,
                    f"visual of link '{name}' extends {-low:.3g} m below the ground, and its "
                    "collision geometry does not reach the ground",
                    robot.link[name].collisions[0].place,
                    "link",
                    name,
                    "collision is much smaller than the visual; check its size, scale and units"
                    if small
                    else "collision is offset or rotated from the visual; check its "
                    + name_element(robot, "<origin>"),
                    "collision-much-smaller-than-visual" if small else "collision-off-visual",
                )


def _compute_lowest_corner(box: tuple[Array, Array], place: Pose) -> float:
    """Compute the height of the lowest corner of a box at a pose in the world [m]."""
    up = np.array(place.rotation[2])
    middle = float(up @ (box[0] + box[1])) / 2 + place.translation[2]
    return middle - float(np.abs(up) @ (box[1] - box[0])) / 2


def _report_unlike_copies(robot: Robot, run: Run, state: FinalState) -> Iterator[Fault]:
    """Report links without collision geometry whose copies carry the robot."""
    feet = {
        look: name for name in state.supports if (look := _get_visual_key(robot, name)) is not None
    }
    for body in run.bodies.bodies[1:]:
        for name in body.links:
            look = None if robot.link[name].collisions else _get_visual_key(robot, name)
            twin = None if look is None else feet.get(look)
            if twin is not None:
                yield Fault(
                    "missing-contact-geometry",
                    Severity.ERROR,
                    f"link '{name}' has no {name_element(robot, '<collision>')}, but link '{twin}' "
                    "with equal visuals makes contact with the ground",
                    robot.link[name].place,
                    "link",
                    name,
                    "this wheel or foot makes no contact; the load is carried by its neighbors",
                    "missing-collision",
                )


def _get_visual_key(robot: Robot, name: str) -> tuple[object, ...] | None:
    """Return a key of a link's visuals, equal for copies; None without visuals."""
    visuals = robot.link[name].visuals
    if not visuals:
        return None
    return tuple(_collect_geometry_key(visual.geometry) for visual in visuals)


def _collect_geometry_key(geometry: Geometry | None) -> tuple[object, ...]:
    if isinstance(geometry, Mesh):
        return geometry.filename, *(abs(factor) for factor in geometry.scale)
    if isinstance(geometry, Box):
        return ("box", *sorted(geometry.size))
    if isinstance(geometry, Sphere):
        return "sphere", geometry.radius
    if isinstance(geometry, (Cylinder, Capsule)):
        return "round", geometry.radius, geometry.length
    return (id(geometry),)


def _collect_visual_points(
    robot: Robot, name: str, read: Callable[[Robot, Visual], Array | None]
) -> Array:
    """Collect points of a link's visuals in its frame [m], shape (n, 3)."""
    found = [np.zeros((0, 3))]
    for shape in robot.link[name].visuals:
        if isinstance(shape.geometry, (Cylinder, Sphere, Capsule)):
            pose = make_pose(shape.origin)
            corners = tessellate_primitive_triangles(shape).reshape(-1, 3)
            found.append(corners @ np.array(pose.rotation).T + np.array(pose.translation))
        elif (points := read(robot, shape)) is not None:
            found.append(points)
    return np.concatenate(found)
