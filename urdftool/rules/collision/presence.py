"""Links that nothing can touch."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.bounds import size_of
from ...model.elements import Link, Mesh, Robot
from ..gazebo.contact import axis_up
from ..rule import INFO, WARNING, Problem, rule
from ..xml.vocabulary_table import misspelt_children

_FRAME = re.compile(r"optical|(^|_)frame$")
_CONTACT = re.compile(r"wheel|caster|(^|_)(foot|feet)(_|\d|$)", re.IGNORECASE)
_MARKER = 0.1  # [m] a marker of a frame is no larger


@rule(
    INFO,
    raised=dict.fromkeys(("gazebo-classic", "gz", "mujoco", "pybullet", "moveit"), WARNING),
    effects={
        "gazebo, pybullet": "it falls through the floor and is passed through",
        "moveit": "plans straight through it",
        "mujoco": "the body has no geom at all: visuals of a URDF are discarded",
    },
)
def missing_collision(
    robot: Robot, *, smallest: float = 0.01, small: float = 0.03
) -> Iterator[Problem]:
    """A link is seen but has no collision.

    What has no collision is a ghost: it falls through the floor, hands close on nothing, planners
    move the arm through it, and lasers that look at collision shapes see nothing. Primitives are
    best; a copy of the visual mesh is better than nothing. A link that is meant to be so (a
    sticker, a motor inside a housing) says it with a comment,
    ``urdftool-ignore[missing-collision]``.

    Links smaller than ``smallest`` [m] and markers of frames are left out, and those smaller than
    ``small`` [m] are no more than info.
    """
    seen = [link for link in robot.links if _seen_size(link) >= smallest]
    ghosts = [link for link in seen if not link.collisions]
    sizes = _sizes(robot, ghosts)
    for link in ghosts:
        if sizes[link.name] < smallest or "collision" in misspelt_children(link.element).values():
            continue
        yield Problem(
            link,
            f"link '{link.name}' has a visual and no collision; "
            "add a <collision>, best with a primitive shape",
            severity=INFO if sizes[link.name] < small else None,
        )


@rule(
    WARNING,
    on=("gazebo-classic", "gz", "pybullet"),
    effects={"gazebo, pybullet": "it sinks through the ground and takes the robot with it"},
)
def massive_link_without_collision(robot: Robot, *, lightest: float = 0.1) -> Iterator[Problem]:
    """A heavy wheel or foot has neither visual nor collision.

    The robot stands on it, and nothing is there to stand on: the body drops until the next shape
    meets the ground. A wheel that is seen and does not collide is a case of ``missing-collision``;
    this one cannot even be seen to be missing. ``lightest`` [kg] is the mass from which it
    matters.
    """
    for link in robot.links:
        if link.collisions or link.mass < lightest or _seen_size(link) >= 0.01:
            continue
        joint = robot.tree.parent_joint(link.name)
        if joint is None or any(not below.is_fixed for below in robot.tree.child_joints(link.name)):
            continue
        if any(_shapes_below(robot, link)):
            continue
        level = joint.type == "continuous" and abs(axis_up(robot, link, joint)) < 0.5
        if level or (_CONTACT.search(link.name) and not joint.is_fixed):
            yield Problem(
                link,
                f"link '{link.name}' weighs {link.mass:g} kg, turns on '{joint.name}' and has "
                "nothing to touch the ground with; add a <collision>",
            )


def _seen_size(link: Link) -> float:
    """The largest length of what a link shows [m]; 1 for a mesh, 0 for the marker of a frame."""
    largest = 0.0
    for visual in link.visuals:
        if visual.geometry is not None:
            size = size_of(visual.geometry)
            largest = max(largest, 1.0 if size is None else max(size))
    return 0.0 if _FRAME.search(link.name) and largest <= _MARKER else largest


def _sizes(robot: Robot, links: list[Link]) -> dict[str, float]:
    """What links show, by their names, with meshes measured as far as that is cheap [m]."""
    sizes = {link.name: _seen_size(link) for link in links}
    with_mesh = {
        link.name
        for link in links
        if len(link.visuals) == 1 and isinstance(link.visuals[0].geometry, Mesh)
    }
    if with_mesh and robot.source is not None:
        from ..mesh.scale import rough_size
        from ..mesh.uses import mesh_uses

        for use in mesh_uses(robot, robot.source):
            if use.link.name in with_mesh:
                size = rough_size(use)
                sizes[use.link.name] = 1.0 if size is None else size
    return sizes


def _shapes_below(robot: Robot, link: Link) -> Iterator[bool]:
    """Whether there are shapes in the links below one."""
    for name in robot.tree.descendants(link.name):
        below = robot.link.get(name)
        yield below is not None and bool(below.collisions or below.visuals)
