"""Operations on robots: ``robot.attach`` and similar ones, each with a proof."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..arguments import check_arguments
from ..edit.draft import Draft, open_draft
from ..edit.finish import Edited, finish, is_xacro_name
from ..model.elements import Robot, Vector
from ..suggestions import require_number, require_word

if TYPE_CHECKING:
    from ..edit.attach import Mount

Paths = Iterable[str | Path]


@check_arguments
def attach(
    robot: Robot,
    other: Robot,
    *,
    to: str,
    prefix: str = "",
    xyz: Vector = (0.0, 0.0, 0.0),
    rpy: Vector = (0.0, 0.0, 0.0),
    joint: str = "",
    files: Paths = (),
    other_files: Paths = (),
    output: str | Path | None = None,
) -> Edited:
    """Attach another robot to a link by a fixed joint, such as a gripper to an arm.

    Args:
        robot: The first robot.
        other: The robot to attach.
        to: Link of the first robot.
        prefix: Prefix of all names of the other robot; empty for none.
        xyz: Position of its first link in ``to`` [m].
        rpy: Its rotation [rad].
        joint: Name of the joint; empty for ``TO_to_LINK``.
        files: SRDF and YAML files of the first robot, in addition to those that are found.
        other_files: Those of the other robot.
        output: Path of the URDF, to which relative paths refer; None keeps the folder. It is not
            written; ``Edited.write`` does. With the ending ``.xacro``, the result includes the
            sources, or calls their macros.

    Raises:
        ModelError: A link does not exist, or names clash.
    """
    from ..edit.attach import Mount

    mount, given = Mount(to, joint, xyz, rpy), (files, other_files)

    def make(name: str, keep: frozenset[str]) -> Edited:
        chosen = replace(mount, joint=name), prefix, keep
        return _attach((robot, other), chosen, given, output)

    if output is None or not is_xacro_name(output):
        return make(joint, frozenset())
    from ..edit.xacro_output import attach_in_xacro

    return attach_in_xacro((robot, other), mount, prefix, make, output)


def _attach(
    robots: tuple[Robot, Robot],
    chosen: tuple[Mount, str, frozenset[str]],
    files: tuple[Paths, Paths],
    output: str | Path | None,
) -> Edited:
    """Return the URDF of two robots, by mount, prefix, and names without prefix."""
    from ..edit.around import apply_changes
    from ..edit.attach import attach_robot, list_origin_lines
    from ..edit.prefix import add_prefix

    (robot, other), (mount, text, keep) = robots, chosen
    draft, part = _open(robot, files[0]), _open(other, files[1])
    if text:
        add_prefix(part, text, keep=keep)
        part = apply_changes(part)
    folder = None if output is None else Path(output).parent
    first = attach_robot(draft, part, mount, folder)
    draft.notes += part.notes
    names = [words for words in part.lines if words[0] != "root"]
    lines = [*names, *list_origin_lines(part, first)]
    sources = [
        (robot, _get_path(robot), draft.lines),
        (other, _get_path(other), lines),
    ]
    edited = finish(draft, sources, output)
    edited.inputs += [file.path for file in part.description.files]
    return edited


@check_arguments
def prefix(
    robot: Robot, text: str, *, files: Paths = (), output: str | Path | None = None
) -> Edited:
    """Put a prefix before all names, also in the files around the description.

    A root link ``world`` keeps its name, by which Gazebo fixes the robot.

    Args:
        robot: The robot.
        text: The prefix.
        files: SRDF and YAML files, in addition to those that are found.
        output: As for :func:`attach`.

    Raises:
        ModelError: A name is computed, or the text cannot be in a name.
    """
    from ..edit.prefix import add_prefix, list_fixing_names

    def make(_: str, keep: frozenset[str]) -> Edited:
        return _run(robot, lambda draft: add_prefix(draft, text, keep=keep), files, output)

    if output is None or not is_xacro_name(output):
        return make("", list_fixing_names(robot))
    from ..edit.xacro_output import prefix_in_xacro

    return prefix_in_xacro(robot, text, make, output)


@check_arguments
def merge_fixed(
    robot: Robot,
    *,
    keep: Sequence[str] = (),
    frames: bool = False,
    files: Paths = (),
    output: str | Path | None = None,
) -> Edited:
    """Merge links that are fixed to others.

    Args:
        robot: The robot.
        keep: Names of links to keep, with ``*`` and ``?``, in addition to those in use.
        frames: Whether to merge links without mass and geometry, too.
        files: As for :func:`prefix`.
        output: As for :func:`attach`.

    Raises:
        ModelError: A name to keep does not exist.
    """
    from ..edit import merge_fixed as operation

    def change(draft: Draft) -> None:
        operation.merge_fixed(draft, keep, frames=frames)

    return _run(robot, change, files, output)


@check_arguments
def change_root(
    robot: Robot,
    link: str,
    *,
    move_frames: bool = False,
    files: Paths = (),
    output: str | Path | None = None,
) -> Edited:
    """Make another link the root; link frames stay.

    Args:
        robot: The robot.
        link: The new root.
        move_frames: Whether frames of links on the way move to their joints, in place of links
            without mass at the axes.
        files: As for :func:`prefix`.
        output: As for :func:`attach`.

    Raises:
        ModelError: The link does not exist, or a joint cannot be turned round.
    """
    from ..edit.reroot import take_root

    return _run(robot, lambda draft: take_root(draft, link, move_frames=move_frames), files, output)


@check_arguments
def mirror(
    robot: Robot,
    plane: str = "xz",
    *,
    exchange: tuple[str, str] = ("", ""),
    sides: str = "exchange",
    meshes: str = "files",
    mesh_dir: str = "meshes",
    files: Paths = (),
    output: str | Path | None = None,
) -> Edited:
    """Make the mirror image of a robot, or add that of one side of it.

    Args:
        robot: The robot.
        plane: ``xy``, ``xz`` or ``yz``, through the frame of the root.
        exchange: Parts of names to exchange, such as ``("l_", "r_")``.
        sides: ``"exchange"`` mirrors the robot; ``"add"`` keeps it, and adds the mirror image of
            the branches with the first part of a name; ``"replace"`` removes the other side before.
        meshes: ``"files"`` writes meshes with reversed faces, ``"scale"`` a negative scale.
        mesh_dir: Folder of the new meshes, relative to the output.
        files: As for :func:`prefix`.
        output: As for :func:`attach`.

    Raises:
        ConfigError: ``meshes`` or ``sides`` is another word.
        MeshError: A mesh cannot be mirrored.
        ModelError: Names clash, or a joint has several positions.
    """
    from ..edit.mirror import mirror_robot
    from ..edit.mirror_side import add_side, remove_side

    require_word("meshes", meshes, ("files", "scale"))
    require_word("sides", sides, ("exchange", "add", "replace"))

    def change(draft: Draft) -> Draft:
        if sides == "replace":
            draft = remove_side(draft, exchange)
        operation = mirror_robot if sides == "exchange" else add_side
        operation(draft, plane, exchange, meshes=meshes, mesh_dir=mesh_dir)
        return draft

    draft = change(_open(robot, files))
    return finish(draft, [(robot, _get_path(robot), draft.lines)], output)


@check_arguments
def change_zero(
    robot: Robot,
    positions: Mapping[str, float],
    *,
    files: Paths = (),
    output: str | Path | None = None,
) -> Edited:
    """Make positions of joints their new zeros; limits, mimic and states are shifted.

    Args:
        robot: The robot.
        positions: Position of each joint [rad, m] that becomes 0.
        files: As for :func:`prefix`.
        output: As for :func:`attach`.

    Raises:
        ConfigError: A position is not a finite number.
        ModelError: A joint does not exist, or does not have one position.
    """
    from ..edit.change import Change
    from ..edit.positions import change_positions

    for name, value in positions.items():
        require_number(f"position of joint '{name}'", value)
    changes = {name: Change(1.0, -value) for name, value in positions.items()}
    return _run(robot, lambda draft: change_positions(draft, changes), files, output)


@check_arguments
def reverse_sign(
    robot: Robot, joints: Iterable[str], *, files: Paths = (), output: str | Path | None = None
) -> Edited:
    """Reverse the sign of joints: axes, limits, mimic and states.

    Args:
        robot: The robot.
        joints: Names of the joints.
        files: As for :func:`prefix`.
        output: As for :func:`attach`.

    Raises:
        ModelError: A joint does not exist, or does not have one position.
    """
    from ..edit.change import Change
    from ..edit.positions import change_positions

    changes = {name: Change(-1.0) for name in joints}
    return _run(robot, lambda draft: change_positions(draft, changes), files, output)


@check_arguments
def cut(
    robot: Robot,
    link: str,
    *,
    force: bool = False,
    files: Paths = (),
    output: str | Path | None = None,
) -> Edited:
    """Remove a link and all below it.

    Args:
        robot: The robot.
        link: The first link of the branch.
        force: Whether to remove parts also if they are about kept joints, too.
        files: As for :func:`prefix`.
        output: As for :func:`attach`.

    Raises:
        ModelError: The link does not exist or is the root, or a kept part depends on the branch.
    """
    from ..edit.cut import cut_branch

    return _run(robot, lambda draft: cut_branch(draft, link, force=force), files, output)


@check_arguments
def round_numbers(
    robot: Robot, tolerance: float = 1e-9, *, output: str | Path | None = None
) -> Edited:
    """Write numbers with the fewest digits within a tolerance.

    Args:
        robot: The robot.
        tolerance: Largest change, relative for masses, tensors, sizes and numbers above 1.
        output: As for :func:`attach`.

    Raises:
        ModelError: The tolerance is not positive, or an extent would be zero.
    """
    from ..edit import rounding

    bound = rounding.get_proof_tolerance(tolerance)

    def change(draft: Draft) -> None:
        rounding.round_numbers(draft, tolerance)
        name = draft.robot.tree.roots[0].name
        draft.declare("root", name, name)
        draft.declare("tolerance", f"{bound:g}")

    return _run(robot, change, (), output)


def _open(robot: Robot, files: Paths) -> Draft:
    from ..edit.around import add_files_around

    draft = open_draft(robot)
    add_files_around(draft, files)
    return draft


def _get_path(robot: Robot) -> str:
    return "-" if robot.source is None else robot.source.path


def _run(
    robot: Robot,
    change: Callable[[Draft], None],
    files: Paths,
    output: str | Path | None,
) -> Edited:
    """Open a draft, change it, and compare the result with the robot."""
    draft = _open(robot, files)
    change(draft)
    sources = [(robot, _get_path(robot), draft.lines)]
    return finish(draft, sources, output)
