"""MoveIt's SRDF: which pairs never collide, and how the robot stands in its world."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ...errors import ModelError
from ...model.elements import Robot
from ...source.description import read_description
from ...source.packages import Packages
from ..written import Written


@dataclass(frozen=True)
class Srdf:
    """What is used of an SRDF.

    Attributes:
        disabled: Pairs of links that do not collide, in the order of the file.
        virtual_joint: Type of the joint to the world, if one is written.
        path: The file.
    """

    disabled: list[tuple[str, str]]
    virtual_joint: str | None
    path: Path


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
            written.lose(
                "srdf",
                f"the SRDF disables a collision of link '{unknown[0]}', which does not exist",
                element.place,
                kind="link",
                name=unknown[0],
            )
        else:
            disabled.append((one, other))
    virtual = root.child("virtual_joint")
    return Srdf(disabled, virtual.get("type") if virtual is not None else None, path)
