"""Read a robot from SDF, by the specifications of versions 1.4 to 1.12."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...errors import ModelError
from ...model.blocks import add_plugin
from ...model.elements import Link, Robot
from ...model.mechanism import Base
from ...model.native import make_world
from ...model.pose import IDENTITY, get_origin_at
from ...model.provenance import Written
from ...model.read_settings import read_sdf_settings
from ...model.settings import OF_ROBOT
from ...model.world import WORLD
from ...model.world_settings import OF_SDF
from ...source.description import Description
from ...source.document import Document
from ...source.location import Place, SourceFile
from ...source.packages import Packages
from ...workspace import Workspace
from ..reading import Losses, Reading, find_chosen, find_remarks, open_description
from .read_joints import (
    add_closure,
    add_frames,
    add_joint,
    add_world,
    check_mimics,
    find_joints,
    order,
    set_shifts,
)
from .read_links import Context, read_link
from .read_models import BUILT_IN, Models
from .read_native import add_native
from .read_scope import Scope, read_own_pose


def read(
    path: str | Path,
    *,
    file: SourceFile | None = None,
    packages: Packages | None = None,
    workspace: Workspace | None = None,
    name: str = "",
    **_: Any,
) -> Reading:
    """Read a robot: the model of the file, or the one with most joints.

    ``name`` is that of a model; empty for the one with most joints.

    Raises:
        SourceError: A file cannot be read, or includes itself.
        ModelError: The file has no model or two worlds, or a name or value in it is invalid.
    """
    file, finder, workspace = open_description(path, file, packages, workspace)
    losses = Losses()
    models = Models(finder, workspace, losses)
    root = models.parse_root(file)
    top = _choose(models.list_top_models(root), name, root.place, losses)
    if top is None and models.missing:
        raise models.missing[0]
    if top is None:
        raise ModelError("the file has no model with a link", at=root.place)
    robot = Robot(Written(top.element.place), top.name, format="sdf")
    rejected, part = robot.rejected_settings, ("robot", robot.name)
    robot.settings = read_sdf_settings(top.element, OF_ROBOT, rejected, part)
    for world in root.list_children("world"):
        part = ("world", world.get("name") or "")
        robot.world = read_sdf_settings(world, OF_SDF, rejected, part)
        robot.native = [make_world(world)]
    robot.source = Description(str(path), Document(file, root, []), models.files, finder)
    robot.source.gltf_up = "z"  # Gazebo keeps the axes of the file
    context = Context(robot, losses, file.path)
    _fill(context, top)
    _add_plugins(robot, top)
    add_native(context, top)
    found = [*losses.make_findings(), *find_remarks(robot)]
    robot.unread = found
    return Reading(robot, found)


def _add_plugins(robot: Robot, top: Scope) -> None:
    for prefix, scope in top.list_scopes():
        owners = [(item.element, prefix + item.name) for item in scope.links.values()]
        owners += [(item.element, prefix + item.name) for item in scope.joints.values()]
        for element, owner in ((scope.element, ""), *owners):
            for plugin in element.list_children("plugin"):
                add_plugin(robot, plugin, owner, Written(plugin.place, plugin))


def _choose(found: list[Scope], name: str, place: Place, losses: Losses) -> Scope | None:
    """Return the model of a name, or with most joints, then most links; report the others.

    Of equal ones, that which is not the ground.

    Raises:
        ModelError: No model, or several, have the name.
    """
    sizes = {
        id(model): tuple(
            sum(len(part) for part in parts)
            for parts in zip(
                *((scope.joints, scope.links) for _, scope in model.list_scopes()), strict=True
            )
        )
        for model in found
    }
    top = max(
        found, key=lambda model: (*sizes[id(model)], model.name not in BUILT_IN), default=None
    )
    if name and found:
        top = found[find_chosen(name, [model.name for model in found], "model", place)]
    for model in found:
        if top is not None and model is not top:
            text = f"of {len(found)} models, only '{top.name}' is read; -r NAME chooses another"
            losses.add("model", text, model.name, model.posed.place)
    return top if top is not None and sizes[id(top)][1] else None


def _fill(context: Context, top: Scope) -> None:
    """Add links, joints and frames to a robot."""
    robot = context.robot
    links = []
    for prefix, scope in top.list_scopes():
        path = prefix.removesuffix("::")
        base = top.compute_pose(path, top.element) if path else IDENTITY
        for name, item in scope.links.items():
            links.append((scope, prefix, item.element))
            context.poses[prefix + name] = base @ scope.compute_pose(name, item.element)
    context.shifts = dict.fromkeys(context.poses, IDENTITY)
    tree, loops = order(find_joints(top))
    has_world = any(WORLD in (joint.parent, joint.child) for joint in (*tree, *loops))
    children = {joint.child for joint in tree}
    roots = [name for name in context.poses if name not in children and name != WORLD]
    is_named = WORLD in context.poses  # a link of that name
    if not is_named:
        context.poses[WORLD] = read_own_pose(top).invert()
        context.shifts[WORLD] = IDENTITY
    set_shifts(context, tree)
    if (has_world or len(roots) > 1) and not is_named:
        robot.links.append(Link(robot.provenance, WORLD))
    else:
        at = read_own_pose(top) @ context.poses[roots[0]] if roots else IDENTITY
        origin = get_origin_at(at, robot.provenance)
        robot.base = Base(robot.provenance, not (top.is_static or is_named), origin)
    for scope, prefix, element in links:
        robot.links.append(read_link(context, scope, prefix, element))
    for joint in tree:
        add_joint(context, joint)
    check_mimics(robot)
    if robot.base is None or (is_named and roots):
        robot.base = None
        add_world(context, robot, roots, top.is_static)
    for joint in loops:
        add_closure(context, joint)
    add_frames(context, top)
