"""The ``<mujoco>`` element of a URDF: its model options are copied to the export."""

from __future__ import annotations

from lxml import etree

from ...diagnostic import Severity
from ...model.elements import Robot
from ...model.mujoco_values import READER_SETTINGS, SECTIONS, describe_required_setting
from ...source.document import Element
from ..written import Written


def apply_extension(robot: Robot, sections: dict[str, etree._Element], written: Written) -> None:
    """Copy ``<compiler>``, ``<option>`` and other known elements to the sections, by name."""
    for extension in () if robot.xml is None else robot.xml.list_children("mujoco"):
        for child in extension.children:
            if child.tag == "compiler":
                _add_compiler(child, sections, written)
            elif child.tag in SECTIONS:
                target = sections.setdefault(child.tag, etree.Element(child.tag))
                _merge(child, target)
            else:
                written.report_loss(
                    "mujoco",
                    f"<{child.tag}> in <mujoco> is not exported; only compiler, "
                    + ", ".join(SECTIONS),
                    child.place,
                    kind="mujoco",
                    name=child.tag,
                )


def _add_compiler(element: Element, sections: dict[str, etree._Element], written: Written) -> None:
    for name, value in element.attributes.items():
        if name not in READER_SETTINGS:
            if not describe_required_setting(element, name):
                sections["compiler"].set(name, value)
            continue
        changes = name in ("balanceinertia", "boundmass", "boundinertia", "settotalmass")
        written.report_loss(
            "mujoco",
            f"{name}={value!r} of <compiler> is not exported: it "
            + ("changes the robot" if changes else "controls how MuJoCo reads URDF"),
            element.locate_attribute(name),
            kind="mujoco",
            name=name,
            severity=Severity.WARNING if changes and value != "false" else Severity.INFO,
        )


def _merge(element: Element, target: etree._Element) -> None:
    for name, value in element.attributes.items():
        if not describe_required_setting(element, name):
            target.set(name, value)
    for child in element.children:
        found = target.find(child.tag)
        _merge(child, etree.SubElement(target, child.tag) if found is None else found)
