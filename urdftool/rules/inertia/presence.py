"""Check that links and rigid bodies have an inertia where simulators require it."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.attached import find_attached_links, is_fixed_to_world
from ...model.elements import Joint, Link, Robot
from ...source.description import Description
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
from ..gazebo.contact import are_fingers
from ..gazebo.lumped_model import find_kept_links
from ..rule import (
    ANY_FORMAT,
    ERROR,
    GAZEBO,
    INFO,
    ROS,
    UNSAFE,
    URDF_AND_SDF,
    WARNING,
    Problem,
    rule,
)
from ..symmetry import find_twin
from ..tree.mounted import is_arm, is_floating_base
from ..xml.vocabulary_table import find_misspelled_children
from .bodies import compute_mass, find_rigid_bodies
from .device_frames import is_light_marker, is_massless_scene, is_slight_frame
from .light_body import find_light_body
from .massless import (
    INERTIAL_HINT,
    LUMPED,
    MASS_READERS,
    find_moved_bodies,
    is_bare,
    is_only_kinematic,
    report_holders,
    report_massless,
    select_effects,
)
from .optional_inertials import has_optional_inertials
from .solids import DENSITY
from .tensors import has_written_inertial

_SIMULATED = ("gazebo-classic", "gz", "mujoco")

_REMOVED = "Gazebo removes the link and everything attached to it"
_ALL_REMOVED = "Gazebo removes them and everything attached to them"
_AS_PART = (
    "PyBullet gives {} 1 kg in addition to {} body's mass. Write a small <inertial> if PyBullet is "
    "to read the robot"
)


@rule(
    WARNING,
    raised=dict.fromkeys(("gazebo-classic", "gz", "mujoco", "pybullet"), ERROR),
    effects={
        "gz, gazebo-classic": "omit the link and its descendants, without a message",
        "gz, gazebo-classic (root)": "load nothing: a model must have at least one link",
        "gz, gazebo-classic (part)": (
            "lump it into the link with mass that it is fixed to; the upper name remains"
        ),
        "gz, gazebo-classic (holds)": (
            "omit the links whose joints are on it, and their descendants, without a message"
        ),
        "pybullet": "assumes 1 kg, and with URDF_USE_INERTIA_FROM_FILE 1 kg·m² about each axis",
        "mujoco (collisions)": "computes a mass from its collisions, at the density of water",
        "mujoco (no mass)": "rejects the file: mass of moving bodies must be positive",
        "pinocchio, KDL, drake": "take 0 kg",
    },
    group="robot",
    formats=URDF_AND_SDF,
    pedantic="infos, except about robots for ROS of which no link has an inertial; robots of one "
    "link without collision, and massless scenes",
    infos=True,
)
def missing_inertial(
    robot: Robot, description: Description, targets: frozenset[str]
) -> Iterator[Problem]:
    """A link with geometry has no ``<inertial>``.

    A body without mass cannot be accelerated, and each simulator substitutes something different:
    Gazebo removes the body and its descendants, PyBullet assumes 1 kg, MuJoCo computes a mass from
    the collision geometry at the density of water. If a fixed joint attaches the link to one with
    a mass, it is only an info, unless the link of the other side has one, or that mass is less
    than that of air of the link's size, and except for PyBullet and MuJoCo, which substitute a mass
    there too. This info is not given for markers of at most 1 cm, for frames of tools and sensors
    by name of at most 6 cm, for links that are fixed to the world, and where the 1 kg of PyBullet
    is less than a fiftieth of the robot's mass and than its body's.
    Frames without geometry need none, although PyBullet gives them 1 kg, nor does a frame with a
    marker below 1 g at the density of water that is fixed to a link with a mass. Another such
    marker is an info where MuJoCo substitutes the mass. A link without mass, with geometry or not,
    that is fixed to a link with mass is no place for a joint in Gazebo: sdformat 12.3 omits the
    link that the joint moves. Without a simulator among the targets,
    links of xacro files are not reported that write inertials under a condition, and a
    robot without any is one info, if it has several links with geometry, or no geometry and at
    least three joints that move: it serves kinematics or display.
    """
    if robot.format == "sdf":
        yield from _report_default_inertials(robot)
        return
    if targets.isdisjoint(MASS_READERS) and is_only_kinematic(robot):
        if not has_optional_inertials(description):
            yield report_massless(robot, targets)
        return
    in_gazebo = not targets.isdisjoint(GAZEBO)
    if in_gazebo and robot.links and all(link.is_frame for link in robot.links):
        yield Problem(
            robot,
            "no link of the robot has a mass or a shape; Gazebo needs a link with mass",
            severity=ERROR,
            effects=("gz, gazebo-classic (root)",),
        )
        return
    tops: dict[str, Link] | None = None
    kept = find_kept_links(robot)
    holders = list(report_holders(robot, targets, is_written=False))
    yield from holders
    for link in robot.links:
        if link.inertial is not None or link.is_frame or link.name == "world":
            continue
        if "inertial" in find_misspelled_children(link.xml).values():
            continue
        if tops is None:
            bodies = find_rigid_bodies(robot).values()
            body = {one.name: links for links in bodies for one in links}
            tops = {name: links[0] for name, links in body.items()}
            heavy = {name for name, links in body.items() if compute_mass(links) > 0}
        joint = robot.tree.get_parent_joint(tops.get(link.name, link).name)
        moves = joint is not None and not joint.is_fixed
        held = is_fixed_to_world(robot, link)
        if in_gazebo and link.name not in heavy:
            outcome, severity, so = "removed", ERROR, f"; {_REMOVED}"
            several = f"; {_ALL_REMOVED}"
            if kept is not None and not kept:
                so = several = "; no link of the robot remains in Gazebo"
        elif "pybullet" in targets and not held:
            outcome, severity, so = "1 kg", ERROR, "; PyBullet gives it 1 kg"
            several = "; PyBullet gives each of them 1 kg"
        elif "mujoco" in targets and link.collisions and moves:
            outcome, severity = "water", INFO if is_light_marker(link) else ERROR
            so = "; MuJoCo computes a mass at the density of water"
            several = "; MuJoCo computes their masses at the density of water"
        elif link.name in heavy:
            twin = find_twin(robot, link)
            outcome, severity = "part", INFO
            so = f"; {_AS_PART.format('it', 'its')}"
            several = f"; {_AS_PART.format('each of them', 'their')}"
            if twin is not None and twin.inertial is not None and twin.mass > 0:
                outcome, severity = "half", WARNING
                so = f", but its mirror image '{twin.name}' has one"
                several = ", but their mirror images have one"
            elif light := find_light_body(robot, link, body[link.name]):
                outcome, severity = "light", WARNING
                so = f", and the links fixed to it {light.describe()}"
                several = ", and the links fixed to them are lighter than air of their size"
            elif held or is_light_marker(link) or is_slight_frame(robot, link):
                continue
        elif held and (kept is None or not targets.isdisjoint(("mujoco", "pybullet"))):
            continue  # its mass has no effect there, and Gazebo reads only one tree
        elif held:
            outcome, severity = "static", INFO
            so = f" and is fixed to the world; {_REMOVED}"
            several = f" and are fixed to the world; {_ALL_REMOVED}"
        elif has_optional_inertials(description):
            continue
        else:
            outcome, severity, so = "no mass", WARNING, " and so has no mass"
            several = " and so have no mass"
        warned_by_kdl = link is robot.tree.root and not targets.isdisjoint(ROS)
        needs_mass = severity is not INFO and not warned_by_kdl
        if kept is None:
            case = "not one tree"
        else:
            case = "part" if tops.get(link.name, link).name in kept else "" if kept else "root"
        yield Problem(
            link,
            f"link '{link.name}' has no <inertial>{so}",
            hint=INERTIAL_HINT if needs_mass else "",
            severity=severity,
            group=f"{{count}} links have no <inertial>{several}: {{names}}",
            effects=select_effects(robot, link, case) - (LUMPED if outcome == "part" else set()),
            alike=outcome,
            pedantic=severity is INFO
            or (severity is not ERROR and is_massless_scene(robot))
            or (len(robot.links) == 1 and not link.collisions),
        )


@missing_inertial.full
def report_every_shape_without_inertial(robot: Robot) -> Iterator[Problem]:
    """Report each link with geometry and no inertial, regardless of what it is fixed to."""
    for link in robot.links:
        if link.inertial is None and not link.is_frame and link.name != "world":
            text = f"link '{link.name}' has no <inertial> and so has no mass"
            yield Problem(link, text, hint=INERTIAL_HINT)


def _report_default_inertials(robot: Robot) -> Iterator[Problem]:
    """Report links of SDF whose mass and inertia are the defaults of the format."""
    for link in robot.links:
        if has_written_inertial(robot, link) or link.is_virtual or is_fixed_to_world(robot, link):
            continue
        if link.inertial is not None and not (robot.base and not robot.base.is_free):
            so = "; SDF then takes 1 kg and 1 kg·m² about each axis. Write its mass and inertia"
            yield Problem(
                link,
                f"link '{link.name}' has no <inertial>{so}",
                group=f"{{count}} links have no <inertial>{so}: {{names}}",
            )


_LIGHTEST = 1e-5
"""Mass [kg] below which a shape counts as a marker whose mass may be missing."""


@missing_inertial.fix(UNSAFE)
def add_inertial(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the inertial of the geometry at the density of water.

    A robot without any gets those of all links, unless a macro writes several of these links.
    """
    if problem.kind == "robot":
        links = [link for link in context.robot.links if not link.is_frame]
        if len({(link.place.path, link.place.start) for link in links}) < len(links):
            return None
    elif problem.severity is INFO:
        return None  # the body has a mass, or does not need one
    else:
        links = [context.get_link(problem)]
    from .corrections import make_inertial

    made = [(link, made) for link in links if (made := make_inertial(link, context)) is not None]
    made = [(link, (mass, lines)) for link, (mass, lines) in made if mass >= _LIGHTEST]
    if not made:
        return None
    what = "; ".join("".join(line.strip() for line in lines[1:-1]) for _, (_, lines) in made)
    changes = [prepend_child(link.element, *lines) for link, (_, lines) in made]
    return unsafe(f"add the <inertial> of its geometry at {DENSITY:g} kg/m³: {what}", *changes)


@rule(
    WARNING,
    raised=dict.fromkeys(_SIMULATED, ERROR),
    effects={
        "gz, gazebo-classic": (
            "omit the link and its descendants, without a message (sdformat 12.3)"
        ),
        "mujoco": "rejects the file: mass of moving bodies must be positive",
        "pybullet": "gives it 1 kg",
        "pinocchio": "its mass matrix is singular if no descendant has mass",
    },
    formats=ANY_FORMAT,
)
def massless_moving_body(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A joint moves a frame to which nothing with a mass is fixed.

    A frame between two joints works for kinematics, but not for simulation: a force on zero mass
    has no finite acceleration. Gazebo omits the link and its descendants, and controllers then
    report missing joints. MuJoCo rejects the file. Without a simulator among the targets, such a
    body is reported only if it is the only one, because then its ``<inertial>`` was probably lost.
    """
    bare, heavy = [], 0
    for joint, name, links in find_moved_bodies(robot):
        if is_bare(links):
            bare.append((joint, name, links[0]))
        heavy += compute_mass(links) > 0
    if targets.isdisjoint(_SIMULATED) and (len(bare) > 1 or heavy < 3):
        return
    yield from (_report_moved_body(robot, joint, name, link) for joint, name, link in bare)


@massless_moving_body.full
def report_every_massless_moving_body(robot: Robot) -> Iterator[Problem]:
    """Report each body without mass that a joint moves, also one with geometry."""
    for joint, name, links in find_moved_bodies(robot):
        if compute_mass(links) <= 0:
            yield _report_moved_body(robot, joint, name, links[0])


def _report_moved_body(robot: Robot, joint: Joint, name: str, link: Link) -> Problem:
    return Problem(
        link,
        f"joint '{joint.name}' moves link '{name}', which has no mass"
        f"{_describe_descendants(robot, name)}; add a small <inertial>, or make the joint fixed",
        data={"joint": joint.name, "below": sum(1 for _ in robot.tree.list_descendants(name))},
    )


@massless_moving_body.fix(UNSAFE)
def add_small_inertial(problem: Problem, context: FixContext) -> Proposal | None:
    """Add an inertial of 10 g to the frame."""
    from .corrections import give_small_inertial

    return give_small_inertial(context.get_link(problem))


def _describe_descendants(robot: Robot, name: str) -> str:
    count = sum(1 for _ in robot.tree.list_descendants(name))
    if not count:
        return ""
    return f", and {count} links below it" if count > 1 else ", and one link below it"


@rule(
    ERROR,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": "load nothing: a model must have at least one link",
    },
    formats=ANY_FORMAT,
)
def massless_root_body(robot: Robot) -> Iterator[Problem]:
    """The root and all links fixed to it have no mass, although joints move other links on it.

    Gazebo begins at the root: it omits a root without mass and all its descendants, so that no
    link remains. Only a root named ``world`` may have no mass.
    """
    for name, links in find_rigid_bodies(robot).items():
        joint = robot.tree.get_parent_joint(name)
        if name == "world" or (joint is not None and joint.parent != "world"):
            continue
        if joint is not None and not joint.is_fixed:
            continue
        below = [joint for one in links for joint in robot.tree.get_child_joints(one.name)]
        if not is_bare(links) or all(joint.is_fixed for joint in below):
            continue
        yield _report_root(links[0])


@massless_root_body.full
def report_every_massless_root_body(robot: Robot) -> Iterator[Problem]:
    """Report a root without mass, also one with geometry or without moving joints."""
    for root in robot.tree.roots:
        links = [link for link, _ in find_attached_links(robot, root)]
        if root.name != "world" and compute_mass(links) <= 0:
            yield _report_root(root)


def _report_root(root: Link) -> Problem:
    return Problem(
        root,
        f"root link '{root.name}' and all links fixed to it have no mass; add an <inertial>, or "
        "name the root 'world' if the robot has a fixed base",
    )


def _is_broken(robot: Robot) -> bool:
    """Tell whether names repeat, or a joint names a missing link."""
    twice = len(robot.link) < len(robot.links) or len(robot.joint) < len(robot.joints)
    return twice or any(
        name not in robot.link for joint in robot.joints for name in (joint.parent, joint.child)
    )


_SLIGHT = 1e-3
"""Mass [kg] below which a root without geometry is a frame."""


@rule(
    INFO,
    on=ROS,
    effects={
        "KDL": "warns at every start, and omits that mass from its dynamics",
        "robot_state_publisher": "prints the warning of kdl_parser",
        "mujoco": "welds the root to the world",
    },
    pedantic="robots without a moving joint",
)
def root_link_has_inertia(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """The root link has an ``<inertial>``.

    KDL does not support a mass of the root link: robot_state_publisher prints a warning at every
    start, and KDL computes dynamics without this mass. Add a new root link without
    ``<inertial>`` and attach the old root to it with a fixed joint.

    PyBullet gives such a root 1 kg, and with ``URDF_USE_INERTIA_FROM_FILE`` 1 kg·m² about each
    axis, which makes a robot with a free base heavier. Therefore neither the remedy nor the fix is
    offered with the target ``pybullet``. Arms and grippers are not reported, because their root is
    mounted: its mass has no part in their dynamics; nor are robots that walk or fly, whose root is
    the body that moves, and to which a root above it is another frame of reference.
    """
    root = robot.tree.root
    if root is None or len(robot.tree.roots) > 1 or _is_broken(robot):
        return  # fixing these may change the root
    if is_arm(robot) or are_fingers(robot.moving_joints) or is_floating_base(robot):
        return
    if root.inertial is not None and root.inertial.mass != 0.0:
        remedy, hint = "; add a root link without one above it, on a fixed joint", _IN_PYBULLET
        if root.name == "world" or is_needless(robot, root):
            remedy = "; remove its <inertial>"
        if root.name == "world":
            hint = ""  # PyBullet does not add mass to a root of this name
        elif "pybullet" in targets:
            remedy = hint = ""
        yield Problem(
            root,
            f"root link '{root.name}' has an inertia, which KDL does not support{remedy}",
            hint=hint,
            pedantic=not robot.moving_joints,
        )


_IN_PYBULLET = (
    "PyBullet gives a root without an <inertial> 1 kg, which makes a robot with a free base heavier"
)


def is_needless(robot: Robot, root: Link) -> bool:
    """Tell whether a root is a frame with negligible mass, fixed to links with a mass.

    If nothing with mass is fixed to it, Gazebo omits a root without ``<inertial>`` and the whole
    robot with it.
    """
    if root.mass >= _SLIGHT or root.visuals or root.collisions:
        return False
    return any(link.mass > 0 for link, _ in find_attached_links(robot, root)[1:])


@root_link_has_inertia.fix(UNSAFE)
def add_root_link(problem: Problem, context: FixContext) -> Proposal | None:
    """Add a link without inertial above the root, on a fixed joint; or remove a needless one."""
    robot, link = context.robot, context.get_link(problem)
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
    what = f"add a link '{name}' without <inertial> above it, on a fixed joint"
    return unsafe(f"{what}; PyBullet gives it 1 kg", Change("first", robot.element, blocks=made))


@rule(
    INFO,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": (
            "move the mass, without showing it"
        ),
    },
    default=False,
)
def mass_without_geometry(robot: Robot) -> Iterator[Problem]:
    """A rigid body has a mass, but neither visual nor collision geometry.

    Either a visual was forgotten, or a sensor frame was given a mass because Gazebo omits links
    without mass. If the mass belongs to the geometry of a link that is fixed to it, the link is
    not reported.
    """
    for link in robot.links:
        if link.mass <= 0 or link.visuals or link.collisions:
            continue
        if not any(one.visuals or one.collisions for one, _ in find_attached_links(robot, link)):
            yield Problem(
                link, f"link '{link.name}' has a mass of {link.mass:g} kg but no geometry"
            )
