"""Review of a link's written inertia: missing values and physical inconsistencies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

from ..diagnostic import Diagnostic, Severity
from ..errors import UrdftoolError
from ..finding import Finding
from ..geometry.convex_points import read_convex_points
from ..mechanics.mass_bounds import Misfit, check_com, check_spread, name_shapes
from ..mechanics.spatial_inertia import SpatialInertia, link_inertia
from ..mechanics.tensor import rotate_tensor
from ..mechanics.typo_detection import Proposal, infer_intended_tensor
from ..model.attached import find_attached_links
from ..model.bounds import Bounds, compute_bounds_at
from ..model.elements import Inertial, Mesh, Robot
from ..model.link import COMPONENTS
from ..model.pose import IDENTITY, IDENTITY_ROTATION, Pose, make_pose, rotate, transpose
from ..model.read import number
from ..model.world import WORLD
from ..rules.inertia.size import is_placeholder
from ..rules.inertia.tensors import is_positive
from .bodies import MeshBody
from .comparison import compare
from .link_review import Fault, LinkReview, get_inertial_rotation
from .mesh_files import Meshes
from .pieces import SOURCES, Shape, get_shapes

_LARGEST = 1e60
"""Numbers above it, and masses [kg] below its reciprocal, are not computed with: their products
overflow. Chosen, no source.
"""


def read_written(item: LinkReview) -> None:
    """Set the written inertia of a review, its missing values and its unreadable numbers."""
    inertial = item.link.inertial
    if inertial is None:
        is_world = item.link.name == WORLD and item.link.xml is None  # SDF, MJCF: without mass
        item.missing = () if item.link.is_frame or is_world else ("inertial",)
        return
    missing = []
    if inertial.mass is None and not _is_unreadable(inertial, "mass", "value", item):
        missing.append("mass")
    if inertial.inertia is None:
        missing.append("inertia")
    else:
        tensor = inertial.inertia.xml
        if tensor is not None:
            missing += [name for name in COMPONENTS if name not in tensor.attributes]
        for name in COMPONENTS:
            _is_unreadable(inertial, "inertia", name, item)
    item.missing = tuple(missing)
    if missing or item.faults or inertial.mass is None or inertial.inertia is None:
        return
    pose = make_pose(inertial.origin)
    largest = max(map(abs, (*inertial.inertia.six, inertial.mass, *pose.translation)))
    if largest > _LARGEST or 0 < abs(inertial.mass) < 1 / _LARGEST:
        message = (
            f"a number above {_LARGEST:g} or a mass below {1 / _LARGEST:g} is outside of "
            "the supported range"
        )
        item.faults.append(Fault("unreadable", Severity.ERROR, message, inertial.place))
        return
    item.written = link_inertia(item.link)


def _is_unreadable(inertial: Inertial, tag: str, name: str, item: LinkReview) -> bool:
    """Tell whether an attribute is present but not a number, and add a fault if so."""
    element = None if inertial.xml is None else inertial.xml.find_child(tag)
    text = element.get(name) if element is not None else None
    if element is None or text is None or number(text) is not None:
        return False
    hint = ""
    if text.startswith("{") and text.endswith("}"):
        hint = f"; xacro evaluates ${text} only in braces"
    message = f'{name}="{text}" is not a finite number{hint}'
    item.faults.append(Fault("unreadable", Severity.ERROR, message, element.locate_attribute(name)))
    return True


class Context(NamedTuple):
    """Data for judging a link."""

    robot: Robot
    meshes: Meshes


FAULTS: Mapping[str, str] = MappingProxyType(
    {
        "negative-mass": "mass",
        "zero-mass": "mass",
        "zero-inertia": "positivity",
        "singular-inertia": "positivity",
        "inertia-not-positive-definite": "positivity",
        "inertia-triangle-inequality": "triangle",
        "inertia-component-typo": "triangle",
        "inertia-off-by-power-of-ten": "triangle",
        "placeholder-inertia": "placeholder",
    }
)
"""Kind of fault for each rule that finds one; other findings are notes."""


def judge(item: LinkReview, findings: Sequence[Finding], context: Context) -> None:
    """Add what rules find, compare written inertia with the geometry, and propose a repair."""
    inertial, written = item.link.inertial, item.written
    if inertial is None or inertial.mass is None:
        return
    for finding in findings:
        _add_finding(item, finding)
    if written is None or written.mass <= 0 or inertial.inertia is None:
        return
    complete = item.body is not None and item.body.complete
    if complete and item.body is not None:
        item.comparison = compare(written, item.body.unit)
    if all(fault.code == "placeholder" for fault in item.faults):
        is_made_up = is_placeholder(item.link, inertial.inertia.six)
        _judge_box(item, inertial, context, only_com=is_made_up)
    if complete:
        item.proposal = _propose_repair(item, inertial, written)
    if item.faults and item.proposal is not None and item.proposal.kind == "copied":
        moment = f"{inertial.inertia.ixx:.6g}"
        message = f"the inertia is {moment} about every axis, that of its geometry is not"
        item.faults = [Fault("copied", Severity.ERROR, message, inertial.inertia.place)]


def _add_finding(item: LinkReview, finding: Finding) -> None:
    """Add a finding as a fault, or as a note where it is harmless or no more than a remark."""
    kind = FAULTS.get(finding.code)
    harmless = finding.data.get("is_harmless", False) or not finding.data.get("is_large", True)
    if kind is None or harmless:
        item.notes.append(finding)
        return
    if kind == "triangle" and item.written is not None and not is_positive(item.written.tensor):
        kind = "positivity"
    item.faults.append(Fault(kind, Severity.ERROR, finding.message, finding.location))


def _judge_box(item: LinkReview, inertial: Inertial, context: Context, *, only_com: bool) -> None:
    """Judge whether the mass fits into the bounding box of the shapes, as lint does.

    The shapes of ``item.body`` are tried first, then all shapes of the link, then those of attached
    links with little mass, too.
    """
    tensor, mass, link = inertial.inertia, inertial.mass, item.link
    if tensor is None or not mass:
        return
    pose = make_pose(inertial.origin)
    com, six = pose.translation, rotate_tensor(tensor.six, pose.rotation)

    def find_misfits(
        box: Bounds, has_mesh: bool, attached: Sequence[str] = ()
    ) -> list[tuple[str, Misfit]]:
        shapes, rough = name_shapes(attached), has_mesh or not link.collisions
        spread = None
        if not only_com:
            spread = check_spread(box, mass, com, six, rough, shapes=shapes)
        center = check_com(box, com, has_mesh, shapes=shapes)
        found = ("center of mass", center), ("inertia", spread)
        return [(subject, misfit) for subject, misfit in found if misfit is not None]

    if item.body is not None:
        box = _compute_shapes_box(get_shapes(link, item.body.source), IDENTITY, context)
        if box is not None and not find_misfits(box, False):
            return
    kinds = [kind for kind in SOURCES if get_shapes(link, kind)]
    boxes = [_compute_shapes_box(get_shapes(link, kind), IDENTITY, context) for kind in kinds]
    if not boxes:
        return
    whole = boxes[0]
    for box in boxes:
        if box is None or whole is None:
            message = "not compared with its geometry: one of its shapes cannot be read"
            item.notes.append(Diagnostic("not-compared", Severity.INFO, message, link.place))
            return
        if not whole.meets(box):
            message = (
                "not compared with its geometry: its visual and collision geometry do not overlap"
            )
            item.notes.append(Diagnostic("not-compared", Severity.INFO, message, link.place))
            return
        whole = whole.join(box)
    if whole is None or not any(whole.size):
        return
    shapes = [shape for kind in kinds for shape in get_shapes(link, kind)]
    has_mesh = any(isinstance(shape.geometry, Mesh) for shape in shapes)
    if not find_misfits(whole, has_mesh):
        return
    attached: list[str] = []
    for other, at in find_attached_links(context.robot, link)[1:]:
        more: list[Shape] = [*other.visuals, *other.collisions]
        if more and other.mass <= 0.1 * mass:
            attached.append(other.name)
            box = _compute_shapes_box(more, at, context)
            if box is None:
                return
            whole = whole.join(box)
    for subject, misfit in find_misfits(whole, has_mesh, attached):
        message = f"the {subject} {misfit.sentence}"
        if not misfit.certain:
            message += "; the mesh may not contain the heavy parts"
            item.notes.append(
                Diagnostic("box", Severity.INFO, message, inertial.place, data={"subject": subject})
            )
        else:
            item.faults.append(Fault("box", Severity.ERROR, message, inertial.place))


def _compute_shapes_box(shapes: Sequence[Shape], at: Pose, context: Context) -> Bounds | None:
    """Compute the bounding box of shapes at a pose of their link; None if one is unknown."""
    box: Bounds | None = None
    for shape in shapes:
        pose, geometry = at @ make_pose(shape.origin), shape.geometry
        if isinstance(geometry, Mesh):
            other = _compute_mesh_box(geometry, pose, context)
        else:
            other = compute_bounds_at(geometry, pose)
        if other is None:
            return None
        box = other if box is None else box.join(other)
    return box


def _compute_mesh_box(mesh: Mesh, pose: Pose, context: Context) -> Bounds | None:
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
        box = Bounds(*points.compute_box(mesh.scale, *pose))
    # a mesh in a wrong unit is reported for its size and is not evidence here
    return box if SMALLEST < max(box.size) < LARGEST else None


LARGEST, SMALLEST = 10.0, 0.001
"""Range of the extent of a mesh [m]; outside it, its unit is probably wrong. Chosen, no source."""


def _propose_repair(
    item: LinkReview, inertial: Inertial, written: SpatialInertia
) -> Proposal | None:
    """Propose a repair of the tensor, along the axes of the inertial's frame."""
    assert item.body is not None
    rotation = get_inertial_rotation(inertial)
    back = transpose(rotation)
    low, high = (tuple(corner.tolist()) for corner in item.body.box)
    try:
        unit = item.body.unit.rotate(back)
    except UrdftoolError:
        return None
    return infer_intended_tensor(
        written.mass,
        rotate(back, written.com),
        rotate_tensor(written.tensor, back),
        solid=unit.with_mass(written.mass).tensor,
        box=Bounds(low, high).rotate(back),
        rotation=None if rotation == IDENTITY_ROTATION else rotation,
    )
