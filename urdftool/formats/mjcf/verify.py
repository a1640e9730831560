"""Comparison of an export with its description: MuJoCo's compiled model, number by number.

The expected values are computed in ``mechanics``, which shares no code with the exporter. A
difference is accepted only if the export reported a loss for the same link or joint.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...compare.check import Check
from ...mechanics.reference import Mechanics
from ...model.elements import Joint, Robot
from ...model.load import read_again
from ...model.world import add_world
from ..common.losses import DeclaredLosses
from ..written import Written
from .compiled import Compiled, compile_all, copy_export
from .declared_losses import EFFORT, FREE, INERTIA, LIMITS, TORN, TREE
from .options import Options
from .verify_contact import check_contact, check_surface
from .verify_drives import check_actuator
from .verify_fuse import fuse_check
from .verify_home import check_base, check_home
from .verify_looks import check_material
from .verify_loops import compare_loops, list_loop_ends
from .verify_meshes import SourceMeshes
from .verify_physics import check_gravity_flag, check_joint_physics, check_option
from .verify_runs import check_runs
from .verify_scene import check_scene
from .verify_sensors import check_sensor
from .verify_shapes import check_collision, check_visual
from .verify_source import Source
from .write import write

CONFIGURATIONS = 20

STIFF = (0.005, 1.0, 0.95, 0.99, 0.001, 0.5, 2.0)
"""``solref`` and ``solimp`` of every equality."""

POSE, FORCE, MASS = 1e-9, 1e-8, 1e-12


def verify_copy(robot: Robot, options: Options, written: Written) -> list[Check]:
    """Compile and compare a temporary copy of an export, before user files are replaced."""
    with copy_export(written) as folder:
        compile_all(written, folder)
        model, again = folder / written.main, write(robot, options)
        if not options.fuse:
            return verify(robot, written, model, again, options)
        whole = replace(options, fuse=False)
        apart = write(robot, whole)
        with copy_export(apart) as place:
            checks = verify(robot, apart, place / apart.main, apart, whole, stepped=model)
            merged = _check_fused(robot, apart, place / apart.main, model)
    repeat = _check_repeats(written, again)
    return [*(repeat if check.name == repeat.name else check for check in checks), merged]


def _check_fused(robot: Robot, apart: Written, whole: Path, merged: Path) -> Check:
    """Compare the model with merged links with the model of all links."""
    robot, _ = add_world(robot)
    mechanics = Mechanics(robot)
    plain, fused = (Compiled(path, mechanics.root, apart.renamed) for path in (whole, merged))
    links = [link.name for link in robot.links]
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

    Args:
        robot: The robot.
        written: The export.
        model: Path of the model, next to its meshes.
        again: A second export with the same options.
        options: Options of the export; None for the defaults.
        stepped: Path of the model to step, if it is a different one.

    Raises:
        MissingDependency: MuJoCo is not installed.
        OutputError: MuJoCo does not compile the model.
    """
    robot, _ = add_world(read_again(robot))
    declared = DeclaredLosses.from_findings(written.losses)
    mechanics = Mechanics(robot)
    compiled = Compiled(model, mechanics.root, written.renamed)
    configurations = list(_list_configurations(mechanics, compiled))
    source = Source(
        robot, options or Options(), declared.has_for((FREE,), robot.tree.roots[0].name)
    )
    meshes = SourceMeshes(robot)
    checks = [
        check_base(source, compiled),
        _check_tree(robot, compiled, declared),
        _check_frames(mechanics, compiled, configurations, declared),
        *_compare_dynamics(mechanics, compiled, configurations, declared),
        _check_centroid(mechanics, compiled, configurations, declared),
        check_gravity_flag(source, compiled),
        _check_limits(mechanics, compiled, declared),
        check_joint_physics(source, compiled, declared),
        check_option(source, compiled, declared),
        check_collision(robot, meshes, mechanics, compiled, configurations, declared),
        check_contact(source, compiled, declared),
        check_surface(source, compiled, declared),
        check_actuator(source, compiled, declared),
        check_home(source, compiled, declared),
        check_sensor(source, mechanics, compiled, configurations[0], declared),
        check_visual(robot, meshes, mechanics, compiled, configurations, declared),
        check_material(source, meshes, compiled, declared),
        check_runs(stepped or model, declared, excluded=source.options.exclude == "touching"),
        _check_repeats(written, again),
    ]
    clean = Check("loads", "MuJoCo compiles and poses it without a warning", 0)
    for warning in compiled.warnings:
        clean.compare(math.inf, warning, known=declared.has_any("lossy-massless"))
    if source.options.scene:
        name = f"{Path(source.options.file).stem}_scene.xml" if source.options.file else "scene.xml"
        checks.append(check_scene(source, compiled, model.parent / name))
    return [clean, *checks]


def _list_configurations(mechanics: Mechanics, compiled: Compiled) -> Iterator[dict[str, float]]:
    """Yield joint positions: all zero, then random within limits; welded joints at their limits."""
    welded = _get_welded(mechanics, compiled)
    yield {joint.name: welded.get(joint.name, 0.0) for joint in mechanics.joints}
    random = np.random.default_rng(0)
    for _ in range(CONFIGURATIONS):
        positions = {}
        for joint in mechanics.joints:
            reach = math.pi if joint.type != "prismatic" else 1.0
            low, high = -reach, reach
            if joint.is_limited and joint.limit is not None:
                written = joint.limit.lower or 0.0, joint.limit.upper or 0.0
                low, high = written if written[0] < written[1] else (low, high)
            positions[joint.name] = float(random.uniform(max(low, -1e3), min(high, 1e3)))
        yield positions | welded


def _get_welded(mechanics: Mechanics, compiled: Compiled) -> dict[str, float]:
    """Return the position [rad or m] of each locked joint that MuJoCo's model does not have."""
    return {
        joint.name: position
        for joint in mechanics.joints
        if compiled.get_id("JOINT", joint.name) < 0
        if (position := _get_locked(joint)) is not None
    }


def _get_locked(joint: Joint) -> float | None:
    """Return the only position that the limits of a joint allow [rad or m]; None if it can move."""
    if joint.type not in ("revolute", "prismatic") or joint.limit is None:
        return None
    lower, upper = joint.limit.lower or 0.0, joint.limit.upper or 0.0
    return lower if lower == upper else None


def _check_tree(robot: Robot, compiled: Compiled, declared: DeclaredLosses) -> Check:
    """Compare joints by name: type, parent, child, and mimic joint."""
    check = Check("tree", "joints, their types, parents and children, mimics", 0)
    kinds = {
        "revolute": 3,
        "continuous": 3,
        "prismatic": 2,
        "floating": 0,
        "spherical": 1,
        "ball": 1,
    }
    model = compiled.model
    freedom = 6 if compiled.get_id("JOINT", f"{robot.tree.roots[0].name}_freejoint") >= 0 else 0
    for joint in robot.joints:
        known = declared.has_for(TREE, joint.name)
        body = compiled.get_body(joint.child)
        if body < 0:
            check.compare(math.inf, f"link '{joint.child}' is missing", known=known)
            continue
        parent = compiled.get_body(joint.parent)
        if joint.type != "floating" and model.body_parentid[body] != parent:
            check.compare(math.inf, f"link '{joint.child}' has another parent", known=known)
        if joint.type == "planar":
            found = [compiled.get_id("JOINT", joint.name + end) for end in ("_TX", "_TY", "_RZ")]
            freedom += 3
            check.compare(0 if min(found) >= 0 else math.inf, f"joint '{joint.name}'", known=known)
            continue
        if joint.type not in kinds:
            continue
        number = compiled.get_id("JOINT", joint.name)
        if number < 0 and _get_locked(joint) is not None and not model.body_jntnum[body]:
            here = compiled.get_id("SITE", joint.name)
            right = here >= 0 and model.site_bodyid[here] == body
            check.compare(0 if right else math.inf, f"site of welded joint '{joint.name}'")
            continue
        freedom += {0: 6, 1: 3}.get(kinds[joint.type], 1)
        right = number >= 0 and model.jnt_type[number] == kinds[joint.type]
        right = right and model.jnt_bodyid[number] == body
        check.compare(0 if right else math.inf, f"joint '{joint.name}'", known=known)
        if joint.mimic is not None:
            same = _follows(joint, compiled)
            check.compare(0 if same else math.inf, f"mimic of joint '{joint.name}'", known=known)
    compare_loops(robot, compiled, declared, check)
    _report_unasked(robot, compiled, check)
    if freedom != model.nv:
        text = f"{model.nv} degrees of freedom instead of {freedom}"
        check.compare(math.inf, text, known=declared.has_any(*TREE))
    return check


def _report_unasked(robot: Robot, compiled: Compiled, check: Check) -> None:
    """Report constraints between bodies that are not in the description."""
    model, kinds = compiled.model, compiled.mujoco.mjtEq
    follower = {joint.name for joint in robot.joints if joint.mimic is not None}
    ends = {frozenset(pair) for pair in list_loop_ends(robot, compiled)}
    for number in range(model.neq):
        kind = int(model.eq_type[number])
        one, other = int(model.eq_obj1id[number]), int(model.eq_obj2id[number])
        if kind == int(kinds.mjEQ_JOINT):  # without a second joint it holds a joint, see _limits
            asked = other < 0 or compiled.name("JOINT", one) in follower
        else:
            asked = kind in (int(kinds.mjEQ_CONNECT), int(kinds.mjEQ_WELD))
            asked = asked and frozenset((one, other)) in ends
        if not asked:
            check.compare(math.inf, f"equality {number} is not in the description")
        soft = *model.eq_solref[number], *model.eq_solimp[number]
        if not np.allclose(soft, STIFF, rtol=1e-9, atol=0):
            check.compare(math.inf, f"softness of equality {number}")
    for field in ("ntendon", "nflex", "nplugin", "nmocap"):
        if getattr(model, field, 0):
            check.compare(math.inf, f"{field[1:]} that is not in the description")


def _follows(joint: Joint, compiled: Compiled) -> bool:
    assert joint.mimic is not None
    model = compiled.model
    for number in _list_couplings(compiled):
        if not model.eq_active0[number]:
            continue
        if model.eq_obj1id[number] == compiled.get_id("JOINT", joint.name):
            leader = compiled.get_id("JOINT", joint.mimic.joint)
            data = model.eq_data[number][:5]
            wanted = [joint.mimic.offset, joint.mimic.multiplier, 0, 0, 0]
            same = np.allclose(data, wanted, rtol=1e-14, atol=0)
            if same and model.eq_obj2id[number] == leader >= 0:
                return True
    return False


def _check_frames(
    mechanics: Mechanics,
    compiled: Compiled,
    configurations: list[dict[str, float]],
    declared: DeclaredLosses,
) -> Check:
    check = Check("frames", f"pose of every link, {len(configurations)} configurations", POSE)
    torn = declared.has_any(*TORN)
    for positions in configurations:
        compiled.set_pose(positions)
        for link, expected in mechanics.compute_frames(positions).items():
            found = compiled.get_frame(link)
            difference = math.inf if found is None else float(abs(found - expected).max())
            check.compare(difference, f"link '{link}'", known=torn)
    return check


def _compare_dynamics(
    mechanics: Mechanics,
    compiled: Compiled,
    configurations: list[dict[str, float]],
    declared: DeclaredLosses,
) -> Iterator[Check]:
    """Compare mass matrix and gravity of the joints, with a fixed root."""
    inertia = Check("mass matrix", "over all joints, with a fixed root", compiled.tensor_rounding)
    gravity = Check("gravity", "force at every joint that holds the robot", FORCE)
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
        force = mechanics.compute_gravity(positions)[present]
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


def _check_limits(mechanics: Mechanics, compiled: Compiled, declared: DeclaredLosses) -> Check:
    """Compare limits, damping and friction of each joint; a locked joint is an equality."""
    check = Check("limits", "lower, upper, effort, velocity, damping, friction", POSE)
    model = compiled.model
    for joint in mechanics.joints:
        number = compiled.get_id("JOINT", joint.name)
        if number < 0:
            continue
        dof = model.jnt_dofadr[number]
        found = {
            "lower": float(model.jnt_range[number][0]) if model.jnt_limited[number] else -math.inf,
            "upper": float(model.jnt_range[number][1]) if model.jnt_limited[number] else math.inf,
            "effort": math.inf,
            "velocity": _compute_custom(compiled, f"{joint.name}_velocity_limit"),
            "damping": float(np.ravel(model.dof_damping[dof])[0]),
            "friction": float(model.dof_frictionloss[dof]),
        }
        if model.jnt_actfrclimited[number]:
            backward, found["effort"] = (float(bound) for bound in model.jnt_actfrcrange[number])
            if backward != -found["effort"]:
                text = f"lower bound of the effort of joint '{joint.name}' is {backward:g}"
                check.compare(math.inf, text, known=declared.has_for(EFFORT, joint.name))
        for held in _list_held(compiled, number):
            found["lower"] = found["upper"] = held
        for what, expected in _collect_expected(joint).items():
            both = abs(found[what]) >= 1e15 and abs(expected) >= 1e15
            scale = max(abs(expected), 1.0) if math.isfinite(expected) else 1.0
            difference = 0.0 if both else abs(found[what] - expected) / scale
            known = declared.has_for(EFFORT if what == "effort" else LIMITS, joint.name)
            check.compare(difference, f"{what} of joint '{joint.name}'", known=known)
    return check


def _collect_expected(joint: Joint) -> dict[str, float]:
    limit, dynamics = joint.limit, joint.dynamics
    bounded = joint.is_limited and limit is not None
    return {
        "lower": (limit.lower or 0.0) if bounded and limit else -math.inf,
        "upper": (limit.upper or 0.0) if bounded and limit else math.inf,
        "effort": _bound(limit.effort if limit else None),
        "velocity": _bound(limit.velocity if limit else None),
        "damping": (dynamics.damping or 0.0) if dynamics else 0.0,
        "friction": (dynamics.friction or 0.0) if dynamics else 0.0,
    }


def _bound(value: float | None) -> float:
    return math.inf if value is None else abs(value)


def _compute_custom(compiled: Compiled, name: str) -> float:
    number = compiled.get_id("NUMERIC", name)
    if number < 0:
        return math.inf
    return float(compiled.model.numeric_data[compiled.model.numeric_adr[number]])


def _list_couplings(compiled: Compiled) -> Iterator[int]:
    """Yield the indices of the joint equalities."""
    kind = compiled.mujoco.mjtEq.mjEQ_JOINT
    yield from (n for n in range(compiled.model.neq) if compiled.model.eq_type[n] == kind)


def _list_held(compiled: Compiled, joint: int) -> Iterator[float]:
    """Yield the position at which an equality holds a joint."""
    model = compiled.model
    for number in _list_couplings(compiled):
        active = bool(model.eq_active0[number])
        if active and model.eq_obj1id[number] == joint and model.eq_obj2id[number] < 0:
            yield float(model.eq_data[number][0])
