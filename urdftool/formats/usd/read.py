"""Read a robot from a stage of OpenUSD with the schemas of UsdPhysics.

Bodies become links, and joints become joints of URDF. Attributes of Newton take precedence over
those of PhysX. Names and frames that an export of this tool stored in ``customData`` are restored.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...extras import is_installed, make_missing_error
from ...model.elements import Robot
from ...model.provenance import Written
from ...source.description import Description
from ...source.document import STDIN, Document, Element, read_file
from ...source.location import SourceFile
from ...source.packages import Packages
from ...storage import cache_folder
from ...workspace import Workspace
from ..reading import Losses, Reading


def read(
    path: str | Path,
    *,
    file: SourceFile | None = None,
    packages: Packages | None = None,
    workspace: Workspace | None = None,
    articulation: str = "",
    mesh_folder: str | Path | None = None,
    **_: Any,
) -> Reading:
    """Read a robot.

    Args:
        path: A ``.usda``, ``.usdc``, ``.usd`` or ``.usdz`` file.
        file: The file, if it has been read.
        packages: Finder of image files; None creates one.
        workspace: Access to files; None creates a new one.
        articulation: Path of the prim of a robot; empty for the default prim.
        mesh_folder: Folder for the meshes of the stage, as STL and OBJ files; None is a folder
            in the user's cache.

    Raises:
        MissingDependency: usd-core is not installed.
        SourceError: The file cannot be read.
        ModelError: OpenUSD does not open it, or it has no rigid body.
    """
    if not is_installed("pxr"):
        raise make_missing_error("pxr", "a USD file")
    from .read_mesh import MeshFolder
    from .read_open import convert_errors, open_stage
    from .read_shapes import add_shapes
    from .read_stage import Context
    from .read_tree import add_tree
    from .read_unread import report_unread

    workspace = workspace or Workspace()
    file = file or read_file(path, workspace)
    losses = Losses()
    with convert_errors(file):
        stage, layers = open_stage(file, losses, workspace)
        context = Context(stage, layers, losses, articulation)
        robot = Robot(Written(context.get_place(context.top)), context.robot_name, format="usd")
        source = None if file.path == STDIN else file.path
        finder = packages or Packages(source, workspace=workspace)
        root = Element("robot", {"name": robot.name}, None, file, 0)
        document = Document(file, root, [])
        robot.source = Description(str(path), document, layers.list_files(), finder)
        add_tree(context, robot)
        report_unread(context)
        folder = Path(mesh_folder) if mesh_folder is not None else cache_folder("usd-meshes")
        add_shapes(context, robot, MeshFolder(folder))
    robot.unread = losses.make_findings()
    return Reading(robot, robot.unread)
