"""Find links without collision geometry."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from statistics import fmean, median

from ...model.attached import find_attached_links, is_fixed_to_world
from ...model.bounds import Bounds, compute_size, has_extent
from ...model.elements import Box, Collision, Cylinder, Joint, Link, Mesh, Robot, Sphere, Visual
from ...model.pose import make_pose
from ..fix import FixContext, Proposal, unsafe
from ..gazebo.contact import compute_axis_elevation
from ..inertia.bodies import compute_mass, find_rigid_bodies
from ..mesh.link_extents import get_extents
from ..mujoco import keeps_visuals
from ..rule import INFO, UNSAFE, URDF_AND_SDF, WARNING, Problem, rule
from ..shape_changes import copy_shape
from ..symmetry import get_family
from ..words import join_some
from ..xml.vocabulary_table import find_misspelled_children, is_for_another_reader

_FRAME = re.compile(r"optical|(^|_)frame$")
_VIRTUAL = re.compile(r"(^|_)(virtual|dummy)(_|\d|$)|_visuals?$", re.IGNORECASE)
_CONTACT = re.compile(r"wheel|caster|(^|_)(foot|feet)(_|\d|$)", re.IGNORECASE)
_CONTACT_TARGETS = ("gazebo-classic", "gz", "mujoco", "pybullet", "moveit")
_LOAD = "gz, gazebo-classic, pybullet, pinocchio, drake"
_PASS = "gz, gazebo-classic, pybullet"
_MARKER = 0.1
"""Maximum size [m] of a marker of a frame; chosen, no source."""


@rule(
    INFO,
    raised=dict.fromkeys(_CONTACT_TARGETS, WARNING),
    effects={
        _LOAD: "load the link without collision geometry: it makes no contact",
        "moveit": "ignores it when planning; MoveIt 2 warns",
        "mujoco": "creates no geom for the link, because it discards the visuals of a URDF",
    },
    group="robot",
    formats=URDF_AND_SDF,
    pedantic="without a target that makes contact, light links, and links of robots of few "
    "collisions, except wheels and feet",
)
def missing_collision(
    robot: Robot, targets: frozenset[str], *, smallest: float = 0.01, small: float = 0.03
) -> Iterator[Problem]:
    """A link has visual geometry but no collision geometry.

    Such a link falls through the ground, grippers close without contact, motion planners move the
    arm through it, and simulated lidars that use collision geometry do not see it. Add a
    ``<collision>``, best with primitives; a copy of the visual mesh is better than nothing. If a
    link needs no collision (a sticker, a cable), state it in a comment,
    ``urdftool-ignore[missing-collision]``.

    Not reported are links that the collision of a link fixed to them covers, that rotate inside the
    collision of their parent body, that slide along a rail that goes through them, or that are such
    a rail, whose collision would block the joint. Neither are links between bodies with collisions,
    as in robots of few collision shapes, links smaller than ``small`` [m], and those inside the
    bounding box of their rigid body's collisions. Links of at most ``smallest`` [m], which mark
    frames, links named virtual or dummy, and those with fully transparent visuals are skipped, and
    so is a single link without mass, such as the marker of a goal. A link that is fixed to the
    world cannot fall, and is an info. Neither is a robot without any
    collision that only Drake or MuJoCo reads, such as a pendulum of which the motion is computed.

    If nothing shows that Gazebo, MuJoCo, PyBullet or MoveIt reads the robot, it is an info, except
    for wheels and feet by name, on which a robot stands.
    Others are off by default: fingers in the collision of a hand, covers, stands that are fixed to
    the world, and links of robots whose authors reduced the collisions or wrote none.
    ``missing-inertial`` reports a robot that has neither a collision nor an inertial.
    """
    if len(robot.links) == 1 and not robot.links[0].mass:
        return  # a marker, such as a goal
    if _is_only_for_motion(robot):
        return
    seen = [link for link in robot.links if _compute_visual_size(link) > smallest]
    colors = {one.name: one.color for one in robot.materials if one.color is not None}
    ghosts = [link for link in seen if not link.collisions and not _is_invisible(link, colors)]
    sizes = _compute_sizes(robot, ghosts)
    odd = {link.name for link, _ in _find_odd_links(robot)}
    discarded = not keeps_visuals(robot)
    is_simulated = not targets.isdisjoint(_CONTACT_TARGETS)
    is_bare = not any(link.inertial is not None or link.collisions for link in robot.links)
    for link in ghosts:
        if link.name in odd:
            continue
        if sizes[link.name] <= smallest or _has_misspelled_collision(link):
            continue
        if _is_covered(robot, link) or _is_rotating_inside(robot, link) or _has_rail(robot, link):
            continue
        if _is_rail(robot, link):
            continue
        if sizes[link.name] < small or _is_enveloped(robot, link) or _is_between(robot, link):
            continue
        is_held = is_fixed_to_world(robot, link)
        touches = not is_bare and _CONTACT.search(link.name) is not None
        yield Problem(
            link,
            f"link '{link.name}' has a visual but no collision; "
            "add a <collision>, best with a primitive shape",
            severity=INFO if is_held else WARNING if touches else None,
            effects=[_LOAD, "moveit", *["mujoco"] * discarded],
            pedantic=not is_simulated and (is_bare or is_held or not _is_expected(robot, link)),
            group="{count} links have a visual but no collision: {names}; "
            "add a <collision> to each, best with a primitive shape",
        )


def _is_expected(robot: Robot, link: Link) -> bool:
    """Tell whether the robot itself shows that a link should have a collision.

    That is a wheel or foot, and, where at least two thirds of the links with a visual have a
    collision, a link of a fourth of their mean mass. The fractions are chosen, without a source.
    """
    solid = [one for one in robot.links if one.collisions]
    if _CONTACT.search(link.name):
        return True
    if not solid:
        return False
    seen = [one for one in robot.links if one.visuals]
    is_rule = 3 * sum(bool(one.collisions) for one in seen) >= 2 * len(seen)
    return is_rule and link.mass >= fmean(one.mass for one in solid) / 4 > 0


def _is_only_for_motion(robot: Robot) -> bool:
    """Tell whether a robot of which no link collides is for Drake or MuJoCo, by its elements.

    Drake alone accepts a joint to ``world`` without a link of that name.
    """
    if any(link.collisions for link in robot.links):
        return False
    to_world = any(joint.parent == "world" for joint in robot.joints)
    return is_for_another_reader(robot.xml) or (to_world and "world" not in robot.link)


@missing_collision.full
def report_robot_without_collision(robot: Robot) -> Iterator[Problem]:
    """Report a robot without any collision geometry with an extent."""
    shapes = [shape.geometry for link in robot.links for shape in link.collisions]
    if not any(shape is not None and has_extent(shape) for shape in shapes):
        what = "geom that makes contact" if robot.format == "mjcf" else "<collision>"
        yield Problem(
            robot,
            f"no link has a {what}, so the robot cannot make contact with the ground; add a {what} "
            "to each link",
        )


@rule(
    WARNING,
    effects={
        _PASS: (
            "load the link without collision geometry: it passes through the ground and other "
            "bodies"
        ),
        "moveit": "ignores it when planning; MoveIt 2 warns",
        "mujoco": "creates no geom for the link, because it discards the visuals of a URDF",
    },
    formats=URDF_AND_SDF,
)
def odd_link_without_collision(robot: Robot) -> Iterator[Problem]:
    """One link has no collision, but similar links have one.

    Either links of the same name at other corners of the robot have one: the rear hips of a
    quadruped, but not its front hips. Or it is the only moving body of the robot with a visual
    and without a collision. Then it was forgotten, or lost in an edit: add a ``<collision>``.
    Links that are fixed to each other count as one body. Links with less than a hundredth of the
    median mass of the others are ignored, or with less than the mass of the only other one.
    """
    discarded = not keeps_visuals(robot)
    for link, others in _find_odd_links(robot):
        yield Problem(
            link,
            f"link '{link.name}' has a visual but no collision, while {others} one; add a "
            "<collision>",
            effects=[_PASS, "moveit", *["mujoco"] * discarded],
        )


@missing_collision.fix(UNSAFE, reveals=True)
@odd_link_without_collision.fix(UNSAFE, reveals=True)
def copy_visuals(problem: Problem, context: FixContext) -> Proposal | None:
    """Copy the visuals, if all are primitives; small links may lack a collision on purpose."""
    link = context.get_link(problem)
    if not link.visuals or link.collisions or problem.severity is INFO:
        return None
    changes = []
    for visual in link.visuals:
        if not isinstance(visual.geometry, Box | Cylinder | Sphere):
            return None
        if not has_extent(visual.geometry):
            return None  # a marker of no size, which readers reject as a collision
        change = copy_shape(visual, "collision")
        if change is None:
            return None
        changes.append(change)
    return unsafe("copy its visuals as collisions", *changes)


def _find_odd_links(robot: Robot) -> list[tuple[Link, str]]:
    """Find links without a collision although similar links have one, with these links."""
    found = {
        link.name: others for link, others in (*_find_only_body(robot), *_find_odd_corners(robot))
    }
    return [(link, found[link.name]) for link in robot.links if link.name in found]


def _find_odd_corners(robot: Robot) -> Iterator[tuple[Link, str]]:
    """Find links without a collision although most links at other corners have one."""
    families: dict[str, list[Link]] = {}
    for link in robot.links:
        if link.visuals:
            families.setdefault(get_family(link.name), []).append(link)
    for links in families.values():
        solid = [link for link in links if link.collisions]
        if 2 * len(solid) < len(links):
            continue
        typical = median(link.mass for link in solid)
        names = [f"'{link.name}'" for link in solid]
        others = f"{join_some(names, 'links')} {'have' if len(names) > 1 else 'has'}"
        for link in links:
            if link.collisions or _has_misspelled_collision(link):
                continue
            if link.mass >= typical / 100:
                yield link, others


def _find_only_body(robot: Robot) -> Iterator[tuple[Link, str]]:
    """Find the only moving body without a collision, as its first link with a visual."""
    moving = [
        links
        for name, links in find_rigid_bodies(robot).items()
        if (joint := robot.tree.get_parent_joint(name)) is not None
        and not joint.is_fixed
        and any(link.visuals for link in links)
    ]
    solid = [links for links in moving if any(link.collisions for link in links)]
    if len(solid) != len(moving) - 1 or not solid:
        return
    bare = next(links for links in moving if links not in solid)
    if any(_has_misspelled_collision(link) or _has_rail(robot, link) for link in bare):
        return
    if len(solid) == 1 and any(_is_rotating_inside(robot, link) for link in bare):
        return
    part = 1 / 100 if len(solid) > 1 else 1
    if compute_mass(bare) >= part * median(map(compute_mass, solid)):
        link = next(link for link in bare if link.visuals)
        others = f"the {len(solid)} other moving bodies of the robot have"
        yield link, others if len(solid) > 1 else "the other moving body of the robot has"


def _has_misspelled_collision(link: Link) -> bool:
    return "collision" in find_misspelled_children(link.xml).values()


@rule(
    WARNING,
    on=("gazebo-classic", "gz", "pybullet"),
    effects={
        "gz, gazebo-classic, mujoco, pybullet": (
            "load the link without collision geometry: it sinks through the ground"
        ),
    },
)
def massive_link_without_collision(robot: Robot, *, lightest: float = 0.1) -> Iterator[Problem]:
    """A heavy wheel or foot has neither visual nor collision geometry.

    The robot cannot stand on it: the body drops until other collision geometry makes contact with
    the ground. Add a ``<collision>``. A wheel with visual geometry is reported by
    ``missing-collision`` instead. ``lightest`` [kg] is the smallest mass that is reported.
    """
    for link in robot.links:
        if link.collisions or link.mass < lightest or _compute_visual_size(link) >= 0.01:
            continue
        joint = robot.tree.get_parent_joint(link.name)
        if joint is None or any(
            not below.is_fixed for below in robot.tree.get_child_joints(link.name)
        ):
            continue
        if any(_find_shapes_below(robot, link)):
            continue
        if any(one.collisions for one, _ in find_attached_links(robot, link)):
            continue
        level = joint.type == "continuous" and abs(compute_axis_elevation(robot, link, joint)) < 0.5
        if level or (_CONTACT.search(link.name) and not joint.is_fixed):
            yield Problem(
                link,
                f"link '{link.name}' ({link.mass:g} kg) on joint '{joint.name}' has no collision "
                "geometry and cannot make contact with the ground; add a <collision>",
            )


def _is_covered(robot: Robot, link: Link) -> bool:
    """Tell whether attached links' collisions cover at least four fifths of a link's visual."""
    attached = find_attached_links(robot, link)[1:]
    if not any(other.collisions for other, _ in attached):
        return False
    reach = get_extents(robot)
    seen = reach.get_shapes_box(link.visuals)
    if seen is None:
        return False
    for other, at in attached:
        box = reach.get_body_box(link, "collisions", [(other, at)]) if other.collisions else None
        if box is not None and _contains_box(box, seen):
            return True
    return False


def _is_invisible(link: Link, colors: Mapping[str, tuple[float, ...]]) -> bool:
    """Tell whether a link is virtual, or all its visuals have a color with opacity 0."""
    if _VIRTUAL.search(link.name):
        return True
    materials = [visual.material for visual in link.visuals]
    shown = [one and (one.color or colors.get(one.name)) for one in materials]
    return bool(shown) and all(color and color[3] == 0 for color in shown)


def _is_enveloped(robot: Robot, link: Link) -> bool:
    """Tell whether a link's visual is inside the bounding box of its rigid body's collisions."""
    reach = get_extents(robot)
    seen = reach.get_shapes_box(link.visuals)
    solid = [(other, at) for other, at in reach.get_attached(link) if other.collisions]
    box = reach.get_body_box(link, "collisions", solid) if seen is not None and solid else None
    return box is not None and seen is not None and _contains_box(box, seen)


def _is_between(robot: Robot, link: Link) -> bool:
    """Tell whether a body moves others, and its own links or bodies on both sides have collisions.

    Then the world makes contact with these first; the ends of a robot make contact with it.
    """
    own = robot.tree.bodies.get(link.name)
    if own is None:
        return False
    joint = robot.tree.get_parent_joint(own)
    above = robot.tree.bodies.get(joint.parent) if joint is not None else None
    below = {
        robot.tree.bodies.get(joint.child)
        for joint in robot.moving_joints
        if robot.tree.bodies.get(joint.parent) == own
    }
    solid = robot.memo.get(_find_solid_bodies, lambda: _find_solid_bodies(robot))
    return not solid.isdisjoint(below) and not solid.isdisjoint((own, above))


def _find_solid_bodies(robot: Robot) -> set[str | None]:
    """Find the rigid bodies with a collision, by the names of their first links."""
    return {robot.tree.bodies.get(one.name) for one in robot.links if one.collisions}


def _is_rotating_inside(robot: Robot, link: Link) -> bool:
    """Tell whether a body without a collision rotates inside the body that carries it.

    At any angle, its visuals stay in a sphere about the origin of the joint.
    """
    reach = get_extents(robot)
    members = reach.get_attached(link)
    joint = robot.tree.get_parent_joint(link.name)
    above = robot.link.get(joint.parent) if joint is not None else None
    if joint is None or above is None or joint.type not in ("revolute", "continuous"):
        return False
    if any(one.collisions for one, _ in members):
        return False
    seen = reach.get_shapes_box(link.visuals)
    if seen is None:
        return False
    radius = math.hypot(*(max(abs(a), abs(b)) for a, b in zip(seen.low, seen.high, strict=True)))
    x, y, z = make_pose(joint.origin).translation
    ball = Bounds((x - radius, y - radius, z - radius), (x + radius, y + radius, z + radius))
    for other, at in reach.get_attached(above):
        box = reach.get_body_box(above, "collisions", [(other, at)]) if other.collisions else None
        if box is not None and _contains_box(box, ball):
            return True
    return False


def _is_rail(robot: Robot, link: Link) -> bool:
    """Tell whether a link is the rail of a prismatic joint, and goes through what slides on it."""
    for joint in robot.tree.get_child_joints(link.name):
        slider = robot.link.get(joint.child)
        if slider is not None and joint.type == "prismatic":
            shapes = (slider.visuals, slider.collisions)
            if any(_is_on_rail(robot, joint, link, seen) for seen in shapes):
                return True
    return False


def _has_rail(robot: Robot, link: Link) -> bool:
    """Tell whether the rail of a prismatic joint, which collides, goes through a link's visuals."""
    joint = robot.tree.get_parent_joint(link.name)
    rail = robot.link.get(joint.parent) if joint is not None else None
    if joint is None or rail is None or joint.type != "prismatic" or not rail.collisions:
        return False
    return _is_on_rail(robot, joint, rail, link.visuals)


def _is_on_rail(
    robot: Robot, joint: Joint, rail: Link, shapes: Sequence[Visual | Collision]
) -> bool:
    """Tell whether the visuals of the parent of a joint go through shapes of its child."""
    reach = get_extents(robot)
    seen, along = reach.get_shapes_box(shapes), reach.get_shapes_box(rail.visuals)
    if seen is None or along is None:
        return False
    pose = make_pose(joint.origin)
    x, y, z = pose.translation
    turned = seen.rotate(pose.rotation)
    low, high = turned.low, turned.high
    placed = Bounds((low[0] + x, low[1] + y, low[2] + z), (high[0] + x, high[1] + y, high[2] + z))
    crossed = [
        a <= c and d <= b
        for a, b, c, d in zip(placed.low, placed.high, along.low, along.high, strict=True)
    ]
    return crossed.count(True) >= 2 and placed.meets(along)


def _contains_box(box: Bounds, other: Bounds) -> bool:
    """Tell whether a box contains another, except for a fifth of each side."""
    return all(
        min(c, d) - max(a, b) >= 0.8 * (c - a)
        for a, b, c, d in zip(other.low, box.low, other.high, box.high, strict=True)
    )


def _compute_visual_size(link: Link) -> float:
    """Compute the largest length of a link's visuals [m]; 1 for a mesh, 0 for a frame marker."""
    largest = 0.0
    for visual in link.visuals:
        if visual.geometry is not None:
            size = compute_size(visual.geometry)
            largest = max(largest, 1.0 if size is None else max(size))
    return 0.0 if _FRAME.search(link.name) and largest <= _MARKER else largest


def _compute_sizes(robot: Robot, links: list[Link]) -> dict[str, float]:
    """Compute the sizes of links' visuals by name [m]; meshes are measured if that is cheap."""
    sizes = {link.name: _compute_visual_size(link) for link in links}
    with_mesh = {
        link.name
        for link in links
        if len(link.visuals) == 1 and isinstance(link.visuals[0].geometry, Mesh)
    }
    if with_mesh and robot.source is not None:
        from ..mesh.mesh_uses import get_mesh_uses
        from ..mesh.scale import estimate_size

        for use in get_mesh_uses(robot, robot.source):
            if use.link.name in with_mesh:
                size = estimate_size(use)
                sizes[use.link.name] = 1.0 if size is None else size
    return sizes


def _find_shapes_below(robot: Robot, link: Link) -> Iterator[bool]:
    """Yield for each link below one whether it has geometry."""
    for name in robot.tree.list_descendants(link.name):
        below = robot.link.get(name)
        yield below is not None and bool(below.collisions or below.visuals)
