"""``urdftool.export_sdf`` and ``urdftool.export_mjcf``: conversion to simulator formats."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..arguments import check_arguments
from ..formats.written import Written
from ..model.elements import Robot
from ..model.world import weld_base
from ..source.description import GltfUp

if TYPE_CHECKING:
    from ..formats.common.cut import Cut, Cutter
    from ..formats.common.option import Actuators, Base, FixInertia
    from ..formats.mjcf.options import Exclude, Purpose
    from ..formats.mjcf.options import Options as MjcfOptions
    from ..formats.sdf.options import ChosenBase, FixedJoints, Target, Uri
    from .pair_proofs import PairProofs


@check_arguments
def export_sdf(
    robot: Robot,
    output: str | Path | None = None,
    *,
    target: Target = "gz",
    version: str = "",
    fixed_joints: FixedJoints = "",
    uri: Uri = "",
    base: ChosenBase = "auto",
    world: bool = False,
    fix_inertia: FixInertia = "none",
    mesh_dir: str = "meshes",
    actuator_config: str | Path | None = None,
    force: bool = False,
    verify: bool = False,
    overwrite: bool = False,
) -> Written:
    """Convert a robot to SDF for Gazebo.

    Args:
        robot: A robot from ``load``.
        output: A folder, or a file that ends in .sdf, .xml or .world; None writes nothing.
        target: Gazebo version: ``"gz"`` or ``"gazebo-classic"``.
        version: SDF version; empty uses the default of the target.
        fixed_joints: ``"keep"``, or ``"lump"`` to merge their links; empty uses the default of the
            target.
        uri: Form of mesh URIs; empty uses the default of the target.
        base: ``"auto"`` decides as the export to MJCF does; ``"fixed"`` adds a joint to the world;
            ``"free"``; empty keeps that of the description, free if it defines none.
        world: Whether to write a world with ground and sun around the model.
        fix_inertia: ``"lift"``, ``"balance"`` or ``"box"`` repairs physically inconsistent tensors.
        mesh_dir: Folder of the meshes, relative to the model.
        actuator_config: A TOML file with settings of joints, which ``--actuator-config`` lists.
        force: Whether to continue past errors if a robot remains.
        verify: Whether to read the result back and compare it; ``checks`` has the result.
        overwrite: Whether to replace files not written by urdftool.

    Raises:
        ModelError: The robot has errors that prevent writing it; ``notes`` lists the others.
        ConfigError: An option has a value that is not allowed, or the target does not read that
            version.
        OutputError: A file cannot be written; previous contents are unchanged.
    """
    choices = {**locals()}  # the arguments by name
    from ..formats.common.option import make_options
    from ..formats.export import finish_export
    from ..formats.registry import format_named
    from ..formats.sdf.options import Options, get_folder_and_file
    from .overlaps import find_overlaps
    from .plugin_checks import check_plugins

    folder, file = get_folder_and_file(output or robot.name or "robot")
    options = make_options(Options, choices, folder=folder, file=file, overlaps=find_overlaps)
    sdf, robot = format_named("sdf"), robot if base == "free" else weld_base(robot)
    written = sdf.write(robot, options)
    written.losses += check_plugins(robot, target)
    written.checks = finish_export(
        sdf, robot, options, written, output, verify=verify, overwrite=overwrite
    )
    return written


@check_arguments
def export_mjcf(
    robot: Robot,
    output: str | Path | None = None,
    *,
    actuators: Actuators = "auto",
    timestep: float | None = None,
    base: Base = "auto",
    scene: bool = False,
    srdf: str | Path | None = None,
    fix_inertia: FixInertia = "none",
    decompose: bool = False,
    keep_locked_joints: bool = False,
    pose: Mapping[str, float] | None = None,
    state: str = "",
    base_sensors: bool = False,
    actuator_config: str | Path | None = None,
    armature: float | None = None,
    exclude: Exclude = "touching",
    purpose: Purpose = "",
    fuse: bool = False,
    mesh_dir: str = "assets",
    force: bool = False,
    verify: bool = False,
    overwrite: bool = False,
) -> Written:
    """Convert a robot to a MuJoCo model.

    Args:
        robot: A robot from ``load``.
        output: A folder, or a file that ends in .xml or .mjcf; None writes nothing.
        actuators: ``"auto"`` follows transmissions, ros2_control and drive plugins, and gives the
            other joints position servos; ``"described"`` gives them none; ``"none"``; or
            ``"position"``, ``"velocity"`` or ``"motor"`` for all joints.
        timestep: Physics time step [s], written to the model, for which gains are chosen; None for
            MuJoCo's 0.002.
        base: ``"fixed"`` or ``"free"``; ``"auto"`` is free if the robot stands on legs or driven
            wheels, or if the description requires it.
        scene: Whether to write a scene with floor and light too.
        srdf: A MoveIt SRDF that provides disabled collisions, and a group state as the home
            position.
        fix_inertia: ``"lift"``, ``"balance"`` or ``"box"`` repairs physically inconsistent tensors.
        decompose: Whether to decompose non-convex collision meshes into convex pieces.
        keep_locked_joints: Whether to keep joints with equal limits, constrained by an equality,
            instead of welding their links.
        pose: Joint positions by name or pattern [rad, m] in the home position.
        state: Group state of the SRDF for the home position, or ``"stand"`` for bent legs on which
            the robot stands; empty chooses the likeliest.
        base_sensors: Whether to add sensors of linear velocity, angular velocity, acceleration and
            orientation to a free base that has none.
        actuator_config: A TOML file with settings of joints, which ``--actuator-config`` lists.
        armature: Reflected rotor inertia of every joint [kg·m², or kg for a slide joint].
        exclude: Pairs of links that never collide: ``"adjacent"`` excludes links connected by a
            joint, ``"touching"`` also those that overlap in the home position, ``"none"`` none.
        purpose: ``"rl"`` adds what policies for reinforcement learning need: ``base_sensors``,
            ``fuse``, sensors of joints, servos in place of motors, armature and friction loss by
            effort limit, and contacts of feet with condim 6 and priority 1.
        fuse: Whether to merge links fixed to another link into it; their frames become sites.
        mesh_dir: Folder of the meshes, relative to the model.
        force: Whether to continue past errors if a robot remains.
        verify: Whether to compare the model compiled by MuJoCo with the robot; ``checks`` has the
            result. The model is compiled in any case if MuJoCo is installed.
        overwrite: Whether to replace files not written by urdftool.

    Raises:
        ModelError: The robot has errors that prevent writing it, listed in ``notes``; or it lacks
            a joint of ``pose``.
        ConfigError: An option has a value that is not allowed, or the SRDF has no such group state.
        MissingDependency: MuJoCo (for ``verify``) or CoACD (for ``decompose``) is not installed.
        OutputError: A file cannot be written, or MuJoCo cannot compile it; previous contents are
            unchanged.
    """
    choices = {**locals()}  # the arguments by name
    from ..formats.export import finish_export
    from ..formats.registry import format_named
    from .pair_proofs import prove_srdf_pairs
    from .plugin_checks import check_plugin_names

    mjcf, robot = format_named("mjcf"), weld_base(robot)
    proofs = prove_srdf_pairs(robot, srdf)
    options = make_mjcf_options(robot, output or "", choices, proofs)
    written = mjcf.write(robot, options)
    written.losses += [*proofs.findings, *check_plugin_names(robot)]
    written.checks = finish_export(
        mjcf, robot, options, written, output, verify=verify, overwrite=overwrite
    )
    return written


def make_mjcf_options(
    robot: Robot, output: str | Path, choices: Mapping[str, Any], proofs: PairProofs
) -> MjcfOptions:
    """Make the options of an export to MJCF.

    Args:
        robot: The robot, with its base.
        output: File or folder of the model.
        choices: Values of the options, and ``state``.
        proofs: Those of the pairs of its SRDF.
    """
    from ..formats.common.option import make_options
    from ..formats.mjcf.options import Options
    from ..formats.registry import format_named

    return make_options(
        Options,
        choices,
        file=Path(output).name if format_named("mjcf").has_suffix(output) else "",
        cutter=make_cutter(robot),
        state=choices["state"],
        overlap=measure_overlap,
        proofs=proofs.texts,
    ).complete()


def measure_overlap(
    robot: Robot, positions: Mapping[str, float], one: str, other: str
) -> float | None:
    """Return the penetration depth [m] of the original collision geometry of two links.

    Args:
        robot: The robot.
        positions: Joint positions by name [rad or m].
        one: Name of a link.
        other: Name of another link.

    Returns:
        The depth; None if neither has a mesh, so that the result of the engine is exact.
    """
    from ..model.elements import Mesh
    from ..model.kinematics import link_poses
    from ..simulation.overlap import measure_triangle_penetration

    shapes = [*robot.link[one].collisions, *robot.link[other].collisions]
    if not any(isinstance(shape.geometry, Mesh) for shape in shapes):
        return None
    return measure_triangle_penetration(robot, link_poses(robot, positions), one, other)


def make_cutter(robot: Robot) -> Cutter:
    """Return the function that decomposes meshes of a robot, with the up axis of its glTF files."""
    axes: GltfUp = "y" if robot.source is None else robot.source.gltf_up
    return partial(cut_meshes, gltf_up=axes)


def cut_meshes(paths: Sequence[Path], gltf_up: GltfUp = "y") -> dict[Path, Cut | str]:
    """Decompose meshes into convex pieces, as ``urdftool collision`` does with CoACD.

    Args:
        paths: The mesh files.
        gltf_up: Up axis of glTF files.

    Returns:
        The pieces by path, or the message of the error for a mesh that cannot be decomposed.

    Raises:
        MissingDependency: A required library is not installed.
    """
    from ..collision.compute import Result, Task
    from ..collision.parallel import compute_all
    from ..collision.settings import Settings
    from ..errors import MissingDependency
    from ..formats.common.cut import Cut
    from ..storage import DiskCache, cache_folder

    settings = Settings(method="coacd", max_error=0.01, max_hulls=32)
    tasks = {path: Task(path, settings=settings, gltf_up=gltf_up) for path in paths}
    results = compute_all(list(tasks.values()), DiskCache(cache_folder("collision")))
    cuts: dict[Path, Cut | str] = {}
    for path, task in tasks.items():
        result = results[task]
        if isinstance(result, MissingDependency):
            raise result
        if isinstance(result, Result):
            cuts[path] = Cut([(p.vertices, p.faces) for p in result.pieces], result.error)
        else:
            cuts[path] = result.message
    return cuts
