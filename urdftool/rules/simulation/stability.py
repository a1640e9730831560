"""Check properties that make a simulation unstable."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ..inertia.solids import is_helper
from ..rule import ANY_FORMAT, INFO, WARNING, Problem, rule


@rule(
    INFO,
    on=("gazebo-classic",),
    effects={
        "gazebo-classic": "solves joints iteratively, by default 50 times; this one may give way",
    },
    default=False,
    formats=ANY_FORMAT,
)
def mass_ratio(robot: Robot, *, high: float = 100.0, extreme: float = 1000.0) -> Iterator[Problem]:
    """A joint carries a body that is much heavier than the body above it.

    ODE, the engine of Gazebo Classic, solves joints iteratively and converges slowly for a light
    body between heavy ones: the joint stretches, shakes or breaks. From ``high`` on it is an
    info, from ``extreme`` on a warning. The ratio is the mass below the joint divided by that of
    the body just above it; links on fixed joints count as one body. Light bodies without geometry,
    or with tiny shapes on links named fake or dummy, are skipped, because they are parts of a joint
    with several axes. New Gazebo, MuJoCo and
    PyBullet compute a tree of joints exactly.
    """
    bodies = robot.tree.body_links
    mass = {
        name: sum(robot.link[link].mass for link in links if link in robot.link)
        for name, links in bodies.items()
    }
    below = _compute_masses_below(robot, mass)
    for joint in robot.moving_joints:
        above, under = robot.tree.bodies.get(joint.parent), robot.tree.bodies.get(joint.child)
        if above is None or under is None or robot.tree.get_parent_joint(above) is None:
            continue
        links = [robot.link[name] for name in bodies[above]]
        if not any((one.visuals or one.collisions) and not is_helper(one) for one in links):
            continue
        light, heavy = mass[above], below[under]
        if light > 0 and heavy / light > high:
            ratio = heavy / light
            yield Problem(
                joint,
                f"joint '{joint.name}' carries {heavy:.3g} kg on a body of {light:.3g} kg "
                f"({ratio:.0f} times as heavy); if it shakes, raise the iterations of the solver",
                severity=WARNING if ratio > extreme else None,
                data={"carried": heavy, "carrying": light, "ratio": ratio},
            )


def _compute_masses_below(robot: Robot, mass: dict[str, float]) -> dict[str, float]:
    """Compute the mass of each body with all its descendants [kg]."""
    total = dict(mass)
    for name in reversed(robot.tree.order):
        if name not in mass:
            continue
        joint = robot.tree.get_parent_joint(name)
        above = robot.tree.bodies.get(joint.parent) if joint is not None else None
        if above is not None and above != name:
            total[above] += total[name]
    return total
