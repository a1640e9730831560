"""Check names of links and joints."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from ...model.elements import Joint, Link, Robot
from ...source.description import Description
from ..fix import FixContext, Proposal, set_attribute, unsafe
from ..gazebo.lumped_model import find_kept_links, find_sdf_joints, is_joint_kept, is_named_as_link
from ..gazebo.lumping import is_lumped
from ..renaming import rename_part
from ..rule import ANY_FORMAT, ERROR, GAZEBO, INFO, UNSAFE, WARNING, Problem, rule, select_holding
from ..xml.vocabulary_table import find_misspelled_children


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pybullet, pinocchio": "reject the robot",
        "mujoco, drake": "load a model without a body",
    },
    formats=ANY_FORMAT,
)
def no_links(robot: Robot, description: Description) -> Iterator[Problem]:
    """The robot has no link.

    urdfdom, and with it ROS and Gazebo, rejects a robot without links. A ``<robot>`` with a comment
    and neither name nor elements is ignored, as a placeholder that another file includes.
    """
    if (
        not (robot.name.strip() or (robot.xml and robot.xml.children))
        and description.document.comments
    ):
        return
    if not robot.links and "link" not in find_misspelled_children(robot.xml).values():
        yield _report_no_link(robot)


@no_links.full
def report_every_missing_link(robot: Robot) -> Iterator[Problem]:
    """Report a robot without links, also a placeholder or one whose links are misspelled."""
    if not robot.links:
        yield _report_no_link(robot)


def _report_no_link(robot: Robot) -> Problem:
    macros = robot.source is not None and robot.source.expansion is not None
    what = "use a file that calls its macros" if macros else 'add a <link name="…"/>'
    who = f"robot '{robot.name}'" if robot.name else "the robot"
    return Problem(robot, f"{who} has no link; {what}")


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio": "reject the robot: link is not unique",
        "mujoco, pybullet, drake": "reject the file",
    },
    formats=ANY_FORMAT,
)
def duplicate_link_name(robot: Robot) -> Iterator[Problem]:
    """Two links have the same name.

    Joints refer to links by name, so readers reject the robot. Often a macro is called twice with
    the same prefix.
    """
    for link in robot.links:
        first = robot.link[link.name]
        if first is not link and link.name.strip():
            yield _report_second(link, first)


@duplicate_link_name.full
def report_every_second_link(robot: Robot) -> Iterator[Problem]:
    """Report each link after the first of its name, also if the name is blank or empty."""
    yield from _report_every_second(robot.links, robot.link)


def _report_every_second(
    parts: Sequence[Link] | Sequence[Joint], first: Mapping[str, Link] | Mapping[str, Joint]
) -> Iterator[Problem]:
    for part in parts:
        if first[part.name] is not part:
            problem = _report_second(part, first[part.name])
            problem.data = {"has_name": bool(part.name)}
            yield problem


def _report_second(part: Link | Joint, first: Link | Joint) -> Problem:
    kind = "link" if isinstance(part, Link) else "joint"
    named = part.has_attribute("name")
    return Problem(
        part,
        f"{kind} name '{part.name}' is used twice (first in line {first.place.line}); rename one",
        at=part.locate_attribute("name") if named else None,
    )


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio": "reject the robot: joint is not unique",
        "mujoco (of other links)": "loads it",
        "mujoco (of the same link)": "rejects the file: multiple parents",
        "drake (of the same link)": "rejects the file",
        "pybullet": "crashes",
    },
    formats=ANY_FORMAT,
)
def duplicate_joint_name(robot: Robot) -> Iterator[Problem]:
    """Two joints have the same name.

    Joint states and commands refer to joints by name. urdfdom rejects the robot, PyBullet crashes.
    """
    for joint in robot.joints:
        first = robot.joint[joint.name]
        if first is not joint and joint.name.strip():
            problem = _report_second(joint, first)
            case = "of the same link" if first.child == joint.child else "of other links"
            problem.effects = select_holding(duplicate_joint_name.effects, case)
            yield problem


@duplicate_joint_name.full
def report_every_second_joint(robot: Robot) -> Iterator[Problem]:
    """Report each joint after the first of its name, also if the name is blank or empty."""
    yield from _report_every_second(robot.joints, robot.joint)


@duplicate_joint_name.fix(UNSAFE)
def number_joint_name(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the only name that a ``<transmission>`` uses and no joint has, or append a number."""
    joint, robot = context.get_joint(problem), context.robot
    taken = {*robot.joint, *robot.link}
    used = {one.name for each in robot.transmissions for one in each.joints}
    missed = used - taken - {""}
    name = missed.pop() if len(missed) == 1 else _find_free_name(joint.name, taken)
    return unsafe(f"rename it to '{name}'", set_attribute(joint.element, "name", name))


def _find_free_name(name: str, taken: set[str]) -> str:
    number = 2
    while f"{name}_{number}" in taken:
        number += 1
    return f"{name}_{number}"


_OTHERS_ACCEPT = "urdfdom, mujoco, pybullet, pinocchio, drake"
_CLASH = {
    "gz, gazebo-classic (both stay)": "reject the model: a name is not unique (sdformat 12.3)",
    "gz, gazebo-classic (one is lumped)": (
        "load the model, because a lumped link or joint leaves no name (sdformat 12.3)"
    ),
    _OTHERS_ACCEPT: "accept it",
}


@rule(
    INFO,
    on=GAZEBO,
    raised=dict.fromkeys(GAZEBO, ERROR),
    effects=_CLASH,
    group="robot",
)
def link_joint_name_clash(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A link and a joint have the same name.

    In SDF, links and joints share one namespace, so Gazebo rejects a model that other readers
    load. If a fixed joint is lumped with its link, sdformat 12.3 writes neither name, but versions
    that write frames for them (9.9 of series 9, and 13 or later) write both: then it is a warning.
    A ``<joint>`` of SDF in a ``<gazebo>`` block belongs to the same namespace.
    """
    in_gazebo = not targets.isdisjoint(GAZEBO)
    kept = find_kept_links(robot)
    for name, joint in robot.joint.items():
        if name in robot.link and name.strip():
            stay = kept is not None and is_named_as_link(robot, joint, kept)
            lumped = is_lumped(robot, name) or is_lumped(robot, joint.child)
            case = "both stay" if stay else "one is lumped" if kept and lumped else ""
            yield Problem(
                joint,
                f"joint '{name}' has the name of a link, but both share one namespace in SDF; "
                f"rename it to '{name}_joint'",
                at=joint.locate_attribute("name"),
                severity=WARNING if in_gazebo and lumped and not stay else None,
                effects=select_holding(_CLASH, case),
            )
    yield from _report_sdf_clashes(robot, kept or set())


def _report_sdf_clashes(robot: Robot, kept: set[str]) -> Iterator[Problem]:
    """Report SDF joints with the name of a link or joint that Gazebo has too."""
    names = dict.fromkeys((*kept, "world"), "a link")
    for joint in robot.joints:
        if is_joint_kept(robot, joint, kept):
            names.setdefault(joint.name, "a joint")
    for element in find_sdf_joints(robot):
        name = element.get("name") or ""
        if name in names:
            yield Problem(
                element,
                f"joint '{name}' in <gazebo> has the name of {names[name]}; write a unique name",
                at=element.locate_attribute("name"),
                effects=[
                    key for key in select_holding(_CLASH, "both stay") if key != _OTHERS_ACCEPT
                ],
                alike=names[name],
            )
        elif name:
            names[name] = "another joint in <gazebo>"


@link_joint_name_clash.fix(UNSAFE, renames=True)
def rename_joint(problem: Problem, context: FixContext) -> Proposal | None:
    """Append ``_joint`` to the name of a joint of URDF."""
    if not isinstance(problem.subject, Joint):
        return None
    joint = context.get_joint(problem)
    return rename_part(context, joint, f"{joint.name}_joint")
