"""Comparison of an exported robot with its source: the file is read back by the reader of SDF."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

from ....compare.check import Check
from ....compare.proof import Claims, prove
from ....compare.rows import ROWS as ROWS_OF_ROBOTS
from ....compare.rows import narrow_tolerances
from ....errors import UrdftoolError
from ....model.elements import Joint, Limit, Robot
from ....model.kinematics import MOVABLE
from ....model.load import read_again
from ....model.mechanism import MountedSensor, NativeElement
from ....model.native import AROUND
from ....model.sensors import get_kind
from ....model.settings import RESISTANCE
from ....model.world import WORLD, add_gazebo_base, weld_base
from ...common.actuator_config import JointSettings, read_actuator_config
from ...common.force_fallbacks import drop_invalid_parts
from ...written import Written
from ..options import Options
from ..read import read
from ..write import write
from .declared_losses import EXCUSES, list_added_bodies, list_dropped_parts, name_blocks
from .loader import run_loads
from .pair import Pair
from .world import compare_world

TOLERANCE = 1e-9
"""Largest difference that counts as equal: numbers are written with all digits; chosen, no source,
above the rounding errors of poses in other frames.
"""

_NOT_IN_SDF = ("actuators", "contact pairs", "configurations", "simulator data", "world")
"""Rows of what SDF does not have."""

ROWS = tuple(
    row for row in narrow_tolerances(ROWS_OF_ROBOTS, TOLERANCE) if row.name not in _NOT_IN_SDF
)
"""Rows of the robot."""

COMPARED_AS_ELEMENTS = tuple(
    f"unread-{tag}"
    for tag in (
        *("light", "projector", "particle_emitter", "battery", "audio_source", "plugin"),
        *("gripper", "element", "look"),
    )
)
"""Codes of what the reader does not hold as values; the row of other elements compares it."""


def verify(robot: Robot, written: Written, options: Options, output: str | Path) -> list[Check]:
    """Read an export back and compare it with its source."""
    place = Path(output) if options.file else Path(output) / written.main
    try:
        pair = read_pair(robot, written, place, options)
    except (ElementTree.ParseError, UrdftoolError, OSError, LookupError, ValueError) as error:
        return [Check("file", "can be read back", 0.0, differing=[f"{place}: {error}"])]
    checks = compare(pair)
    if options.world:
        checks.append(compare_world(pair))
    checks.append(_check_same_again(robot, written, options))
    loaded = run_loads(robot, options, place)
    return checks if loaded is None else [*checks, loaded]


def read_pair(robot: Robot, written: Written, place: Path, options: Options | None = None) -> Pair:
    """Read the source again, and the exported file.

    Raises:
        UrdftoolError: The file cannot be read back.
    """
    options = options or Options()
    source = _read_source(robot, options, written)
    packages = None if robot.source is None else robot.source.packages.make_finder_for(place)
    reading = read(place, packages=packages)
    losses = [
        *written.losses,
        *name_blocks(robot, written.losses),
        *list_dropped_parts(written.losses),
        *list_added_bodies(source),
    ]
    around = ("unread-world", "unread-model") if options.world else ()  # in the row of the world
    known = (*COMPARED_AS_ELEMENTS, *around)
    unread = [loss for loss in reading.losses if loss.code not in known]
    claims = Claims(losses, written.renamed, EXCUSES, unread)
    return Pair(source, reading.robot, claims, options, place, ROWS)


def _read_source(robot: Robot, options: Options, written: Written) -> Robot:
    """Return the robot as its file and the user define it: base, values of an actuator file."""
    source = read_again(robot)
    if options.force:
        source = drop_invalid_parts(source)
    source = add_gazebo_base(source)
    source = replace(source, native=[one for one in source.native if one.tag != AROUND])
    if options.classic:
        source = replace(source, native=[*_drop_reflectance(source)])
    else:
        sensors = [_cast_on_gpu(sensor) for sensor in source.mounted_sensors]
        source = replace(source, mounted_sensors=sensors)
    if options.base == "fixed" or any(one.code == "lossy-welded-base" for one in written.losses):
        root = source.tree.roots[0]
        if root.name != WORLD and source.base is not None:
            source = weld_base(replace(source, base=replace(source.base, is_free=False)))
    if options.actuator_config is None:
        return source
    names = [joint.name for joint in source.joints if joint.type in MOVABLE]
    settings = read_actuator_config(options.actuator_config).match_joints(names)
    joints = [
        _set(joint, settings[joint.name]) if joint.name in settings else joint
        for joint in source.joints
    ]
    return replace(source, joints=joints)


def _drop_reflectance(source: Robot) -> Iterator[NativeElement]:
    """Yield the elements of a robot without the reflectance of visuals, which only gz reads."""
    for element in source.native:
        kept = [child for child in element.children if child.tag != "laser_retro"]
        if element.tag != "visual" or len(kept) == len(element.children):
            yield element
        elif kept:
            yield replace(element, children=kept)


def _cast_on_gpu(sensor: MountedSensor) -> MountedSensor:
    """Return a sensor, a lidar as gz has it."""
    is_lidar = get_kind(sensor.type).type == "lidar"
    return replace(sensor, type="gpu_lidar") if is_lidar else sensor


def _set(joint: Joint, settings: JointSettings) -> Joint:
    """Replace values of the description by those of the user."""
    limit = joint.limit or Limit(None)
    if settings.force_range is not None:
        limit = replace(limit, effort=max(abs(bound) for bound in settings.force_range))
    resistance = settings.list_resistance(row for row in RESISTANCE if row.path)
    return replace(joint, limit=limit).replace_resistance(resistance)


def compare(pair: Pair) -> list[Check]:
    """Run all checks that need no external program."""
    has_frames = pair.options.is_at_least("1.7")
    return prove(pair.robot, pair.result, pair.claims, rows=pair.rows, has_frames=has_frames)


def _check_same_again(robot: Robot, written: Written, options: Options) -> Check:
    check = Check("again", f"{len(written.files)} files, the same bytes", 0.0)
    again = write(robot, options)
    for name, content in written.files.items():
        if again.files.get(name) != content:
            check.differing.append(f"{name}: different bytes")
    return check
