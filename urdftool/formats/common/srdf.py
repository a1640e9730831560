"""Reading of MoveIt's SRDF: disabled collisions, virtual joint and group states."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from ...errors import ModelError
from ...model.elements import Robot
from ...model.semantic import SemanticDescription, read_semantic
from ...source.description import read_description
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
    content = read_semantic(root)
    disabled = []
    for pair in content.list_disabled(robot.link):
        unknown = [name for name in (pair.link1, pair.link2) if name not in robot.link]
        if unknown:
            written.report_loss(
                "srdf",
                f"the SRDF disables a collision of link '{unknown[0]}', which does not exist",
                pair.element.place,
                kind="link",
                name=unknown[0],
            )
        else:
            disabled.append((pair.link1, pair.link2))
    virtual = content.virtual_joints[0].type if content.virtual_joints else None
    return Srdf(disabled, virtual or None, path, _collect_states(content, robot, written))


def _collect_states(
    content: SemanticDescription, robot: Robot, written: Written
) -> dict[str, dict[str, float]]:
    states: dict[str, dict[str, float]] = {}
    for group_state in content.states:
        state = states.setdefault(group_state.name, {})
        for joint in group_state.joints:
            if joint.name not in robot.joint or joint.value is None:
                why = (
                    "which does not exist"
                    if joint.name not in robot.joint
                    else "without one number"
                )
                written.report_loss(
                    "srdf",
                    f"group state '{group_state.name}' of the SRDF has joint '{joint.name}', {why}",
                    joint.element.place,
                    kind="joint",
                    name=joint.name,
                )
            else:
                state[joint.name] = joint.value
    return states
