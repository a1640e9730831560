"""Review of a link's written inertia: missing values and physical inconsistencies."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from ..errors import UrdftoolError
from ..geometry.convex_points import read_convex_points
from ..mechanics.mass_bounds import Misfit, misfit_of_com, misfit_of_spread, shapes_in_words
from ..mechanics.spatial_inertia import SpatialInertia, combine_links, link_inertia
from ..mechanics.tensor import COMPONENTS, consistency, noise_of, principal_moments, rotate_tensor
from ..mechanics.typo_detection import ROUNDING, Proposal, infer_intended_tensor
from ..model.attached import attached_links, is_fixed_to_world
from ..model.bounds import Bounds, bounds_at
from ..model.elements import Inertia, Inertial, Link, Mesh, Robot
from ..model.pose import IDENTITY, UPRIGHT, Pose, pose_of, rotate, transpose
from ..model.read import number
from ..model.world import WORLD
from ..source.location import Place
from .bodies import MeshBody
from .comparison import compare
from .link_review import Fault, LinkReview, inertial_rotation
from .mesh_files import Meshes
from .pieces import SOURCES, Shape, shapes_of

_LARGEST = 1e60


def read_written(item: LinkReview) -> None:
    """Set the written inertia of a review, its missing values and its unreadable numbers."""
    inertial = item.link.inertial
    if inertial is None:
        item.missing = () if item.link.is_frame else ("inertial",)
        return
    missing = []
    if inertial.mass is None and not _unreadable(inertial, "mass", "value", item):
        missing.append("mass")
    if inertial.inertia is None:
        missing.append("inertia")
    else:
        attributes = inertial.inertia.element.attributes
        missing += [name for name in COMPONENTS if name not in attributes]
        for name in COMPONENTS:
            _unreadable(inertial, "inertia", name, item)
    item.missing = tuple(missing)
    if missing or item.faults or inertial.mass is None or inertial.inertia is None:
        return
    pose = pose_of(inertial.origin)
    largest = max(map(abs, (*inertial.inertia.six, inertial.mass, *pose.translation)))
    if largest > _LARGEST or 0 < abs(inertial.mass) < 1 / _LARGEST:
        message = (
            f"a number above {_LARGEST:g} or a mass below {1 / _LARGEST:g} is outside of "
            "the supported range"
        )
        item.faults.append(Fault("unreadable", message, inertial.place))
        return
    item.written = link_inertia(item.link)


def _unreadable(inertial: Inertial, tag: str, name: str, item: LinkReview) -> bool:
    """Tell whether an attribute is present but not a number, and add a fault if so."""
    element = inertial.element.child(tag)
    text = element.get(name) if element is not None else None
    if element is None or text is None or number(text) is not None:
        return False
    hint = ""
    if text.startswith("{") and text.endswith("}"):
        hint = f"; xacro evaluates ${text} only in braces"
    message = f'{name}="{text}" is not a finite number{hint}'
    item.faults.append(Fault("unreadable", message, element.attribute_place(name)))
    return True


class Context(NamedTuple):
    """Data for judging a link.

    Attributes:
        robot: The robot.
        meshes: Bodies of its meshes.
    """

    robot: Robot
    meshes: Meshes


def judge(item: LinkReview, context: Context) -> None:
    """Compare written inertia with the geometry, and add faults and a proposed repair.

    The verdict agrees with ``urdftool lint``: what lint reports as information is a note here.
    """
    inertial, written = item.link.inertial, item.written
    if inertial is None or inertial.mass is None:
        return
    _judge_mass(item, inertial, context.robot)
    if written is None or written.mass <= 0 or inertial.inertia is None:
        return
    complete = item.body is not None and item.body.complete
    if complete and item.body is not None:
        item.comparison = compare(written, item.body.unit)
    _judge_tensor(item, written, inertial.inertia.place, context.robot)
    if not item.faults:
        made_up = _judge_placeholder(item, inertial.inertia, written.mass)
        _judge_box(item, inertial, context, only_com=made_up)
    if complete:
        item.proposal = _proposal(item, inertial, written)
    if item.faults and item.proposal is not None and item.proposal.kind == "copied":
        moment = f"{inertial.inertia.ixx:.6g}"
        message = f"the inertia is {moment} about every axis, that of its geometry is not"
        item.faults = [Fault("copied", message, inertial.inertia.place)]


def _judge_mass(item: LinkReview, inertial: Inertial, robot: Robot) -> None:
    """Judge the mass; 0 is valid for a part of a body with mass, and for a static root."""
    mass = inertial.element.child("mass")
    at = mass.attribute_place("value") if mass is not None else inertial.place
    assert inertial.mass is not None
    if inertial.mass < 0:
        message = f"the mass is {inertial.mass:g} kg; it must be above zero"
        item.faults.append(Fault("mass", message, at))
    if inertial.mass != 0 or item.link.name == WORLD:
        return
    members = [link for link, _ in attached_links(robot, item.link)]
    if sum(link.mass for link in members) > 0:
        if inertial.inertia is not None and any(inertial.inertia.six):
            message = "the mass is 0 kg, and the inertia is not"
            item.faults.append(Fault("mass", message, at))
        else:
            item.notes.append("a mass of 0: the link adds none to what it is fixed to")
        return
    joints = [robot.tree.parent_joint(link.name) for link in members]
    if any(joint is not None and not joint.is_fixed for joint in joints):
        item.faults.append(Fault("mass", "the mass is 0 kg; a body that moves has a mass", at))
    else:
        item.notes.append("a mass of 0: PyBullet takes the robot as static, and Gazebo removes it")


def _judge_tensor(item: LinkReview, written: SpatialInertia, at: Place, robot: Robot) -> None:
    found = consistency(written.tensor)
    moments, excess = found.moments, found.excess
    shown = ", ".join(f"{moment:.4g}" for moment in moments)
    nothing = max(map(abs, written.tensor)) <= noise_of(written.mass)
    thin = nothing or moments[0] <= 0 < (item.volume or 0.0)
    negative = not nothing and found.negativity > 1e-6
    impossible = not nothing and excess > ROUNDING
    if thin and not negative and not impossible and _is_added(robot, item.link):
        item.notes.append(
            f"principal moments {shown} kg m²: no body of its own, and harmless, since it is a "
            "part of one that has an inertia or does not move"
        )
        return
    if negative or (thin and not impossible):
        message = f"principal moments {shown} kg·m² are not all positive"
        item.faults.append(Fault("positivity", message, at))
        return
    if excess > ROUNDING:
        message = (
            f"principal moment {moments[2]:.4g} is larger than {moments[0]:.4g} + "
            f"{moments[1]:.4g} kg·m², which is physically inconsistent"
        )
        item.faults.append(Fault("triangle", message, at))
    elif excess > 1e-12:
        item.notes.append(
            f"principal moments {shown} break the triangle inequality by rounding "
            f"({excess:.1g}), which MuJoCo rejects"
        )


def _is_added(robot: Robot, link: Link) -> bool:
    """Tell whether a link is attached to a body with inertia, or fixed to the world."""
    members = attached_links(robot, link)
    if is_fixed_to_world(robot, link):
        return True
    return len(members) > 1 and not combine_links(members).is_thin


def _judge_box(item: LinkReview, inertial: Inertial, context: Context, *, only_com: bool) -> None:
    """Judge whether the mass fits into the bounding box of the shapes, as lint does.

    The shapes of ``item.body`` are tried first, then all shapes of the link, then those of attached
    links with little mass, too.
    """
    tensor, mass, link = inertial.inertia, inertial.mass, item.link
    if tensor is None or not mass:
        return
    pose = pose_of(inertial.origin)
    com, six = pose.translation, rotate_tensor(tensor.six, pose.rotation)

    def misfits(
        box: Bounds, has_mesh: bool, attached: Sequence[str] = ()
    ) -> list[tuple[str, Misfit]]:
        shapes, rough = shapes_in_words(attached), has_mesh or not link.collisions
        spread = None
        if not only_com:
            spread = misfit_of_spread(box, mass, com, six, rough, shapes=shapes)
        center = misfit_of_com(box, com, has_mesh, shapes=shapes)
        found = ("center of mass", center), ("inertia", spread)
        return [(subject, misfit) for subject, misfit in found if misfit is not None]

    if item.body is not None:
        box = _box_of_shapes(shapes_of(link, item.body.source), IDENTITY, context)
        if box is not None and not misfits(box, False):
            return
    kinds = [kind for kind in SOURCES if shapes_of(link, kind)]
    boxes = [_box_of_shapes(shapes_of(link, kind), IDENTITY, context) for kind in kinds]
    if not boxes:
        return
    whole = boxes[0]
    for box in boxes:
        if box is None or whole is None:
            item.notes.append("not compared with its geometry: one of its shapes cannot be read")
            return
        if not whole.meets(box):
            item.notes.append(
                "not compared with its geometry: its visual and collision geometry do not overlap"
            )
            return
        whole = whole.joined(box)
    if whole is None or not any(whole.size):
        return
    shapes = [shape for kind in kinds for shape in shapes_of(link, kind)]
    has_mesh = any(isinstance(shape.geometry, Mesh) for shape in shapes)
    if not misfits(whole, has_mesh):
        return
    attached: list[str] = []
    for other, at in attached_links(context.robot, link)[1:]:
        more: list[Shape] = [*other.visuals, *other.collisions]
        if more and other.mass <= 0.1 * mass:
            attached.append(other.name)
            box = _box_of_shapes(more, at, context)
            if box is None:
                return
            whole = whole.joined(box)
    for subject, misfit in misfits(whole, has_mesh, attached):
        message = f"the {subject} {misfit.sentence}"
        if not misfit.certain:
            item.notes.append(f"{message}; the mesh may not contain the heavy parts")
        else:
            item.faults.append(Fault("box", message, inertial.place))


def _box_of_shapes(shapes: Sequence[Shape], at: Pose, context: Context) -> Bounds | None:
    """Compute the bounding box of shapes at a pose of their link; None if one is unknown."""
    box: Bounds | None = None
    for shape in shapes:
        pose, geometry = at @ pose_of(shape.origin), shape.geometry
        if isinstance(geometry, Mesh):
            other = _box_of_mesh(geometry, pose, context)
        else:
            other = bounds_at(geometry, pose)
        if other is None:
            return None
        box = other if box is None else box.joined(other)
    return box


def _box_of_mesh(mesh: Mesh, pose: Pose, context: Context) -> Bounds | None:
    """Compute the bounding box of a mesh; points are read only if its body's box is of no use."""
    body, source = context.meshes.known.get(mesh.filename), context.robot.source
    if 0 in mesh.scale or source is None:
        return None
    aligned = all(sum(abs(part) > 1e-9 for part in row) == 1 for row in pose.rotation)
    if aligned and isinstance(body, MeshBody):
        (a, b, c), ends = mesh.scale, (body.lower.tolist(), body.upper.tolist())
        corners = [pose.transform((a * x, b * y, c * z)) for x, y, z in ends]
        (d, e, f), (g, h, i) = corners
        box = Bounds((min(d, g), min(e, h), min(f, i)), (max(d, g), max(e, h), max(f, i)))
    else:
        try:
            points = read_convex_points(source.resolve(mesh.filename), source.gltf_up)
        except UrdftoolError:
            return None
        if points is None:
            return None
        box = Bounds(*points.box(mesh.scale, *pose))
    # a mesh in a wrong unit is reported for its size and is not evidence here
    return box if SMALLEST < max(box.size) < LARGEST else None


LARGEST, SMALLEST = 10.0, 0.001
"""Range of the extent of a mesh [m]; outside it, its unit is probably wrong."""


def _judge_placeholder(item: LinkReview, inertia: Inertia, mass: float) -> bool:
    """Tell whether a tensor is the same power of ten about every axis: a placeholder.

    A large one is added as a fault, a small one as a note, as in lint.
    """
    xx, xy, xz, yy, yz, zz = inertia.six
    if not (xx == yy == zz > 0 and xy == xz == yz == 0):
        return False
    power = math.log10(xx)
    if abs(power - round(power)) > 1e-9:
        return False
    shapes = item.link.collisions or item.link.visuals
    if item.implied is not None and len(shapes) == 1 and not isinstance(shapes[0].geometry, Mesh):
        if all(0.5 * xx <= moment <= 2 * xx for moment in principal_moments(item.implied.tensor)):
            return False
    message = f"the inertia is a placeholder, {xx:g} about every axis"
    if xx == 1.0 or xx > mass:
        item.faults.append(Fault("placeholder", message, inertia.place))
    else:
        item.notes.append(message)
    return True


def _proposal(item: LinkReview, inertial: Inertial, written: SpatialInertia) -> Proposal | None:
    """Propose a repair of the tensor, along the axes of the inertial's frame."""
    assert item.body is not None
    rotation = inertial_rotation(inertial)
    back = transpose(rotation)
    low, high = (tuple(corner.tolist()) for corner in item.body.box)
    try:
        unit = item.body.unit.rotated(back)
    except UrdftoolError:
        return None
    return infer_intended_tensor(
        written.mass,
        rotate(back, written.com),
        rotate_tensor(written.tensor, back),
        solid=unit.with_mass(written.mass).tensor,
        box=Bounds(low, high).rotated(back),
        rotation=None if rotation == UPRIGHT else rotation,
    )
