"""Changes of an MJCF."""

from __future__ import annotations

import random
from collections.abc import Iterator

import numpy as np

from .changes import (
    DEGREE,
    MASSLESS,
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

_JOINT = {"axis": "0 0 1", "type": "hinge", "damping": "0", "frictionloss": "0"}


def list_mjcf(root: Node, generator: random.Random) -> Iterator[Change]:
    """Yield the changes of an MJCF."""
    for body in root.find("worldbody").iter("body"):
        joints = body.findall("joint")
        names = {body.get("name"), *(joint.get("name") for joint in joints)}
        if body.getparent().tag == "body":
            yield from _list_place(body, names, generator)
        yield from _list_inertial(body.find("inertial"), {body.get("name")}, generator)
        for joint in joints:
            yield from _list_joint(joint, {joint.get("name"), body.get("name")})
        yield from _list_geoms(body, generator)
        parent = body.getparent()  # a moving body without mass needs its child
        is_leaf = body.find("body") is None and parent.find("inertial") is not None
        if is_leaf and (joints or any(body.find(tag) is not None for tag in ("inertial", "geom"))):
            if not root.xpath(
                "//equality/*[@joint2=$name]", name=(joints or [body])[0].get("name")
            ):
                yield Change("link removed", body, _remove_body, names)
    for node in root.findall("equality/joint"):
        if node.get("joint2"):
            name = node.get("joint1")
            (joint,) = root.xpath("//worldbody//joint[@name=$name]", name=name)
            names = {name, joint.getparent().get("name")}
            values = numbers(node.get("polycoef"), "0 1 0 0 0")
            values[1] *= 1.1
            value = " ".join(map(repr, values))
            yield Change("mimic by 10 %", node, set_to("polycoef", value), names)
            yield Change("mimic lost", node, remove, names)


def get_value(node: Node, key: str, default: str | None = None) -> str | None:
    """Return an attribute of an element, with the defaults of its class."""
    if node.get(key) is not None:
        return node.get(key)
    name = node.get("class")
    above = node.getparent()
    while name is None and above is not None:
        name, above = above.get("childclass"), above.getparent()
    root = node.getroottree().getroot()
    found = root.xpath("/mujoco/default//default[@class=$name]", name=name) if name else []
    chosen = found[0] if found else root.find("default")
    while chosen is not None and chosen.tag == "default":
        inner = chosen.find(node.tag)
        if inner is not None and inner.get(key) is not None:
            return inner.get(key)
        chosen = chosen.getparent()
    return default


def _list_place(body: Node, names: set[str], generator: random.Random) -> Iterator[Change]:
    index = generator.randrange(3)
    prefix = "origin" if body.find("joint") is not None else "fixed joint"
    value = shift(body.get("pos"), index, 0.001)
    yield Change(f"{prefix} by 1 mm", body, set_to("pos", value), names)
    if not any(body.get(key) for key in ("euler", "axisangle", "xyaxes", "zaxis")):
        value = _turn(numbers(body.get("quat"), "1 0 0 0"), index, DEGREE)
        yield Change(f"{prefix} by 1°", body, set_to("quat", value), names)


def _turn(quat: list[float], index: int, angle: float) -> str:
    """Multiply a quaternion by a rotation about an axis of the body."""
    w, v = quat[0], np.array(quat[1:])
    w2, v2 = np.cos(angle / 2), np.sin(angle / 2) * np.eye(3)[index]
    value = [w * w2 - v @ v2, *(w * v2 + w2 * v + np.cross(v, v2))]
    return " ".join(repr(float(x)) for x in value)


def _list_joint(joint: Node, names: set[str]) -> Iterator[Change]:
    kind = get_value(joint, "type", "hinge")
    if kind not in ("hinge", "slide"):
        return
    axis = get_value(joint, "axis", "0 0 1")
    limits = get_value(joint, "range")
    low, high = numbers(limits, "0 0")
    if limits is not None and low == high:
        return  # locked
    yield Change("axis reversed", joint, set_to("axis", negate(axis)), names)
    yield Change("axis by 1°", joint, set_to("axis", tilt(axis)), names)
    if limits is not None and get_value(joint, "limited") != "false" and max(-low, high) < 1e9:
        unit = 1 / DEGREE if _uses_degrees(joint) and kind == "hinge" else 1.0
        upper, lower = shift(limits, 1, 0.05 * unit), shift(limits, 0, -0.05 * unit)
        yield Change("upper limit", joint, set_to("range", upper), names)
        yield Change("lower limit", joint, set_to("range", lower), names)
        yield Change("limits lost", joint, set_to("limited", "false"), names)
    effort = get_value(joint, "actuatorfrcrange")
    if effort is not None and 1e-3 < numbers(effort)[1] < 1e8:
        value = " ".join(repr(0.9 * x) for x in numbers(effort))  # actuators may bound it, too
        yield Change("effort by 10 %", joint, set_to("actuatorfrcrange", value), names)
    for key in ("damping", "frictionloss"):
        value = float(get_value(joint, key, "0"))
        edit = set_to(key, repr(value * 1.1 if value > 1e-3 else value + 0.1))
        yield Change(key.removesuffix("loss"), joint, edit, names)
    if kind == "hinge":
        yield Change("slide for a hinge", joint, set_to("type", "slide"), names)
    yield Change("joint fixed", joint, _remove_joint, names)


def _uses_degrees(node: Node) -> bool:
    compiler = node.getroottree().getroot().find("compiler")
    return compiler is None or compiler.get("angle") != "radian"


def _remove_references(root: Node, names: set[str]) -> None:
    """Remove elements outside the bodies that name a removed part, and every key."""
    for section in root:
        if section.tag in ("worldbody", "default", "asset", "compiler", "option"):
            continue
        for node in list(section.iter()):
            values = {value for key, value in node.items() if key != "name"}
            if node.tag == "key" or (node is not section and values & names):
                if node.getparent() is not None:
                    remove(node)


def _remove_joint(joint: Node) -> None:
    root, name = joint.getroottree().getroot(), joint.get("name")
    remove(joint)
    _remove_references(root, {name})


def _remove_body(body: Node) -> None:
    root = body.getroottree().getroot()
    names = {node.get("name") for node in body.iter() if node.get("name")}
    remove(body)
    _remove_references(root, names)


def _list_inertial(
    inertial: Node | None, names: set[str], generator: random.Random
) -> Iterator[Change]:
    if inertial is None or float(inertial.get("mass")) <= MASSLESS:
        return
    value = scale(inertial.get("mass"), 1.01)
    yield Change("mass by 1 %", inertial, set_to("mass", value), names)
    value = shift(inertial.get("pos"), generator.randrange(3), 0.001)
    yield Change("center of mass by 1 mm", inertial, set_to("pos", value), names)
    full, diagonal = inertial.get("fullinertia"), inertial.get("diaginertia")
    if full is None and diagonal is None:
        return
    if full is not None:
        xx, yy, zz, xy, xz, yz = numbers(full)
        tensor = make_tensor([xx, xy, xz, yy, yz, zz])
    elif inertial.get("quat") is None:
        tensor = np.diag(numbers(diagonal))
    else:
        return
    for kind, new in change_tensor(tensor):
        yield Change(kind, inertial, _set_tensor(new), names)


def _set_tensor(tensor: np.ndarray) -> Edit:
    xx, xy, xz, yy, yz, zz = get_six(tensor)

    def edit(node: Node) -> None:
        node.attrib.pop("diaginertia", None)
        node.set("fullinertia", " ".join(map(repr, (xx, yy, zz, xy, xz, yz))))

    return edit


def _list_geoms(body: Node, generator: random.Random) -> Iterator[Change]:
    names = {body.get("name")}
    for geom in body.findall("geom"):
        touches = not (get_value(geom, "contype") == get_value(geom, "conaffinity") == "0")
        kind = "collision" if touches else "visual"
        form = "mesh" if geom.get("mesh") else get_value(geom, "type", "sphere")
        if form in ("plane", "hfield", "sdf") or geom.get("fromto"):
            continue
        yield Change(f"{kind} lost", geom, remove, names)
        value = shift(get_value(geom, "pos"), generator.randrange(3), 0.001)
        yield Change(f"{kind} by 1 mm", geom, set_to("pos", value), names)
        size = get_value(geom, "size")
        if form == "mesh":
            yield from _list_meshes(geom, names, generator)
        elif size is not None and 0.01 * numbers(size)[0] > SMALLEST:
            edit = set_to("size", scale(size, 1.01))
            yield Change(f"size of a {kind} by 1 %", geom, edit, names)


def _list_meshes(geom: Node, names: set[str], generator: random.Random) -> Iterator[Change]:
    root = geom.getroottree().getroot()
    own, assets = geom.get("mesh"), {}
    for mesh in root.findall("asset/mesh"):
        assets[mesh.get("name") or mesh.get("file").rpartition("/")[2].rpartition(".")[0]] = mesh
    folder = root.find("compiler").get("meshdir", ".")
    files = {name: f"{folder}/{mesh.get('file')}" for name, mesh in assets.items()}
    if own in files and (others := list_other_meshes(geom, own, files)):
        edit = set_to("mesh", generator.choice(others))
        yield Change("another mesh", geom, edit, names)
    if own in assets and len(root.xpath("//geom[@mesh=$name]", name=own)) == 1:
        value = scale(assets[own].get("scale"), 1.01, "1 1 1")
        yield Change("scale of a mesh by 1 %", assets[own], set_to("scale", value), names)
