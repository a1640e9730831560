"""The operations of ``urdftool edit``."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..console import Console
from .edit_options import GROUPS, VECTOR, Words, add_edit_options, load_source, report_edit
from .grouped_help import GroupedCommand
from .options import FiniteRange, split_robots

if TYPE_CHECKING:
    from ..edit.finish import Edited
    from ..model.elements import Robot

Package = dict[str, Path]


class _Common:
    """Options of all operations, as click passes them."""

    def __init__(self, options: dict[str, Any]) -> None:
        self.output: str | None = options["output"]
        self.files: tuple[str, ...] = options["files"]
        self.force: bool = options["force"]
        self.style: str = options["style"]
        self.package: Package = options["package"]
        self.package_path: tuple[str, ...] = options["package_path"]

    @property
    def place(self) -> str | None:
        """Return the path of the output; None for standard output."""
        return None if self.output in (None, "-") else self.output


def _run(
    console: Console,
    words: Words,
    options: dict[str, Any],
    operation: Callable[[Robot, dict[str, Any]], Edited],
) -> int:
    """Read a robot, change it, and report the result."""
    common = _Common(options)
    robot = load_source(console, words.path, words.arguments, common.package, common.package_path)
    edited = operation(robot, {"files": common.files, "output": common.place})
    return report_edit(console, edited, common.output, force=common.force, style=common.style)


@click.command("attach", cls=GroupedCommand, groups={"Mount": "to prefix xyz rpy joint", **GROUPS})
@click.argument("words", nargs=-1, metavar="ROBOT [name:=value ...] PART [name:=value ...]")
@click.option("--to", metavar="LINK", required=True, help="Link of ROBOT to which PART is fixed.")
@click.option("--prefix", default="", help="Prefix of all names of PART.  [default: none]")
@click.option("--xyz", type=VECTOR, default=(0, 0, 0), help="Position of PART in LINK [m].")
@click.option("--rpy", type=VECTOR, default=(0, 0, 0), help="Rotation of PART in LINK [rad].")
@click.option("--joint", default="", help="Name of the fixed joint.  [default: LINK_to_PART]")
@add_edit_options
@click.pass_obj
def attach(console: Console, /, words: tuple[str, ...], **options: Any) -> int:
    """Attach the robot PART, such as a gripper, to a link of ROBOT, such as an arm.

    Both robots stay as they are, with their comments. SRDF files are joined, YAML files get the
    prefix. An empty world link of PART is dropped. Names that clash are an error.

    \b
        urdftool edit attach arm.urdf gripper.urdf --to tool --prefix g_ -o robot.urdf

    Exit code 1: the result differs, and is not written.
    """  # noqa: D301 -- click reads the escape
    from ..api import edit

    sides = split_robots(words)
    if len(sides) != 2:
        raise click.UsageError("the arguments are ROBOT and PART")
    common = _Common(options)
    one, two = (
        load_source(console, path, arguments, common.package, common.package_path)
        for path, arguments in sides
    )
    mount = {name: options[name] for name in ("to", "prefix", "xyz", "rpy", "joint")}
    edited = edit.attach(one, two, **mount, files=common.files, output=common.place)
    return report_edit(console, edited, common.output, force=common.force, style=common.style)


@click.command("prefix", cls=GroupedCommand, groups=GROUPS)
@click.argument("words", nargs=-1, metavar="ROBOT [name:=value ...] PREFIX")
@add_edit_options
@click.pass_obj
def prefix(console: Console, /, words: tuple[str, ...], **options: Any) -> int:
    """Put PREFIX before all names of ROBOT, also in the files around it.

    Links, joints, materials, transmissions, hardware components and their sensors; references in
    <gazebo>, <ros2_control>, the SRDF, and YAML files of controllers, limits and initial positions.
    A root link 'world' keeps its name, by which Gazebo fixes the robot.

    \b
        urdftool edit prefix arm.urdf l_ -o left/arm.urdf

    Exit code 1: the result differs, and is not written.
    """  # noqa: D301 -- click reads the escape
    from ..api import edit

    split = Words(words, 1, "ROBOT and PREFIX")
    return _run(console, split, options, lambda r, o: edit.prefix(r, split.operands[0], **o))


@click.command("merge-fixed", cls=GroupedCommand, groups={"Links": "keep frames", **GROUPS})
@click.argument("words", nargs=-1, metavar="ROBOT [name:=value ...]")
@click.option(
    "--keep",
    multiple=True,
    metavar="NAME",
    help="Link to keep, with * and ?. Repeatable.",
)
@click.option(
    "--frames",
    type=click.Choice(("keep", "merge")),
    default="keep",
    show_default=True,
    help="Links without mass and geometry.",
)
@add_edit_options
@click.pass_obj
def merge_fixed(
    console: Console, /, words: tuple[str, ...], keep: tuple[str, ...], frames: str, **options: Any
) -> int:
    """Merge the links of ROBOT that are fixed to others; masses and tensors are summed.

    Links to which a <gazebo>, an SRDF group or a YAML file refers are kept, and frames.

    \b
        urdftool edit merge-fixed arm.urdf --keep tool -o merged.urdf

    Exit code 1: the result differs, and is not written.
    """  # noqa: D301 -- click reads the escape
    from ..api import edit

    chosen = {"keep": keep, "frames": frames == "merge"}
    return _run(
        console,
        Words(words, 0, "ROBOT"),
        options,
        lambda r, o: edit.merge_fixed(r, **chosen, **o),  # type: ignore[arg-type]
    )


@click.command("root", cls=GroupedCommand, groups={"Frames": "move_frames", **GROUPS})
@click.argument("words", nargs=-1, metavar="ROBOT [name:=value ...] LINK")
@click.option(
    "--move-frames",
    is_flag=True,
    help="Move the frames of links on the way to their joints, in place of links without mass.",
)
@add_edit_options
@click.pass_obj
def root(console: Console, /, words: tuple[str, ...], move_frames: bool, **options: Any) -> int:
    """Make LINK the root of ROBOT; link frames, masses and positions of joints stay.

    Joints on the way are turned round: each moves a link without mass at its axis, to which its
    old parent is fixed. The way back restores every byte.

    \b
        urdftool edit root arm.urdf tool -o from_tool.urdf

    Exit code 1: the result differs, and is not written.
    """  # noqa: D301 -- click reads the escape
    from ..api import edit

    split = Words(words, 1, "ROBOT and LINK")
    link = split.operands[0]
    return _run(
        console,
        split,
        options,
        lambda r, o: edit.change_root(r, link, move_frames=move_frames, **o),
    )


@click.command(
    "mirror",
    cls=GroupedCommand,
    groups={"Mirror": "plane one other sides meshes mesh_dir", **GROUPS},
)
@click.argument("words", nargs=-1, metavar="ROBOT [name:=value ...]")
@click.option(
    "--plane",
    type=click.Choice(("xz", "yz", "xy")),
    default="xz",
    show_default=True,
    help="Plane through the frame of the root.",
)
@click.option("--from", "one", default="", help="Part of names to exchange, such as l_.")
@click.option("--to", "other", default="", help="Part of names in its place, such as r_.")
@click.option(
    "--sides",
    type=click.Choice(("exchange", "add", "replace")),
    default="exchange",
    show_default=True,
    help="Mirror all of ROBOT; or keep it, and add the mirror image of the branches with --from in "
    "their names; or remove those with --to before.",
)
@click.option(
    "--mesh",
    "meshes",
    type=click.Choice(("files", "scale")),
    default="files",
    show_default=True,
    help="New files with reversed faces, or a negative scale, which PyBullet and others refuse.",
)
@click.option("--mesh-dir", default="meshes", show_default=True, help="Folder of new meshes.")
@add_edit_options
@click.pass_obj
def mirror(
    console: Console,
    /,
    words: tuple[str, ...],
    plane: str,
    one: str,
    other: str,
    sides: str,
    meshes: str,
    mesh_dir: str,
    **options: Any,
) -> int:
    """Make the mirror image of ROBOT, such as a left hand of a right one.

    Link frames, axes, tensors and shapes are reflected; positions and limits of joints keep their
    values. Meshes are written to new files with reversed faces.

    \b
        urdftool edit mirror left_arm.urdf --from l_ --to r_ -o right_arm.urdf
        urdftool edit mirror left_arm.urdf --from l_ --to r_ --sides add -o two_arms.urdf

    Exit code 1: the result differs, and is not written.
    """  # noqa: D301 -- click reads the escape
    from ..api import edit

    if bool(one) != bool(other):
        raise click.UsageError("--from and --to are given together")
    if sides != "exchange" and not one:
        raise click.UsageError(f"--sides {sides} requires --from and --to")

    def run(robot: Robot, rest: dict[str, Any]) -> Edited:
        how = {"sides": sides, "meshes": meshes, "mesh_dir": mesh_dir}
        return edit.mirror(robot, plane, exchange=(one, other), **how, **rest)

    return _run(console, Words(words, 0, "ROBOT"), options, run)


@click.command("zero", cls=GroupedCommand, groups=GROUPS)
@click.argument("words", nargs=-1, metavar="ROBOT [name:=value ...] JOINT=VALUE ...")
@add_edit_options
@click.pass_obj
def zero(console: Console, /, words: tuple[str, ...], **options: Any) -> int:
    """Make the position VALUE [rad, m] of JOINT its new zero.

    Origins, limits, mimic offsets, ros2_control, SRDF states and YAML positions are shifted.

    \b
        urdftool edit zero arm.urdf elbow=-1.57 -o zeroed.urdf

    Exit code 1: the result differs, and is not written.
    """  # noqa: D301 -- click reads the escape
    from ..api import edit

    split = Words(words, None, "ROBOT and JOINT=VALUE ...")
    values = dict(map(_parse_position, split.operands))
    return _run(console, split, options, lambda r, o: edit.change_zero(r, values, **o))


def _parse_position(word: str) -> tuple[str, float]:
    name, equals, text = word.rpartition("=")
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not equals or not name or value != value or abs(value) == float("inf"):
        raise click.UsageError(f"'{word}' is not JOINT=VALUE with a number [rad, m]")
    return name, value


@click.command("sign", cls=GroupedCommand, groups=GROUPS)
@click.argument("words", nargs=-1, metavar="ROBOT [name:=value ...] JOINT ...")
@add_edit_options
@click.pass_obj
def sign(console: Console, /, words: tuple[str, ...], **options: Any) -> int:
    """Reverse the sign of JOINT: its axis, limits, mimic, SRDF states and YAML positions.

    \b
        urdftool edit sign arm.urdf elbow roll -o signs.urdf

    Exit code 1: the result differs, and is not written.
    """  # noqa: D301 -- click reads the escape
    from ..api import edit

    split = Words(words, None, "ROBOT and JOINT ...")
    return _run(console, split, options, lambda r, o: edit.reverse_sign(r, split.operands, **o))


@click.command("cut", cls=GroupedCommand, groups={"Links": "drop", **GROUPS})
@click.argument("words", nargs=-1, metavar="ROBOT [name:=value ...] LINK")
@click.option(
    "--drop-references",
    "drop",
    is_flag=True,
    help="Remove the joint also from a <transmission> that is about kept joints, too.",
)
@add_edit_options
@click.pass_obj
def cut(console: Console, /, words: tuple[str, ...], drop: bool, **options: Any) -> int:
    """Remove LINK of ROBOT, all below it, and what refers to them.

    A kept joint that mimics a removed one, and a transmission of both, are errors. What edit attach
    inserted is removed byte for byte.

    \b
        urdftool edit cut arm.urdf tool -o without_tool.urdf

    Exit code 1: the result differs, and is not written.
    """  # noqa: D301 -- click reads the escape
    from ..api import edit

    split = Words(words, 1, "ROBOT and LINK")
    link = split.operands[0]
    return _run(console, split, options, lambda r, o: edit.cut(r, link, force=drop, **o))


@click.command("round", cls=GroupedCommand, groups={"Numbers": "tolerance", **GROUPS})
@click.argument("words", nargs=-1, metavar="ROBOT [name:=value ...]")
@click.option(
    "--tolerance",
    type=FiniteRange(0.0, 0.1, min_open=True, max_open=True),
    default=1e-9,
    show_default=True,
    help="Largest change [m, rad]; relative for masses, tensors, sizes and numbers above 1.",
)
@add_edit_options
@click.pass_obj
def round(console: Console, /, words: tuple[str, ...], tolerance: float, **options: Any) -> int:
    """Write the numbers of ROBOT with the fewest digits within a tolerance.

    \b
        urdftool edit round arm.urdf --tolerance 1e-6 -o rounded.urdf

    Exit code 1: the result differs, and is not written.
    """  # noqa: D301 -- click reads the escape
    from ..api import edit

    def run(robot: Robot, rest: dict[str, Any]) -> Edited:
        return edit.round_numbers(robot, tolerance, output=rest["output"])

    return _run(console, Words(words, 0, "ROBOT"), options, run)
