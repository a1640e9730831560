"""Rigid bodies of a robot, as picklable data for any engine."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..mechanics.spatial_inertia import SpatialInertia, combine, link_inertia
from ..model.actuation import find_actuated_joints
from ..model.elements import ZERO, Joint, Link, Robot
from ..model.kinematics import find_movable_joints, get_limits, link_poses
from ..model.pose import IDENTITY, Pose, make_pose, rotation_from_rpy
from ..model.settings import RESISTANCE_OF_URDF, SURFACE, get_number
from ..model.start import start_positions
from .control import NONE
from .recording import Array
from .settings import Settings
from .shapes import Shape, make_shapes


def choose_surface(robot: Robot, links: Iterable[str]) -> dict[str, float]:
    """Return the contact parameters that a rigid body of several links has, by their rows.

    Engines have one set for a body: if its collisions differ, the smallest of each is used. A
    stiffness of 0 is none.
    """
    found: dict[str, float] = {}
    for settings in (shape.surface for name in links for shape in robot.link[name].collisions):
        for row in SURFACE:
            value = get_number(settings, row.name)
            if value is not None and value >= 0:
                found[row.name] = min(found.get(row.name, value), value)
    if found.get("contact_stiffness") == 0:
        del found["contact_stiffness"]
    return found


TENSOR_ROUNDING = 0.01
"""Relative violation of the triangle inequality by rounding [1]; engines get a valid tensor."""

ROOTED = "world"
"""The name of a root link that Gazebo fixes to the world."""


@dataclass(frozen=True)
class RigidBodyJoint:
    """The joint between a body and its parent.

    Attributes:
        name: Name of the joint.
        kind: ``revolute``, ``continuous`` or ``prismatic``.
        axis: Unit vector in the joint's frame.
        lower: Lower limit [rad, m]; -inf without one.
        upper: Upper limit [rad, m]; inf without one.
        effort: Effort limit [N·m, N]; None without one, or if it is zero.
        resistance: Values of ``RESISTANCE`` of the URDF, by the names of the rows.
        leader: Name of the joint that it mimics; None without one.
        multiplier: Factor of the leader's position.
        offset: Offset added to the product [rad, m].
        stiffness: Stiffness of Gazebo's joint spring [N·m/rad, N/m]; 0 without one.
        spring_rest: Rest position of the spring [rad, m].
    """

    name: str
    kind: str
    axis: tuple[float, float, float]
    lower: float = -math.inf
    upper: float = math.inf
    effort: float | None = None
    resistance: Mapping[str, float] = field(default_factory=dict)
    leader: str | None = None
    multiplier: float = 1.0
    offset: float = 0.0
    stiffness: float = 0.0
    spring_rest: float = 0.0


@dataclass(frozen=True, eq=False)
class RigidBody:
    """Links connected by fixed joints; the frame is that of the topmost link.

    Attributes:
        name: Name of the topmost link.
        links: Names of all links.
        places: Pose of each link in the body's frame.
        properties: Mass, center of mass and tensor in the body's frame; None without mass.
        shapes: Collision geometry.
        joint: Joint to the parent; None for the root.
        parent: Index of the parent body; -1 for the root.
        origin: Pose of the joint in the parent's body frame.
        surface: Friction and contact parameters.
        weightless: Part of ``properties`` on which gravity does not act; None without one.
    """

    name: str
    links: tuple[str, ...]
    places: Mapping[str, Pose]
    properties: SpatialInertia | None
    shapes: tuple[Shape, ...]
    joint: RigidBodyJoint | None
    parent: int
    origin: Pose
    surface: Mapping[str, float]
    weightless: SpatialInertia | None = None

    @property
    def mass(self) -> float:
        """Return the mass [kg]."""
        return self.properties.mass if self.properties else 0.0

    @property
    def weight(self) -> tuple[float, Array]:
        """Return the mass on which gravity acts [kg], and its center in the body's frame [m].

        The center is zero if the mass is zero.
        """
        if self.properties is None:
            return 0.0, np.zeros(3)
        if self.weightless is None:
            return self.properties.mass, np.array(self.properties.com)
        mass = self.properties.mass - self.weightless.mass
        if mass <= 1e-9 * self.properties.mass:
            return 0.0, np.zeros(3)
        moment = self.properties.mass * np.array(self.properties.com)
        return mass, (moment - self.weightless.mass * np.array(self.weightless.com)) / mass


@dataclass(frozen=True, eq=False)
class RigidBodyModel:
    """Rigid bodies of a robot, each after its parent, with their start.

    Attributes:
        bodies: The bodies, the root first.
        fixed_base: Whether the robot has a fixed base: the root is fixed to the world.
        start: Pose of the root in the world.
        positions: Initial positions of joints by name [rad, m], with those of mimic joints.
        held: Names of the held joints.
        size: Largest extent of the collision geometry at the start [m]; without any, that of the
            origins of the bodies.
        moved_start: Positions of joints that start at a limit, because 0 is outside their range,
            by name [rad, m].
    """

    bodies: tuple[RigidBody, ...]
    fixed_base: bool
    start: Pose
    positions: Mapping[str, float]
    held: tuple[str, ...]
    size: float
    moved_start: Mapping[str, float] = field(default_factory=dict)

    @property
    def joints(self) -> list[RigidBodyJoint]:
        """List the joints, in the order of their bodies."""
        return [body.joint for body in self.bodies if body.joint is not None]

    @property
    def mass(self) -> float:
        """Return the mass of the whole robot [kg]."""
        return math.fsum(body.mass for body in self.bodies)

    def compute_spring_energy(self, positions: Array) -> float:
        """Compute the energy of the joint springs [J] at positions of shape (j,) [rad, m]."""
        joints = self.joints
        stiffness = np.array([joint.stiffness for joint in joints])
        rest = np.array([joint.spring_rest for joint in joints])
        return 0.5 * float(stiffness @ (positions - rest) ** 2)


def make_rigid_bodies(robot: Robot, settings: Settings) -> RigidBodyModel:
    """Make rigid bodies of a robot without defects, placed above the plane.

    Raises:
        UrdftoolError: A mesh cannot be read, a shape has no extent, a mass is below zero.
    """
    top = _find_root(robot)
    made = _collect_lumps(robot, settings, top)
    fixed_base = settings.fixed_base or has_fixed_base(robot, robot.link[top])
    positions, clamped = start_positions(robot, settings.pose)
    positions = {b.joint.name: positions[b.joint.name] for b in made if b.joint is not None}
    poses = link_poses(robot, positions)
    back = poses[top].invert()
    shapes = [(back @ poses[body.name], body.shapes) for body in made]
    at_origin = fixed_base and _is_world(robot.link[top])
    start, size = _spawn_pose(shapes, settings, fixed=fixed_base, at_origin=at_origin)
    origins = np.array([pose.translation for pose, _ in shapes])
    return RigidBodyModel(
        tuple(made),
        fixed_base,
        start,
        positions,
        list_held_joints(robot, made, settings),
        size or float(np.ptp(origins, axis=0).max()),
        clamped,
    )


def has_fixed_base(robot: Robot, root: Link) -> bool:
    """Tell whether the file has a fixed base: the root is welded to the world, or is the world."""
    return (robot.base is not None and not robot.base.is_free) or _is_world(root)


def _is_world(link: Link) -> bool:
    """Tell whether a root is the world, so that the robot has a fixed base, as in the exports.

    Gazebo attaches the children of a root link ``world`` to its world, also one with mass.
    """
    return link.name == ROOTED


def _find_root(robot: Robot) -> str:
    """Find the root link; with a floating joint below the root, its child link."""
    assert robot.tree.root is not None
    name = robot.tree.root.name
    joints = robot.tree.get_child_joints(name)
    free = len(joints) == 1 and joints[0].type == "floating" and not robot.link[name].collisions
    return joints[0].child if free else name


def _collect_lumps(robot: Robot, settings: Settings, top: str) -> list[RigidBody]:
    poses = link_poses(robot)
    order = [name for name in robot.tree.order if name == top or _is_below(robot, name, top)]
    members: dict[str, list[str]] = {}
    owner: dict[str, str] = {}
    for name in order:
        joint = robot.tree.get_parent_joint(name)
        fixed = joint is not None and joint.is_fixed and name != top
        owner[name] = owner[joint.parent] if joint is not None and fixed else name
        members.setdefault(owner[name], []).append(name)
    index = {name: number for number, name in enumerate(members)}
    bodies: list[RigidBody] = []
    shape_count = 0
    for name, links in members.items():
        back = poses[name].invert()
        places = {link: back @ poses[link] if link != name else IDENTITY for link in links}
        shapes: list[Shape] = []
        for link in links:
            shapes += make_shapes(robot, robot.link[link], places[link], shape_count)
            shape_count += len(robot.link[link].collisions)
        joint = robot.tree.get_parent_joint(name) if name != top else None
        parent, origin = -1, IDENTITY
        if joint is not None:
            parent = index[owner[joint.parent]]
            origin = bodies[parent].places[joint.parent] @ make_pose(joint.origin)
        bodies.append(
            RigidBody(
                name,
                tuple(links),
                places,
                _make_properties(robot, places, settings.payloads),
                tuple(shapes),
                None if joint is None else make_joint(joint, robot),
                parent,
                origin,
                choose_surface(robot, links),
                _make_properties(
                    robot,
                    {n: at for n, at in places.items() if robot.link[n].is_weightless},
                    settings.payloads,
                ),
            )
        )
    return bodies


def _is_below(robot: Robot, name: str, top: str) -> bool:
    root = robot.tree.root
    return root is not None and (top == root.name or name != root.name)


def link_mass_properties(link: Link) -> SpatialInertia | None:
    """Return mass, center of mass and tensor of a link in its frame; None without mass."""
    return link_inertia(link) if link.mass else None


def _make_properties(
    robot: Robot, places: Mapping[str, Pose], payloads: Mapping[str, float]
) -> SpatialInertia | None:
    """Combine links and payloads, also the tensor of a link of mass 0; None without mass."""
    parts = []
    for name, pose in places.items():
        own = link_inertia(robot.link[name])
        payload = payloads.get(name, 0.0)
        point = SpatialInertia(payload, own.com if own.mass else ZERO)
        parts.append(combine([own, point] if payload else [own]).transform(pose))
    whole = combine(parts)
    return whole if whole.mass else None


def make_joint(joint: Joint, robot: Robot) -> RigidBodyJoint:
    """Convert a joint with one degree of freedom to the data of engines."""
    axis = np.array(joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0))
    x, y, z = (float(part) for part in axis / np.linalg.norm(axis))
    lower, upper = get_limits(joint)
    if lower > upper:
        lower, upper = -math.inf, math.inf
    mimic = joint.mimic
    stiffness, spring_rest = joint.spring or (0.0, 0.0)
    return RigidBodyJoint(
        joint.name,
        joint.type,
        (x, y, z),
        lower,
        upper,
        joint.get_magnitude("effort") or None,
        {name: joint.get_resistance(name) for name in RESISTANCE_OF_URDF},
        mimic.joint if mimic is not None and mimic.joint in find_movable_joints(robot) else None,
        mimic.multiplier if mimic is not None else 1.0,
        mimic.offset if mimic is not None else 0.0,
        stiffness,
        spring_rest,
    )


def list_held_joints(robot: Robot, bodies: list[RigidBody], settings: Settings) -> tuple[str, ...]:
    """List the held joints; mimic joints follow their leaders."""
    joints = [body.joint for body in bodies if body.joint is not None]
    names = [joint.name for joint in joints if joint.leader is None]
    if settings.controls is not None:
        controls = settings.controls
        return tuple(name for name in names if name in controls and controls[name].kind != NONE)
    if settings.hold == "none":
        return ()
    if settings.hold == "actuated":
        actuated = find_actuated_joints(robot)
        return tuple(name for name in names if name in actuated)
    return tuple(names)


_GAP = 1e-4
"""Height of the lowest point above the plane at the start [m]. Chosen, no source."""

_CLEAR = 0.05
"""Height of the moving links on a fixed base above the plane at the start, over the robot's size.
Joint drift of an arm of this length is reported before its end is as low as the plane. Chosen, no
source.
"""


def _spawn_pose(
    parts: Sequence[tuple[Pose, Sequence[Shape]]],
    settings: Settings,
    *,
    fixed: bool,
    at_origin: bool,
) -> tuple[Pose, float]:
    """Compute the pose of the root above the plane, and the largest extent of the robot [m].

    The lowest point of a robot starts on the plane. If the base is fixed and the lowest link moves,
    it starts clear of the plane, which would carry a load that the joints must hold.

    ``at_origin``: the file places the root, which is raised only if it is below the plane.
    """
    upright = Pose(rotation_from_rpy(settings.upright_rpy))
    turn = Pose(rotation_from_rpy(settings.start_rpy)) @ upright
    low, high = _compute_bounds(parts, turn)
    size = float((high - low).max()) if np.isfinite(low).all() else 0.0
    if settings.height is not None:
        return Pose(turn.rotation, (0.0, 0.0, settings.height)), size
    if not fixed:
        height = _GAP - float(low[2])
    else:
        root, moving = (float(_compute_bounds(some, turn)[0][2]) for some in (parts[:1], parts[1:]))
        height = max(_GAP - root, _CLEAR * size - moving)
    if not math.isfinite(height):
        height = 0.0
    elif at_origin:
        height = max(0.0, height)
    return Pose(turn.rotation, (0.0, 0.0, height)), size


def _compute_bounds(
    parts: Iterable[tuple[Pose, Sequence[Shape]]], turn: Pose
) -> tuple[Array, Array]:
    """Compute the box around shapes of a turned robot; infinite without shapes."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for place, shapes in parts:
        if not shapes:
            continue
        pose = turn @ place
        rotation, at = np.array(pose.rotation), np.array(pose.translation)
        for axis in range(3):
            along = rotation.T @ np.eye(3)[axis]
            low[axis] = min(low[axis], at[axis] - max(s.compute_reach(-along) for s in shapes))
            high[axis] = max(high[axis], at[axis] + max(s.compute_reach(along) for s in shapes))
    return low, high
