"""Settings that are old, or that one Gazebo does not read."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ...source.document import Element
from ..rule import GAZEBO, WARNING, Problem, rule
from ..words import quoted
from .keywords import NOT_IN_GZ


@rule(WARNING, on=GAZEBO, effects={"gazebo": "warns, and takes it for implicitSpringDamper"})
def deprecated_cfm_damping(robot: Robot) -> Iterator[Problem]:
    """``cfmDamping`` is the old name of ``implicitSpringDamper``.

    It still works, with a warning at every start.
    """
    for block in robot.gazebo:
        for child in block.element.all("cfmDamping"):
            yield Problem(
                block.element, "cfmDamping is now called implicitSpringDamper; write that", at=child
            )


@rule(
    WARNING,
    on=("gz",),
    effects={"gz": "reads nothing of it", "gazebo-classic": "takes it"},
)
def no_effect_in_gz(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A setting of Gazebo Classic does nothing in new Gazebo.

    Contact stiffness and damping, contact counts, stops and feedback are ODE's; they are carried
    into the SDF, and neither gz-sim nor its physics engines read them. Friction (mu1, mu2, fdir1)
    is read. A robot that is for Gazebo Classic as well needs them and is not told.
    """
    if "gazebo-classic" in targets:
        return
    found: dict[str, list[tuple[Element, Element]]] = {}
    for block in robot.gazebo:
        for child in block.element.children:
            if block.reference and child.tag in NOT_IN_GZ:
                found.setdefault(child.tag, []).append((block.element, child))
    if found:
        block_, first = next(iter(found.values()))[0]
        words = quoted(found, 6).replace("'", "")
        count = sum(map(len, found.values()))
        times = f" ({count} times)" if count > 1 else ""
        do = "do" if len(found) > 1 else "does"
        yield Problem(block_, f"{words} {do} nothing in new Gazebo{times}; take it away", at=first)
