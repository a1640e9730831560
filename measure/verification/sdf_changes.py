"""Changes of an SDF."""

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

_SIZES = ("box/size", "cylinder/radius", "sphere/radius", "capsule/radius")


def list_sdf(root: Node, generator: random.Random) -> Iterator[Change]:
    """Yield the changes of an SDF."""
    joints = {joint.findtext("child"): joint for joint in root.iter("joint")}
    parents = {joint.findtext("parent") for joint in joints.values()}
    leaders = {mimic.get("joint") for mimic in root.iter("mimic")}
    for joint in joints.values():
        if joint.findtext("parent") != "world":
            yield from _list_joint(joint, joints, generator)
    for link in root.iter("link"):
        name = link.get("name")
        yield from _list_inertial(link.find("inertial"), {name}, generator)
        yield from _list_shapes(link, generator)
        joint = joints.get(name)
        if joint is not None and name not in parents and joint.get("name") not in leaders:
            has_mass = float(link.findtext("inertial/mass", "0")) > MASSLESS
            has_shape = any(link.find(tag) is not None for tag in ("visual", "collision"))
            if joint.get("type") != "fixed" or has_mass or has_shape:
                yield Change("link removed", link, _remove_link, {name, joint.get("name")})


def _remove_link(link: Node) -> None:
    model, name = link.getparent(), link.get("name")
    gone = {name}
    for joint in model.findall("joint"):
        if joint.findtext("child") == name:
            gone.add(joint.get("name"))
            remove(joint)
    for frame in model.findall("frame"):
        if frame.get("attached_to") in gone:
            gone.add(frame.get("name"))
            remove(frame)
    remove(link)


def _put(path: str, value: str) -> Edit:
    """Return an edit that sets the text below an element; missing elements are added."""

    def edit(node: Node) -> None:
        for tag in path.split("/"):
            child = node.find(tag)
            if child is None:
                child = node.makeelement(tag, {})
                node.append(child)
            node = child
        node.text = value

    return edit


def _list_joint(joint: Node, joints: dict[str, Node], generator: random.Random) -> Iterator[Change]:
    names = {joint.get("name"), joint.findtext("child")}
    kind, axis, pose = joint.get("type"), joint.find("axis"), joint.find("pose")
    if pose is not None and pose.text and pose.get("relative_to"):
        prefix = "fixed joint" if kind == "fixed" else "origin"
        index = generator.randrange(3)
        for at, word, size in ((index, "1 mm", 0.001), (3 + index, "1°", DEGREE)):
            value = shift(pose.text, at, size)
            yield Change(f"{prefix} by {word}", pose, set_to("", value), names)
    if axis is None or kind not in ("revolute", "prismatic", "continuous"):
        return
    low, high = (float(axis.findtext(f"limit/{tag}", "nan")) for tag in ("lower", "upper"))
    if low == high:
        return  # locked
    direction = axis.find("xyz")
    yield Change("axis reversed", direction, set_to("", negate(direction.text)), names)
    yield Change("axis by 1°", direction, set_to("", tilt(direction.text)), names)
    if max(abs(low), abs(high)) < 1e9:
        yield Change("upper limit", axis, _put("limit/upper", repr(high + 0.05)), names)
        yield Change("lower limit", axis, _put("limit/lower", repr(low - 0.05)), names)
        yield Change("limits lost", axis, _lose_limits, names)
    for tag in ("effort", "velocity"):
        text = axis.findtext(f"limit/{tag}")
        if text is not None and 1e-3 < float(text) < 1e8:
            yield Change(f"{tag} by 10 %", axis, _put(f"limit/{tag}", scale(text, 1.1)), names)
    for tag in ("damping", "friction"):
        value = float(axis.findtext(f"dynamics/{tag}", "0"))
        new = repr(value * 1.1 if value > 1e-3 else value + 0.1)
        yield Change(tag, axis, _put(f"dynamics/{tag}", new), names)
    if kind == "revolute":
        yield Change("slide for a hinge", joint, set_to("type", "prismatic"), names)
    yield Change("joint fixed", joint, _fix, names)
    mimic = axis.find("mimic")
    if mimic is not None:
        yield Change(
            "mimic by 10 %",
            mimic,
            _put("multiplier", scale(mimic.findtext("multiplier"), 1.1)),
            names,
        )
        yield Change("mimic lost", mimic, remove, names)
    parent = joints.get(joint.findtext("parent"))
    if parent is not None and parent.get("type") in ("revolute", "continuous", "prismatic"):
        value = parent.findtext("parent")
        if value != "world":
            yield Change("another parent", joint.find("parent"), set_to("", value), names)


def _lose_limits(axis: Node) -> None:
    limit = axis.find("limit")
    for tag in ("lower", "upper"):
        remove(limit.find(tag))


def _fix(joint: Node) -> None:
    name = joint.get("name")
    joint.set("type", "fixed")
    remove(joint.find("axis"))
    for mimic in joint.getroottree().xpath("//mimic[@joint=$name]", name=name):
        remove(mimic)


def _list_inertial(
    inertial: Node | None, names: set[str], generator: random.Random
) -> Iterator[Change]:
    mass = None if inertial is None else inertial.find("mass")
    if mass is None or float(mass.text) <= MASSLESS:
        return
    yield Change("mass by 1 %", mass, set_to("", scale(mass.text, 1.01)), names)
    pose = inertial.find("pose")
    if pose is None or pose.get("relative_to") is None:
        text = None if pose is None else pose.text
        value = shift(text, generator.randrange(3), 0.001, "0 0 0 0 0 0")
        yield Change("center of mass by 1 mm", inertial, _put("pose", value), names)
    tensor = inertial.find("inertia")
    if tensor is not None:
        six = [float(tensor.findtext(tag, "0")) for tag in SIX]
        for kind, new in change_tensor(make_tensor(six)):
            yield Change(kind, tensor, _set_six(get_six(new)), names)


def _set_six(six: list[float]) -> Edit:
    def edit(node: Node) -> None:
        for tag, value in zip(SIX, six, strict=True):
            _put(tag, repr(value))(node)

    return edit


def _list_shapes(link: Node, generator: random.Random) -> Iterator[Change]:
    names = {link.get("name")}
    uris = {node.text for node in link.getroottree().iter("uri")
            if node.getparent().tag == "mesh"}  # fmt: skip
    for kind in ("collision", "visual"):
        for shape in link.findall(kind):
            geometry = shape.find("geometry")
            size = next((n for path in _SIZES if (n := geometry.find(path)) is not None), None)
            mesh = geometry.find("mesh")
            if size is None and mesh is None:
                continue
            yield Change(f"{kind} lost", shape, remove, names)
            value = shift(shape.findtext("pose"), generator.randrange(3), 0.001, "0 0 0 0 0 0")
            yield Change(f"{kind} by 1 mm", shape, _put("pose", value), names)
            if mesh is not None:
                value = scale(mesh.findtext("scale"), 1.01, "1 1 1")
                yield Change("scale of a mesh by 1 %", mesh, _put("scale", value), names)
                files = {uri: uri for uri in uris}
                if others := list_other_meshes(link, mesh.findtext("uri"), files):
                    edit = _put("uri", generator.choice(others))
                    yield Change("another mesh", mesh, edit, names)
            elif numbers(size.text)[0] * 0.01 > SMALLEST:
                value = scale(size.text, 1.01)
                yield Change(f"size of a {kind} by 1 %", size, set_to("", value), names)
