"""What keeps a robot from leaving as SDF, beside what keeps it from leaving at all."""

from __future__ import annotations

from collections.abc import Iterator

from ...finding import Finding
from ...lint.validate import validate
from ...mechanics.spatial_inertia import link_inertia
from ...model.elements import Joint, Link, Mesh, Robot
from ...model.read import numbers
from ...source.document import Element
from ..common.gazebo_blocks import read_value, value_of
from ..common.missing_files import missing_mesh
from ..defects import defect
from .block_numbers import wanted
from .extensions import block_elements
from .keywords import COLLISION_KEYWORDS, JOINT_KEYWORDS, LINK_KEYWORDS
from .mesh_files import MeshFiles
from .plan import ROUNDING, Plan, excess_of
from .sensor_types import KNOWN

_WANTED = {
    "number": "a finite number",
    "count": "a whole number",
    "vector": "three finite numbers",
    "flag": "true or false",
}


def written_defects(robot: Robot) -> Iterator[Finding]:
    """Defects that can be seen without the files that the robot names."""
    yield from validate(robot, "export:sdf")
    for link in robot.links:
        yield from _inertial(link)
        yield from _extension(robot, link)
    for joint in robot.joints:
        yield from _joint(robot, joint)
        yield from _extension(robot, joint)
    yield from _origin(robot)
    yield from _kinds(robot)
    for block in robot.gazebo:
        yield from _blocks(block.element, block.reference or "")


def mesh_defects(robot: Robot, meshes: MeshFiles) -> Iterator[Finding]:
    """Meshes that are not there, or are none, each once."""
    seen = set()
    for link, shape in robot.shapes:
        mesh = shape.geometry
        if isinstance(mesh, Mesh) and not meshes.known(mesh) and mesh.filename not in seen:
            seen.add(mesh.filename)
            refused = meshes.refused.get(mesh.filename)
            if not refused:
                yield missing_mesh(robot, link, mesh)
                continue
            text = f"mesh '{mesh.filename}' of link '{link.name}' cannot be used: {refused}"
            place = mesh.element.attribute_place("filename")
            yield defect("corrupt-mesh", text, place, "link", link.name)


def inertia_defects(robot: Robot, plan: Plan) -> Iterator[Finding]:
    """Bodies whose inertia no rigid body has, also with what fixed joints add to them."""
    for owner, mass in plan.mass.items():
        short = excess_of(mass)
        if mass.mass <= 0 or short <= ROUNDING:
            continue
        members = [robot.link[name] for name in plan.members[owner]]
        worst = max(members, key=_own_shortfall)
        inertia = worst.inertial and (worst.inertial.inertia or worst.inertial)
        yield defect(
            "inertia-triangle-inequality",
            f"no rigid body has the inertia of link '{worst.name}': its largest principal moment "
            f"exceeds the sum of the others by {short:.0%} of itself",
            (inertia or worst).place,
            "link",
            worst.name,
            "--fix-inertia lift, balance or box changes it",
        )


def _own_shortfall(link: Link) -> float:
    return excess_of(link_inertia(link))


def _inertial(link: Link) -> Iterator[Finding]:
    inertial = link.inertial
    if inertial is None:
        return
    mass = inertial.element.child("mass")
    if mass is None or inertial.element.child("inertia") is None:
        what = "<mass>" if mass is None else "<inertia>"
        text = f"<inertial> of link '{link.name}' has no {what}"
        yield defect("incomplete-inertial", text, inertial.place, "link", link.name)
    if (inertial.mass or 0.0) < 0 and mass is not None:
        text = f"mass {inertial.mass:g} of link '{link.name}' is negative; write one above zero"
        yield defect("negative-mass", text, mass.attribute_place("value"), "link", link.name)


def _joint(robot: Robot, joint: Joint) -> Iterator[Finding]:
    leader = robot.joint.get(joint.mimic.joint) if joint.mimic else None
    if joint.mimic and leader is not None and leader.is_fixed:
        yield defect(
            "mimic-dof-mismatch",
            f"joint '{joint.name}' mimics '{leader.name}', which is fixed",
            joint.mimic.element.attribute_place("joint"),
            "joint",
            joint.name,
        )


def _extension(robot: Robot, part: Link | Joint) -> Iterator[Finding]:
    tables = {**COLLISION_KEYWORDS, **LINK_KEYWORDS} if isinstance(part, Link) else JOINT_KEYWORDS
    for element in block_elements(robot, part):
        keyword = tables.get(element.tag)
        text = value_of(element)
        if keyword is not None and read_value(keyword.holds, text) is None:
            yield defect(
                "bad-extension-number",
                f"<{element.tag}> of '{part.name}' is '{text}', not {_WANTED[keyword.holds]}",
                element.place,
                part.element.tag,
                part.name,
            )


def _origin(robot: Robot) -> Iterator[Finding]:
    """The pose of the robot itself, which only Gazebo reads."""
    origin = robot.element.child("origin")
    if origin is None:
        return
    for name in ("xyz", "rpy"):
        text = origin.get(name)
        if text is not None and numbers(text, 3) is None:
            message = f'{name}="{text}" of <origin> of the robot is not 3 finite numbers'
            yield defect("not-a-number", message, origin.attribute_place(name), "robot")


def _kinds(robot: Robot) -> Iterator[Finding]:
    """Sensors of types that no Gazebo has, and plugins that name no library."""
    for block in robot.gazebo:
        for sensor in block.sensors:
            if sensor.type not in KNOWN:
                text = (
                    f"sensor '{sensor.name}' is of type '{sensor.type}', which no version of "
                    "Gazebo has"
                )
                yield defect("unknown-sensor-type", text, sensor.place, "sensor", sensor.name)
    for plugin in robot.plugins:
        if not plugin.filename:
            text = f"plugin '{plugin.name}' has no library; write filename=\"…\""
            yield defect("plugin-without-filename", text, plugin.place, "plugin", plugin.name)


def _blocks(block: Element, reference: str) -> Iterator[Finding]:
    inside = {id(e) for plugin in block.walk() if plugin.tag == "plugin" for e in plugin.walk()}
    for element in block.walk():
        right = wanted(element) if id(element) not in inside else ""
        if right:
            parent = element.parent or block
            text = f"<{element.tag}> of <{parent.tag}> is '{element.text.strip()}', not {right}"
            yield defect("bad-extension-number", text, element.place, "gazebo", reference)
