"""Reading of a stage in the process with limits. The reader's only use of OpenUSD is below it."""

from __future__ import annotations

from pathlib import Path

from ...dependencies import Dependencies
from ...errors import UrdftoolError
from ...model.elements import Robot
from ...model.provenance import Written
from ...source.description import Description
from ...source.document import Document, Element
from ...source.location import Place
from ...workspace import Workspace
from ..reading import Losses, Opened, Reading
from .read_mesh import MeshFolder
from .read_native import add_native
from .read_open import convert_errors, open_stage
from .read_shapes import add_shapes
from .read_stage import Context
from .read_tree import add_tree
from .read_unread import report_unread
from .read_world import read_world


def read_stage(
    opened: Opened, shown: str, path: str, name: str, mesh_folder: Path
) -> tuple[Reading | UrdftoolError, Dependencies]:
    """Read a robot, and return it or why it cannot be read, and the files that were asked for."""
    view = opened.workspace.with_record()
    assert view.dependencies is not None
    try:
        return _read(opened, view, shown, path, name, mesh_folder), view.dependencies
    except UrdftoolError as error:
        return error, view.dependencies


def _read(
    opened: Opened, view: Workspace, shown: str, path: str, name: str, mesh_folder: Path
) -> Reading:
    """Read a robot.

    Raises:
        SourceError: A layer cannot be read.
        ModelError: OpenUSD does not open it, or it has no rigid body.
    """
    file, finder, _ = opened
    losses = Losses()
    with convert_errors(file):
        stage, layers = open_stage(path, file, losses, view)
        context = Context(stage, layers, losses, name)
        robot = Robot(Written(context.get_place(context.top)), context.robot_name, format="usd")
        root = Element("robot", {"name": robot.name}, None, file, 0)
        document = Document(file, root, [])
        robot.source = Description(shown, document, layers.list_files(), finder)
        robot.world = read_world(context)
        joints = add_tree(context, robot)
        report_unread(context)
        add_native(context, robot, joints)
        folder = MeshFolder(mesh_folder, Place(file, 0, 0))
        try:
            add_shapes(context, robot, folder)
        except BaseException:
            folder.remove_new()
            raise
    robot.contradictions = context.contradictions
    robot.unread = losses.make_findings()
    return Reading(robot, robot.unread)
