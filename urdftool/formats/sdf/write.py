"""Export of a robot to SDF: files and losses."""

from __future__ import annotations

import json
from pathlib import PurePath

from lxml import etree

from ...lint.validate import validate
from ...model.elements import Robot
from ..common.directory import mark
from ..common.force_fallbacks import (
    FATAL,
    drop_invalid_parts,
    report_passed_defects,
    report_tree_defects,
)
from ..common.unexpressed import report_unexpressed
from ..defects import FATAL as STRUCTURAL
from ..defects import refuse
from ..written import Written
from .config import write_config
from .defects import report_inertia_defects, report_mesh_defects
from .joint_settings import choose_joint_settings
from .mesh_files import find_meshes
from .model import add_model
from .names import get_model_name, make_names
from .options import MODEL, Options
from .plan import make_plan
from .translation import Translation
from .world import add_world
from .xml import Node, serialize_document

WORLD_FILE = "world.sdf"
NAMES_FILE = "names.json"


def write(robot: Robot, options: Options | None = None) -> Written:
    """Convert a robot to SDF.

    Args:
        robot: The robot.
        options: Options of the export; None for the defaults of gz.

    Raises:
        Refused: The robot has defects that prevent the export; the error lists them.
        ConfigError: The actuator file is invalid.
    """
    options = options or Options()
    left = drop_invalid_parts(robot)
    found = [*report_tree_defects(robot, left, options.force), *validate(robot, "export:sdf")]
    if options.force:
        robot = left
    meshes = find_meshes(robot, options)
    found += report_mesh_defects(robot, meshes)
    if any(finding.code in FATAL | STRUCTURAL for finding in found):
        refuse(found, force=options.force, fatal=FATAL)
    plan = make_plan(robot, lump=options.lump)
    if options.fix_inertia == "none":
        found += report_inertia_defects(robot, plan)
    refuse(found, force=options.force, fatal=FATAL)
    names = make_names(robot, anchored=plan.anchored)
    written = Written(options.file or MODEL, renamed=names.renamed)
    report_unexpressed(robot, written)
    settings = choose_joint_settings(robot, options, written)
    t = Translation(robot, options, plan, names, meshes, written, settings)
    root = _build_root(options)
    node = add_model(root, t)
    _report_names(t)
    report_passed_defects(written, found)
    _add_files(t, root, node)
    return written


def _build_root(options: Options) -> Node:
    return etree.Element("sdf", version=options.sdf_version)


def _add_files(t: Translation, root: Node, node: Node) -> None:
    options, files = t.options, t.written.files
    source = PurePath(t.robot.source.path).name if t.robot.source is not None else "a robot"
    if options.file and options.world:
        add_world(root, t, node)
    files[t.written.main] = mark(serialize_document(root), source)
    if not options.file:
        files["model.config"] = mark(write_config(get_model_name(t.robot), options), source)
        if options.world:
            around = _build_root(options)
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
