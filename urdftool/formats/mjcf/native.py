"""Elements that an export of an MJCF copies: tendons, actuators, equalities, sensors and others.

They are copied as written, with the default classes that they use. An element is left out, and
reported, if the export has not what it names.
"""

from __future__ import annotations

from dataclasses import replace

from lxml import etree

from ...diagnostic import Severity
from ...model.elements import Robot
from ...model.mechanism import NativeElement
from ...model.numbers import format_numbers_text, number_text
from ..common.drive_choice import AUTO
from ..common.naming import get_free_name
from ..written import Written
from .copied import has_copied_actuators, has_copied_home, has_copies, list_native
from .options import Options
from .read_native_table import COPIED, KINDS, MERGED, OBJECTS, REFERENCES
from .structure import Structure

Sections = dict[str, etree._Element]

_TAGS = {
    "joint": ("joint", "freejoint"),
    "body": ("body",),
    "site": ("site",),
    "geom": ("geom",),
    "camera": ("camera",),
    "material": ("material",),
    "mesh": ("mesh",),
}
"""Elements of an export by the kind of its references."""


def add_native(
    structure: Structure, options: Options, sections: Sections, written: Written
) -> None:
    """Add the copied elements of a robot to the sections of an export."""
    robot = structure.robot
    if not list_native(robot):
        return
    names = _collect_names(sections)
    for element in robot.native:
        if not element.section:
            _set_attributes(element, sections, written)
        elif element.section in MERGED:
            _merge(element, _get_section(sections, element.section))
    classes = _add_classes(robot, sections["default"])
    kept: list[NativeElement] = []  # actuators that are copied
    for tag in COPIED:
        if tag in MERGED or (tag == "actuator" and options.actuators not in AUTO):
            continue
        if tag == "keyframe" and not _has_same_positions(structure, written):
            continue
        copied = [element for element in robot.native if element.section == tag]
        if tag == "keyframe":
            copied = _fit_keys(robot, options, copied, kept, written)
        done = _copy_section(copied, tag, sections, names, classes, written)
        kept = done if tag == "actuator" else kept
    if has_copied_actuators(robot, options) and not has_copied_home(robot, options):
        _set_controls(structure, kept, sections)


def _fit_keys(
    robot: Robot,
    options: Options,
    keys: list[NativeElement],
    kept: list[NativeElement],
    written: Written,
) -> list[NativeElement]:
    """Return the keys to copy, with the controls of the actuators that the export has.

    Args:
        robot: The robot with the choices of the export.
        options: Options of the export.
        keys: Keys of the source.
        kept: Actuators of the source that the export has.
        written: Receives the controls that are not copied.
    """
    if not has_copied_home(robot, options):
        keys = [key for key in keys if key.name != "home"]
    actuators = [element for element in robot.native if element.section == "actuator"]
    if len(kept) == len(actuators) and not (robot.joint_actuators and not actuators):
        return keys
    fitted = []
    for key in keys:
        lost = [name for name in ("ctrl", "act") if name in key.attributes]
        attributes = {name: v for name, v in key.attributes.items() if name not in lost}
        if lost:
            why = f"{' and '.join(lost)} changed: the export has other actuators"
            _report(key, why, written)
        controls = key.attributes.get("ctrl", "").split()
        if not has_copied_actuators(robot, options):
            held = next((c.positions for c in robot.configurations if c.place == key.place), {})
            controls = [
                number_text(held.get(one.joint, 0.0) if one.mode == "position" else 0.0)
                for one in robot.joint_actuators
            ]
        elif controls:
            places = {id(one) for one in kept}
            controls = [
                text for text, one in zip(controls, actuators, strict=False) if id(one) in places
            ]
        if controls:
            attributes["ctrl"] = " ".join(controls)
        fitted.append(replace(key, attributes=attributes))
    return fitted


def _set_controls(structure: Structure, kept: list[NativeElement], sections: Sections) -> None:
    """Write the controls of the export's own key for the copied actuators."""
    robot = structure.robot
    of = {str(actuator.place): actuator.joint for actuator in robot.joint_actuators
          if actuator.mode == "position"}  # fmt: skip
    (home,) = (one.positions for one in robot.configurations if one.name == "home")
    controls = [home.get(of.get(str(element.place), ""), 0.0) for element in kept]
    for key in sections["keyframe"]:
        if key.get("name") == "home":
            key.set("ctrl", format_numbers_text(controls))


def _collect_names(sections: Sections) -> dict[str, set[str]]:
    """Return the names of the elements of an export by kind."""
    names: dict[str, set[str]] = {kind: set() for kind in REFERENCES}
    for kind, tags in _TAGS.items():
        for section in (sections["worldbody"], sections["asset"]):
            names[kind] |= {e.get("name", "") for e in section.iter(*tags) if e.get("name")}
    names["body"].add("world")
    return names


def _set_attributes(element: NativeElement, sections: Sections, written: Written) -> None:
    """Set the attributes of a part of the export."""
    tags = ("joint", "freejoint") if element.tag == "joint" else (element.tag,)
    for section in (sections["worldbody"], sections["asset"]):
        for found in section.iter(*tags):
            if found.get("name") == element.name:
                for name, value in element.attributes.items():
                    if name == "mocap" and found.getparent() is not sections["worldbody"]:
                        _report(element, "mocap is not copied: its parent has a body", written)
                    else:
                        found.set(name, value)
                return
    names = ", ".join(name for name in element.attributes if name != "name")
    _report(element, f"{names} is not copied: the export has no such <{element.tag}>", written)


def _report(element: NativeElement, why: str, written: Written) -> None:
    title = f"<{element.tag}>" + (f" '{element.name}'" if element.name else "")
    written.report_loss(
        "mujoco-element",
        f"{title}: {why}",
        element.place,
        kind="mujoco",
        name=element.name,
        severity=Severity.WARNING if element.section in KINDS else Severity.INFO,
    )


def _get_section(sections: Sections, tag: str) -> etree._Element:
    return sections.setdefault(tag, etree.Element(tag))


def _merge(element: NativeElement, target: etree._Element) -> None:
    """Add the attributes and children that a section lacks."""
    for name, value in element.attributes.items():
        if name not in target.attrib:
            target.set(name, value)
    for child in element.children:
        found = target.find(child.tag)
        _merge(child, etree.SubElement(target, child.tag) if found is None else found)


def _add_classes(robot: Robot, section: etree._Element) -> dict[str, str]:
    """Add the default classes of copied elements; return the new name of each.

    The settings of all elements are a class, as the export's own elements do not have them.
    """
    taken = {str(one.get("class")) for one in section.iter("default")}
    classes: dict[str, str] = {}
    for element in robot.native:
        if element.section == "default":
            _add_class(element, section, taken, classes)
    return classes


def _add_class(
    element: NativeElement, parent: etree._Element, taken: set[str], classes: dict[str, str]
) -> None:
    old = element.attributes.get("class", "")
    old = "" if old == "main" else old
    new = classes[old] = get_free_name(old or "source", taken)
    taken.add(new)
    made = etree.SubElement(parent, "default", {"class": new})
    for child in element.children:
        if child.tag == "default":
            _add_class(child, made, taken, classes)
        else:
            made.append(_build(child))


def _build(element: NativeElement) -> etree._Element:
    made = etree.Element(element.tag, element.attributes)
    made.extend(_build(child) for child in element.children)
    return made


def _copy_section(
    copied: list[NativeElement],
    tag: str,
    sections: Sections,
    names: dict[str, set[str]],
    classes: dict[str, str],
    written: Written,
) -> list[NativeElement]:
    """Copy the elements of a section; those that the export built stay if they are others.

    Returns:
        The elements that are copied.
    """
    if not copied:
        return []
    done: list[NativeElement] = []
    section, kind = _get_section(sections, tag), tag if tag in REFERENCES else ""
    built = [e for e in section if not _is_copy(e, tag, copied)]
    section[:] = built if tag in ("contact", "custom") else []
    for element in copied:
        missing = _find_missing(element, names)
        if missing:
            text = f"it is not copied: the model of the robot has no {missing}"
            lost = ", which is scenery; the contacts of the pair are lost"
            _report(element, text + (lost if element.tag == "pair" else ""), written)
            continue
        made = _build(element)
        _set_class(made, tag, classes)
        section.append(made)
        done.append(element)
        names.setdefault(kind, set()).add(element.name)
    if tag not in ("contact", "custom"):
        section.extend(built)
    return done


def _is_copy(built: etree._Element, tag: str, copied: list[NativeElement]) -> bool:
    """Tell whether an element of the export stands for one that is copied."""
    if tag == "actuator":
        return True
    if tag == "equality":
        held = {e.attributes.get("joint1") for e in copied if e.tag == "joint"}
        return built.tag != "joint" or built.get("joint1") in held
    names = {element.name for element in copied}
    return tag != "contact" and (not built.get("name") or built.get("name") in names)


def _set_class(made: etree._Element, tag: str, classes: dict[str, str]) -> None:
    if tag not in ("tendon", "actuator", "equality", "contact"):
        return
    new = classes.get(made.get("class", ""), classes.get(""))
    if new is not None:
        made.set("class", new)
    elif "class" in made.attrib:
        del made.attrib["class"]


def _find_missing(element: NativeElement, names: dict[str, set[str]]) -> str:
    """Return what an element names and the export lacks; empty if it has all."""
    of = {attribute: kind for kind, found in REFERENCES.items() for attribute in found}
    for attribute, value in element.attributes.items():
        kind = of.get(attribute, "")
        if attribute in OBJECTS:
            kind = element.attributes.get(OBJECTS[attribute], "").replace("xbody", "body")
        if kind and value not in names.get(kind, ()) and element.tag not in ("numeric", "text"):
            return f"{kind} '{value}'"
    return next((m for child in element.children if (m := _find_missing(child, names))), "")


def _has_same_positions(structure: Structure, written: Written) -> bool:
    """Tell whether the export has the positions of the source's keyframes, in their order."""
    robot = structure.robot
    if not has_copies(robot, "keyframe"):
        return False
    source = [joint.name for joint in robot.joints if structure.get_kind(joint) != "weld"]
    fixed = [j for j in robot.joints if not j.is_fixed and structure.get_kind(j) == "weld"]
    if [joint.name for joint in structure.moving] == source and not fixed:
        return True
    element = next(e for e in robot.native if e.section == "keyframe")
    _report(element, "keyframes are not copied: the export has other joints", written)
    return False
