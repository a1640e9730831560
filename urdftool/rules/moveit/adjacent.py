"""Rules on adjacent links that collide in MoveIt."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Joint, Link, Robot
from ...model.semantic import read_semantic
from ...source.description import Description
from ...source.document import Document, Element
from ..collision.convex_bodies import get_convex_bodies
from ..collision.exact_contact import find_contact
from ..collision.overlap import has_mesh
from ..fix import FixContext, Proposal, append_child, escape_attribute, insert_after, unsafe
from ..rule import INFO, UNSAFE, WARNING, Problem, rule
from .semantic import get_srdf_documents


@rule(
    WARNING,
    on=("moveit",),
    effects={
        "moveit": "reports the start state in collision",
    },
)
def adjacent_pair_not_disabled(robot: Robot, description: Description) -> Iterator[Problem]:
    """Two adjacent links overlap, and the SRDF does not disable their collision.

    Links that share a joint often overlap there. MoveIt checks each pair without
    ``<disable_collisions>``, reports the start state in collision, and plans nothing. MoveIt
    compares the triangles of meshes, so links whose convex hulls overlap while their surfaces are
    apart are not reported. If a mesh cannot be read as triangles, or has too many, the overlap of
    the hulls is an info. A pair that the SRDF disables under names with a prefix that the robot
    does not have is ``srdf-unknown-link``.
    """
    for document in get_srdf_documents(robot, description):
        content = read_semantic(document.root)
        disabled = {pair.links for pair in content.list_disabled(robot.link)}
        unknown = [pair for pair in disabled if not pair <= robot.link.keys()]
        known = get_convex_bodies(robot)

        def may_touch(one: Link, other: Link) -> bool:
            return find_contact(robot, one, other) is not False

        for joint in robot.joints:
            one, other = (known.body_of.get(n, n) for n in (joint.parent, joint.child))
            if one == other or one not in known.bodies or other not in known.bodies:
                continue
            deepest = known.find_deepest_overlap(other, one, counts=may_touch)
            if deepest is None:
                continue
            link, above, _ = deepest
            ends = (link.name, above.name)
            if frozenset(ends) not in disabled and not _is_prefixed(ends, unknown):
                yield _report_pair(robot, document, joint, above, link)


def _is_prefixed(ends: tuple[str, str], unknown: list[frozenset[str]]) -> bool:
    """Tell whether a pair of links is disabled under names with another beginning."""
    return any(all(any(name.endswith(end) for name in pair) for end in ends) for pair in unknown)


def _report_pair(
    robot: Robot, document: Document, joint: Joint, above: Link, link: Link
) -> Problem:
    """Report two links at a joint that overlap; those of unknown surfaces by their hulls."""
    known = not (has_mesh(above) or has_mesh(link)) or find_contact(robot, above, link)
    what = "links" if known else "the convex hulls of links"
    but = "" if known else ", whose triangles were not compared as MoveIt does,"
    return Problem(
        joint,
        f"{what} '{above.name}' and '{link.name}'{but} overlap at joint '{joint.name}', but the "
        f"SRDF does not disable their collision; write <disable_collisions "
        f'link1="{above.name}" link2="{link.name}" reason="Adjacent"/>'
        f"{'' if known else ' if the links touch'}",
        at=document.root,
        severity=None if known else INFO,
        effects=None if known else (),
        data={"links": [above.name, link.name]},
    )


@adjacent_pair_not_disabled.fix(UNSAFE)
def disable_collision(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the pair after the existing ones; MoveIt then no longer checks it."""
    root = problem.at
    if not isinstance(root, Element):
        return None
    above, below = map(escape_attribute, problem.data["links"])
    line = f'<disable_collisions link1="{above}" link2="{below}" reason="Adjacent"/>'
    pairs = list(root.list_children("disable_collisions"))
    change = insert_after(pairs[-1], line) if pairs else append_child(root, line)
    return unsafe("disable their collision", change)
