"""What keeps a robot from being a tree, as facts about its links and joints."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from ..model.elements import Joint, Link, Robot
from ..source.location import Place
from .words import visible


class Fault(NamedTuple):
    """Something that keeps a robot from being a tree.

    Attributes:
        part: The link or joint it is about.
        mark: A few words that stand on its node.
        message: A sentence, with what would be right.
        place: Where it is written.
    """

    part: Link | Joint
    mark: str
    message: str
    place: Place


def find_faults(robot: Robot) -> Iterator[Fault]:
    """Every fault of a robot's tree, links first."""
    yield from _roots(robot)
    yield from _loops(robot)
    yield from _parents(robot)
    yield from _twins(robot)
    for joint in robot.joints:
        yield from _ends(robot, joint)


def first_of_each(faults: Iterable[Fault]) -> dict[str, Fault]:
    """Faults by their message, the first where several links share one."""
    found: dict[str, Fault] = {}
    for fault in faults:
        found.setdefault(fault.message, fault)
    return found


def _roots(robot: Robot) -> Iterator[Fault]:
    roots = robot.tree.roots
    if len(roots) < 2:
        return
    message = (
        f"{len(roots)} links have no parent, {_names(link.name for link in roots)}; "
        "a robot has one such link, its root"
    )
    for number, link in enumerate(roots, 1):
        yield Fault(link, f"root {number} of {len(roots)}", message, link.place)


def _loops(robot: Robot) -> Iterator[Fault]:
    """Links that are their own ancestors, each loop once; and what hangs on a loop alone."""
    tree = robot.tree
    told: set[str] = set()
    for link in robot.link.values():
        chain = _loop_through(robot, link.name) if link.name else []
        if len(chain) > 1 and link.name not in told:
            told.update(chain)
            shown = " → ".join(f"'{visible(name)}'" for name in _shortened([*chain, chain[0]]))
            message = f"links hang on each other in a loop, {shown}; one of them hangs elsewhere"
            for name in chain:
                yield Fault(robot.link[name], "in a loop", message, robot.link[name].place)
    for link in tree.detached:
        if link.name not in told:
            yield Fault(
                link,
                "detached",
                f"link '{visible(link.name)}' hangs on no root; the joints above it end in a loop "
                "or at a link that is not there",
                link.place,
            )


def _loop_through(robot: Robot, name: str) -> list[str]:
    """The links of the loop that a link is in, from it downwards; by first parents; or none."""
    chain = [name]
    seen = {name}
    joint = robot.tree.parent_joint(name)
    while joint is not None and joint.parent in robot.link:
        if joint.parent == name:
            return [name, *chain[:0:-1]]
        if joint.parent in seen:
            return []
        seen.add(joint.parent)
        chain.append(joint.parent)
        joint = robot.tree.parent_joint(joint.parent)
    return []


def _parents(robot: Robot) -> Iterator[Fault]:
    for name, joints in robot.tree.joints_of_child.items():
        link = robot.link.get(name)
        if name and link is not None and len(joints) > 1:
            named = _names(joint.name for joint in joints)
            yield Fault(
                link,
                f"{len(joints)} parents",
                f"link '{visible(name)}' is the child of {len(joints)} joints, {named}; "
                "a link has one parent",
                link.place,
            )


def _twins(robot: Robot) -> Iterator[Fault]:
    for kind, parts in (("link", robot.links), ("joint", robot.joints)):
        counts: dict[str, list[Link | Joint]] = {}
        for part in parts:
            counts.setdefault(part.name, []).append(part)
        for name, same in counts.items():
            if len(same) > 1:
                for part in same if kind == "joint" else same[:1]:
                    yield Fault(
                        part,
                        f"one of {len(same)} of this name",
                        f"{len(same)} {kind}s are called '{visible(name)}'; "
                        "each wants a name of its own",
                        same[1].place,
                    )


def _ends(robot: Robot, joint: Joint) -> Iterator[Fault]:
    name = visible(joint.name)
    if joint.parent and joint.parent == joint.child:
        yield Fault(
            joint,
            "joins a link to itself",
            f"joint '{name}' joins link '{visible(joint.parent)}' to itself; "
            "its parent and its child are two links",
            joint.place,
        )
    for end, link, element in (
        ("parent", joint.parent, joint.parent_element),
        ("child", joint.child, joint.child_element),
    ):
        place = joint.place if element is None else element.place
        if not link:
            mark = f"no {end}"
            message = f"joint '{name}' has no {end}; <{end} link=\"…\"/> names a link"
            yield Fault(joint, mark, message, place)
        elif link not in robot.link:
            mark = f"unknown {end}"
            message = f"the {end} of joint '{name}', '{visible(link)}', is no link of this robot"
            yield Fault(joint, mark, message, place)


def _names(names: Iterable[str]) -> str:
    shown = [f"'{visible(name)}'" for name in _shortened(list(names))]
    return shown[0] if len(shown) == 1 else f"{', '.join(shown[:-1])} and {shown[-1]}"


def _shortened(names: list[str], most: int = 6) -> list[str]:
    return names if len(names) <= most else [*names[: most - 2], "…", names[-1]]
