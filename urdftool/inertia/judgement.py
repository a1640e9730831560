"""What of a link's inertia is written, and what of that cannot be."""

from __future__ import annotations

import math

import numpy as np

from ..errors import UrdftoolError
from ..model.elements import Inertial
from ..model.pose import pose_of
from ..model.read import number
from ..source.location import Place
from .bound import spread_ratio
from .comparison import compare
from .link_review import NAMES, Fault, LinkReview, inertial_rotation
from .mesh_files import Meshes
from .pieces import link_body, mesh_names, shapes_of
from .proposal import ROUNDING, SPREAD, Proposal, propose
from .tensor import (
    Array,
    MassProperties,
    is_positive,
    principal,
    rotate,
    tensor_from_six,
    triangle_excess,
)

_LARGEST = 1e60


def read_written(item: LinkReview) -> None:
    """Take what is written of a link's inertia, what is missing, and what is no number."""
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
        missing += [name for name in NAMES if name not in attributes]
        for name in NAMES:
            _unreadable(inertial, "inertia", name, item)
    item.missing = tuple(missing)
    if missing or item.faults or inertial.mass is None or inertial.inertia is None:
        return
    pose = pose_of(inertial.origin)
    six = [getattr(inertial.inertia, name) for name in NAMES]
    largest = max(map(abs, (*six, inertial.mass, *pose.translation)))
    if largest > _LARGEST or 0 < abs(inertial.mass) < 1 / _LARGEST:
        message = f"a number above {_LARGEST:g} or a mass below {1 / _LARGEST:g} is no robot's"
        item.faults.append(Fault("unreadable", message, inertial.place))
        return
    item.written = MassProperties(
        inertial.mass,
        np.array(pose.translation, dtype=np.float64),
        rotate(tensor_from_six(*six), np.array(pose.rotation, dtype=np.float64)),
    )


def _unreadable(inertial: Inertial, tag: str, name: str, item: LinkReview) -> bool:
    """Whether an attribute is there and is no number, which is a fault."""
    element = inertial.element.child(tag)
    text = element.get(name) if element is not None else None
    if element is None or text is None or number(text) is not None:
        return False
    hint = ""
    if text.startswith("{") and text.endswith("}"):
        hint = f"; in xacro, ${text} would be evaluated"
    message = f'{name}="{text}" is not a finite number{hint}'
    item.faults.append(Fault("unreadable", message, element.attribute_place(name)))
    return True


def judge(item: LinkReview, meshes: Meshes) -> None:
    """Compare what is written with the geometry, find what cannot be, propose a repair."""
    inertial, written = item.link.inertial, item.written
    if inertial is None or inertial.mass is None:
        return
    mass_element = inertial.element.child("mass")
    at = mass_element.attribute_place("value") if mass_element is not None else inertial.place
    if inertial.mass < 0:
        item.faults.append(
            Fault("mass", f"the mass is {inertial.mass:g} kg; it must be above zero", at)
        )
    elif inertial.mass == 0 and (item.body or (written is not None and written.inertia.any())):
        item.faults.append(Fault("mass", "the mass is 0 kg; what has a shape weighs something", at))
    if written is None or written.mass <= 0 or inertial.inertia is None:
        return
    complete = item.body is not None and item.body.complete
    if complete and item.body is not None:
        item.comparison = compare(written, item.body.unit)
    _judge_tensor(item, written, inertial.inertia.place)
    if not item.faults:
        _judge_box(item, written, inertial.place, meshes)
    if complete:
        item.proposal = _proposal(item, inertial, written)
    if item.proposal is not None and item.proposal.kind == "copied":
        moment = f"{inertial.inertia.ixx:.6g}"
        message = f"the inertia is {moment} about every axis, that of its geometry is not"
        item.faults = [Fault("copied", message, inertial.inertia.place)]


def _judge_tensor(item: LinkReview, written: MassProperties, at: Place) -> None:
    moments = principal(written.inertia)[0]
    shown = ", ".join(f"{moment:.4g}" for moment in moments)
    if not is_positive(written.inertia, tolerance=1e-6) or moments[0] <= 0 < (item.volume or 0.0):
        message = f"principal moments {shown} kg m² are not all positive"
        item.faults.append(Fault("positivity", message, at))
        return
    excess = triangle_excess(written.inertia)
    if excess > ROUNDING:
        message = (
            f"principal moment {moments[2]:.4g} is larger than {moments[0]:.4g} + "
            f"{moments[1]:.4g} kg m², which no rigid body has"
        )
        item.faults.append(Fault("triangle", message, at))
    elif excess > 1e-12:
        item.notes.append(
            f"principal moments {shown} break the triangle inequality by rounding "
            f"({excess:.1g}), which MuJoCo does not take"
        )


def _judge_box(item: LinkReview, written: MassProperties, at: Place, meshes: Meshes) -> None:
    """Whether so wide a spread of mass fits into the box around the geometry of either kind."""
    if item.body is None or not item.body.complete:
        return
    low, high = item.body.box
    if _worst_spread(written, low, high) <= SPREAD:
        return
    other = "visual" if item.body.source == "collision" else "collision"
    meshes.want(mesh_names(shapes_of(item.link, other)))
    body = link_body(item.link, other, meshes.known)
    if body is not None:
        if not body.complete:
            item.notes.append(f"not judged against its box: a {other} of it cannot be read")
            return
        low, high = np.minimum(low, body.box[0]), np.maximum(high, body.box[1])
    worst = _worst_spread(written, low, high)
    if worst <= SPREAD:
        return
    corners = " to ".join(" ".join(f"{value:.4g}" for value in corner) for corner in (low, high))
    if math.isinf(worst):
        com = " ".join(f"{value:.4g}" for value in written.com)
        message = f"the centre of mass {com} is outside the geometry, which spans {corners} m"
    else:
        message = (
            f"the inertia needs mass spread {math.sqrt(worst):.3g} times as far as the geometry "
            f"reaches, which spans {corners} m"
        )
    item.faults.append(Fault("box", message, at))


def _worst_spread(written: MassProperties, low: Array, high: Array) -> float:
    return float(spread_ratio(written.mass, written.com, written.inertia, low, high).max())


def _proposal(item: LinkReview, inertial: Inertial, written: MassProperties) -> Proposal | None:
    """The repair of the tensor along the axes of the inertial's own frame, as it is written."""
    assert item.body is not None
    turn = inertial_rotation(inertial)
    turned = not np.array_equal(turn, np.eye(3))
    unit, (low, high) = item.body.unit, item.body.box
    centre, half = (low + high) / 2, (high - low) / 2
    if turned:
        unit = MassProperties(unit.mass, turn.T @ unit.com, rotate(unit.inertia, turn.T))
        centre, half = turn.T @ centre, np.abs(turn.T) @ half
    try:
        return propose(
            written.mass,
            turn.T @ written.com,
            rotate(written.inertia, turn.T),
            implied=unit,
            box=(centre - half, centre + half),
            rotation=turn if turned else None,
        )
    except UrdftoolError:
        return None
