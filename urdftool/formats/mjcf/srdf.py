"""MoveIt's SRDF: which pairs never collide, and how the robot stands in its world."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from ...errors import ModelError
from ...model.elements import Robot
from ...model.read import number
from ...source.description import read_description
from ...source.document import Element
from ...source.packages import Packages
from ..written import Written


@dataclass(frozen=True)
class Srdf:
    """What is used of an SRDF.

    Attributes:
        disabled: Pairs of links that do not collide, in the order of the file.
        virtual_joint: Type of the joint to the world, if one is written.
        path: The file.
        states: Positions by joint [rad, m] of each group state; groups whose states have the same
            name are one.
    """

    disabled: list[tuple[str, str]]
    virtual_joint: str | None
    path: Path
    states: dict[str, dict[str, float]] = field(default_factory=dict)


def read_srdf(path: Path, robot: Robot, written: Written, packages: Packages | None) -> Srdf:
    """An SRDF of a robot; pairs with links it does not have are said and left out.

    Raises:
        SourceError: It cannot be read.
        ModelError: Its root element is not ``<robot>``.
    """
    named = packages.named if packages is not None else {}
    paths = packages.paths if packages is not None else []
    root = read_description(path, packages=named, package_paths=paths).document.root
    if root.tag != "robot":
        raise ModelError(
            f"the root element is <{root.tag}>; an SRDF file starts with <robot>", at=root.place
        )
    disabled = []
    for element in root.all("disable_collisions"):
        one, other = element.get("link1") or "", element.get("link2") or ""
        unknown = [name for name in (one, other) if name not in robot.link]
        if unknown:
            written.report_loss(
                "srdf",
                f"the SRDF disables a collision of link '{unknown[0]}', which does not exist",
                element.place,
                kind="link",
                name=unknown[0],
            )
        else:
            disabled.append((one, other))
    virtual = root.child("virtual_joint")
    kind = virtual.get("type") if virtual is not None else None
    return Srdf(disabled, kind, path, _states(root, robot, written))


def _states(root: Element, robot: Robot, written: Written) -> dict[str, dict[str, float]]:
    states: dict[str, dict[str, float]] = {}
    for element in root.all("group_state"):
        state = states.setdefault(element.get("name") or "", {})
        for joint in element.all("joint"):
            name, value = joint.get("name") or "", number(joint.get("value"))
            if name not in robot.joint or value is None:
                why = "which does not exist" if name not in robot.joint else "without one number"
                written.report_loss(
                    "srdf",
                    f"group state '{element.get('name') or ''}' of the SRDF has joint '{name}', "
                    f"{why}",
                    joint.place,
                    kind="joint",
                    name=name,
                )
            else:
                state[name] = value
    return states
