"""Comparison of an export with its robot: the file read back, and the model that MuJoCo compiles.

The file is read by ``read.py`` and compared with the source, which has the choices of the export
(``plan.py``) where URDF says nothing. In addition, MuJoCo's compiled model is compared with the
reference arithmetic of ``mechanics``. Only a reported loss of the same link or joint excuses a
difference.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...compare.check import Check
from ...compare.proof import Claims, prove
from ...compare.rows import GLOBAL_ROWS, ROWS, Row
from ...limited import Limits
from ...mechanics.reference import Array, Mechanics, get_origin_matrix
from ...model.elements import Joint, Link, Robot
from ...model.kinematics import get_limits
from ...model.load import read_again
from ...model.materials import resolve_materials
from ...model.mechanism import Closure
from ...model.world import add_world
from ..common.additions import announce_additions
from ..common.losses import DeclaredLosses, name_links
from ..reading import Reading
from ..written import Written
from .compiled import Compiled, compile_all, copy_export
from .copied import has_copied_home, list_copied, list_uncopied
from .declared_losses import EFFORT, EXCUSES, INERTIA, TORN
from .options import Options
from .read import read
from .read_compile import LIMITS
from .verify_defaults import SOFT, STIFF, check_defaults
from .verify_fuse import fuse_check
from .verify_home import check_home
from .verify_looks import check_material
from .verify_meshes import SourceMeshes
from .verify_native import keep_native, list_force_ranges, select_native
from .verify_runs import check_runs
from .verify_scene import check_scene
from .write import write

CONFIGURATIONS = 20
"""Random configurations of the dynamics; chosen, no source."""

_FAR = 1e3
"""Largest position [rad or m] of a joint with wide limits; chosen, no source."""

POSE, FORCE, MASS = 1e-9, 1e-8, 1e-12
"""Tolerances of positions [m], of forces and of masses, relative; chosen above rounding errors."""

_EXACT = 1e-9
"""Tolerance of numbers that the model has as written; chosen above rounding errors."""

_SINGLE = 1e-6
"""Tolerance of what MuJoCo or a mesh file stores in single precision."""

_NOT_READ = (*GLOBAL_ROWS, "simulator data", "plugins", "looks")
"""Rows that are compared in the compiled model, or do not exist in MJCF."""


def verify_copy(robot: Robot, options: Options, written: Written) -> list[Check]:
    """Compile and compare a temporary copy of an export, before user files are replaced."""
    with copy_export(written) as folder:
        compile_all(written, folder)
        model, again = folder / written.main, write(robot, options)
        if not options.fuse:
            return verify(robot, written, model, again, options)
        whole = replace(options, fuse=False)
        unfused = write(robot, whole)
        with copy_export(unfused) as place:
            checks = verify(robot, unfused, place / unfused.main, unfused, whole, stepped=model)
            merged = _check_fused(robot, unfused, place / unfused.main, model)
    repeat = _check_repeats(written, again)
    return [*(repeat if check.name == repeat.name else check for check in checks), merged]


def _check_fused(robot: Robot, unfused: Written, whole: Path, merged: Path) -> Check:
    """Compare the model with merged links with the model of all links."""
    robot, _ = add_world(robot)
    mechanics = Mechanics(robot)
    plain, fused = (Compiled(path, mechanics.root, unfused.renamed) for path in (whole, merged))
    links = [link.name for link in robot.links if not link.is_virtual]
    return fuse_check(links, plain, fused, list(_list_configurations(mechanics, plain)))


def _check_repeats(written: Written, again: Written) -> Check:
    repeat = Check("repeats", "a second export has the same bytes", 0)
    for name in sorted(written.files.keys() | again.files.keys()):
        repeat.compare(0 if written.files.get(name) == again.files.get(name) else math.inf, name)
    return repeat


def verify(
    robot: Robot,
    written: Written,
    model: Path,
    again: Written,
    options: Options | None = None,
    *,
    stepped: Path | None = None,
) -> list[Check]:
    """Compare an export with its robot.

    ``again`` is a second export with the same options; ``stepped`` is the model to step.

    Raises:
        MissingDependency: MuJoCo is not installed.
        OutputError: MuJoCo does not compile the model.
    """
    options = options or Options()
    robot, _ = add_world(read_again(robot))
    assert again.planned is not None
    expected = _make_expected(robot, again.planned)
    reading = read(model, limits=Limits(LIMITS.time))  # this process has compiled it already
    expected.native = select_native(robot, options)
    checks = _compare_read(expected, written, reading)
    announce_additions(checks, robot, again.planned)
    declared = DeclaredLosses.from_findings(written.losses)
    checks += _compare_compiled(robot, expected, written, model, options)
    checks.append(
        check_runs(
            stepped or model,
            declared,
            excluded=options.exclude == "touching",
        )
    )
    return [*checks, _check_repeats(written, again)]


def _make_expected(source: Robot, planned: Robot) -> Robot:
    """Return the robot that the file must hold: the source with the choices of the export."""
    source = resolve_materials(source)
    kept = {one.name for one in planned.configurations}
    return replace(
        planned,
        closures=[*planned.closures, *_list_dropped(source, planned)],
        configurations=[
            *planned.configurations,
            *(one for one in source.configurations if one.name not in kept),
        ],
        links=[
            *(_make_link(link, planned) for link in source.links),
            *(link for link in planned.links if link.name not in source.link),
        ],
        joints=[_make_joint(joint, source) for joint in planned.joints],
        format="mjcf",
        source=source.source,
        gazebo=[],
        transmissions=[],
        ros2_controls=[],
    )


def _list_dropped(source: Robot, planned: Robot) -> list[Closure]:
    """Return the connections of the source that close no loop of the export."""
    left = [(one.name, {one.parent, one.child}) for one in planned.closures]
    dropped = []
    for closure in source.closures:
        ends = {closure.parent, closure.child}
        found = next(
            (n for n, (name, two) in enumerate(left) if two == ends and closure.name in (name, "")),
            None,
        )
        if found is None:
            dropped.append(closure)
        else:
            del left[found]
    return dropped


def _make_link(link: Link, planned: Robot) -> Link:
    """Return a link of the source with the friction and contact that are chosen."""
    chosen = planned.link[link.name].collisions
    shapes = [
        replace(one, surface=other.surface)
        for one, other in zip(link.collisions, chosen, strict=True)
    ]
    return replace(link, collisions=shapes)


def _make_joint(joint: Joint, source: Robot) -> Joint:
    """Return a joint of the source with the dynamics, effort and stops that are chosen."""
    origin = source.joint.get(joint.name)
    if origin is None or origin.parent != joint.parent:
        return joint
    limit = origin.limit
    if joint.limit is not None and (limit is None or joint.limit.effort != limit.effort):
        bounds = joint.limit if limit is None else limit
        limit = replace(joint.limit, lower=bounds.lower, upper=bounds.upper)
    settings = joint.settings | origin.settings
    return replace(origin, dynamics=joint.dynamics, limit=limit, settings=settings)


def _compare_read(expected: Robot, written: Written, reading: Reading) -> list[Check]:
    """Compare the robot that is read from the file."""
    losses = list(name_links(expected, written.losses))
    unread = list(list_uncopied(reading.robot, reading.losses))
    claims = Claims(losses, written.renamed, EXCUSES, unread)
    result = replace(reading.robot, native=keep_native(expected, reading.robot))
    return prove(expected, result, claims, rows=_choose_rows())


def _choose_rows() -> tuple[Row, ...]:
    single = ("collisions", "visuals", "colors", "inertia", "mass matrix", "gravity", "sensors")
    return tuple(
        row._replace(tolerance=min(row.tolerance, _SINGLE if row.name in single else _EXACT))
        for row in ROWS
        if row.name not in _NOT_READ
    )


def _compare_compiled(
    robot: Robot, expected: Robot, written: Written, model: Path, options: Options
) -> Iterator[Check]:
    """Compare MuJoCo's compiled model: dynamics, home, sensors, materials and defaults."""
    declared = DeclaredLosses.from_findings(written.losses)
    mechanics = Mechanics(robot)
    compiled = Compiled(model, mechanics.root, written.renamed)
    clean = Check("loads", "MuJoCo compiles and poses it without a warning", 0)
    yield clean
    configurations = list(_list_configurations(mechanics, compiled))
    yield _check_frames(mechanics, compiled, configurations, declared)
    base = expected.base
    turn = get_origin_matrix(None if base is None else base.origin)[:3, :3]
    yield from _compare_dynamics(mechanics, compiled, configurations, turn, declared)
    yield _check_centroid(mechanics, compiled, configurations, declared)
    ranges = list_force_ranges(expected) if robot.format == "mjcf" else _list_efforts(expected)
    yield _check_efforts(ranges, compiled, declared)
    softness = SOFT if robot.format == "mjcf" else STIFF
    yield check_defaults(compiled, list_copied(robot), softness)
    yield check_home(
        expected,
        compiled,
        on_floor=robot.format != "mjcf",
        is_copied=has_copied_home(robot, options),
    )
    yield check_material(robot, SourceMeshes(robot), compiled, declared)
    for warning in compiled.warnings:
        clean.compare(math.inf, warning, known=declared.has_any("lossy-massless"))
    if options.scene:
        name = f"{Path(options.file).stem}_scene.xml" if options.file else "scene.xml"
        yield check_scene(expected, compiled, model.parent / name)


def _list_efforts(robot: Robot) -> dict[str, tuple[float, float]]:
    """Return the bounds of force of the joints that no actuator bounds [N·m or N], by joint."""
    ranged = {one.joint for one in robot.joint_actuators if one.force_range is not None}
    return {
        joint.name: (-effort, effort)
        for joint in robot.joints
        if (effort := joint.get_magnitude("effort")) and joint.name not in ranged and joint.has_axis
    }


def _check_efforts(
    ranges: Mapping[str, tuple[float, float]], compiled: Compiled, declared: DeclaredLosses
) -> Check:
    """Compare the bounds of force at the joints, which other bounds of an actuator may hide."""
    check = Check("effort", "bounds of the force at each joint", _EXACT, is_empty=True)
    model = compiled.model
    for joint, bounds in ranges.items():
        number = compiled.get_id("JOINT", joint)
        if number < 0:
            continue
        is_limited = math.isfinite(bounds[1])
        off = 0.0 if model.jnt_actfrclimited[number] == is_limited else math.inf
        if is_limited and not off:
            size = max(1.0, *map(abs, bounds))
            off = float(max(abs(model.jnt_actfrcrange[number] - bounds))) / size
        check.compare(off, f"effort of joint '{joint}'", known=declared.has_for(EFFORT, joint))
    return check


def _list_configurations(mechanics: Mechanics, compiled: Compiled) -> Iterator[dict[str, float]]:
    """Yield joint positions: all zero, then random within limits; welded joints at their limits."""
    welded = _get_welded(mechanics, compiled)
    yield {joint.name: welded.get(joint.name, 0.0) for joint in mechanics.joints}
    random = np.random.default_rng(0)
    for _ in range(CONFIGURATIONS):
        positions = {}
        for joint in mechanics.joints:
            reach = math.pi if joint.type != "prismatic" else 1.0
            low, high = get_limits(joint)
            is_bounded = low < high and math.isfinite(low) and math.isfinite(high)
            low, high = max(low, -_FAR), min(high, _FAR)
            if not joint.is_limited or not is_bounded:
                low, high = -reach, reach
            positions[joint.name] = float(random.uniform(low, high))
        yield positions | welded


def _get_welded(mechanics: Mechanics, compiled: Compiled) -> dict[str, float]:
    """Return the position [rad or m] of each locked joint that MuJoCo's model does not have."""
    return {
        joint.name: get_limits(joint)[0]
        for joint in mechanics.joints
        if joint.is_limited
        and joint.limit is not None
        and compiled.get_id("JOINT", joint.name) < 0
        and get_limits(joint)[0] == get_limits(joint)[1]
    }


def _check_frames(
    mechanics: Mechanics,
    compiled: Compiled,
    configurations: list[dict[str, float]],
    declared: DeclaredLosses,
) -> Check:
    check = Check("frames", f"pose of every link, {len(configurations)} configurations", POSE)
    torn = declared.has_any(*TORN)
    frames = [frame for frame in mechanics.robot.frames if frame.kind == "body"]
    in_link = {frame.link: get_origin_matrix(frame.origin) for frame in frames}
    for positions in configurations:
        compiled.set_pose(positions)
        for link, pose in mechanics.compute_frames(positions).items():
            expected = pose @ in_link.get(link, np.eye(4))
            found = compiled.get_frame(link)
            if found is None and mechanics.robot.link[link].is_virtual:
                continue  # between two joints of one body
            difference = math.inf if found is None else float(abs(found - expected).max())
            check.compare(difference, f"link '{link}'", known=torn)
    return check


def _compare_dynamics(
    mechanics: Mechanics,
    compiled: Compiled,
    configurations: list[dict[str, float]],
    turn: Array,
    declared: DeclaredLosses,
) -> Iterator[Check]:
    """Compare mass matrix and gravity of the joints, with a fixed root of a rotation, 3 × 3."""
    inertia = Check(
        "mass matrix", "of the links, without armature, fixed root", compiled.tensor_rounding
    )
    gravity = Check("gravity", "force at every joint that holds the robot", FORCE)
    inertia.is_empty = gravity.is_empty = True
    welded = _get_welded(mechanics, compiled)
    names = [joint.name for joint in mechanics.joints]
    dofs = compiled.get_dofs(names)
    present = [index for index, dof in enumerate(dofs) if dof >= 0]
    if len(names) > len(welded) and not present:
        inertia.compare(math.inf, "no joint")
    for positions in configurations if present else ():
        compiled.set_pose(positions)
        expected = mechanics.compute_mass_matrix(positions)[np.ix_(present, present)]
        found = compiled.compute_mass_matrix([dofs[index] for index in present])
        scale = np.sqrt(np.maximum(np.diag(expected), 0.0))
        heaviest = float(np.diag(expected).max())
        floor = 1e-6 * heaviest if heaviest > 0 else 1.0  # no mass to relate the difference to
        difference = abs(found - expected) / np.maximum(np.outer(scale, scale), floor)
        inertia.compare(
            float(difference.max()),
            "the mass matrix",
            known=declared.has_any(*INERTIA, *TORN),
        )
        force = mechanics.compute_gravity(positions, turn)[present]
        bias = compiled.get_gravity([dofs[index] for index in present])
        mass = mechanics.compute_centroid(positions)[0]
        weight = max(float(abs(force).max()), 1e-6 * 9.81 * mass, 0.0) or 1.0
        gravity.compare(
            float(abs(bias - force).max()) / weight, "gravity", known=declared.has_any(*INERTIA)
        )
    yield inertia
    yield gravity


def _check_centroid(
    mechanics: Mechanics,
    compiled: Compiled,
    configurations: list[dict[str, float]],
    declared: DeclaredLosses,
) -> Check:
    bound = compiled.tensor_rounding
    check = Check("centroid", "total mass, center of mass and inertia about it", bound)
    for positions in configurations:
        compiled.set_pose(positions)
        mass, com, tensor = mechanics.compute_centroid(positions)
        found_mass, found_com, found_tensor = compiled.compute_centroid()
        if mass == 0:
            check.compare(
                found_mass,
                "mass of a massless link",
                known=declared.has_any(*INERTIA, *TORN),
            )
            continue
        known = declared.has_any(*INERTIA, *TORN)
        # scaled from its own tolerance to that of the row
        check.compare(abs(found_mass - mass) / mass * bound / MASS, "total mass", known=known)
        check.compare(
            float(abs(found_com - com).max()) * bound / POSE, "center of mass", known=known
        )
        size = max(float(abs(tensor).max()), 1e-300)
        check.compare(float(abs(found_tensor - tensor).max()) / size, "inertia", known=known)
    return check
