"""The ``<mujoco>`` element of a URDF: what of it speaks of the model is taken over."""

from __future__ import annotations

from lxml import etree

from ...finding import Severity
from ...model.elements import Robot
from ...source.document import Element
from ..written import Written

OURS = frozenset(
    ("angle", "meshdir", "texturedir", "assetdir", "strippath", "discardvisual", "fusestatic",
     "balanceinertia", "inertiafromgeom", "inertiagrouprange", "eulerseq", "coordinate",
     "autolimits", "boundmass", "boundinertia", "settotalmass", "convexhull")
)  # fmt: skip
"""Attributes of ``<compiler>`` about reading URDF, or that would change the robot."""

SECTIONS = ("option", "size", "visual", "statistic")


def apply_extension(robot: Robot, sections: dict[str, etree._Element], written: Written) -> None:
    """Take over ``<compiler>``, ``<option>`` and what else is known, into sections by name."""
    for extension in robot.element.all("mujoco"):
        for child in extension.children:
            if child.tag == "compiler":
                _compiler(child, sections, written)
            elif child.tag in SECTIONS:
                target = sections.setdefault(child.tag, etree.Element(child.tag))
                _merge(child, target)
            else:
                written.lose(
                    "mujoco",
                    f"<{child.tag}> in <mujoco> is not carried; of it there are compiler, "
                    + ", ".join(SECTIONS),
                    child.place,
                    kind="mujoco",
                    name=child.tag,
                )


def _compiler(element: Element, sections: dict[str, etree._Element], written: Written) -> None:
    for name, value in element.attributes.items():
        if name not in OURS:
            sections["compiler"].set(name, value)
            continue
        changes = name in ("balanceinertia", "boundmass", "boundinertia", "settotalmass")
        written.lose(
            "mujoco",
            f"{name}={value!r} of <compiler> is not carried: it "
            + ("would change the robot" if changes else "speaks of how MuJoCo reads URDF"),
            element.attribute_place(name),
            kind="mujoco",
            name=name,
            severity=Severity.WARNING if changes and value != "false" else Severity.INFO,
        )


def _merge(element: Element, target: etree._Element) -> None:
    for name, value in element.attributes.items():
        target.set(name, value)
    for child in element.children:
        found = target.find(child.tag)
        _merge(child, etree.SubElement(target, child.tag) if found is None else found)
