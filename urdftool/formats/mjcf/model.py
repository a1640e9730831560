"""Assembly of the model file from its sections."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

from lxml import etree

from ...diagnostic import Severity
from ...model.elements import Robot
from ...model.mujoco_values import READER_SETTINGS, SECTIONS, describe_required_setting
from ...model.numbers import format_numbers_text, number_text
from ...model.pose import Pose, quaternion_from_rotation
from ...model.world_settings import OF_MUJOCO
from ...source.document import Element
from ..common.naming import UniqueNames
from ..written import Written
from .actuator import build_actuator_section
from .body import build_body_tree, fill_bodies
from .contact import build_contact_section
from .copied import has_copied_actuators
from .defaults import build_default_section
from .document import assemble, report_losses
from .equality import build_equality_section
from .frame import simplify_quaternion
from .fuse import fuse_links
from .gazebo import get_attributes, report_gazebo_losses
from .home import Home
from .home_contacts import exclude_overlapping
from .joint import PLANAR_SUFFIXES
from .material import Materials
from .meshes import Assets
from .mounted import put_mounted
from .native import add_native
from .options import Options
from .plan import Plan
from .sensor import build_sensor_section
from .source_frames import join_bodies, restore_frames
from .structure import WORLD, Structure


def build_model_text(plan: Plan, assets: Assets, written: Written) -> bytes:
    """Build the model as XML."""
    structure, options, robot = plan.structure, plan.options, plan.robot
    _rename_world(structure, written)
    materials = Materials(robot, written, options.mesh_dir)
    world, bodies = build_body_tree(structure, plan.home, plan.name, written)
    fill_bodies(structure, bodies, plan.masses, assets, materials, written)
    join_bodies(structure, bodies)
    put_mounted(robot, bodies)
    sections: dict[str, etree._Element] = {
        "compiler": _build_compiler(options, assets, materials),
        "option": _build_option(robot),
        "worldbody": world,
    }
    actuators = build_actuator_section(robot)
    _summarize(structure, options, len(robot.joint_actuators), written)
    _put(
        sections,
        build_contact_section(structure, options.proofs),
        build_equality_section(structure, written),
        actuators,
        build_sensor_section(robot),
        build_keyframe_section(structure, plan.home),
        _build_custom(structure, plan.name),
    )
    exclude_overlapping(structure, plan.home.positions, sections, bodies, assets, options, written)
    report_gazebo_losses(robot, written)
    _report_controller_losses(robot, written)
    apply_extension(robot, sections, written)
    restore_frames(robot, bodies, sections)
    create_share_colors(world, materials.elements)
    shared = None if has_copied_actuators(robot, options) else actuators
    sections["default"] = build_default_section(plan.name, world, shared)
    sections["asset"] = _build_asset(assets, materials)
    if options.fuse:
        fuse_links(structure, bodies, sections, plan.masses, written)
    add_native(structure, options, sections, written)
    report_losses(written.losses, bodies)
    return assemble(plan.name, sections)


def _summarize(structure: Structure, options: Options, actuators: int, written: Written) -> None:
    """Summarize base and actuators, which are easily overlooked in a model."""
    held = "free" if structure.free else "fixed"
    written.summary.append(f"{held} base ({structure.reason})")
    count = "1 actuator" if actuators == 1 else f"{actuators} actuators"
    is_assumed = any(loss.code == "lossy-gains" for loss in written.losses)
    written.summary.append(f"{count} with assumed gains" if is_assumed else count)
    moves = any(structure.is_single(joint) for joint in structure.moving)
    if moves and not actuators and options.actuators in ("auto", "described"):
        written.advice.append(
            "the model has no actuators, as the source describes; --actuators position adds servos"
        )


def _rename_world(structure: Structure, written: Written) -> None:
    new = structure.get_body_name(WORLD)
    if new == WORLD or WORLD not in structure.robot.link:
        return
    written.renamed["link", WORLD] = new
    written.report_loss(
        "name",
        f"link '{WORLD}' is not the root, and MuJoCo reserves its name; its body is named '{new}'",
        structure.robot.link[WORLD].place,
        kind="link",
        name=WORLD,
    )


def _put(sections: dict[str, etree._Element], *made: etree._Element | None) -> None:
    for section in made:
        if section is not None:
            sections[section.tag] = section


def _build_option(robot: Robot) -> etree._Element:
    """Build ``<option>`` with the settings of the world."""
    option = etree.Element("option")
    attributes = get_attributes(robot.world, OF_MUJOCO)
    for state in ("disable", "enable"):
        words = attributes.pop(f"{state}flags", "")
        if words:
            found = option.find("flag")
            flag = etree.SubElement(option, "flag") if found is None else found
            _set_all(flag, dict.fromkeys(words.split(), state))
    _set_all(option, attributes)
    return option


def _set_all(element: etree._Element, attributes: Mapping[str, str]) -> None:
    for name, value in attributes.items():
        element.set(name, value)


def _build_compiler(options: Options, assets: Assets, materials: Materials) -> etree._Element:
    compiler = etree.Element("compiler", angle="radian")
    if assets.elements and options.mesh_dir:
        compiler.set("meshdir", options.mesh_dir)
    if materials.has_textures and options.mesh_dir:
        compiler.set("texturedir", options.mesh_dir)
    compiler.set("autolimits", "true")
    compiler.set("inertiafromgeom", "false")
    return compiler


def _build_asset(assets: Assets, materials: Materials) -> etree._Element:
    section = etree.Element("asset")
    textures = [element for element in materials.elements if element.tag == "texture"]
    section.extend(textures)
    section.extend(element for element in materials.elements if element.tag == "material")
    section.extend(assets.elements)
    return section


def _build_custom(structure: Structure, name: str) -> etree._Element | None:
    """Build ``<custom>`` for data without an MJCF element: velocity limits, a changed name."""
    section = etree.Element("custom")
    if structure.robot.name and structure.robot.name != name:
        etree.SubElement(section, "text", name="robot_name", data=structure.robot.name)
    for joint in structure.moving:
        velocity = joint.get_magnitude("velocity")
        if velocity is not None and structure.is_single(joint):
            own = f"{joint.name}_velocity_limit"
            etree.SubElement(section, "numeric", name=own, data=number_text(velocity))
    return section if len(section) else None


def _report_controller_losses(robot: Robot, written: Written) -> None:
    for joint in robot.joints:
        for part, what in (
            (joint.safety_controller, "safety_controller"),
            (joint.calibration, "calibration"),
        ):
            if part is not None:
                written.report_loss(
                    what.replace("_", "-"),
                    f"<{what}> of joint '{joint.name}' belongs to a controller and is not exported",
                    part.place,
                    kind="joint",
                    name=joint.name,
                    severity=Severity.INFO,
                )


PLAIN: dict[tuple[float, ...], str] = {
    (0, 0, 0): "black",
    (1, 1, 1): "white",
    (1, 0, 0): "red",
    (0, 1, 0): "green",
    (0, 0, 1): "blue",
    (1, 1, 0): "yellow",
    (0, 1, 1): "cyan",
    (1, 0, 1): "magenta",
}


def create_share_colors(world: etree._Element, materials: list[etree._Element]) -> None:
    """Create a material for each color of two or more visual geoms."""
    geoms = [g for g in world.iter("geom") if g.get("class") == "visual" and g.get("rgba")]
    counts = Counter(geom.get("rgba", "") for geom in geoms)
    names = UniqueNames(tuple(m.get("name", "") for m in materials if m.tag == "material"))
    named: dict[str, str] = {}
    for geom in geoms:
        rgba = geom.get("rgba", "")
        if counts[rgba] < 2:
            continue
        if rgba not in named:
            named[rgba] = names.take(color_name(rgba))
            materials.append(etree.Element("material", name=named[rgba], rgba=rgba))
        del geom.attrib["rgba"]
        geom.set("material", named[rgba])


def color_name(rgba: str) -> str:
    """Name a color: a plain word, the percentage of a gray, or its hexadecimal digits."""
    red, green, blue, alpha = (min(max(float(part), 0.0), 1.0) for part in rgba.split())
    name = PLAIN.get((red, green, blue))
    if name is None and red == green == blue:
        name = f"gray{round(100 * red)}"
    if name is None:
        name = "color_" + "".join(f"{round(255 * part):02x}" for part in (red, green, blue))
    return name if alpha == 1 else f"{name}_alpha{round(100 * alpha)}"


def build_keyframe_section(structure: Structure, home: Home) -> etree._Element:
    """Build ``<keyframe>`` with the key ``home``, whose controls hold the joints in place."""
    section = etree.Element("keyframe")
    key = etree.SubElement(section, "key", name="home")
    qpos = _get_positions(structure, home)
    if qpos:
        key.set("qpos", format_numbers_text(qpos))
    actuators = structure.robot.joint_actuators
    if actuators:
        key.set(
            "ctrl",
            format_numbers_text(
                home.positions.get(one.joint, 0.0) if one.mode == "position" else 0.0
                for one in actuators
            ),
        )
    return section


def _get_positions(structure: Structure, home: Home) -> list[float]:
    """Return ``qpos`` in MuJoCo's order: nested free bodies come after the root's tree."""
    first = _collect_free(home.pose) if structure.free else []
    later: list[float] = []
    torn: set[str] = set()
    for joint in structure.moving:
        kind = structure.get_kind(joint)
        if kind == "free":
            values = _collect_free(home.floating[joint.name])
        elif kind == "ball":
            values = [1.0, 0.0, 0.0, 0.0]
        elif kind == "planar":
            values = [0.0] * len(PLANAR_SUFFIXES)
        else:
            values = [home.positions.get(joint.name, 0.0)]
        nested = joint.parent in torn
        if (kind == "free" and not structure.in_world) or nested:
            torn.update((joint.child, *structure.robot.tree.list_descendants(joint.child)))
            later += values
        else:
            first += values
    return first + later


def _collect_free(pose: Pose) -> list[float]:
    turn = simplify_quaternion(quaternion_from_rotation(pose.rotation)) or (1.0, 0.0, 0.0, 0.0)
    return [*pose.translation, *turn]


def apply_extension(robot: Robot, sections: dict[str, etree._Element], written: Written) -> None:
    """Copy ``<compiler>``, ``<option>`` and other known elements to the sections, by name."""
    for extension in () if robot.xml is None else robot.xml.list_children("mujoco"):
        for child in extension.children:
            if child.tag == "compiler":
                _add_compiler(child, sections, written)
            elif child.tag in SECTIONS:
                target = sections.setdefault(child.tag, etree.Element(child.tag))
                _merge(child, target)
            else:
                written.report_loss(
                    "mujoco",
                    f"<{child.tag}> in <mujoco> is not exported; only compiler, "
                    + ", ".join(SECTIONS),
                    child.place,
                    kind="mujoco",
                    name=child.tag,
                )


def _add_compiler(element: Element, sections: dict[str, etree._Element], written: Written) -> None:
    for name, value in element.attributes.items():
        if name not in READER_SETTINGS:
            if not describe_required_setting(element, name):
                sections["compiler"].set(name, value)
            continue
        changes = name in ("balanceinertia", "boundmass", "boundinertia", "settotalmass")
        written.report_loss(
            "mujoco",
            f"{name}={value!r} of <compiler> is not exported: it "
            + ("changes the robot" if changes else "controls how MuJoCo reads URDF"),
            element.locate_attribute(name),
            kind="mujoco",
            name=name,
            severity=Severity.WARNING if changes and value != "false" else Severity.INFO,
        )


def _merge(element: Element, target: etree._Element) -> None:
    for name, value in element.attributes.items():
        if not describe_required_setting(element, name):
            target.set(name, value)
    for child in element.children:
        found = target.find(child.tag)
        _merge(child, etree.SubElement(target, child.tag) if found is None else found)
