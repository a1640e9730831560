"""The facts of an SDF model, as libsdformat prints it."""

from __future__ import annotations

from typing import Any
from xml.etree import ElementTree


def sdf_facts(text: str) -> dict[str, Any]:
    """Links, joints, and the text itself, line by line."""
    try:
        root = ElementTree.fromstring(text.strip() or "<sdf/>")
    except ElementTree.ParseError:
        return {"sdf": text.splitlines()}
    links = {link.get("name", ""): _link(link) for link in root.iter("link")}
    joints = {joint.get("name", ""): _joint(joint) for joint in root.iter("joint")}
    lines = [line for line in text.splitlines() if line.strip()]
    return {"links": links, "joints": joints, "sdf": lines}


def _link(link: ElementTree.Element) -> dict[str, Any]:
    found: dict[str, Any] = {}
    inertial = link.find("inertial")
    if inertial is not None:
        found["mass"] = _number(inertial.findtext("mass"))
        found["pose"] = _numbers(inertial.findtext("pose"))
        tensor = inertial.find("inertia")
        if tensor is not None:
            names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
            found["inertia"] = [_number(tensor.findtext(name)) for name in names]
    for kind in ("visual", "collision"):
        found[f"{kind}s"] = [_shape(shape) for shape in link.findall(kind)]
    for kind in ("sensor", "light", "particle_emitter"):
        if names := [str(each.get("name")) for each in link.findall(kind)]:
            found[f"{kind}s"] = names
    return found


def _shape(shape: ElementTree.Element) -> dict[str, Any]:
    found: dict[str, Any] = {"name": shape.get("name")}
    for kind in shape.findall("geometry/*"):
        found["shape"] = kind.tag
        for value in kind:
            found[value.tag] = value.text if value.tag == "uri" else _numbers(value.text)
    if (pose := shape.findtext("pose")) is not None:
        found["pose"] = _numbers(pose)
    return found


def _joint(joint: ElementTree.Element) -> dict[str, Any]:
    found: dict[str, Any] = {
        "type": joint.get("type"),
        "parent": joint.findtext("parent"),
        "child": joint.findtext("child"),
        "pose": _numbers(joint.findtext("pose")),
    }
    axis = joint.find("axis")
    if axis is not None:
        found["axis"] = _numbers(axis.findtext("xyz"))
        for group in ("limit", "dynamics"):
            for value in axis.findall(f"{group}/*"):
                found[value.tag] = _number(value.text)
        if axis.find("mimic") is not None:
            found["mimic"] = axis.find("mimic").get("joint")  # type: ignore[union-attr]
    return found


def _number(text: str | None) -> float | str | None:
    try:
        return float(text or "")
    except ValueError:
        return text


def _numbers(text: str | None) -> list[float | str | None] | None:
    return None if text is None else [_number(word) for word in text.split()]
