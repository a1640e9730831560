"""Where a model starts in Gazebo: the height at which it stands, and links that overlap there."""

from __future__ import annotations

from collections.abc import Mapping

from lxml import etree

from ...diagnostic import Severity
from ...listing import list_first
from ...model.elements import Robot
from ...model.numbers import number_text
from ...model.pose import IDENTITY
from ...model.settings import is_set
from ...model.start import start_positions
from ...model.world import WORLD, find_model_origin
from ..common.floor import lift_to_floor
from ..common.home_positions import choose_home_positions
from ..common.rigid_tree import RigidTree, group_rigid_links
from ..common.shape_box import ShapeBoxes
from ..common.standing_pose import choose_standing_positions
from ..written import Written
from .options import Options
from .xml import Node


def report_start(robot: Robot, boxes: ShapeBoxes, options: Options, written: Written) -> float:
    """Report where a model starts, and return the height of its root above the ground [m].

    Gazebo starts joints at zero, or at the limit nearest to it. The height follows from the boxes
    of the robot's shapes, and is that of exports to MJCF and USD; a base that is fixed, or that the
    description places, has none.
    """
    if options.overlaps is None:
        return 0.0
    positions, _ = start_positions(robot)
    _report_overlaps(robot, options, positions, written)
    roots = robot.tree.roots
    if len(roots) != 1 or roots[0].name == WORLD or find_model_origin(robot) is not None:
        return 0.0
    tree = group_rigid_links(robot, lambda joint: not joint.is_fixed)
    height = lift_to_floor(tree, boxes, positions, IDENTITY).translation[2]
    if height:
        home = _list_home(tree, boxes, positions)
        done = "world.sdf places it there" if options.world else f"spawn it there (-z {height:g})"
        written.report_loss(
            "start",
            f"the lowest point of the robot is at the ground if its root is at z = {height:g} m; "
            f"{done}{_describe_home(home)}",
            roots[0].place,
            kind="link",
            name=roots[0].name,
            severity=Severity.INFO,
            data={"height": height, "home": home},
        )
    return height


def _list_home(tree: RigidTree, boxes: ShapeBoxes, start: Mapping[str, float]) -> dict[str, float]:
    """List the joints that ``export mjcf`` starts elsewhere, with their positions [rad, m]."""
    home = choose_home_positions(tree.robot, {}, "", None, Written(""))
    positions = choose_standing_positions(tree, boxes, home, Written(""))
    return {name: value for name, value in positions.items() if value != start.get(name, 0.0)}


def _describe_home(home: Mapping[str, float]) -> str:
    """Describe the joint positions that an SDF does not hold; empty if there are none."""
    if not home:
        return ""
    listed = list_first([f"'{name}' {value:.3g}" for name, value in home.items()], 3)
    return (
        "; SDF has no initial joint positions, so joints start at zero or the limit nearest to it, "
        f"not at the home of export mjcf: {listed}"
    )


def place_on_ground(model: Node, height: float) -> None:
    """Place a model without a pose at a height [m]."""
    if height and model.find("pose") is None:
        pose = etree.Element("pose")
        pose.text = f"0 0 {number_text(height)} 0 0 0"
        model.insert(0, pose)


def _report_overlaps(
    robot: Robot, options: Options, positions: Mapping[str, float], written: Written
) -> None:
    """Report links that overlap at the start of a model whose links collide with each other."""
    levels = (robot.settings, *(link.settings for link in robot.links))
    if options.overlaps is None or not any(is_set(one, "self_collide") for one in levels):
        return  # Gazebo has no contacts between the links
    finding = options.overlaps(robot, positions)
    if finding is None:
        return
    pairs = finding.data.get("pairs", ())
    names = list_first([f"'{one}' and '{other}'" for one, other in pairs], _SHOWN)
    count = f"{len(pairs)} pairs of links overlap" if len(pairs) > 1 else "2 links overlap"
    written.report_loss(
        "overlap",
        f"{count} at the start, and Gazebo pushes them apart, since <self_collide> is set: "
        f"{names}; SDF has no pairs without contact",
        robot.place,
        data={"pairs": pairs},
    )


_SHOWN = 4
"""Pairs that a message names; chosen, no source."""
