"""Changes of a URDF."""

from __future__ import annotations

import random
from collections.abc import Iterator

from .changes import (
    DEGREE,
    MASSLESS,
    SIX,
    SMALLEST,
    Change,
    Edit,
    Node,
    change_tensor,
    get_six,
    list_other_meshes,
    make_tensor,
    negate,
    numbers,
    remove,
    scale,
    set_to,
    shift,
    tilt,
)

_KEYS = {"box": "size", "cylinder": "radius", "sphere": "radius"}


def list_urdf(root: Node, generator: random.Random) -> Iterator[Change]:
    """Yield the changes of a URDF."""
    joints = {joint.find("child").get("link"): joint for joint in root.findall("joint")}
    links = {link.get("name"): link for link in root.findall("link")}
    top = next(name for name in links if name not in joints)
    for joint in joints.values():
        if not _carries_all(joint, top, joints, links):
            yield from _list_joint(joint, joints, generator)
    parents = {joint.find("parent").get("link") for joint in joints.values()}
    for name, link in links.items():
        joint = joints.get(name)
        yield from _list_inertial(link.find("inertial"), {name}, generator)
        yield from _list_shapes(link, generator)
        if joint is not None and name not in parents and not root.xpath(
            "//mimic[@joint=$name]", name=joint.get("name")
        ):  # fmt: skip
            if joint.get("type") != "fixed" or _has_content(link):
                names = {name, joint.get("name")}
                yield Change("link removed", link, _remove_link(name), names)


def _has_content(link: Node) -> bool:
    mass = link.find("inertial/mass")
    has_mass = mass is not None and float(mass.get("value")) > MASSLESS
    return has_mass or any(link.find(tag) is not None for tag in ("visual", "collision"))


def _carries_all(joint: Node, top: str, joints: dict[str, Node], links: dict[str, Node]) -> bool:
    """Tell whether a fixed joint only places the whole robot."""
    children = [j for j in joints.values() if j.find("parent").get("link") == top]
    fixed = joint.get("type") in ("fixed", "floating")
    return fixed and children == [joint] and not _has_content(links[top])


def _remove_link(name: str) -> Edit:
    def edit(node: Node) -> None:
        root = node.getparent()
        for joint in root.findall("joint"):
            if joint.find("child").get("link") == name:
                remove(joint)
        remove(node)

    return edit


def _ensure(tag: str, key: str, value: str, **others: str) -> Edit:
    """Return an edit that sets an attribute of a child, which is added if it does not exist."""

    def edit(node: Node) -> None:
        child = node.find(tag)
        if child is None:
            child = node.makeelement(tag, others)
            node.append(child)
        child.set(key, value)

    return edit


def _list_joint(joint: Node, joints: dict[str, Node], generator: random.Random) -> Iterator[Change]:
    names = {joint.get("name"), joint.find("child").get("link")}
    origin, kind = joint.find("origin"), joint.get("type")
    xyz, rpy = (None if origin is None else origin.get(key) for key in ("xyz", "rpy"))
    index = generator.randrange(3)
    prefix = "fixed joint" if kind == "fixed" else "origin"
    if kind == "floating":
        return
    yield Change(
        f"{prefix} by 1 mm", joint, _ensure("origin", "xyz", shift(xyz, index, 0.001)), names
    )
    yield Change(
        f"{prefix} by 1°", joint, _ensure("origin", "rpy", shift(rpy, index, DEGREE)), names
    )
    if kind not in ("revolute", "continuous", "prismatic"):
        return
    limit, axis = joint.find("limit"), joint.find("axis")
    get = {} if limit is None else limit.attrib
    low, high = (float(get.get(key, "0")) for key in ("lower", "upper"))
    if low == high and kind != "continuous":
        return  # locked
    text = "1 0 0" if axis is None else axis.get("xyz", "1 0 0")
    yield Change("axis reversed", joint, _ensure("axis", "xyz", negate(text)), names)
    yield Change("axis by 1°", joint, _ensure("axis", "xyz", tilt(text)), names)
    if kind != "continuous" and max(abs(low), abs(high)) < 1e9:
        yield Change("upper limit", limit, set_to("upper", repr(high + 0.05)), names)
        yield Change("lower limit", limit, set_to("lower", repr(low - 0.05)), names)
        if kind == "revolute":
            yield Change("limits lost", joint, set_to("type", "continuous"), names)
    for key in ("effort", "velocity"):
        if 1e-3 < float(get.get(key, "0")) < 1e8:
            yield Change(f"{key} by 10 %", limit, set_to(key, scale(get[key], 1.1)), names)
    dynamics = joint.find("dynamics")
    for key in ("damping", "friction"):
        value = 0.0 if dynamics is None else float(dynamics.get(key, "0"))
        edit = _ensure("dynamics", key, repr(value * 1.1 if value > 1e-3 else value + 0.1))
        yield Change(key, joint, edit, names)
    if kind == "revolute" and limit is not None:
        yield Change("slide for a hinge", joint, set_to("type", "prismatic"), names)
    yield Change("joint fixed", joint, _fix, names)
    mimic = joint.find("mimic")
    if mimic is not None:
        value = scale(mimic.get("multiplier"), 1.1, "1")
        yield Change("mimic by 10 %", mimic, set_to("multiplier", value), names)
        yield Change("mimic lost", mimic, remove, names)
    parent = joints.get(joint.find("parent").get("link"))
    if parent is not None and parent.get("type") in ("revolute", "continuous", "prismatic"):
        value = parent.find("parent").get("link")
        yield Change("another parent", joint.find("parent"), set_to("link", value), names)


def _fix(joint: Node) -> None:
    name, root = joint.get("name"), joint.getparent()
    joint.set("type", "fixed")
    for mimic in root.xpath("//mimic"):
        if mimic.get("joint") == name or mimic.getparent() is joint:
            remove(mimic)


def _list_inertial(
    inertial: Node | None, names: set[str], generator: random.Random
) -> Iterator[Change]:
    mass = None if inertial is None else inertial.find("mass")
    if mass is None or float(mass.get("value")) <= MASSLESS:
        return
    yield Change("mass by 1 %", mass, set_to("value", scale(mass.get("value"), 1.01)), names)
    origin = inertial.find("origin")
    xyz = None if origin is None else origin.get("xyz")
    value = shift(xyz, generator.randrange(3), 0.001)
    yield Change("center of mass by 1 mm", inertial, _ensure("origin", "xyz", value), names)
    tensor = inertial.find("inertia")
    six = [float(tensor.get(key)) for key in SIX]
    for kind, new in change_tensor(make_tensor(six)):
        yield Change(kind, tensor, _set_six(get_six(new)), names)


def _set_six(six: list[float]) -> Edit:
    def edit(node: Node) -> None:
        for key, value in zip(SIX, six, strict=True):
            node.set(key, repr(value))

    return edit


def _list_shapes(link: Node, generator: random.Random) -> Iterator[Change]:
    names, root = {link.get("name")}, link.getroottree()
    for kind in ("collision", "visual"):
        for shape in link.findall(kind):
            (geometry,) = shape.find("geometry")
            if geometry.tag not in (*_KEYS, "mesh"):
                continue
            yield Change(f"{kind} lost", shape, remove, names)
            origin = shape.find("origin")
            xyz = None if origin is None else origin.get("xyz")
            value = shift(xyz, generator.randrange(3), 0.001)
            yield Change(f"{kind} by 1 mm", shape, _ensure("origin", "xyz", value), names)
            if geometry.tag == "mesh":
                value = scale(geometry.get("scale"), 1.01, "1 1 1")
                yield Change("scale of a mesh by 1 %", geometry, set_to("scale", value), names)
                own = geometry.get("filename")
                files = {name: name for m in root.iter("mesh") if (name := m.get("filename"))}
                if others := list_other_meshes(link, own, files):
                    edit = set_to("filename", generator.choice(others))
                    yield Change("another mesh", geometry, edit, names)
                continue
            key = _KEYS[geometry.tag]
            if numbers(geometry.get(key))[0] * 0.01 > SMALLEST:
                value = scale(geometry.get(key), 1.01)
                yield Change(f"size of a {kind} by 1 %", geometry, set_to(key, value), names)
