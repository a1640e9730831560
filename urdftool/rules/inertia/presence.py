"""Whether a link has an inertia at all."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.attached import attached_links, is_fixed_to_world
from ...model.elements import MOVING_TYPES, Joint, Link, Robot
from ..fix import (
    Change,
    FixContext,
    Proposal,
    escape_attribute,
    is_computed,
    prepend_child,
    remove_element,
    unsafe,
)
from ..gazebo.kept import kept_links
from ..rule import ERROR, GAZEBO, INFO, ROS, UNSAFE, WARNING, Problem, rule
from ..xml.vocabulary_table import misspelt_children
from .bodies import bodies, mass_of
from .solids import DENSITY, solid_volume

_SIMULATED = ("gazebo-classic", "gz", "mujoco")
_MARKER = 1e-3  # [kg]
_REMOVED = "Gazebo removes it and everything attached to it"
_HINT = "'urdftool inertia robot --write --mass LINK=KG' computes one from its shapes"
_IN_GAZEBO = {"gz, gazebo-classic", "gz, gazebo-classic (root)", "gz, gazebo-classic (part)"}


@rule(
    WARNING,
    raised=dict.fromkeys(("gazebo-classic", "gz", "mujoco", "pybullet"), ERROR),
    effects={
        "gz, gazebo-classic": "leave out the link and all below it, without a message",
        "gz, gazebo-classic (root)": "load nothing: a model must have at least one link",
        "gz, gazebo-classic (part)": (
            "make one link of it and the link with mass that it is fixed to, named after the upper"
        ),
        "pybullet": "assumes 1 kg, and with URDF_USE_INERTIA_FROM_FILE 1 kg·m² about each axis",
        "mujoco (collisions)": "assumes the mass of water in the shape of its collisions",
        "mujoco (no mass)": "rejects the file: mass of moving bodies must be positive",
        "pinocchio, KDL, drake": "take 0 kg",
    },
    group="robot",
)
def missing_inertial(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A link with a shape has no ``<inertial>``.

    A body without mass cannot be accelerated, and each simulator substitutes something else: Gazebo
    removes the body with everything below, PyBullet takes one kilogram, MuJoCo fills the collision
    shapes with water. Where a fixed joint attaches the link to one with a mass, it is only a
    remark, except for PyBullet and MuJoCo, which substitute a mass there as well. A frame without
    shapes needs none; PyBullet gives it a kilogram nevertheless. A marker that would weigh less
    than a gram is an info where no simulator gives it more.
    """
    in_gazebo = not targets.isdisjoint(GAZEBO)
    tops: dict[str, Link] | None = None
    kept = kept_links(robot)
    for link in robot.links:
        if link.inertial is not None or link.is_frame or link.name == "world":
            continue
        if link.xml is not None and "inertial" in misspelt_children(link.xml).values():
            continue
        if tops is None:
            found = bodies(robot).values()
            tops = {one.name: links[0] for links in found for one in links}
            heavy = {one.name for links in found if mass_of(links) > 0 for one in links}
        joint = robot.tree.parent_joint(tops.get(link.name, link).name)
        moves = joint is not None and not joint.is_fixed
        held = is_fixed_to_world(robot, link)
        if in_gazebo and link.name not in heavy:
            outcome, severity, so = "removed", ERROR, f"; {_REMOVED}"
            several = "; Gazebo removes them and everything attached to them"
        elif "pybullet" in targets and not held:
            outcome, severity, so = "1 kg", ERROR, "; PyBullet gives it 1 kg"
            several = "; PyBullet gives each of them 1 kg"
        elif "mujoco" in targets and link.collisions and moves:
            outcome, severity = "water", INFO if _is_marker(link) else ERROR
            so = "; MuJoCo gives it the mass of water"
            several = "; MuJoCo gives each of them the density of water"
        elif link.name in heavy:
            others = [one for one, _ in attached_links(robot, link) if one.mass > 0]
            outcome, severity = "part", INFO
            so = f", and is fixed to '{others[0].name}', which has one"
            several = ", and are fixed to links that have one"
        elif held:
            outcome, severity = "static", INFO
            so = " and is fixed to the world, where its mass has no effect"
            several = " and are fixed to the world, where their mass has no effect"
        else:
            outcome, severity, so = "no mass", WARNING, " and so has no mass"
            several = " and so have no mass"
        has_shapes = bool(link.visuals or link.collisions)
        warned_by_kdl = link is robot.tree.root and not targets.isdisjoint(ROS)
        needs_mass = severity is not INFO and has_shapes and not warned_by_kdl
        if kept is None:
            case = "not one tree"
        else:
            case = "part" if link.name in heavy else "" if kept else "root"
        yield Problem(
            link,
            f"link '{link.name}' has no <inertial>{so}",
            hint=_HINT if needs_mass else "",
            severity=severity,
            group=f"{{count}} links have no <inertial>{several}: {{names}}",
            effects=_effects_without_inertial(robot, link, case),
            alike=outcome,
        )


@missing_inertial.full
def every_shape_without_inertial(robot: Robot) -> Iterator[Problem]:
    """Report each link with a shape and no inertial, whatever it is fixed to."""
    for link in robot.links:
        if link.inertial is None and not link.is_frame and link.name != "world":
            text = f"link '{link.name}' has no <inertial> and so has no mass"
            yield Problem(link, text, hint=_HINT)


def _effects_without_inertial(robot: Robot, link: Link, in_gazebo: str) -> set[str]:
    """Select what readers do with a link without mass; MuJoCo welds the root to the world.

    Args:
        robot: The robot.
        link: Its link without an ``<inertial>``.
        in_gazebo: The case of Gazebo's effect; empty for that without one.
    """
    body = [one for one, _ in attached_links(robot, link)]
    tops = [robot.tree.parent_joint(one.name) for one in body]
    keys = {"pybullet", "pinocchio, KDL, drake"}
    keys |= {"gz, gazebo-classic" + (f" ({in_gazebo})" if in_gazebo else "")} & _IN_GAZEBO
    if None in tops or is_fixed_to_world(robot, link):
        return keys
    if link.collisions:
        keys.add("mujoco (collisions)")
    elif not any(one.mass > 0 or (one.inertial is None and one.collisions) for one in body):
        keys.add("mujoco (no mass)")
    return keys


def _is_marker(link: Link) -> bool:
    """Whether a link is so small that as water it would weigh less than a gram."""
    shapes = link.collisions or link.visuals
    volumes = [solid_volume(shape.geometry) for shape in shapes]
    return all(volumes) and 1000 * sum(volumes) < _MARKER


_LIGHTEST = 1e-5
"""Mass [kg] below which a shape marks a place, and has no mass that is worth writing."""


@missing_inertial.fix(UNSAFE)
def add_inertial(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the inertial of the shapes at the density of water."""
    link = context.link(problem)
    if problem.severity is INFO:
        return None  # the body has a mass, or needs none
    from .corrections import inertial_of_shapes

    found = inertial_of_shapes(link, context)
    if found is None or found[0] < _LIGHTEST:
        return None
    change = prepend_child(link.element, *found[1])
    return unsafe(f"add the <inertial> of its shapes at {DENSITY:g} kg/m³", change)


@rule(
    WARNING,
    raised=dict.fromkeys(_SIMULATED, ERROR),
    effects={
        "gz, gazebo-classic": (
            "leave out the link and all below it, without a message (sdformat 12.3)"
        ),
        "mujoco": "rejects the file: mass of moving bodies must be positive",
        "pybullet": "gives it 1 kg",
        "pinocchio": "its mass matrix is singular if nothing with mass is below it",
    },
)
def massless_moving_body(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A joint moves a frame to which nothing with a mass is fixed.

    A frame between two joints is fine for kinematics and impossible to simulate: a force on zero
    mass has no finite answer. Gazebo leaves out the link and the whole branch on it; controllers
    then report joints that are not found. MuJoCo refuses the file. Where the robot is for no
    simulator, such a body is reported if it is the only one: its ``<inertial>`` was lost.
    """
    bare, heavy = [], 0
    for joint, name, links in moved_bodies(robot):
        if _is_bare(links):
            bare.append((joint, name, links[0]))
        heavy += mass_of(links) > 0
    if targets.isdisjoint(_SIMULATED) and (len(bare) > 1 or heavy < 3):
        return
    yield from (_of_moved_body(robot, joint, name, link) for joint, name, link in bare)


@massless_moving_body.full
def every_massless_moving_body(robot: Robot) -> Iterator[Problem]:
    """Report each body that a joint moves and that has no mass, also one with shapes."""
    for joint, name, links in moved_bodies(robot):
        if mass_of(links) <= 0:
            yield _of_moved_body(robot, joint, name, links[0])


def _of_moved_body(robot: Robot, joint: Joint, name: str, link: Link) -> Problem:
    return Problem(
        link,
        f"joint '{joint.name}' moves link '{name}', which has no mass{_below(robot, name)}; "
        "give it a small <inertial>, or make the joint fixed",
        data={"joint": joint.name, "below": sum(1 for _ in robot.tree.descendants(name))},
    )


@massless_moving_body.fix(UNSAFE)
def add_small_inertial(problem: Problem, context: FixContext) -> Proposal | None:
    """Add an inertial of a few grams to the frame."""
    from .corrections import give_small_inertial

    return give_small_inertial(context.link(problem))


def moved_bodies(robot: Robot) -> Iterator[tuple[Joint, str, list[Link]]]:
    """List the rigid bodies on joints that are not fixed: joint, topmost link and links of each."""
    for name, links in bodies(robot).items():
        joint = robot.tree.parent_joint(name)
        if joint is not None and not joint.is_fixed:
            yield joint, name, links


def has_bare_moved_body(robot: Robot) -> bool:
    """Tell whether a joint moves a body without mass and shapes, which MuJoCo rejects."""
    moved = (links for joint, _, links in moved_bodies(robot) if joint.type in MOVING_TYPES)
    return any(map(_is_bare, moved))


def _below(robot: Robot, name: str) -> str:
    count = sum(1 for _ in robot.tree.descendants(name))
    if not count:
        return ""
    return f", and {count} links hang on it" if count > 1 else ", and one link hangs on it"


def _is_bare(links: list[Link]) -> bool:
    """Whether no link of a body has an inertial, or needs one because it is seen or touches."""
    for link in links:
        misspelt = {} if link.xml is None else misspelt_children(link.xml)
        if not link.is_frame or "inertial" in misspelt.values():
            return False
    return True


@rule(
    ERROR,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": "load nothing: a model must have at least one link",
    },
)
def massless_root_body(robot: Robot) -> Iterator[Problem]:
    """The root and all that is fixed to it have no mass, and joints move other links on it.

    Gazebo starts at the root. A root without mass is left out and everything below with it, so no
    link remains. Only a root called ``world`` may weigh nothing.
    """
    for name, links in bodies(robot).items():
        joint = robot.tree.parent_joint(name)
        if name == "world" or (joint is not None and joint.parent != "world"):
            continue
        if joint is not None and not joint.is_fixed:
            continue
        if not _is_bare(links) or not _moves_something(robot, links):
            continue
        yield _of_root(links[0])


@massless_root_body.full
def every_massless_root_body(robot: Robot) -> Iterator[Problem]:
    """Report a root without mass, also one that has shapes or moves nothing."""
    for root in robot.tree.roots:
        links = [link for link, _ in attached_links(robot, root)]
        if root.name != "world" and mass_of(links) <= 0:
            yield _of_root(root)


def _of_root(root: Link) -> Problem:
    return Problem(
        root,
        f"root link '{root.name}' has no mass, nor has anything fixed to it; "
        "give it an <inertial>, or call it world if the robot is bolted down",
    )


def _moves_something(robot: Robot, links: list[Link]) -> bool:
    return any(not joint.is_fixed for link in links for joint in robot.tree.child_joints(link.name))


def _is_broken(robot: Robot) -> bool:
    """Whether names are there twice, or a joint names a link that is not there."""
    twice = len(robot.link) < len(robot.links) or len(robot.joint) < len(robot.joints)
    return twice or any(
        name not in robot.link for joint in robot.joints for name in (joint.parent, joint.child)
    )


_SLIGHT = 1e-3
"""Mass [kg] below which a root without shapes is a frame."""


@rule(
    INFO,
    on=ROS,
    effects={
        "KDL": "warns at every start, and leaves that mass out of its dynamics",
        "robot_state_publisher": "prints the warning of kdl_parser",
        "mujoco": "welds the root to the world",
    },
)
def root_link_has_inertia(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """The root link has an ``<inertial>``.

    KDL cannot give its root a mass: it prints a warning at every start of robot_state_publisher and
    computes dynamics without it. A root without ``<inertial>``, joined by a fixed joint to the link
    that was the root, avoids the warning. PyBullet gives such a root 1 kg, and with
    ``URDF_USE_INERTIA_FROM_FILE`` 1 kg·m² about each axis, which a free base carries along; with
    the target ``pybullet`` this remedy is therefore not given, and neither is the fix.
    """
    root = robot.tree.root
    if root is None or len(robot.tree.roots) > 1 or _is_broken(robot):
        return  # another link may be the root once it is mended
    if root.inertial is not None and root.inertial.mass != 0.0:
        remedy, hint = "; put a link without one above it, on a fixed joint", _IN_PYBULLET
        if root.name == "world" or is_needless(robot, root):
            remedy = "; remove its <inertial>"
        if root.name == "world":
            hint = ""  # PyBullet gives no mass to a root of this name
        elif "pybullet" in targets:
            remedy = hint = ""
        yield Problem(
            root,
            f"root link '{root.name}' has an inertia, which KDL does not support{remedy}",
            hint=hint,
        )


_IN_PYBULLET = (
    "PyBullet gives a root without an <inertial> 1 kg, which makes a robot with a free base heavier"
)


def is_needless(robot: Robot, root: Link) -> bool:
    """Whether a root is a frame with next to no mass, fixed to links that have one.

    Where nothing with mass is fixed to it, Gazebo leaves out a root without ``<inertial>``, with
    the whole robot.
    """
    if root.mass >= _SLIGHT or root.visuals or root.collisions:
        return False
    return any(link.mass > 0 for link, _ in attached_links(robot, root)[1:])


@root_link_has_inertia.fix(UNSAFE)
def add_root_link(problem: Problem, context: FixContext) -> Proposal | None:
    """Add a link without inertial above the root, on a fixed joint; remove a needless one."""
    robot, link = context.robot, context.link(problem)
    if link.element.parent is not robot.element or link.inertial is None:
        return None
    if link.name == "world" or (is_needless(robot, link) and "pybullet" not in context.targets):
        return unsafe("remove its <inertial>", remove_element(link.inertial.element))
    name, joint = f"{link.name}_root", f"{link.name}_root_joint"
    taken = {*robot.link, *robot.joint}
    if name in taken or joint in taken or is_computed(link.element):
        return None
    if context.targets & {"moveit", "pybullet"}:
        return None  # the SRDF names the root, and PyBullet gives a new one 1 kg
    from ..cross_file_references import check_not_included

    check_not_included(context)
    made = (
        (f'<link name="{escape_attribute(name)}"/>',),
        (
            f'<joint name="{escape_attribute(joint)}" type="fixed">',
            f'\t<parent link="{escape_attribute(name)}"/>',
            f'\t<child link="{escape_attribute(link.name)}"/>',
            "</joint>",
        ),
    )
    what = f"put a link '{name}' without <inertial> above it, on a fixed joint"
    return unsafe(f"{what}; PyBullet gives it 1 kg", Change("first", robot.element, blocks=made))


@rule(
    INFO,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": (
            "move the mass, and show nothing of it"
        ),
    },
    default=False,
)
def mass_without_geometry(robot: Robot) -> Iterator[Problem]:
    """A rigid body has a mass and no shape.

    Sensor frames get a gram to survive Gazebo; otherwise a visual was forgotten. A link whose mass
    belongs to the shapes of a link that is fixed to it is not reported.
    """
    for link in robot.links:
        if link.mass <= 0 or link.visuals or link.collisions:
            continue
        if not any(one.visuals or one.collisions for one, _ in attached_links(robot, link)):
            yield Problem(link, f"link '{link.name}' weighs {link.mass:g} kg and has no shape")
