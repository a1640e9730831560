"""Kinds of damage: each changes one element of a robot's XML and says which names are hit."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement

from urdftool.model.pose import Pose, rotate, rotation_from_rpy, rpy_from_rotation

Damage = Callable[["Robot", random.Random], "set[str] | None"]
KINDS: dict[str, Damage] = {}
SIX = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
PRINTS_LFS = "version https://git-lfs.github.com/spec/v1\noid sha256:{}\nsize 812345\n"


class Robot:
    """A robot's XML with what the damages look for."""

    def __init__(self, root: Element, folder: Path) -> None:
        self.root = root
        self.folder = folder
        self.links = {link.get("name", ""): link for link in root.findall("link")}
        self.joints = {joint.get("name", ""): joint for joint in root.findall("joint")}

    def parent(self, joint: Element) -> str:
        return joint.find("parent").get("link")

    def child(self, joint: Element) -> str:
        return joint.find("child").get("link")

    def moving(self) -> list[Element]:
        kinds = ("revolute", "prismatic", "continuous")
        return [joint for joint in self.joints.values() if joint.get("type") in kinds]

    def limited(self) -> list[Element]:
        """Joints with a real range and drive."""
        found = []
        for joint in self.moving():
            limit = joint.find("limit")
            if joint.get("type") == "continuous" or limit is None:
                continue
            if joint.find("mimic") is not None:
                continue
            low, high = (float(limit.get(name, 0)) for name in ("lower", "upper"))
            if high - low > 0.02:
                found.append(joint)
        return found

    def bodies(self) -> list[Element]:
        """Links with a mass that counts, an inertia that is one, and a shape."""
        found = []
        for link in self.links.values():
            inertial = link.find("inertial")
            if inertial is None or inertial.find("mass") is None:
                continue
            mass = float(inertial.find("mass").get("value", 0))
            inertia = inertial.find("inertia")
            if mass < 0.05 or inertia is None or float(inertia.get("ixx", 0)) <= 1e-6:
                continue
            moments = {inertia.get(name) for name in ("ixx", "iyy", "izz")}
            if len(moments) > 1 and link.find("collision") is not None:
                found.append(link)
        return found

    def meshes(self) -> list[tuple[Element, Element]]:
        """Meshes in the formats that can be read."""
        return [
            (link, mesh)
            for link in self.links.values()
            for mesh in link.iter("mesh")
            if mesh.get("filename", "").lower().endswith((".stl", ".dae", ".obj", ".glb"))
        ]


def damage(check: Damage) -> Damage:
    KINDS[check.__name__] = check
    return check


def numbers(text: str | None, default: str = "0 0 0") -> list[float]:
    return [float(word) for word in (text or default).split()]


def words(values: list[float]) -> str:
    return " ".join(f"{value:.9g}" for value in values)


def origin(element: Element) -> Element:
    found = element.find("origin")
    return found if found is not None else SubElement(element, "origin")


def around(joint: Element, robot: Robot) -> set[str]:
    """The names that a damaged joint goes by: its own, and that of the link it carries."""
    return {joint.get("name", ""), robot.child(joint)}


def factor_of(path: str, name: str, factor: float) -> Damage:
    def apply(robot: Robot, rng: random.Random) -> set[str] | None:
        bodies = robot.bodies()
        if not bodies:
            return None
        link = rng.choice(bodies)
        element = link.find(path)
        for key in SIX if name == "six" else (name,):
            element.set(key, f"{float(element.get(key, 0)) * factor:.9g}")
        return {link.get("name", "")}

    return apply


for label, path, name, factor in (
    ("mass times ten", "inertial/mass", "value", 10),
    ("mass times five", "inertial/mass", "value", 5),
    ("mass a tenth", "inertial/mass", "value", 0.1),
    ("mass in grams", "inertial/mass", "value", 1000),
    ("mass negative", "inertial/mass", "value", -1),
    ("mass zero", "inertial/mass", "value", 0),
    ("inertia times ten", "inertial/inertia", "six", 10),
    ("inertia a tenth", "inertial/inertia", "six", 0.1),
    ("inertia times hundred", "inertial/inertia", "six", 100),
    ("inertia a hundredth", "inertial/inertia", "six", 0.01),
    ("inertia in kg·mm²", "inertial/inertia", "six", 1e6),
    ("inertia zero", "inertial/inertia", "six", 0),
    ("one moment times ten", "inertial/inertia", "izz", 10),
    ("one moment times thousand", "inertial/inertia", "izz", 1000),
    ("one moment a thousandth", "inertial/inertia", "ixx", 0.001),
    ("one moment negative", "inertial/inertia", "iyy", -1),
):
    KINDS[label] = factor_of(path, name, factor)


@damage
def inertia_about_the_joint(robot, rng):
    """The tensor about the link's frame, not about the centre of mass."""
    far = []
    for link in robot.bodies():
        com = (
            numbers(link.find("inertial/origin").get("xyz"))
            if link.find("inertial/origin") is not None
            else [0, 0, 0]
        )
        mass = float(link.find("inertial/mass").get("value"))
        inertia = link.find("inertial/inertia")
        shift = mass * sum(c * c for c in com)
        if shift > 2 * max(float(inertia.get(k)) for k in ("ixx", "iyy", "izz")):
            far.append((link, com, mass))
    if not far:
        return None
    link, (x, y, z), mass = rng.choice(far)
    shifted = (y * y + z * z, -x * y, -x * z, x * x + z * z, -y * z, x * x + y * y)
    more = dict(zip(SIX, shifted, strict=True))
    inertia = link.find("inertial/inertia")
    for key in SIX:
        inertia.set(key, f"{float(inertia.get(key, 0)) + mass * more[key]:.9g}")
    return {link.get("name")}


@damage
def center_of_mass_with_another_sign(robot, rng):
    """One coordinate of the centre of mass of one side was copied, or lost its sign."""
    bodies = robot.bodies()
    found = []
    for one, other in twins(robot.links):
        com, twin = one.find("inertial/origin"), other.find("inertial/origin")
        if one not in bodies or com is None or twin is None:
            continue
        far = [math.dist([0, 0, 0], numbers(place.get("xyz"))) for place in (com, twin)]
        if abs(far[0] - far[1]) > 0.05 * max(far):
            continue  # they are no twins even now
        found += [
            (one, other, com, axis)
            for axis, value in enumerate(numbers(com.get("xyz")))
            if abs(value) >= 0.005
        ]
    if not found:
        return None
    one, other, com, axis = rng.choice(found)
    xyz = numbers(com.get("xyz"))
    xyz[axis] *= -1
    com.set("xyz", words(xyz))
    return {one.get("name"), other.get("name")}


@damage
def inertia_of_another_axis(robot, rng):
    """A long link's moments in another order, as of a frame that is turned."""
    long = []
    for link in robot.bodies():
        inertia = link.find("inertial/inertia")
        moments = sorted((float(inertia.get(k)), k) for k in ("ixx", "iyy", "izz"))
        if moments[2][0] > 5 * moments[0][0]:
            long.append((link, moments))
    if not long:
        return None
    link, moments = rng.choice(long)
    inertia = link.find("inertial/inertia")
    inertia.set(moments[0][1], f"{moments[2][0]:.9g}")
    inertia.set(moments[2][1], f"{moments[0][0]:.9g}")
    return {link.get("name")}


def com_moved(factor: float | None) -> Damage:
    def apply(robot, rng):
        found = []
        for link in robot.bodies():
            com = link.find("inertial/origin")
            if com is not None and max(map(abs, numbers(com.get("xyz")))) > 0.01:
                found.append((link, com))
        if not found:
            return None
        link, com = rng.choice(found)
        xyz = numbers(com.get("xyz"))
        if factor is None:
            xyz[rng.randrange(3)] += 0.5
        else:
            xyz = [factor * value for value in xyz]
        com.set("xyz", words(xyz))
        return {link.get("name")}

    return apply


KINDS["centre of mass half a metre off"] = com_moved(None)
KINDS["centre of mass in millimetres"] = com_moved(1000)


def axis_made(change: Callable[[list[float]], list[float]]) -> Damage:
    def apply(robot, rng):
        moving = [joint for joint in robot.moving() if joint.find("axis") is not None]
        if not moving:
            return None
        joint = rng.choice(moving)
        axis = joint.find("axis")
        axis.set("xyz", words(change(numbers(axis.get("xyz")))))
        return around(joint, robot)

    return apply


KINDS["axis of length two"] = axis_made(lambda xyz: [2 * value for value in xyz])
KINDS["axis of zero length"] = axis_made(lambda xyz: [0, 0, 0])


@damage
def axis_flipped(robot, rng):
    """Of a joint that has a twin."""
    pairs = [pair for pair in twins(robot.joints) if pair[0] in robot.moving()]
    if not pairs:
        return None
    joint, _ = rng.choice(pairs)
    axis = joint.find("axis")
    axis = SubElement(joint, "axis", xyz="1 0 0") if axis is None else axis
    axis.set("xyz", words([-value for value in numbers(axis.get("xyz"))]))
    return around(joint, robot)


TWINS = (
    *(("left", "right"), ("Left", "Right"), ("L", "R"), ("l", "r"), ("fl", "fr"), ("FL", "FR")),
    *(("hl", "hr"), ("HL", "HR"), ("rl", "rr"), ("RL", "RR"), ("lf", "rf"), ("LF", "RF")),
    *(("lh", "rh"), ("LH", "RH"), ("toeL", "toeR")),
)


def twins(named: dict[str, Element]) -> list[tuple[Element, Element]]:
    """Elements of a left side and those of the right, told by names that differ in one word."""
    import re

    found = []
    for name, element in named.items():
        for left, right in TWINS:
            other = re.sub(rf"(?<![A-Za-z]){left}(?![a-z])", right, name)
            if other != name and other in named:
                found.append((element, named[other]))
                found.append((named[other], element))
                break
    return found


def both(pair: tuple[Element, Element], robot: Robot) -> set[str]:
    one, other = pair
    if one.tag == "link":
        return {one.get("name"), other.get("name")}
    return around(one, robot) | around(other, robot)


@damage
def one_side_heavier(robot, rng):
    bodies = robot.bodies()
    pairs = [pair for pair in twins(robot.links) if pair[0] in bodies]
    if not pairs:
        return None
    pair = rng.choice(pairs)
    mass = pair[0].find("inertial/mass")
    mass.set("value", f"{1.2 * float(mass.get('value')):.9g}")
    return both(pair, robot)


@damage
def one_side_elsewhere(robot, rng):
    """The joint of one side is 3 cm off where the other's mirror image is."""
    moving = robot.moving()
    pairs = [pair for pair in twins(robot.joints) if pair[0] in moving]
    if not pairs:
        return None
    pair = rng.choice(pairs)
    place = origin(pair[0])
    xyz = numbers(place.get("xyz"))
    xyz[rng.randrange(3)] += 0.03
    place.set("xyz", words(xyz))
    return both(pair, robot)


@damage
def one_side_limited(robot, rng):
    limited = robot.limited()
    pairs = [pair for pair in twins(robot.joints) if pair[0] in limited]
    if not pairs:
        return None
    pair = rng.choice(pairs)
    limit = pair[0].find("limit")
    limit.set("upper", f"{float(limit.get('upper', 0)) + 0.7:.9g}")
    return both(pair, robot)


def poses(robot: Robot) -> dict[str, Pose]:
    """Where links are in the frame of the root."""
    parents = {robot.child(joint): joint for joint in robot.joints.values()}
    found: dict[str, Pose] = {}

    def pose(name: str) -> Pose:
        if name not in found:
            joint = parents.get(name)
            found[name] = Pose() if joint is None else pose(robot.parent(joint)) @ place_of(joint)
        return found[name]

    for name in robot.links:
        pose(name)
    return found


def place_of(element: Element) -> Pose:
    place = element.find("origin")
    if place is None:
        return Pose()
    rotation = rotation_from_rpy(tuple(numbers(place.get("rpy"))))
    return Pose(rotation, tuple(numbers(place.get("xyz"))))


def put(element: Element, pose: Pose) -> None:
    place = origin(element)
    place.set("xyz", words(pose.translation))
    place.set("rpy", words(rpy_from_rotation(pose.rotation)))


def turned_about_the_origin(robot: Robot, joints: list[Element]) -> None:
    """Put the frames of the children of joints into the root's; the robot looks as it did."""
    where = poses(robot)
    moved = {robot.child(joint) for joint in joints}
    for joint in robot.joints.values():
        parent, child = robot.parent(joint), robot.child(joint)
        if child in moved and joint.find("axis") is not None:
            axis = joint.find("axis")
            axis.set("xyz", words(rotate(where[child].rotation, numbers(axis.get("xyz")))))
        base = Pose() if parent in moved else where[parent]
        put(joint, base.invert() @ (Pose() if child in moved else where[child]))
    for name in moved:
        link = robot.links[name]
        for part in (*link.iter("inertial"), *link.iter("visual"), *link.iter("collision")):
            put(part, where[name] @ place_of(part))


@damage
def frames_at_the_origin(robot, rng):
    """As of a CAD export without coordinate systems of the links."""
    turning = [j for j in robot.moving() if j.get("type") != "prismatic"]
    if len(turning) < 3:
        return None
    turned_about_the_origin(robot, list(robot.joints.values()))
    return set(robot.joints) | set(robot.links)


@damage
def meshes_placed_twice(robot, rng):
    """As of a CAD export whose meshes are in the frame of the assembly."""
    turning = [j for j in robot.moving() if j.get("type") != "prismatic"]
    if len(turning) < 3:
        return None
    where = poses(robot)
    for name, link in robot.links.items():
        for part in (*link.iter("visual"), *link.iter("collision")):
            put(part, where[name] @ place_of(part))
    return set(robot.joints) | set(robot.links)


@damage
def joint_inside_its_parent(robot, rng):
    """The origin was lost: the child sits where its parent does."""
    far = []
    for joint in robot.moving():
        place = joint.find("origin")
        if place is None or math.hypot(*numbers(place.get("xyz"))) < 0.08:
            continue
        one, other = robot.links[robot.parent(joint)], robot.links[robot.child(joint)]
        if one.find("collision") is not None and other.find("collision") is not None:
            far.append(joint)
    if not far:
        return None
    joint = rng.choice(far)
    joint.find("origin").set("xyz", "0 0 0")
    return around(joint, robot) | {robot.parent(joint)}


@damage
def collision_shifted(robot, rng):
    """By half a metre, on a link that is seen."""
    seen = [
        link
        for link in robot.links.values()
        if len(link.findall("collision")) == 1 and link.find("visual") is not None
    ]
    if not seen:
        return None
    link = rng.choice(seen)
    place = origin(link.find("collision"))
    xyz = numbers(place.get("xyz"))
    xyz[rng.randrange(3)] += 0.5
    place.set("xyz", words(xyz))
    return {link.get("name")}


def same_mesh_elsewhere(change: Callable[[Element, random.Random], None]) -> Damage:
    def apply(robot, rng):
        found = []
        for link in robot.links.values():
            seen, touches = link.findall("visual"), link.findall("collision")
            meshes = [shape.find("geometry/mesh") for shape in (*seen, *touches)]
            if len(seen) == len(touches) == 1 and all(mesh is not None for mesh in meshes):
                if meshes[0].attrib == meshes[1].attrib:
                    found.append((link, touches[0]))
        if not found:
            return None
        link, collision = rng.choice(found)
        change(origin(collision), rng)
        return {link.get("name")}

    return apply


def _move(place, rng):
    xyz = numbers(place.get("xyz"))
    xyz[rng.randrange(3)] += 0.005
    place.set("xyz", words(xyz))


def _turn(place, rng):
    rpy = numbers(place.get("rpy"))
    rpy[rng.randrange(3)] += math.pi / 2
    place.set("rpy", words(rpy))


KINDS["collision mesh 5 mm off"] = same_mesh_elsewhere(_move)
KINDS["collision mesh turned"] = same_mesh_elsewhere(_turn)


def mesh_scaled(factor: float) -> Damage:
    def apply(robot, rng):
        found = robot.meshes()
        if not found:
            return None
        link, mesh = rng.choice(found)
        scale = numbers(mesh.get("scale"), "1 1 1")
        mesh.set("scale", words([factor * value for value in scale]))
        return {link.get("name")}

    return apply


KINDS["mesh in millimetres"] = mesh_scaled(1000)
KINDS["mesh scaled twice"] = mesh_scaled(0.001)
KINDS["mesh ten times too large"] = mesh_scaled(10)
KINDS["mesh a tenth"] = mesh_scaled(0.1)


def limit_made(change: Callable[[Element], None], names: tuple[str, ...] = ()) -> Damage:
    def apply(robot, rng):
        limited = [j for j in robot.limited() if all(j.find("limit").get(n) for n in names)]
        limited = [j for j in limited if all(float(j.find("limit").get(n)) for n in names)]
        if not limited:
            return None
        joint = rng.choice(limited)
        change(joint.find("limit"))
        return around(joint, robot)

    return apply


def _swap(limit):
    low, high = limit.get("lower", "0"), limit.get("upper", "0")
    limit.set("lower", high)
    limit.set("upper", low)


KINDS["limits swapped"] = limit_made(_swap)
KINDS["effort zero"] = limit_made(lambda limit: limit.set("effort", "0"), ("effort",))
KINDS["velocity zero"] = limit_made(lambda limit: limit.set("velocity", "0"), ("velocity",))
KINDS["effort negative"] = limit_made(lambda limit: limit.set("effort", "-10"), ("effort",))
KINDS["effort not written"] = limit_made(lambda limit: limit.attrib.pop("effort"), ("effort",))


@damage
def limits_in_degrees(robot, rng):
    turning = [joint for joint in robot.limited() if joint.get("type") == "revolute"]
    if not turning:
        return None
    joint = rng.choice(turning)
    limit = joint.find("limit")
    for name in ("lower", "upper"):
        limit.set(name, f"{round(math.degrees(float(limit.get(name, 0))))}")
    return around(joint, robot)


@damage
def limit_lost(robot, rng):
    limited = robot.limited()
    if not limited:
        return None
    joint = rng.choice(limited)
    joint.remove(joint.find("limit"))
    return around(joint, robot)


@damage
def rotation_in_degrees(robot, rng):
    turned = [
        joint
        for joint in robot.joints.values()
        if joint.find("origin") is not None and any(numbers(joint.find("origin").get("rpy")))
    ]
    if not turned:
        return None
    joint = rng.choice(turned)
    place = joint.find("origin")
    place.set("rpy", words([round(math.degrees(v)) for v in numbers(place.get("rpy"))]))
    return around(joint, robot)


@damage
def mesh_missing(robot, rng):
    found = robot.meshes()
    if not found:
        return None
    link, mesh = rng.choice(found)
    mesh.set("filename", mesh.get("filename").replace(".", "_v2.", 1))
    return {link.get("name"), mesh.get("filename")}


@damage
def mesh_is_an_lfs_pointer(robot, rng):
    found = robot.meshes()
    if not found:
        return None
    link, mesh = rng.choice(found)
    file = robot.folder / ("pointer" + Path(mesh.get("filename")).suffix)
    file.write_text(PRINTS_LFS.format("4d7a" * 16))
    mesh.set("filename", file.name)
    return {link.get("name"), file.name}


@damage
def soft_limits_of_a_tenth(robot, rng):
    limited = [joint for joint in robot.limited() if joint.find("safety_controller") is None]
    if not limited:
        return None
    joint = rng.choice(limited)
    limit = joint.find("limit")
    low, high = (float(limit.get(name, 0)) for name in ("lower", "upper"))
    middle, half = (low + high) / 2, (high - low) / 20
    soft = {"soft_lower_limit": f"{middle - half:.6g}", "soft_upper_limit": f"{middle + half:.6g}"}
    SubElement(joint, "safety_controller", soft, k_velocity="10", k_position="20")
    return around(joint, robot)


@damage
def mimic_loop(robot, rng):
    moving = [joint for joint in robot.limited() if joint.find("mimic") is None]
    if len(moving) < 2:
        return None
    one, other = rng.sample(moving, 2)
    SubElement(one, "mimic", joint=other.get("name"))
    SubElement(other, "mimic", joint=one.get("name"))
    return {one.get("name"), other.get("name")}


@damage
def mimic_of_nothing(robot, rng):
    limited = robot.limited()
    if not limited:
        return None
    joint = rng.choice(limited)
    SubElement(joint, "mimic", joint="no_such_joint")
    return around(joint, robot)


@damage
def two_links_of_one_name(robot, rng):
    one, other = rng.sample(list(robot.links), 2)
    robot.links[one].set("name", other)
    return {one, other}


@damage
def two_joints_of_one_name(robot, rng):
    one, other = rng.sample(list(robot.joints), 2)
    robot.joints[one].set("name", other)
    return {one, other}


@damage
def parent_unknown(robot, rng):
    joint = rng.choice(list(robot.joints.values()))
    joint.find("parent").set("link", "no_such_link")
    return around(joint, robot)


@damage
def links_in_a_circle(robot, rng):
    below = {robot.parent(joint) for joint in robot.joints.values()}
    inner = [joint for joint in robot.joints.values() if robot.child(joint) in below]
    if not inner:
        return None
    joint = rng.choice(inner)
    lower = next(j for j in robot.joints.values() if robot.parent(j) == robot.child(joint))
    joint.find("parent").set("link", robot.child(lower))
    return around(joint, robot) | around(lower, robot)


@damage
def inertial_lost(robot, rng):
    bodies = robot.bodies()
    if not bodies:
        return None
    link = rng.choice(bodies)
    link.remove(link.find("inertial"))
    return {link.get("name")}


@damage
def collision_lost(robot, rng):
    seen = [
        link
        for link in robot.links.values()
        if link.find("collision") is not None and link.find("visual") is not None
    ]
    if not seen:
        return None
    link = rng.choice(seen)
    for collision in link.findall("collision"):
        link.remove(collision)
    return {link.get("name")}


@damage
def links_overlap_at_rest(robot, rng):
    """A limb is moved onto another that hangs on the same body."""
    by_parent: dict[str, list[Element]] = {}
    for joint in robot.moving():
        link = robot.links[robot.child(joint)]
        if link.find("collision") is not None:
            by_parent.setdefault(robot.parent(joint), []).append(joint)
    pairs = [
        (one, other)
        for group in by_parent.values()
        for one in group
        for other in group
        if math.dist(numbers(origin(one).get("xyz")), numbers(origin(other).get("xyz"))) > 0.01
    ]
    if not pairs:
        return None
    one, other = rng.choice(pairs)
    here, there = origin(one), origin(other)
    for name in ("xyz", "rpy"):
        here.set(name, there.get(name, "0 0 0"))
    return around(one, robot) | around(other, robot)


@damage
def passes_through_when_it_moves(robot, rng):
    """A range that was kept off the other links now goes all the way round."""
    limited = [
        joint
        for joint in robot.limited()
        if joint.get("type") == "revolute"
        and float(joint.find("limit").get("upper")) - float(joint.find("limit").get("lower")) < 3.2
        and any(robot.parent(j) == robot.child(joint) for j in robot.moving())
    ]
    if not limited:
        return None
    joint = rng.choice(limited)
    joint.find("limit").set("lower", "-3.1")
    joint.find("limit").set("upper", "3.1")
    return around(joint, robot)
