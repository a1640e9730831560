"""Whether a link has an inertia at all."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Link, Robot
from ..rule import ERROR, GAZEBO, INFO, ROS, WARNING, Problem, rule
from ..xml.vocabulary_table import misspelt_children
from .bodies import bodies, mass_of
from .solids import solid_volume

_SIMULATED = ("gazebo-classic", "gz", "mujoco")
_MARKER = 1e-3  # [kg]
_LOST = "Gazebo leaves it out, with all that hangs on it"


@rule(
    WARNING,
    raised=dict.fromkeys(("gazebo-classic", "gz", "mujoco", "pybullet"), ERROR),
    effects={
        "gz, gazebo-classic": (
            "leave out the link and all below it, without a message; a link fixed to one with "
            "mass is merged into it"
        ),
        "pybullet": "assumes 1 kg, and with URDF_USE_INERTIA_FROM_FILE 1 kg·m² about each axis",
        "mujoco": "assumes the mass of water in the shape of its collisions",
        "pinocchio, KDL, drake": "take 0 kg",
    },
    group="robot",
)
def missing_inertial(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A link that is seen or touches has no ``<inertial>``.

    A body without mass cannot be accelerated, and every simulator makes something else of it:
    Gazebo leaves out the link with everything below, PyBullet makes it weigh one kilogram, MuJoCo
    fills its collision shapes with water. A mere frame needs none, and a marker that would weigh
    less than a gram is an info where nobody gives it more.
    """
    in_gazebo = not targets.isdisjoint(GAZEBO)
    heavy = _links_with_mass(robot) if in_gazebo else frozenset()
    for link in robot.links:
        if link.inertial is not None or link.is_frame or link.name == "world":
            continue
        if "inertial" in misspelt_children(link.element).values():
            continue
        joint = robot.tree.parent_joint(link.name)
        if in_gazebo and link.name not in heavy:
            severity, so = ERROR, f"; {_LOST}"
            several = "; Gazebo leaves them out, with all that is fixed or joined to them"
        elif "pybullet" in targets:
            severity, so = ERROR, "; PyBullet makes it weigh 1 kg"
            several = "; PyBullet gives each of them 1 kg"
        elif "mujoco" in targets and link.collisions:
            severity = INFO if _is_marker(link) else ERROR
            so = "; MuJoCo makes it as heavy as water"
            several = "; MuJoCo gives each of them the density of water"
        elif in_gazebo and joint is not None and joint.is_fixed:
            severity, so = INFO, f" and adds nothing to '{joint.parent}', which it is fixed to"
            several = " and add nothing to the links that they are fixed to"
        else:
            fixed = joint is not None and joint.is_fixed
            severity = INFO if fixed and _is_marker(link) else WARNING
            so = ", so it weighs nothing"
            several = ", so they have no mass"
        yield Problem(
            link,
            f"link '{link.name}' has no <inertial>{so}",
            hint="'urdftool inertia' computes one from its shapes",
            severity=severity,
            group=f"{{count}} links have no <inertial>{several}: {{names}}",
        )


def _is_marker(link: Link) -> bool:
    """Whether a link is so small that as water it would weigh less than a gram."""
    shapes = link.collisions or link.visuals
    volumes = [solid_volume(shape.geometry) for shape in shapes]
    return all(volumes) and 1000 * sum(volumes) < _MARKER


def _links_with_mass(robot: Robot) -> frozenset[str]:
    return frozenset(
        link.name for links in bodies(robot).values() if mass_of(links) > 0 for link in links
    )


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
    for name, links in bodies(robot).items():
        joint = robot.tree.parent_joint(name)
        if joint is None or joint.is_fixed:
            continue
        if _is_bare(links):
            bare.append((joint, name, links[0]))
        heavy += mass_of(links) > 0
    if targets.isdisjoint(_SIMULATED) and (len(bare) > 1 or heavy < 3):
        return
    for joint, name, link in bare:
        yield Problem(
            link,
            f"joint '{joint.name}' moves link '{name}', which has no mass{_below(robot, name)}; "
            "give it a small <inertial>, or make the joint fixed",
        )


def _below(robot: Robot, name: str) -> str:
    count = sum(1 for _ in robot.tree.descendants(name))
    if not count:
        return ""
    return f", and {count} links hang on it" if count > 1 else ", and one link hangs on it"


def _is_bare(links: list[Link]) -> bool:
    """Whether no link of a body has an inertial, or needs one because it is seen or touches."""
    for link in links:
        if not link.is_frame or "inertial" in misspelt_children(link.element).values():
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
        yield Problem(
            links[0],
            f"root link '{name}' has no mass, nor has anything fixed to it; "
            "give it an <inertial>, or call it world if the robot is bolted down",
        )


def _moves_something(robot: Robot, links: list[Link]) -> bool:
    return any(not joint.is_fixed for link in links for joint in robot.tree.child_joints(link.name))


@rule(
    INFO,
    on=ROS,
    effects={
        "KDL": "warns at every start, and leaves that mass out of its dynamics",
        "robot_state_publisher": "prints the warning of kdl_parser",
        "mujoco": "welds the root to the world",
    },
)
def root_link_has_inertia(robot: Robot) -> Iterator[Problem]:
    """The root link has an ``<inertial>``.

    KDL cannot give its root a mass: it prints a warning at every start of robot_state_publisher and
    computes dynamics without it. A root without mass, joined by a fixed joint to the link that was
    the root, cures it.
    """
    root = robot.tree.root
    if root is not None and root.inertial is not None and root.inertial.mass != 0.0:
        yield Problem(
            root,
            f"root link '{root.name}' has an inertia, which KDL does not support; "
            f"put a link without one above it, on a fixed joint",
        )


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
    """A link has a mass and no shape.

    Sensor frames get a gram to survive Gazebo; otherwise a visual was forgotten.
    """
    for link in robot.links:
        if link.mass > 0 and not link.visuals and not link.collisions:
            yield Problem(link, f"link '{link.name}' weighs {link.mass:g} kg and has no shape")
