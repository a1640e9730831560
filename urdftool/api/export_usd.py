"""``urdftool.export_usd``: conversion to OpenUSD."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..arguments import check_arguments
from ..formats.written import Written
from ..model.elements import Robot

if TYPE_CHECKING:
    from ..formats.common.option import Actuators, Base, FixInertia
    from ..formats.usd.options import Approximation, Layers, Options, Target
    from .pair_proofs import PairProofs


@check_arguments
def export_usd(
    robot: Robot,
    output: str | Path | None = None,
    *,
    target: Target = "both",
    layers: Layers = "single",
    base: Base = "auto",
    srdf: str | Path | None = None,
    pose: Mapping[str, float] | None = None,
    state: str = "",
    actuators: Actuators = "auto",
    timestep: float | None = None,
    self_collision: bool | None = None,
    actuator_config: str | Path | None = None,
    approximation: Approximation = "hull",
    decompose: bool = False,
    fix_inertia: FixInertia = "none",
    force: bool = False,
    verify: bool = False,
    overwrite: bool = False,
) -> Written:
    """Convert a robot to a stage of OpenUSD, for Isaac Sim, Isaac Lab and Newton.

    Args:
        robot: A robot from ``load``.
        output: A folder, or a file that ends in .usda, .usdc or .usdz; None writes nothing.
        target: Simulator whose attributes are written.
        layers: One layer, or a payload with one layer for each kind of data.
        base: Whether the root is fixed to the world; ``"auto"`` uses the description.
        srdf: A MoveIt SRDF, for pairs of links that never collide, and group states.
        pose: Joint positions by name or pattern [rad, m] in the home position.
        state: Group state of the SRDF for the home position, or ``"stand"`` for bent legs on which
            the robot stands; empty chooses the likeliest.
        actuators: Which joints a drive holds; ``"auto"`` adds position servos to what the
            description drives.
        timestep: Physics time step [s] for which gains are chosen; None for 2 ms.
        self_collision: Whether links collide with each other; None with an SRDF.
        actuator_config: A TOML file with settings of joints, which ``--actuator-config`` lists.
        approximation: Collision geometry of a mesh: its convex hull, or its triangles.
        decompose: Whether to decompose collision meshes into convex pieces, with CoACD.
        fix_inertia: ``"lift"``, ``"balance"`` or ``"box"`` repairs physically inconsistent tensors.
        force: Whether to continue past errors if a robot remains.
        verify: Whether to read the result back and compare it; ``checks`` has the result.
        overwrite: Whether to replace files not written by urdftool.

    Raises:
        ConfigError: An option has a value that is not allowed.
        MissingDependency: usd-core is not installed.
        ModelError: The robot has errors that prevent writing it; ``notes`` lists the others.
        OutputError: A file cannot be written; previous contents are unchanged.
    """
    choices = {**locals()}  # the arguments by name
    from ..extras import require
    from ..formats.export import finish_export
    from ..formats.registry import format_named
    from .pair_proofs import prove_srdf_pairs
    from .plugin_checks import check_plugin_names

    require("export_usd", "pxr")
    usd, proofs = format_named("usd"), prove_srdf_pairs(robot, srdf)
    options = make_usd_options(robot, output or "", choices, proofs)
    written = usd.write(robot, options)
    written.losses += [*proofs.findings, *check_plugin_names(robot)]
    written.checks = finish_export(
        usd, robot, options, written, output, verify=verify, overwrite=overwrite
    )
    return written


def make_usd_options(
    robot: Robot, output: str | Path, choices: Mapping[str, Any], proofs: PairProofs
) -> Options:
    """Make the options of an export to USD.

    Args:
        robot: The robot.
        output: File or folder of the stage.
        choices: Values of the options, ``state`` and ``overwrite``.
        proofs: Those of the pairs of its SRDF.

    Raises:
        OutputError: The output is a file that the export would not replace.
    """
    from ..formats.common.option import make_options
    from ..formats.registry import format_named
    from ..formats.usd.options import Options
    from .export import make_cutter
    from .overlaps import find_overlaps

    options = make_options(
        Options,
        choices,
        file=Path(output).name if format_named("usd").has_suffix(output) else "",
        cutter=make_cutter(robot),
        overlaps=find_overlaps,
        proofs=proofs.texts,
        state=choices["state"],
    )
    if options.file and not choices["overwrite"]:
        from ..formats.usd.files import check_replaced

        check_replaced(Path(output))
    return options
