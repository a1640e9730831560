"""Robots built from parts, without a file."""

from urdftool.model.elements import (
    Axis,
    Collision,
    Inertia,
    Inertial,
    Joint,
    Limit,
    Link,
    Origin,
    Robot,
)


def link(name, *shapes, mass=None):
    """A link with collision shapes, and a unit tensor if it has a mass."""
    inertial = None if mass is None else Inertial(None, None, mass, Inertia(None, 1, 0, 0, 1, 0, 1))
    return Link(None, name, inertial, [], [Collision(geometry=shape) for shape in shapes])


def joint(name, parent, child, type="revolute", xyz=(0, 0, 0), axis=(0, 0, 1), **parts):
    """A joint; a revolute or prismatic one moves within ±1."""
    if type in ("revolute", "prismatic"):
        parts.setdefault("limit", Limit(None, -1.0, 1.0))
    return Joint(
        name=name,
        type=type,
        parent=parent,
        child=child,
        origin=Origin(None, xyz),
        axis=Axis(None, axis),
        **parts,
    )


def robot(links=("base",), joints=(), **parts):
    """A robot; a link may be given by its name."""
    made = [link(one) if isinstance(one, str) else one for one in links]
    return Robot(name="made", links=made, joints=list(joints), **parts)


def arm(count, length=1.0, **parts):
    """A chain of revolute joints ``j1`` … about z between ``link0`` …, each at x = ``length``."""
    links = [link(f"link{i}", mass=1.0) for i in range(count + 1)]
    joints = [
        joint(f"j{i}", f"link{i - 1}", f"link{i}", xyz=(length, 0, 0)) for i in range(1, count + 1)
    ]
    return robot(links, joints, **parts)
