"""Planted differences: one change of a file, which verify must find at the right part."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from lxml import etree

from urdftool.errors import UrdftoolError
from urdftool.formats.registry import format_named
from urdftool.formats.verify.compare import compare_robots
from urdftool.formats.verify.mesh_measure import MeshMeasures
from urdftool.model.elements import Robot

from .round_trips import export, load_robot

FORMATS = ("urdf", "sdf", "mjcf")
DEGREE = 0.017453292519943295


@dataclass
class Change:
    """A change of one file.

    Attributes:
        kind: Name of the kind.
        node: The element.
        key: The attribute; empty for the text.
        value: The new text.
        names: Links and joints at which the difference may be reported.
    """

    kind: str
    node: etree._Element
    key: str
    value: str
    names: set[str]


@dataclass
class Planted:
    """Result of one planted difference."""

    robot: str
    kind: str
    formats: tuple[str, str]
    found: bool
    at_its_part: bool
    others: list[str] = field(default_factory=list)


def _shift(text: str, index: int, amount: float) -> str:
    values = [float(word) for word in text.split()]
    values[index] += amount
    return " ".join(map(repr, values))


def _scale(text: str, factor: float) -> str:
    values = [float(word) for word in text.split()]
    values[0] *= factor
    return " ".join(map(repr, values))


def _negate(text: str) -> str:
    return " ".join(repr(-float(word)) for word in text.split())


def list_urdf(root: etree._Element) -> Iterator[Change]:
    """Yield the changes of a URDF."""
    moved = {j.find("child").get("link"): j.get("name") for j in root.iter("joint")
             if j.find("child") is not None}  # fmt: skip
    for joint in root.findall("joint"):
        names = {joint.get("name"), joint.find("child").get("link")}
        origin, axis, limit = joint.find("origin"), joint.find("axis"), joint.find("limit")
        fixed = joint.get("type") == "fixed"
        if origin is not None and origin.get("xyz"):
            kind = "fixed joint by 1 mm" if fixed else "origin by 1 mm"
            yield Change(kind, origin, "xyz", _shift(origin.get("xyz"), 0, 0.001), names)
            yield Change("origin by 1°", origin, "rpy", _shift(origin.get("rpy"), 0, DEGREE), names)
        bounds = (
            [float(limit.get(key, "0")) for key in ("lower", "upper")]
            if limit is not None
            else [0, 0]
        )
        if bounds[0] == bounds[1] and joint.get("type") != "continuous":
            continue  # locked
        if axis is not None and not fixed:
            yield Change("axis reversed", axis, "xyz", _negate(axis.get("xyz")), names)
        if limit is not None and joint.get("type") in ("revolute", "prismatic"):
            if bounds[1] < 1e9:
                yield Change("upper limit", limit, "upper", repr(bounds[1] + 0.05), names)
            if 0 < float(limit.get("effort")) < 1e8:
                value = _scale(limit.get("effort"), 1.1)
                yield Change("effort by 10 %", limit, "effort", value, names)
        if joint.get("type") == "revolute" and max(map(abs, bounds)) < 1e9:
            yield Change("limits lost", joint, "type", "continuous", names)
        mimic = joint.find("mimic")
        if mimic is not None:
            value = _scale(mimic.get("multiplier", "1"), 1.1)
            yield Change("mimic by 10 %", mimic, "multiplier", value, names)
    for link in root.findall("link"):
        names = {link.get("name")}
        yield from _list_inertial(link.find("inertial"), names)
        for shape in link.findall("collision"):
            for node in shape.find("geometry"):
                key = {"box": "size", "mesh": "scale", "cylinder": "radius", "sphere": "radius"}
                attribute = key[node.tag]
                value = _scale(node.get(attribute, "1 1 1"), 1.01)
                kind = "scale of a mesh" if node.tag == "mesh" else "size of a collision"
                yield Change(f"{kind} by 1 %", node, attribute, value, names)
    meshes = [(m, m.get("filename")) for m in root.iter("mesh")]
    for node, name in meshes:
        other = next((n for _, n in meshes if n != name and n[-4:] == name[-4:]), None)
        if other is not None:
            link = node.getparent().getparent().getparent().get("name")
            yield Change("another mesh", node, "filename", other, {link})
    del moved


def _list_inertial(inertial: etree._Element | None, names: set[str]) -> Iterator[Change]:
    if inertial is None or float(inertial.find("mass").get("value")) <= 0:
        return
    mass, origin, tensor = inertial.find("mass"), inertial.find("origin"), inertial.find("inertia")
    yield Change("mass by 1 %", mass, "value", _scale(mass.get("value"), 1.01), names)
    if origin is not None:
        value = _shift(origin.get("xyz"), 0, 0.001)
        yield Change("center of mass by 1 mm", origin, "xyz", value, names)
        xx, yy, zz = (float(tensor.get(key)) for key in ("ixx", "iyy", "izz"))
        if abs(yy - zz) > 0.1 * (xx + yy + zz):
            value = _shift(origin.get("rpy"), 0, 10 * DEGREE)
            yield Change("tensor by 10°", origin, "rpy", value, names)


def list_sdf(root: etree._Element) -> Iterator[Change]:
    """Yield the changes of an SDF."""
    parent = {j.findtext("child"): j.get("name") for j in root.iter("joint")}
    poses = {j.findtext("child"): j.find("pose") for j in root.iter("joint")}
    for link in root.iter("link"):
        name = link.get("name")
        names = {name, parent.get(name, name)}
        pose = poses.get(name)
        if pose is not None and name in parent:
            yield Change("origin by 1 mm", pose, "", _shift(pose.text, 0, 0.001), names)
            yield Change("origin by 1°", pose, "", _shift(pose.text, 3, DEGREE), names)
        inertial = link.find("inertial")
        if inertial is not None:
            mass = inertial.find("mass")
            yield Change("mass by 1 %", mass, "", _scale(mass.text, 1.01), names)
            at = inertial.find("pose")
            if at is not None:
                yield Change("center of mass by 1 mm", at, "", _shift(at.text, 0, 0.001), names)
        for shape in link.findall("collision"):
            for path in ("box/size", "cylinder/radius", "sphere/radius", "mesh/scale"):
                node = shape.find(f"geometry/{path}")
                if node is not None:
                    kind = "scale of a mesh" if "mesh" in path else "size of a collision"
                    yield Change(f"{kind} by 1 %", node, "", _scale(node.text, 1.01), names)
    for joint in root.iter("joint"):
        names = {joint.get("name"), joint.findtext("child")}
        axis = joint.find("axis/xyz")
        low, high = (joint.findtext(f"axis/limit/{tag}") for tag in ("lower", "upper"))
        if low is not None and low == high:
            continue  # locked
        if axis is not None and joint.get("type") in ("revolute", "prismatic"):
            yield Change("axis reversed", axis, "", _negate(axis.text), names)
        for tag, kind in (("upper", "upper limit"), ("effort", "effort by 10 %")):
            node = joint.find(f"axis/limit/{tag}")
            if node is not None and 0 < abs(float(node.text)) < 1e9:
                yield Change(kind, node, "", _scale(node.text, 1.1), names)


def list_mjcf(root: etree._Element) -> Iterator[Change]:
    """Yield the changes of an MJCF."""
    for body in root.find("worldbody").iter("body"):
        names = {body.get("name"), *(joint.get("name") for joint in body.findall("joint"))}
        if body.getparent().tag == "body":
            value = _shift(body.get("pos", "0 0 0"), 0, 0.001)
            yield Change("origin by 1 mm", body, "pos", value, names)
        inertial = body.find("inertial")
        if inertial is not None:
            value = _scale(inertial.get("mass"), 1.01)
            yield Change("mass by 1 %", inertial, "mass", value, names)
            value = _shift(inertial.get("pos"), 0, 0.001)
            yield Change("center of mass by 1 mm", inertial, "pos", value, names)
        for joint in body.findall("joint"):
            if joint.get("axis"):
                yield Change("axis reversed", joint, "axis", _negate(joint.get("axis")), names)
            if joint.get("range") and "e+" not in joint.get("range"):
                value = _shift(joint.get("range"), 1, 0.05)
                yield Change("upper limit", joint, "range", value, names)
        for geom in body.findall("geom"):
            if geom.get("size") and geom.get("type") not in ("mesh", None):
                value = _scale(geom.get("size"), 1.01)
                yield Change("size of a collision by 1 %", geom, "size", value, names)


LISTS = {"urdf": list_urdf, "sdf": list_sdf, "mjcf": list_mjcf}


class Harness:
    """A robot in every format, whose files are changed one at a time."""

    def __init__(self, path: Path, folder: Path) -> None:
        """Export a robot of example-robot-data to every format and read it back."""
        self.name = path.stem
        robot = load_robot(path)
        self.files = {name: export(robot, name, folder / name)[0] for name in FORMATS}
        self.robots = {name: self.read(name, self.files[name]) for name in FORMATS}
        self.meshes = MeshMeasures()
        self.equal: dict[tuple[str, str], set[str]] = {}

    @staticmethod
    def read(name: str, path: Path) -> Robot:
        """Read a robot."""
        return format_named(name).read(path).robot

    def compare(self, one: Robot, two: Robot) -> set[tuple[str, str, str]]:
        """Return row, name and title of each difference of a part."""
        comparison = compare_robots(one, two, meshes=self.meshes)
        return {
            (d.row, name, d.title)
            for d in comparison.differences
            if d.kind != "robot" and not d.is_convention
            for name in d.names
            if name
        }

    def plant(self, changed: str, other: str, generator: random.Random) -> Iterator[Planted]:
        """Yield the result of one change of each kind in one file, compared with another."""
        tree = etree.parse(self.files[changed])
        by_kind: dict[str, list[Change]] = {}
        for change in LISTS[changed](tree.getroot()):
            by_kind.setdefault(change.kind, []).append(change)
        before = self.compare(self.robots[changed], self.robots[other])
        for kind, changes in by_kind.items():
            change = generator.choice(changes)
            node, key = change.node, change.key
            old = node.get(key) if key else node.text
            if key:
                node.set(key, change.value)
            else:
                node.text = change.value
            path = self.files[changed].with_name(f"changed{self.files[changed].suffix}")
            tree.write(path)
            try:
                new = self.compare(self.read(changed, path), self.robots[other]) - before
            except UrdftoolError:
                new = None
            if key and old is None:
                del node.attrib[key]
            elif key:
                node.set(key, old)
            else:
                node.text = old
            if new is not None:
                outside = [title for _, name, title in new if name not in change.names]
                yield Planted(
                    self.name, kind, (changed, other), bool(new), bool(new) and not outside, outside
                )
