"""What keeps a robot from being a tree, as facts about its links and joints."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from ..control_characters import escape_controls
from ..diagnostic import Diagnostic, Severity
from ..lint.validate import find_problems
from ..model.elements import Joint, Link, Robot
from ..rules.rule import Problem
from ..source.location import Place


@dataclass(slots=True)
class Fault(Diagnostic):
    """Defect that keeps a robot from being a tree.

    Attributes:
        code: Rule of ``lint`` that reports it; ``detached`` for what follows from other faults.
        message: Sentence of the rule.
        location: Location in the source.
        part: The link or joint that it concerns.
        mark: A few words for its node.
        problem: Problem of the rule; several links may share it. None for ``detached``.
    """

    location: Place
    part: Link | Joint
    mark: str
    problem: Problem | None = None


def find_faults(robot: Robot) -> Iterator[Fault]:
    """Find the defects of a robot's tree, those of links first."""
    found: dict[str, list[Problem]] = {}
    for rule, problem in find_problems(robot, "graph"):
        found.setdefault(rule, []).append(problem)
    yield from _find_roots(robot, found.get("multiple-roots", []))
    yield from _find_loops(robot, found.get("detached-cycle", []))
    yield from _find_parents(found.get("multiple-parents", []))
    yield from _find_duplicates(robot, "link", found.get("duplicate-link-name", []))
    yield from _find_duplicates(robot, "joint", found.get("duplicate-joint-name", []))
    ends = [
        fault
        for rule in ("joint-to-itself", *_END_MARKS)
        for problem in found.get(rule, [])
        for fault in _find_wrong_ends(rule, problem)
    ]
    order = {id(joint): number for number, joint in enumerate(robot.joints)}
    yield from sorted(ends, key=lambda f: (order[id(f.part)], f.mark.endswith("child")))


def group_by_message(faults: Iterable[Fault]) -> list[Fault]:
    """Return the faults, only the first of those that share a problem."""
    found: dict[int, Fault] = {}
    for fault in faults:
        found.setdefault(id(fault.problem or fault), fault)
    return list(found.values())


def _make_fault(
    rule: str, part: Link | Joint, mark: str, problem: Problem, message: str, place: Place
) -> Fault:
    return Fault(
        rule,
        Severity.ERROR,
        escape_controls(message),
        place,
        part,
        mark,
        problem,
        data=problem.data,
    )


def _find_roots(robot: Robot, problems: list[Problem]) -> Iterator[Fault]:
    if problems:
        problem, roots = problems[0], robot.tree.roots
        for number, link in enumerate(roots, 1):
            mark = f"root {number} of {len(roots)}"
            yield _make_fault("multiple-roots", link, mark, problem, problem.group, link.place)


def _find_loops(robot: Robot, problems: list[Problem]) -> Iterator[Fault]:
    """Find the links of each loop, and other links that are not connected to a root."""
    reported: set[str] = set()
    for problem in problems:
        names: list[str] = problem.data["links"]
        if len(names) > 1 and names[0] not in reported:
            reported.update(names)
            for name in names:
                link = robot.link[name]
                yield _make_fault(
                    "detached-cycle", link, "in a loop", problem, problem.message, link.place
                )
    for link in robot.tree.detached:
        if link.name not in reported:
            message = (
                f"link '{escape_controls(link.name)}' is not connected to a root link, because "
                "its parent "
                "joints form a loop or refer to a missing link"
            )
            yield Fault("detached", Severity.ERROR, message, link.place, link, "detached")


def _find_parents(problems: list[Problem]) -> Iterator[Fault]:
    reported: set[str] = set()
    for problem in problems:
        link = problem.subject
        if isinstance(link, Link) and link.name not in reported:
            reported.add(link.name)
            mark = f"{problem.data['parents']} parents"
            yield _make_fault("multiple-parents", link, mark, problem, problem.message, link.place)


def _find_duplicates(robot: Robot, kind: str, problems: list[Problem]) -> Iterator[Fault]:
    """Find links or joints with the same name; of links, only the first, which is drawn."""
    by_name: dict[str, list[Problem]] = {}
    for problem in problems:
        by_name.setdefault(problem.name, []).append(problem)
    for name, same in by_name.items():
        joints = [joint for joint in robot.joints if joint.name == name]
        parts: list[Link | Joint] = [robot.link[name]] if kind == "link" else [*joints]
        mark = f"{len(same) + 1} with this name"
        for part in parts:
            place = same[0].element.place
            yield _make_fault(f"duplicate-{kind}-name", part, mark, same[0], same[0].message, place)


_END_MARKS = {
    "missing-parent-or-child": "no {end}",
    "unknown-parent-link": "unknown parent",
    "unknown-child-link": "unknown child",
}


def _find_wrong_ends(rule: str, problem: Problem) -> Iterator[Fault]:
    joint = problem.subject
    if not isinstance(joint, Joint):
        return
    if rule == "joint-to-itself":
        mark, element = "joins a link to itself", None
    else:
        mark = _END_MARKS[rule].format(end=problem.data.get("end"))
        element = joint.parent_element if mark.endswith("parent") else joint.child_element
    place = joint.place if element is None else element.place
    yield _make_fault(rule, joint, mark, problem, problem.message, place)
