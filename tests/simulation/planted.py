"""Faults planted into a sound robot, as edits of its expanded URDF."""

from xml.etree import ElementTree

import numpy as np

from urdftool import cli
from urdftool.api.start import choose_start
from urdftool.model.kinematics import link_poses
from urdftool.model.load import load
from urdftool.simulation.prepare import prepare
from urdftool.simulation.settings import Settings


def expanded(source, folder):
    """The tree of a robot after expansion."""
    target = folder / "expanded.urdf"
    assert cli.call(["-q", "expand", str(source), "-o", str(target)]) == 0
    return ElementTree.parse(target)


def link(tree, name):
    return next(e for e in tree.getroot().findall("link") if e.get("name") == name)


def no_collision(tree, name):
    part = link(tree, name)
    for collision in part.findall("collision"):
        part.remove(collision)


def identity_inertia(tree, name):
    tensor = link(tree, name).find("inertial/inertia")
    for key in tensor.attrib:
        tensor.set(key, "1" if key in ("ixx", "iyy", "izz") else "0")


def thousandfold_mass(tree, name):
    mass = link(tree, name).find("inertial/mass")
    mass.set("value", str(1000 * float(mass.get("value"))))


def millimetres(tree, name):
    for mesh in link(tree, name).iter("mesh"):
        scale = [float(part) for part in (mesh.get("scale") or "1 1 1").split()]
        mesh.set("scale", " ".join(str(1000 * part) for part in scale))


def overlapping(tree, name, shift):
    """A link's collision moved by so much in its own frame."""
    for collision in link(tree, name).findall("collision"):
        origin = collision.find("origin")
        if origin is None:
            origin = ElementTree.SubElement(collision, "origin")
        xyz = [float(part) for part in (origin.get("xyz") or "0 0 0").split()]
        moved = " ".join(str(a + b) for a, b in zip(xyz, shift, strict=True))
        origin.set("xyz", moved)


def no_friction(tree):
    root = tree.getroot()
    for part in root.findall("link"):
        for block in [b for b in root.findall("gazebo") if b.get("reference") == part.get("name")]:
            for word in ("mu1", "mu2"):
                for element in block.findall(word):
                    block.remove(element)
        block = ElementTree.SubElement(root, "gazebo", reference=part.get("name"))
        for word in ("mu1", "mu2"):
            ElementTree.SubElement(block, word).text = "0"


def no_inertia(tree, name):
    part = link(tree, name)
    for inertial in part.findall("inertial"):
        part.remove(inertial)


def collision_in_millimeters(tree, name):
    """The collision of a link as a box of its numbers in millimetres."""
    for geometry in link(tree, name).iterfind("collision/geometry"):
        for shape in list(geometry):
            geometry.remove(shape)
        ElementTree.SubElement(geometry, "box", size="300 200 100")


def absolute(tree, source):
    """Name meshes by their paths, so that the file can lie elsewhere."""
    robot = load(source)
    for mesh in tree.iter("mesh"):
        mesh.set("filename", str(robot.source.resolve(mesh.get("filename"))))


def into_neighbour(path, name, part=1.0):
    """By how much a collision moves in its link's frame to the middle of that of the link above.

    The robot is at the start of a simulation.

    Args:
        path: The robot.
        name: The link.
        part: Of the way to there.
    """
    robot = load(path)
    bodies = prepare(robot, choose_start(robot, Settings())[0])
    poses = link_poses(robot, bodies.positions)
    number = next(n for n, body in enumerate(bodies.bodies) if name in body.links)
    above = bodies.bodies[number].parent
    while not bodies.bodies[above].shapes:
        above = bodies.bodies[above].parent
    there = _middle(bodies.bodies[above], poses)
    here = _middle(bodies.bodies[number], poses, name)
    turn = np.array(poses[name].rotation)
    return tuple((part * turn.T @ (there - here)).tolist())


def _middle(body, poses, link=None):
    """The middle of the largest shape of a body, or of one of its links, in the world."""
    boxes = [shape.get_bounds() for shape in body.shapes if link in (None, shape.link)]
    low, high = max(boxes, key=lambda box: np.prod(box[1] - box[0]))
    return np.array(poses[body.name].transform(tuple(((low + high) / 2).tolist())))
