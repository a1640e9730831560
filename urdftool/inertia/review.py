"""A robot looked over: for each link what is written, what its geometry implies, what cannot be."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..errors import UrdftoolError
from ..model.elements import Inertial, Link, Robot
from ..model.pose import pose_of
from ..model.read import number
from ..source.location import Place
from .bodies import weighed
from .bound import spread_ratio
from .comparison import Comparison, compare
from .masses import Masses, check_masses, weigh
from .pieces import SOURCES, LinkBody, link_body, mesh_names, shapes_of
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

NAMES = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")

_LARGEST = 1e60

ReadMeshes = Callable[[Sequence[str]], dict[str, Any]]


@dataclass(frozen=True)
class Fault:
    """Something that cannot be.

    Attributes:
        kind: ``"unreadable"``, ``"mass"``, ``"positivity"``, ``"triangle"``, ``"box"`` or
            ``"copied"``.
        message: What is wrong, with what would be right.
        place: Where it is written.
    """

    kind: str
    message: str
    place: Place


@dataclass(eq=False)
class LinkReview:
    """One link.

    Attributes:
        link: The link.
        body: What its geometry encloses; None where it has none.
        written: Its mass properties as written, in the link frame; None where they are not whole.
        missing: What of them is not written: ``inertial``, ``mass``, ``inertia``, or single
            numbers such as ``ixy``.
        mass: What it weighs [kg], written or wanted; None where nothing says.
        implied: The geometry's mass properties at that mass, in the link frame.
        comparison: Written against implied.
        faults: What cannot be.
        proposal: The one simple slip that explains a wrong tensor.
        notes: What else is to be said.
    """

    link: Link
    body: LinkBody | None = None
    written: MassProperties | None = None
    missing: tuple[str, ...] = ()
    mass: float | None = None
    implied: MassProperties | None = None
    comparison: Comparison | None = None
    faults: list[Fault] = field(default_factory=list)
    proposal: Proposal | None = None
    notes: list[str] = field(default_factory=list)

    @property
    def status(self) -> str:
        """``wrong``, ``doubtful``, ``frame``, ``missing``, ``incomplete`` or ``ok``."""
        if self.faults:
            return "wrong"
        if self.proposal is not None:
            return "doubtful"
        if self.link.is_frame:
            return "frame"
        if self.missing:
            return "missing" if self.missing == ("inertial",) else "incomplete"
        return "ok"


def review(
    robot: Robot,
    read_meshes: ReadMeshes,
    *,
    masses: Masses | None = None,
    source: str | None = None,
    only: Sequence[str] = (),
) -> list[LinkReview]:
    """Look a robot over.

    Args:
        robot: The robot.
        read_meshes: What the named mesh files enclose, or why it is not known.
        masses: What links weigh; None for what is written.
        source: ``"collision"`` or ``"visual"``; None takes the collisions of a link, or its visuals
            where it has none, or none that can be weighed.
        only: Names of the links wanted; all if empty.

    Raises:
        InertiaError: The masses are not possible.
    """
    masses = masses or Masses()
    check_masses(masses, [link.name for link in robot.links])
    found = [LinkReview(link) for link in robot.links]
    meshes = _Meshes(read_meshes)
    _find_bodies(found, meshes, source)
    for item in found:
        _read_written(item)
    plan = weigh(
        masses,
        {item.link.name: _written_mass(item.link) for item in found},
        {item.link.name: _volume(item) for item in found},
        [item.link.name for item in found if item.body is not None and not item.body.complete],
    )
    for item in found:
        item.mass = plan[item.link.name]
        if item.mass and item.body is not None and item.body.complete:
            item.implied = weighed(item.body.unit, "link", mass=item.mass)
        _judge(item, meshes)
    return [item for item in found if not only or item.link.name in only]


class _Meshes:
    """Meshes that have been read, and more where they are wanted."""

    def __init__(self, read: ReadMeshes) -> None:
        self.read = read
        self.known: dict[str, Any] = {}

    def want(self, names: Iterator[str] | Sequence[str]) -> dict[str, Any]:
        new = [name for name in dict.fromkeys(names) if name not in self.known]
        if new:
            self.known |= self.read(new)
        return self.known


def _find_bodies(found: list[LinkReview], meshes: _Meshes, source: str | None) -> None:
    """The body of each link from the source that is wanted; the meshes of all read in one go."""
    for name in (source,) if source else SOURCES:
        todo = [
            item
            for item in found
            if (item.body is None or not item.body.complete) and shapes_of(item.link, name)
        ]
        meshes.want([mesh for item in todo for mesh in mesh_names(shapes_of(item.link, name))])
        for item in todo:
            body = link_body(item.link, name, meshes.known)
            if item.body is None or (body is not None and body.complete):
                item.body = body


def _volume(item: LinkReview) -> float | None:
    return item.body.volume if item.body is not None and item.body.complete else None


def _written_mass(link: Link) -> float | None:
    mass = link.inertial.mass if link.inertial else None
    return mass if mass and mass > 0 else None


def inertial_rotation(inertial: Inertial | None) -> Array:
    """The rotation of an inertial's frame in the link frame."""
    return np.array(pose_of(inertial.origin if inertial else None).rotation, dtype=np.float64)


def _read_written(item: LinkReview) -> None:
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
    if max(map(abs, (*six, inertial.mass, *pose.translation))) > _LARGEST:
        message = f"a number above {_LARGEST:g} is beyond any robot"
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


def _judge(item: LinkReview, meshes: _Meshes) -> None:
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
    if not is_positive(written.inertia, tolerance=1e-6) or moments[0] <= 0 < _flatness(item):
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


def _flatness(item: LinkReview) -> float:
    """Volume of the geometry; a body that has one has no principal moment of zero."""
    return _volume(item) or 0.0


def _judge_box(item: LinkReview, written: MassProperties, at: Place, meshes: _Meshes) -> None:
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
