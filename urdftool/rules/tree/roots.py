"""Check that the links form one tree."""

from __future__ import annotations

from collections.abc import Iterator

from ...listing import quote_first
from ...model.elements import Joint, Link, Robot
from ...model.joint import JOINT_TYPES
from ..rule import ANY_FORMAT, ERROR, Problem, rule
from ..unexpanded import is_unexpanded
from ..words import quote
from ..xml.vocabulary_table import find_misspelled_children

_SHOWN = 6
"""Number of links that a message names. Chosen, no source."""


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio": "reject the robot: two root links found",
        "mujoco": "welds every root to the world",
        "pybullet": "crashes",
        "drake": "loads each root that no <drake:joint> joins as a free body",
    },
    formats=ANY_FORMAT,
)
def multiple_roots(robot: Robot) -> Iterator[Problem]:
    """Several links have no parent joint.

    A robot is one tree with one root. urdfdom rejects several roots, MuJoCo welds each root to the
    world, and PyBullet crashes. Usually a joint was forgotten. Only Drake reads ``<drake:joint>``.
    """
    roots = robot.tree.roots
    if len(roots) < 2 or "joint" in find_misspelled_children(robot.xml).values():
        return
    main = _find_main_root(robot)
    joined = _find_drake_roots(robot)
    if joined:
        yield _report_drake_roots([link for link in roots if link.name in joined])
    others = [link for link in roots if link is not main and link.name not in joined]
    if main.name in joined:
        others = others[1:]
    lost = sum(1 for joint in robot.joints if joint.child not in robot.link)
    if len(others) <= lost or any(is_unexpanded(link.name) for link in others):
        return
    yield Problem(others[0], _describe_roots(main, others))


@multiple_roots.full
def report_every_root(robot: Robot) -> Iterator[Problem]:
    """Report each root after the first, also those that another finding explains."""
    roots = robot.tree.roots
    if len(roots) < 2:
        return
    group, data = _describe_roots(roots[0], roots[1:]), {"roots": [root.name for root in roots]}
    for link in roots[1:]:
        yield Problem(link, _describe_roots(roots[0], [link]), group=group, data=data)


def _describe_roots(main: Link, others: list[Link]) -> str:
    names = quote_first([link.name for link in others], _SHOWN)
    if len(others) == 1:
        message = f"link {names} and root '{main.name}' have no parent joint; connect them"
    else:
        message = f"links {names} and root '{main.name}' have no parent joint; connect them"
    return f"{message} with joints"


def _find_drake_roots(robot: Robot) -> set[str]:
    """Find the roots that a ``<drake:joint>`` connects to another link."""
    roots = {link.name for link in robot.tree.roots}
    found = set()
    for joint in () if robot.xml is None else robot.xml.list_children("drake:joint"):
        if joint.get("type") in JOINT_TYPES:
            continue  # Drake rejects it
        parent, child = joint.find_child("parent"), joint.find_child("child")
        if parent is not None and child is not None and parent.get("link") in robot.link:
            found.add(child.get("link") or "")
    return found & roots


def _report_drake_roots(links: list[Link]) -> Problem:
    names = quote((link.name for link in links), _SHOWN)
    what = f"link {names} is a root" if len(links) == 1 else f"links {names} are roots"
    return Problem(
        links[0],
        f"{what}, because only Drake reads the <drake:joint> that connects "
        f"{'it' if len(links) == 1 else 'them'}; write <joint> for other readers",
    )


def _find_main_root(robot: Robot) -> Link:
    """Find the root with the most descendants; requires at least one root."""
    return max(
        robot.tree.roots, key=lambda link: sum(1 for _ in robot.tree.list_descendants(link.name))
    )


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": "reject the robot",
    },
    formats=ANY_FORMAT,
)
def no_root(robot: Robot) -> Iterator[Problem]:
    """Every link is the child of a joint, so the robot has no root.

    The joints form a cycle, and all readers reject the robot. Remove the joint that closes it.
    """
    if not robot.links or robot.tree.roots:
        return
    if any(joint.parent == joint.child or joint.parent not in robot.link for joint in robot.joints):
        return
    cycle = _find_cycle(robot, robot.links[0])
    joint = robot.tree.get_parent_joint(cycle[0].name)
    yield Problem(
        robot if joint is None else joint,
        _describe_missing_root(cycle),
        at=None if joint is None else joint.child_element,
    )


@no_root.full
def report_every_missing_root(robot: Robot) -> Iterator[Problem]:
    """Report a robot with links but no root, also if a missing link is above all others."""
    if robot.links and not robot.tree.roots:
        cycles = (_find_cycle(robot, link) for link in robot.links)
        yield Problem(robot, _describe_missing_root(next(filter(None, cycles), [])))


def _describe_missing_root(cycle: list[Link]) -> str:
    shown = f": {_format_cycle(cycle)}" if cycle else ""
    return f"every link has a parent joint{shown}; remove the one of the root link"


@rule(
    ERROR,
    effects={
        "check_urdf": "reports success",
        "gz, gazebo-classic, pybullet, pinocchio": "load the robot without those links",
        "mujoco, drake": "reject the file",
    },
    formats=ANY_FORMAT,
)
def detached_cycle(robot: Robot) -> Iterator[Problem]:
    """Joints connect some links in a cycle without a connection to the root.

    urdfdom reads the tree from the root and never reaches these links. It reports success, and
    Gazebo and PyBullet load the robot without these links.
    """
    if not robot.tree.roots:
        return
    seen: set[str] = set()
    for link in robot.tree.detached:
        if link.name in seen:
            continue
        cycle = _find_cycle(robot, link)
        if len(cycle) > 1:
            seen.update((cycle[0].name, *robot.tree.list_descendants(cycle[0].name)))
            yield Problem(cycle[0], _describe_cycle(cycle))


@detached_cycle.full
def report_every_link_on_cycle(robot: Robot) -> Iterator[Problem]:
    """Report each link that is in or below a cycle, also if a second joint connects it."""
    has_root = bool(robot.tree.roots)
    detached = {link.name for link in robot.tree.detached}
    for name, cycle in _find_cycles(robot).items():
        if cycle:
            data = {
                "links": [link.name for link in cycle],
                "is_detached": name in detached,
                "has_root": has_root,
            }
            message = _describe_cycle(cycle) if has_root else _describe_missing_root(cycle)
            yield Problem(robot.link[name], message, data=data)


def _find_cycles(robot: Robot) -> dict[str, list[Link]]:
    """Find the cycle that each link is in or below, as ``_find_cycle`` does, in linear time."""
    found: dict[str, list[Link]] = {}
    for link in robot.link.values():
        above: dict[str, None] = {}
        name = link.name
        while name in robot.link and name not in found and name not in above:
            above[name] = None
            joint = robot.tree.get_parent_joint(name)
            if joint is None:
                break
            name = joint.parent
        cycle = found[name] if name in found else _find_cycle(robot, link)
        found.update(dict.fromkeys(above, cycle))
    return {name: found[name] for name in robot.link}


def _describe_cycle(cycle: list[Link]) -> str:
    return (
        f"links form a cycle without a connection to the root: {_format_cycle(cycle)}; "
        "change the parent of one of these joints to a link of the tree"
    )


def _find_cycle(robot: Robot, link: Link) -> list[Link]:
    """Find the cycle above a link, child before parent; empty if there is none."""
    above: dict[str, None] = {}
    name = link.name
    while name in robot.link and name not in above:
        above[name] = None
        joint = robot.tree.get_parent_joint(name)
        if joint is None:
            return []
        name = joint.parent
    if name not in above:
        return []
    names = list(above)
    circle = names[names.index(name) :]
    start = min(range(len(circle)), key=lambda i: robot.link[circle[i]].place.start)
    return [robot.link[n] for n in (*circle[start:], *circle[:start])]


def _format_cycle(cycle: list[Link]) -> str:
    """Format a cycle from parent to child."""
    first, *rest = (link.name for link in cycle)
    names = [first, *reversed(rest)]
    shown = names if len(names) <= _SHOWN else [*names[: _SHOWN - 1], "…"]
    return " → ".join(f"'{name}'" for name in (*shown, first))


@rule(
    ERROR,
    effects={
        "check_urdf": "reports success",
        "gz, gazebo-classic": (
            "reject the model, which then has the link twice; a link that is fixed to both is "
            "lumped (sdformat 12.3)"
        ),
        "mujoco, drake, newton": "reject the robot",
        "pinocchio": "loads the link once for each joint, or rejects the robot",
        "pybullet": "crashes",
    },
    formats=ANY_FORMAT,
)
def multiple_parents(robot: Robot) -> Iterator[Problem]:
    """A link is the child of two joints.

    A URDF is a tree and cannot have closed chains. urdfdom accepts it without a message, Gazebo
    rejects it unless the link is lumped into its parent, MuJoCo rejects it, and PyBullet crashes.
    """
    roots = robot.tree.roots
    main = _find_main_root(robot) if roots else None
    orphans = {link.name for link in roots if link is not main}
    for name, joints in robot.tree.joints_of_child.items():
        if len(joints) < 2 or name not in robot.link:
            continue
        joined = [joint for joint in joints if joint.parent != joint.child]
        joined.sort(key=lambda joint: joint.parent in orphans)  # parent and child may be swapped
        first = joined[0] if joined else joints[0]
        for joint in joined[1:]:
            if joint.name == first.name:
                continue
            yield Problem(
                joint, _describe_second_parent(first, joint, orphans), at=joint.child_element
            )


@multiple_parents.full
def report_every_second_parent(robot: Robot) -> Iterator[Problem]:
    """Report a link for each joint after the first that has it as child, of any names."""
    orphans = {link.name for link in robot.tree.roots[1:]}
    for name, (first, *others) in robot.tree.joints_of_child.items():
        for joint in others:
            if name in robot.link:
                yield Problem(
                    robot.link[name],
                    _describe_second_parent(first, joint, orphans),
                    at=joint.child_element or joint,
                    data={"has_name": bool(name), "parents": len(others) + 1},
                )


def _describe_second_parent(first: Joint, joint: Joint, orphans: set[str]) -> str:
    if joint.parent in orphans:
        right = f"swap parent '{joint.parent}' and child '{joint.child}' if they are reversed"
    elif len(orphans) == 1:
        right = f"did you mean '{next(iter(orphans))}', which has no parent joint?"
    else:
        right = "remove one, or close the chain in the simulator"
    return (
        f"link '{joint.child}' is the child of two joints, '{first.name}' and '{joint.name}'; "
        f"{right}"
    )
