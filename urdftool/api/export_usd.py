"""``urdftool.export_usd``: conversion to OpenUSD."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ..formats.written import Written
from ..model.elements import Robot

if TYPE_CHECKING:
    from ..formats.common.inertia_repair import FixInertia


def export_usd(
    robot: Robot,
    output: str | Path | None = None,
    *,
    target: Literal["both", "newton", "isaac"] = "both",
    layers: Literal["single", "payload"] = "single",
    base: Literal["auto", "fixed", "free"] = "auto",
    srdf: str | Path | None = None,
    self_collision: bool | None = None,
    actuator_config: str | Path | None = None,
    approximation: Literal["hull", "mesh"] = "hull",
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
        srdf: A MoveIt SRDF, for pairs of links that never collide.
        self_collision: Whether links collide with each other; None with an SRDF.
        actuator_config: A TOML file with gains, armature, damping, friction and force range of
            joints.
        approximation: Collision geometry of a mesh: its convex hull, or its triangles.
        decompose: Whether to decompose collision meshes into convex pieces, with CoACD.
        fix_inertia: ``"lift"``, ``"balance"`` or ``"box"`` repairs physically inconsistent tensors.
        force: Whether to continue past errors if a robot remains.
        verify: Whether to read the result back and compare it; ``checks`` has the result.
        overwrite: Whether to replace files not written by urdftool.

    Raises:
        MissingDependency: usd-core is not installed.
        ModelError: The robot has errors that prevent writing it; ``notes`` lists the others.
        OutputError: A file cannot be written; previous contents are unchanged.
    """
    from ..extras import require
    from ..formats.export import finish_export
    from ..formats.registry import format_named

    require("export_usd", "pxr")
    from ..formats.usd.options import Options
    from .export import cut_meshes

    usd = format_named("usd")
    axes = "y" if robot.source is None else robot.source.gltf_up
    options = Options(
        target,
        base,
        layers,
        None if srdf is None else Path(srdf),
        self_collision,
        None if actuator_config is None else Path(actuator_config),
        approximation,
        partial(cut_meshes, gltf_up=axes) if decompose else None,
        fix_inertia,
        force,
        Path(output).name if output is not None and usd.has_suffix(output) else "",
    )
    if output is not None and options.file and not overwrite:
        from ..formats.usd.files import check_replaced

        check_replaced(Path(output))
    written = usd.write(robot, options)
    written.checks = finish_export(
        usd, robot, options, written, output, verify=verify, overwrite=overwrite
    )
    return written
