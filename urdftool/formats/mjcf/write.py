"""A robot as MJCF: every section, the meshes, and what was lost."""

from __future__ import annotations

from pathlib import Path

from lxml import etree

from ...finding import Finding, Severity
from ...model.elements import Mesh, Robot
from ..defects import FATAL, defect, defects, refuse
from ..directory import mark
from ..numbers import number_text
from ..written import Written
from .actuator import actuator_section
from .body import body_tree, fill_bodies
from .colors import share_colors
from .contact import contact_section
from .defaults import default_section
from .document import assemble, note_losses
from .equality import equality_section
from .extension import apply_extension
from .gazebo import gazebo_defects, gazebo_losses
from .geom import shape_size
from .inertials import inertials
from .keyframe import keyframe_section
from .light import put_lights
from .material import Materials
from .meshes import Assets, mesh_assets
from .names import file_name
from .options import Options
from .scene import scene_file
from .sensor import sensor_section
from .srdf import read_srdf
from .structure import Structure, structure_of


def write(robot: Robot, options: Options | None = None) -> Written:
    """The MJCF of a robot.

    Args:
        robot: The robot.
        options: The choices; without them those of the command line's defaults.

    Returns:
        The model, its meshes and its scene, with every loss.

    Raises:
        Refused: The robot has defects that forbid it; all are in the error.
        SourceError: The SRDF cannot be read.
    """
    options = options or Options()
    model = model_name(robot)
    written = Written(options.file or f"{model}.xml")
    found = [*defects(robot), *gazebo_defects(robot), *_shape_defects(robot)]
    if any(finding.rule in FATAL for finding in found):
        refuse(found, force=options.force)
    packages = robot.source.packages if robot.source is not None else None
    srdf = read_srdf(options.srdf, robot, written, packages) if options.srdf else None
    structure = structure_of(robot, options.base, srdf.virtual_joint if srdf else None)
    masses, wrong = inertials(structure, options.fix_inertia, written, force=options.force)
    assets, missing = mesh_assets(robot, written, options.mesh_dir)
    refuse([*found, *wrong, *missing], force=options.force)
    for finding in (*found, *wrong, *missing):
        written.losses.append(finding)

    materials = Materials(robot, written, options.mesh_dir)
    world, bodies = body_tree(structure, model, written)
    fill_bodies(structure, bodies, masses, assets, materials, written)
    put_lights(robot, bodies, written)
    sections: dict[str, etree._Element] = {
        "compiler": _compiler(options, assets, materials),
        "option": etree.Element("option", integrator="implicitfast"),
        "worldbody": world,
    }
    actuators, drives = actuator_section(structure, options.actuators, written)
    _put(
        sections,
        contact_section(structure, bodies, srdf),
        equality_section(structure, written),
        actuators,
        sensor_section(robot, bodies, written),
        keyframe_section(structure, drives),
        _custom(structure),
    )
    gazebo_losses(robot, written)
    _other_losses(robot, written)
    apply_extension(robot, sections, written)
    share_colors(world, materials.elements)
    sections["default"] = default_section(model, world)
    sections["asset"] = _asset(assets, materials)
    note_losses(written.losses, bodies)
    source = Path(robot.source.path).name if robot.source is not None else "a robot"
    text = assemble(model, sections, [])
    files: dict[str, bytes | Path] = {written.main: mark(text, source)}
    if options.scene:
        name = f"{Path(options.file).stem}_scene.xml" if options.file else "scene.xml"
        files[name] = mark(scene_file(structure, model, written.main), source)
    files.update(sorted(written.files.items()))
    written.files = files
    return written


def model_name(robot: Robot) -> str:
    """The name of the model and its file: the robot's, or that of the description."""
    name = robot.name
    if not name and robot.source is not None:
        name = Path(robot.source.path).name.partition(".")[0]
    name = file_name(name)
    return f"{name}_robot" if name in ("main", "visual", "collision", "world", "scene") else name


def _put(sections: dict[str, etree._Element], *made: etree._Element | None) -> None:
    for section in made:
        if section is not None:
            sections[section.tag] = section


def _compiler(options: Options, assets: Assets, materials: Materials) -> etree._Element:
    compiler = etree.Element("compiler", angle="radian")
    if assets.elements and options.mesh_dir:
        compiler.set("meshdir", options.mesh_dir)
    if materials.has_textures and options.mesh_dir:
        compiler.set("texturedir", options.mesh_dir)
    compiler.set("autolimits", "true")
    compiler.set("inertiafromgeom", "false")
    return compiler


def _asset(assets: Assets, materials: Materials) -> etree._Element:
    section = etree.Element("asset")
    textures = [element for element in materials.elements if element.tag == "texture"]
    section.extend(textures)
    section.extend(element for element in materials.elements if element.tag == "material")
    section.extend(assets.elements)
    return section


def _custom(structure: Structure) -> etree._Element | None:
    """The velocity limits [rad/s or m/s], which MuJoCo has no place for."""
    section = etree.Element("custom")
    for joint in structure.moving:
        velocity = joint.limit.velocity if joint.limit is not None else None
        if velocity is not None and structure.kind(joint) in ("hinge", "slide"):
            name = f"{joint.name}_velocity_limit"
            etree.SubElement(section, "numeric", name=name, data=number_text(abs(velocity)))
    return section if len(section) else None


def _shape_defects(robot: Robot) -> list[Finding]:
    """Visuals and collisions without a geometry, or with one that nobody knows."""
    found = []
    for link, shape in robot.shapes:
        what = shape.element.tag
        if shape.geometry is None:
            text = f"a {what} of link '{link.name}' has no geometry"
            found.append(defect("missing-geometry", text, shape.place, "link", link.name))
        elif not isinstance(shape.geometry, Mesh) and shape_size(shape.geometry) is None:
            text = (
                f"a {what} of link '{link.name}' is a <{shape.geometry.element.tag}>; the shapes "
                "are box, cylinder, sphere, capsule and mesh"
            )
            place = shape.geometry.place
            found.append(defect("unknown-geometry", text, place, "link", link.name))
    return found


def _other_losses(robot: Robot, written: Written) -> None:
    for joint in robot.joints:
        for part, what in (
            (joint.safety_controller, "safety_controller"),
            (joint.calibration, "calibration"),
        ):
            if part is not None:
                written.lose(
                    what.replace("_", "-"),
                    f"<{what}> of joint '{joint.name}' belongs to a controller and is not carried",
                    part.place,
                    kind="joint",
                    name=joint.name,
                    severity=Severity.INFO,
                )
