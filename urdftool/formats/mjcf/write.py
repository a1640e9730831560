"""Export of a robot to MJCF: model, meshes, scene and losses."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from ...diagnostic import Severity
from ...errors import SourceError
from ...finding import Finding
from ...lint.validate import validate
from ...model.elements import Robot
from ...model.world_settings import OF_MUJOCO
from ...source.document import parse, read_file
from ...source.packages import find_own_package, shorten_path
from ..common.directory import mark
from ..common.naming import replace_file_name, shorten_file_name
from ..common.unexpressed import report_looks, report_unexpressed
from ..defects import FATAL, make_defect, refuse, report_defects, report_size, report_taken_world
from ..written import Written
from .copied import get_described_home, has_copies, list_uncopied
from .meshes import create_mesh_assets
from .model import build_model_text
from .options import Options
from .plan import convert_parts, make_plan
from .read_extras import REFERENCE
from .scene import create_scene_file
from .structure import Structure

_NOISE = re.compile(r"(?:[\s_.-]+(?:urdf|xacro|sldasm|v\d+(?:[._]\d+)*))+\s*$", re.IGNORECASE)

EXPRESSED = (
    *("base", "joint-spring", "joint-armature", "setting", "joint-actuator", "exclusion"),
    *("camera", "sensor", "closure", "light", "frame", "ball-limit", "mujoco"),
)
"""Codes of parts of other formats that an export writes, or reports itself."""

MAX_DEPTH = 490
"""Maximum nesting of bodies: MuJoCo's XML reader stops at 500 elements."""


def write(robot: Robot, options: Options | None = None) -> Written:
    """Convert a robot to MJCF, without options with the defaults of the command line.

    Returns:
        The model, its meshes and its scene, with every loss.

    Raises:
        Refused: The robot has defects that prevent the export; the error lists all of them.
        SourceError: The SRDF cannot be read.
        ConfigError: The SRDF has no such group state, or the actuator file is invalid.
        ModelError: The robot has no such joint, or it mimics another.
    """
    options = options or Options()
    robot, world = report_taken_world(robot)
    model = get_model_name(robot)
    written = Written(options.file or f"{shorten_file_name(model)}.xml")
    _report_unexpressed(robot, options, written)
    report_looks(robot, written)
    written.losses += world if options.force else []
    found = [
        *([] if options.force else world),
        *report_defects(robot),
        *validate(robot, "export:mjcf"),
        *report_size(robot, "MJCF"),
    ]
    if any(finding.code in FATAL for finding in found):
        refuse(found, force=options.force)
    if options.srdf is None:
        offer_srdf(robot, written)
    plan = make_plan(robot, model, options, written)
    found += _find_too_deep(plan.structure)
    assets, missing = create_mesh_assets(robot, written, options)
    found += [*plan.wrong, *missing]
    refuse(found, force=options.force)
    written.losses += found
    text = build_model_text(plan, assets, written)
    written.planned = convert_parts(plan)
    source = Path(robot.source.path).name if robot.source is not None else "a robot"
    files: dict[str, bytes | Path] = {written.main: mark(text, source)}
    if options.scene:
        name = f"{Path(options.file).stem}_scene.xml" if options.file else "scene.xml"
        files[name] = mark(create_scene_file(plan, text, written), source)
    files.update(sorted(written.files.items()))
    written.files = files
    return written


def _report_unexpressed(robot: Robot, options: Options, written: Written) -> None:
    """Report what the reader left out and no element of the export has."""
    kept = [REFERENCE, "home"] if get_described_home(robot, options) else [REFERENCE]
    states = () if has_copies(robot, "keyframe") else robot.configurations
    left = [one for one in states if one.name not in kept]
    copied = {row.name for row in OF_MUJOCO}
    world = {name: value for name, value in robot.world.items() if name not in copied}
    unread = tuple(list_uncopied(robot, robot.unread))
    rest = replace(robot, unread=unread, configurations=left, world=world)
    report_unexpressed(rest, written, expressed=EXPRESSED)


def get_model_name(robot: Robot) -> str:
    """Return the name of the model and its file: the robot's, or that of the description's file.

    Blanks, and suffixes for a version or file type, are removed.
    """
    name = _NOISE.sub("", robot.name)
    if not name and robot.source is not None:
        name = Path(robot.source.path).name.partition(".")[0]
    name = replace_file_name(name)
    return f"{name}_robot" if name in ("main", "visual", "collision", "world", "scene") else name


def _find_too_deep(structure: Structure) -> list[Finding]:
    """Find the first link that is nested too deeply for MuJoCo's XML reader.

    No rule reports it: other readers have no such limit, and it counts the bodies of this export.
    """
    for link, depth in structure.depth.items():
        if depth > MAX_DEPTH:
            text = f"link '{link}' is below {depth} others; MuJoCo reads at most {MAX_DEPTH}"
            return [make_defect("too-deep", text, structure.robot.link[link].place, "link", link)]
    return []


def offer_srdf(robot: Robot, written: Written) -> None:
    """Report the SRDF files of a robot next to it or in its MoveIt configuration."""
    found = find_srdf_files(robot)
    if found:
        names = " or ".join(shorten_path(path) for path in found)
        written.report_loss(
            "srdf-not-used",
            f"robot '{robot.name}' has an SRDF, which is not used: --srdf {names} takes over its "
            "disabled collisions, group states and virtual joint",
            robot.place,
            severity=Severity.INFO,
        )


def find_srdf_files(robot: Robot) -> list[Path]:
    """Find the SRDF files whose robot has the same name.

    The search covers the folder of the description, and ``config`` of a package ``…_moveit_config``
    next to the package of the description or inside it.
    """
    if robot.source is None or robot.source.path == "-":
        return []
    path = Path(robot.source.path).absolute()
    return [file for file in dict.fromkeys(_list_candidates(path)) if _is_of(file, robot)]


def _list_candidates(path: Path) -> Iterator[Path]:
    yield from sorted(path.parent.glob("*.srdf"))
    own = find_own_package(path)
    if own is None:
        return
    yield from sorted(own[1].glob("srdf/*.srdf"))
    yield from sorted(own[1].glob("config/*.srdf"))
    for folder in (own[1], own[1].parent):
        yield from sorted(folder.glob("*_moveit_config/config/*.srdf"))


def _is_of(file: Path, robot: Robot) -> bool:
    try:
        workspace = None if robot.source is None else robot.source.workspace
        root = parse(read_file(shorten_path(file), workspace)).root
    except SourceError:
        return False
    return root.tag == "robot" and root.get("name") == robot.name
