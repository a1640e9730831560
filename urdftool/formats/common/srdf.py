"""Reading of MoveIt's SRDF: disabled collisions, virtual joint and group states."""

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
    """The parts of an SRDF that the export uses.

    Attributes:
        disabled: Pairs of links that do not collide, in file order.
        virtual_joint: Type of the virtual joint, if there is one.
        path: Path of the file.
        states: Joint positions [rad, m] by group state; states of several groups with the same name
            are merged.
    """

    disabled: list[tuple[str, str]]
    virtual_joint: str | None
    path: Path
    states: dict[str, dict[str, float]] = field(default_factory=dict)


def read_srdf(path: Path, robot: Robot, written: Written, packages: Packages | None) -> Srdf:
    """Read the SRDF of a robot; report and skip pairs with unknown links.

    Raises:
        SourceError: The file cannot be read.
        ModelError: Its root element is not ``<robot>``.
    """
    finder = None if packages is None else packages.make_finder_for(path)
    root = read_description(path, finder=finder).document.root
    if root.tag != "robot":
        raise ModelError(
            f"the root element is <{root.tag}>; an SRDF file starts with <robot>", at=root.place
        )
    disabled = []
    for element in root.list_children("disable_collisions"):
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
    virtual = root.find_child("virtual_joint")
    kind = virtual.get("type") if virtual is not None else None
    return Srdf(disabled, kind, path, _collect_states(root, robot, written))


def _collect_states(root: Element, robot: Robot, written: Written) -> dict[str, dict[str, float]]:
    states: dict[str, dict[str, float]] = {}
    for element in root.list_children("group_state"):
        state = states.setdefault(element.get("name") or "", {})
        for joint in element.list_children("joint"):
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
