"""Fixes of what is seen and what touches."""

from __future__ import annotations

import math
import re

from ...model.elements import Box, Collision, Cylinder, Joint, Mesh, Sphere, Visual
from ...model.pose import norm
from ...model.read import numbers
from ..collision.displaced import displaced
from ..collision.shapes import thousandth
from ..mesh.outlines import reaches
from ..rule import INFO, Problem
from ..xml.from_sdf import move_out_of_geometry as moved_up
from ..xml.vocabulary_table import VOCABULARY
from .proposal import (
    Around,
    Change,
    Proposal,
    after,
    attribute_at,
    depends_on_a_call,
    drop,
    element_at,
    is_computed,
    lines_of,
    meant,
    put,
    remove,
    replace,
    retag,
    safe,
    stands_in,
    unsafe,
    written,
)

_WRONG_PLACE = re.compile(
    r"^the (visual|collision) of link .*; (?:write xyz=\"([^\"]*)\"|give it the <origin>)"
)
_PRIMITIVES = (Box, Cylinder, Sphere)


def missing_collision(problem: Problem, around: Around) -> Proposal | None:
    """A copy of each visual, where all are primitives; small links are without one on purpose."""
    link = around.link(problem)
    if not link.visuals or link.collisions or problem.severity is INFO:
        return None
    changes = []
    for visual in link.visuals:
        geometry = visual.geometry
        if not isinstance(geometry, _PRIMITIVES):
            return None
        if not stands_in(geometry.element, visual.element):
            return None
        lines = (
            "<collision>",
            *(f"\t{line}" for origin in visual.element.all("origin") for line in lines_of(origin)),
            "\t<geometry>",
            *(f"\t\t{line}" for line in lines_of(geometry.element)),
            "\t</geometry>",
            "</collision>",
        )
        changes.append(Change("after", visual.element, blocks=(lines,)))
    return unsafe("collide with the shape that is seen", *changes)


odd_link_without_collision = missing_collision


def missing_visual(problem: Problem, around: Around) -> Proposal | None:
    """A copy of each collision."""
    link = around.link(problem)
    changes = []
    for collision in link.collisions:
        if collision.geometry is None:
            return None
        if not stands_in(collision.geometry.element, collision.element):
            return None
        lines = (
            "<visual>",
            *(f"\t{line}" for o in collision.element.all("origin") for line in lines_of(o)),
            "\t<geometry>",
            *(f"\t\t{line}" for line in lines_of(collision.geometry.element)),
            "\t</geometry>",
            "</visual>",
        )
        changes.append(Change("after", collision.element, blocks=(lines,)))
    return unsafe("show the shape that collides", *changes)


def collision_off_visual(problem: Problem, around: Around) -> Proposal | None:
    """Where the other is, where it is known which of the two is wrong."""
    link = around.link(problem)
    found = _WRONG_PLACE.search(problem.message)
    if found is None or len(link.visuals) != 1 or len(link.collisions) != 1:
        return None
    if depends_on_a_call(link.element, "visual", "collision", "inertial"):
        return None
    kind, xyz = found[1], found[2]
    wrong: Visual | Collision = link.visuals[0]
    right: Visual | Collision = link.collisions[0]
    if kind == "collision":
        wrong, right = right, wrong
    if xyz is not None:
        lines: tuple[str, ...] = (f'<origin xyz="{xyz}"/>',)
        what = f'write xyz="{xyz}" for its {kind}'
    else:
        lines = tuple(line for origin in right.element.all("origin") for line in lines_of(origin))
        what = f"give the {kind} the <origin> of the {right.element.tag}"
    if wrong.origin is None:
        change = Change("first", wrong.element, blocks=(lines,))
    elif xyz is not None:
        change = put(wrong.origin.element, "xyz", xyz)
    elif lines:
        change = replace(wrong.origin.element, lines)
    else:
        change = remove(wrong.origin.element)
    return unsafe(what, change)


def collision_mesh_displaced(problem: Problem, around: Around) -> Proposal | None:
    """The origin of the other one, where the center of mass says which of the two is right."""
    link, robot = around.link(problem), around.robot
    found = next(
        (
            pair
            for pair in displaced(robot, link)
            if (pair.collision.origin or pair.collision).place == problem.place
        ),
        None,
    )
    com = link.inertial.origin.xyz if link.inertial and link.inertial.origin else None
    if found is None or com is None or not any(com):
        return None  # a center of mass at the frame may be missing as well
    boxes = [reaches(robot).shape(shape) for shape in (found.visual, found.collision)]
    if boxes[0] is None or boxes[1] is None:
        return None
    visual, collision = (math.dist(com, box.centre) for box in boxes if box is not None)
    if 2 * visual < collision:
        return unsafe("give it the <origin> of the visual", _moved(found.collision, found.visual))
    if 2 * collision < visual:
        return unsafe(
            "give the visual the <origin> of the collision", _moved(found.visual, found.collision)
        )
    return None


def _moved(shape: Visual | Collision, model: Visual | Collision) -> Change:
    """Give a shape the origin of another."""
    lines = tuple(line for origin in model.element.all("origin") for line in lines_of(origin))
    if shape.origin is None:
        return Change("first", shape.element, blocks=(lines,))
    if lines:
        return replace(shape.origin.element, lines)
    return remove(shape.origin.element)


def unsupported_shape(problem: Problem, around: Around) -> Proposal | None:
    """The shape that was meant; what belongs elsewhere goes there."""
    element = element_at(problem)
    if element is not None and element.tag in VOCABULARY and element.parent is not None:
        return moved_up(element, element.parent)
    name = meant(problem, element.tag) if element is not None else ""
    if element is None or not name:
        return None
    return unsafe(f"write <{name}>", retag(element, name))


def shape_in_millimetres(problem: Problem, around: Around) -> Proposal | None:
    """The lengths in meters."""
    element = element_at(problem)
    if element is None or is_computed(element):
        return None
    changes = [
        put(element, name, thousandth(element.get(name)))
        for name in ("size", "radius", "length")
        if name in element.attributes
    ]
    return unsafe("write the lengths in meters", *changes)


def wheel_cylinder_axis(problem: Problem, around: Around) -> Proposal | None:
    """The cylinder turned until its length lies along the axle, or the axis along the cylinder."""
    subject = problem.subject
    found = re.search(r'write <axis xyz="([^"]*)"/>', problem.message)
    if isinstance(subject, Joint):
        if found is None:
            return None
        text = found[1]
        if subject.axis is not None:
            change = put(subject.axis.element, "xyz", text)
        else:
            behind = subject.child_element or subject.parent_element
            if behind is None:
                return None
            change = after(behind, f'<axis xyz="{text}"/>')
        return unsafe(f'write <axis xyz="{text}"/>', change)
    link = around.link(problem)
    joint = around.robot.tree.parent_joint(link.name)
    if joint is None or joint.is_fixed or len(link.collisions) != 1:
        return None
    if "until z lies along the axis" not in problem.message:
        return None
    axis = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    collision = link.collisions[0]
    along = {1: "1.5707963267948966 0 0", 0: "0 1.5707963267948966 0", 2: "0 0 0"}
    place = max(range(3), key=lambda i: abs(axis[i]))
    if abs(axis[place]) < 0.999 * norm(axis):
        return None
    rpy = along[place]
    if collision.origin is not None:
        if collision.origin.quaternion is not None:
            return None
        change = put(collision.origin.element, "rpy", rpy)
    else:
        change = Change("first", collision.element, blocks=((f'<origin rpy="{rpy}"/>',),))
    return unsafe(f'write rpy="{rpy}"', change)


def caster_height_mismatch(problem: Problem, around: Around) -> Proposal | None:
    """At the height at which it ends where the wheels do."""
    found = re.search(r"write z = (-?[\d.]+) for", problem.message)
    origin = element_at(problem)
    if found is None or origin is None or origin.tag != "origin":
        return None
    words = written(origin, "xyz").split()
    if len(words) != 3 or is_computed(origin, "xyz"):
        return None
    x, y, _ = words
    return unsafe(f"write z = {found[1]}", put(origin, "xyz", f"{x} {y} {found[1]}"))


def invalid_color(problem: Problem, around: Around) -> Proposal | None:
    """On a scale of 0 to 1."""
    found = attribute_at(problem)
    values = numbers(found[0].get(found[1]), 4) if found is not None else None
    if found is None or values is None:
        return None
    if "scale of 0 to 255" in problem.message:
        opacity = 1.0 if values[3] <= 1 and values[3] else values[3] / 255
        text = " ".join(f"{value:.4g}" for value in (*(v / 255 for v in values[:3]), opacity))
    else:
        text = " ".join(f"{min(1.0, max(0.0, value)):.6g}" for value in values)
    return unsafe(f'write rgba="{text}"', put(*found, text))


def fully_transparent(problem: Problem, around: Around) -> Proposal | None:
    """Opaque."""
    found = attribute_at(problem, around.robot.element)
    values = (found[0].get(found[1]) or "").split() if found is not None else []
    if found is None or len(values) != 4:
        return None
    text = " ".join([*values[:3], "1"])
    return unsafe(f'write rgba="{text}"', put(*found, text))


def empty_material_name(problem: Problem, around: Around) -> Proposal | None:
    """Name it by its color.

    urdfdom drops the shapes behind a material without a ``name``, and has them afterwards.
    """
    found = attribute_at(problem)
    link = around.link(problem)
    if found is None and not any(v.material and not v.material.name for v in link.visuals):
        return None
    changes = []
    for visual in link.visuals:
        material = visual.material
        if material is None or material.name or (found and material.element is not found[0]):
            continue
        if material.color is None or any(not 0 <= part <= 1 for part in material.color):
            return None
        if is_computed(material.element.child("color") or material.element, "rgba"):
            return None
        name = "rgba_" + "".join(f"{round(part * 255):02x}" for part in material.color)
        known = {m.name: m.color for m in around.robot.materials}
        if known.get(name, material.color) != material.color:
            return None
        changes.append(put(material.element, "name", name))
    there = all("name" in change.element.attributes for change in changes)
    return (safe if there else unsafe)("name it by its color", *changes) if changes else None


def unused_material(problem: Problem, around: Around) -> Proposal | None:
    """Remove it; in xacro another robot, or other arguments, may use it."""
    make = safe if around.description.expansion is None else unsafe
    return make("take it out", remove(problem.element))


def mesh_in_millimetres(problem: Problem, around: Around) -> Proposal | None:
    """A thousandth, wherever the file is used without a scale."""
    found = attribute_at(problem)
    if found is None:
        return None
    uri = found[0].get("filename")
    changes = []
    for _, shape in around.robot.shapes:
        if isinstance(shape.geometry, Mesh) and shape.geometry.filename == uri:
            if shape.geometry.element.get("scale"):
                return None
            changes.append(put(shape.geometry.element, "scale", "0.001 0.001 0.001"))
    return unsafe('write scale="0.001 0.001 0.001"', *changes)


def mesh_scaled_twice(problem: Problem, around: Around) -> Proposal | None:
    """Without the scale, wherever the file is used with one of a thousandth."""
    found = attribute_at(problem)
    if found is None or "take the scale away" not in problem.message:
        return None
    uri = found[0].get("filename")
    changes = []
    for _, shape in around.robot.shapes:
        if isinstance(shape.geometry, Mesh) and shape.geometry.filename == uri:
            if any(not math.isclose(part, 0.001) for part in shape.geometry.scale):
                return None
            changes.append(drop(shape.geometry.element, "scale"))
    return unsafe("take the scale away", *changes)


def optical_frame_orientation(problem: Problem, around: Around) -> Proposal | None:
    """Turned as a camera looks."""
    joint = around.joint(problem)
    rpy = "-1.5707963267948966 0 -1.5707963267948966"
    if joint.origin is not None:
        if "quat_xyzw" in joint.origin.element.attributes:
            return None
        change = put(joint.origin.element, "rpy", rpy)
    else:
        change = Change("first", joint.element, blocks=((f'<origin rpy="{rpy}"/>',),))
    return unsafe(f'write rpy="{rpy}"', change)
