"""Export of a robot to SDF: files and losses."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import PurePath

from lxml import etree

from ...diagnostic import Severity
from ...finding import Finding
from ...lint.validate import validate
from ...mechanics.spatial_inertia import link_inertia
from ...mechanics.tensor import WRITTEN_ROUNDING, get_excess
from ...model.elements import Link, Mesh, Robot
from ...model.mechanism import Base
from ...model.start import start_positions
from ...model.world import WORLD, weld_base
from ..common.base import decide_base
from ..common.directory import mark
from ..common.force_fallbacks import (
    FATAL,
    drop_invalid_parts,
    report_orphaned_sensors,
    report_passed_defects,
    report_tree_defects,
)
from ..common.missing_files import create_missing_mesh
from ..common.rigid_tree import group_rigid_links
from ..common.shape_box import ShapeBoxes
from ..defects import FATAL as STRUCTURAL
from ..defects import Refused, make_defect, refuse
from ..written import Written
from .joint_settings import choose_joint_settings
from .mesh_files import MeshFiles, find_meshes
from .model import add_model
from .names import get_model_name, make_names
from .native import report_uncopied
from .options import MODEL, ChosenBase, Options
from .plan import Plan, make_plan
from .start import place_on_ground, report_start
from .translation import Translation
from .world import add_world
from .xml import Node, add, serialize_document

WORLD_FILE = "world.sdf"
NAMES_FILE = "names.json"


def write(robot: Robot, options: Options | None = None) -> Written:
    """Convert a robot to SDF, without options with the defaults of gz.

    Raises:
        Refused: The robot has defects that prevent the export; the error lists them.
        ConfigError: The actuator file is invalid.
    """
    options = options or Options()
    if robot.links and all(link.name == WORLD for link in robot.links):
        text = "the robot has no link except the world, and a model of SDF requires one"
        raise Refused([make_defect("no-links", text, robot.place, "robot", robot.name)])
    left = drop_invalid_parts(robot)
    found = [*report_tree_defects(robot, left, options.force), *validate(robot, "export:sdf")]
    if options.force:
        robot = left
    meshes = find_meshes(robot, options)
    found += report_mesh_defects(robot, meshes)
    if any(finding.code in FATAL | STRUCTURAL for finding in found):
        refuse(found, force=options.force, fatal=FATAL)
    decided = Written(options.file or MODEL)
    boxes = ShapeBoxes(robot)
    robot = apply_base(robot, boxes, options.base, decided)
    plan = make_plan(robot, lump=options.lump)
    if options.fix_inertia == "none":
        found += report_inertia_defects(robot, plan)
    refuse(found, force=options.force, fatal=FATAL)
    names = make_names(robot, anchored=plan.anchored)
    written = Written(options.file or MODEL, renamed=names.renamed)
    written.losses += decided.losses
    written.summary += decided.summary
    report_uncopied(robot, options, written)
    settings = choose_joint_settings(robot, options, written)
    t = Translation(robot, options, plan, names, meshes, written, settings)
    root = _build_root(options)
    node = add_model(root, t)
    _report_names(t)
    report_passed_defects(written, found)
    report_orphaned_sensors(robot, written)
    height = report_start(robot, boxes, options, written)
    _add_files(t, root, node, height)
    return written


def _build_root(options: Options) -> Node:
    return etree.Element("sdf", version=options.sdf_version)


def _add_files(t: Translation, root: Node, node: Node, height: float) -> None:
    options, files = t.options, t.written.files
    source = PurePath(t.robot.source.path).name if t.robot.source is not None else "a robot"
    if options.file and options.world:
        place_on_ground(node, height)
        add_world(root, t, node)
    files[t.written.main] = mark(serialize_document(root), source)
    if not options.file:
        files["model.config"] = mark(write_config(get_model_name(t.robot), options), source)
        if options.world:
            around = _build_root(options)
            place_on_ground(node, height)
            add_world(around, t, node)
            files[WORLD_FILE] = mark(serialize_document(around), source)
    if t.written.renamed:
        name = NAMES_FILE if not options.file else f"{options.file.rpartition('.')[0]}.{NAMES_FILE}"
        files[name] = _create_sidecar(t)
    for name, content in t.meshes.files.items():
        files.setdefault(name, content)  # a mesh must not replace the model
    for name, text in t.meshes.scripts.items():
        files[name] = b"// " + mark(text, source)


def _create_sidecar(t: Translation) -> bytes:
    """Create ``names.json``, which maps original names to exported names."""
    kinds: dict[str, dict[str, str]] = {"link": {}, "joint": {}}
    for (kind, old), new in t.written.renamed.items():
        kinds[kind][old] = new
    text = json.dumps({"version": 1, "links": kinds["link"], "joints": kinds["joint"]}, indent=2)
    return f"{text}\n".encode()


def _report_names(t: Translation) -> None:
    for (kind, old), new in t.written.renamed.items():
        part = t.robot.link[old] if kind == "link" else t.robot.joint[old]
        both = old in t.robot.link and old in t.robot.joint
        why = "a joint has that name too" if both else "SDF does not allow the name"
        text = f"{kind} '{old}' is '{new}' in SDF, since {why}"
        t.report_loss("name", text, part, part)


def write_config(name: str, options: Options) -> bytes:
    """Write the file."""
    root = etree.Element("model")
    add(root, "name", name)
    add(root, "version", "1.0")
    add(root, "sdf", MODEL, version=options.sdf_version)
    author = add(root, "author")
    add(author, "name", "urdftool")
    add(root, "description", f"{name}, exported from its URDF")
    return serialize_document(root)


def report_mesh_defects(robot: Robot, meshes: MeshFiles) -> Iterator[Finding]:
    """Report meshes that are missing or cannot be read, each once."""
    seen = set()
    for link, shape in robot.shapes:
        mesh = shape.geometry
        if isinstance(mesh, Mesh) and not meshes.is_known(mesh) and mesh.filename not in seen:
            seen.add(mesh.filename)
            refused = meshes.refused.get(mesh.filename)
            if not refused:
                yield create_missing_mesh(robot, link, mesh)
                continue
            text = f"mesh '{mesh.filename}' of link '{link.name}' cannot be used: {refused}"
            place = mesh.locate_attribute("filename")
            yield make_defect("corrupt-mesh", text, place, "link", link.name)


def report_inertia_defects(robot: Robot, plan: Plan) -> Iterator[Finding]:
    """Report bodies whose inertia is physically inconsistent, with all that is lumped into them."""
    for owner, mass in plan.mass.items():
        short = get_excess(mass.tensor, mass.mass)
        if mass.mass <= 0 or short <= WRITTEN_ROUNDING:
            continue
        members = [robot.link[name] for name in plan.members[owner]]
        worst = max(members, key=_compute_own_shortfall)
        inertia = worst.inertial and (worst.inertial.inertia or worst.inertial)
        yield make_defect(
            "inertia-triangle-inequality",
            f"inertia of link '{worst.name}' is physically inconsistent: its largest principal "
            f"moment exceeds the sum of the others by {short:.0%}",
            (inertia or worst).place,
            "link",
            worst.name,
            "--fix-inertia lift, balance or box changes it",
            {"excess": short},
        )


def _compute_own_shortfall(link: Link) -> float:
    body = link_inertia(link)
    return get_excess(body.tensor, body.mass)


def apply_base(robot: Robot, boxes: ShapeBoxes, base: ChosenBase, written: Written) -> Robot:
    """Return the robot with a joint to the world if its base is fixed by ``base``.

    ``auto`` decides as exports to MJCF and USD do, from the boxes of the robot's shapes; a robot
    without a joint that moves is an object, and stays free.
    """
    roots = robot.tree.roots
    if base == "" or base == "free" or len(roots) != 1 or roots[0].name == WORLD:
        return robot
    if base == "auto" and not robot.moving_joints:
        return robot
    tree = group_rigid_links(robot, lambda joint: not joint.is_fixed)
    home, _ = start_positions(robot)
    is_free, reason = decide_base(tree, base, None, boxes, home, written)
    if is_free:
        return robot
    written.report_loss(
        "welded-base",
        f"root link '{roots[0].name}' is fixed to the world: {reason}",
        roots[0].place,
        kind="link",
        name=roots[0].name,
        severity=Severity.INFO,
    )
    written.summary.append(f"fixed base ({reason})")
    origin = None if robot.base is None else robot.base.origin  # that of a URDF is the model's
    return weld_base(replace(robot, base=Base(robot.provenance, False, origin)))
