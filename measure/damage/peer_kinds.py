"""The 17 kinds of defect that simcheck 0.2.0 plants in its own benchmark, written anew.

``simcheck bench`` lists them. A kind changes one random element of a robot (the first two: all of
its geometry), and says which names are hit; an empty set stands for the whole robot. What would
change nothing, such as a zero in place of a zero, is not planted.
"""

from __future__ import annotations

import math
import random
from xml.etree.ElementTree import Element, SubElement

from .kinds import SIX, Damage, Robot, around, numbers, origin, words

PEER_KINDS: dict[str, Damage] = {}
SIZES = {"box": ("size",), "sphere": ("radius",), "cylinder": ("radius", "length")}


class Measured(Robot):
    """A robot of which the greatest extent of each link's collisions is known [m].

    Attributes:
        extent: By link; links without collision geometry are missing.
    """

    def __init__(self, root: Element, folder, extent: dict[str, float]) -> None:
        super().__init__(root, folder)
        self.extent = extent

    def carried(self, *needed: str) -> list[Element]:
        """The links below a moving joint that have certain elements."""
        names = sorted({self.child(joint) for joint in self.moving()} & self.links.keys())
        links = [self.links[name] for name in names]
        return [link for link in links if all(link.find(path) is not None for path in needed)]

    def joints_of(self, *kinds: str) -> list[Element]:
        return [joint for joint in self.moving() if joint.get("type") in kinds]


def peer(check: Damage) -> Damage:
    PEER_KINDS[check.__name__.replace("_", " ")] = check
    return check


def one_of(elements: list[Element], rng: random.Random) -> Element | None:
    return rng.choice(elements) if elements else None


def times(element: Element, name: str, factor: float) -> None:
    """Multiply an attribute's numbers, unless it is missing or not expanded."""
    if "$" not in element.get(name, "$"):
        element.set(name, words([factor * value for value in numbers(element.get(name))]))


def everything_times(factor: float) -> Damage:
    """All lengths of the geometry and of the tree, but no mass and no inertia."""

    def apply(robot: Measured, rng: random.Random) -> set[str]:
        for element in robot.root.iter():
            if element.tag == "mesh":
                element.set("scale", element.get("scale", "1 1 1"))
                times(element, "scale", factor)
            elif element.tag == "origin":
                times(element, "xyz", factor)
            for name in SIZES.get(element.tag, ()):
                times(element, name, factor)
        return set()

    return apply


PEER_KINDS["geometry in millimetres"] = everything_times(1000)
PEER_KINDS["geometry a thousandth"] = everything_times(0.001)


@peer
def axis_reversed(robot: Measured, rng: random.Random) -> set[str] | None:
    joint = one_of(robot.joints_of("revolute", "prismatic"), rng)
    return None if joint is None else _with_axis(joint, robot, -1)


@peer
def axis_zero(robot: Measured, rng: random.Random) -> set[str] | None:
    joint = one_of(robot.moving(), rng)
    return None if joint is None else _with_axis(joint, robot, 0)


def _with_axis(joint: Element, robot: Measured, factor: float) -> set[str]:
    axis = joint.find("axis")
    if axis is None:
        axis = SubElement(joint, "axis", xyz="1 0 0")
    axis.set("xyz", words([factor * value for value in numbers(axis.get("xyz"), "1 0 0")]))
    return around(joint, robot)


@peer
def limits_swapped(robot: Measured, rng: random.Random) -> set[str] | None:
    joint = one_of([j for j in _with_range(robot, 0) if j.get("type") != "continuous"], rng)
    if joint is None:
        return None
    limit = joint.find("limit")
    lower, upper = limit.get("lower", "0"), limit.get("upper", "0")
    limit.set("lower", upper)
    limit.set("upper", lower)
    return around(joint, robot)


@peer
def limits_in_degrees(robot: Measured, rng: random.Random) -> set[str] | None:
    joint = one_of([j for j in _with_range(robot, 0.3) if j.get("type") == "revolute"], rng)
    if joint is None:
        return None
    limit = joint.find("limit")
    for name in ("lower", "upper"):
        limit.set(name, f"{math.degrees(float(limit.get(name, 0))):g}")
    return around(joint, robot)


def _with_range(robot: Measured, least: float) -> list[Element]:
    found = []
    for joint in robot.moving():
        limit = joint.find("limit")
        if limit is not None:
            lower, upper = (float(limit.get(name, 0)) for name in ("lower", "upper"))
            found += [joint] * (upper - lower > least)
    return found


def inertia_made(change) -> Damage:
    """Change the inertia of a link below a moving joint."""

    def apply(robot: Measured, rng: random.Random) -> set[str] | None:
        link = one_of(robot.carried("inertial/inertia"), rng)
        if link is None:
            return None
        inertia = link.find("inertial/inertia")
        change(inertia, {key: float(inertia.get(key, 0)) for key in SIX})
        return {link.get("name", "")}

    return apply


def _nothing(inertia: Element, _: dict[str, float]) -> None:
    for key in SIX:
        inertia.set(key, "0")


def _impossible(inertia: Element, value: dict[str, float]) -> None:
    for key in ("ixy", "ixz", "iyz"):
        inertia.set(key, "0")
    inertia.set("izz", f"{3 * (value['ixx'] + value['iyy']):g}")


def _negative(inertia: Element, value: dict[str, float]) -> None:
    inertia.set("ixx", f"{-abs(value['ixx'] or 0.01):g}")


PEER_KINDS["inertia zero"] = inertia_made(_nothing)
PEER_KINDS["triangle inequality broken"] = inertia_made(_impossible)
PEER_KINDS["moment negative"] = inertia_made(_negative)


@peer
def mass_in_grams(robot: Measured, rng: random.Random) -> set[str] | None:
    """Mass and inertia are a thousand times too large, so the two agree with each other."""
    link = one_of(robot.carried("inertial/mass"), rng)
    if link is None:
        return None
    times(link.find("inertial/mass"), "value", 1000)
    for inertia in link.findall("inertial/inertia"):
        for key in SIX:
            times(inertia, key, 1000)
    return {link.get("name", "")}


@peer
def mass_zero(robot: Measured, rng: random.Random) -> set[str] | None:
    link = one_of(robot.carried("inertial/mass"), rng)
    if link is None:
        return None
    link.find("inertial/mass").set("value", "0")
    return {link.get("name", "")}


@peer
def inertial_removed(robot: Measured, rng: random.Random) -> set[str] | None:
    link = one_of(robot.carried("inertial"), rng)
    if link is None:
        return None
    link.remove(link.find("inertial"))
    return {link.get("name", "")}


@peer
def collision_removed(robot: Measured, rng: random.Random) -> set[str] | None:
    link = one_of(robot.carried("collision", "visual"), rng)
    if link is None:
        return None
    for collision in link.findall("collision"):
        link.remove(collision)
    return {link.get("name", "")}


@peer
def collision_off_its_visual(robot: Measured, rng: random.Random) -> set[str] | None:
    """By one and a half times its greatest extent, along x."""
    link = one_of(robot.carried("collision", "visual"), rng)
    if link is None:
        return None
    for collision in link.findall("collision"):
        _shift(collision, (1.5 * robot.extent.get(link.get("name"), 0.1), 0, 0))
    return {link.get("name", "")}


@peer
def center_of_mass_outside(robot: Measured, rng: random.Random) -> set[str] | None:
    """By twice the greatest extent of the link's collisions, along z."""
    link = one_of(robot.carried("inertial/mass"), rng)
    if link is None:
        return None
    _shift(link.find("inertial"), (0, 0, 2 * robot.extent.get(link.get("name"), 0.1)))
    return {link.get("name", "")}


@peer
def mesh_file_missing(robot: Measured, rng: random.Random) -> set[str] | None:
    shapes = [shape for link in robot.links.values() for shape in link]
    meshes = [mesh for shape in shapes for mesh in shape.findall("geometry/mesh")]
    mesh = one_of(meshes, rng)
    if mesh is None:
        return None
    mesh.set("filename", mesh.get("filename", "") + ".missing")
    return {mesh.get("filename", "")}


@peer
def joint_pushed_into_its_parent(robot: Measured, rng: random.Random) -> set[str] | None:
    """By 0.6 of the child's extent: against a prismatic joint's axis, else along -x."""
    joint = one_of(robot.joints_of("prismatic") or robot.joints_of("revolute"), rng)
    if joint is None:
        return None
    push = -0.6 * robot.extent.get(robot.child(joint), 0.1)
    along = [1.0, 0.0, 0.0]
    if joint.get("type") == "prismatic" and joint.find("axis") is not None:
        along = numbers(joint.find("axis").get("xyz"), "1 0 0")
    length = math.hypot(*along) or 1
    _shift(joint, [push * value / length for value in along])
    return around(joint, robot) | {robot.parent(joint)}


def _shift(element: Element, by) -> None:
    place = origin(element)
    xyz = numbers(place.get("xyz"))
    place.set("xyz", words([a + b for a, b in zip(xyz, by, strict=True)]))
