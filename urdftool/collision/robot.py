"""Simplification for a whole robot: its meshes, and the files with its new collisions."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ..errors import OutputError
from ..model.elements import Mesh, Robot
from ..suggestions import require_word
from .compute import Result, Task
from .links import LinkPlan
from .mesh_files import write_all
from .rewrite import Layout, determine_layout, make_uri, name_pieces, rewrite_robot
from .settings import MESH_FORMATS, URIS

SUFFIXES = (".urdf", ".xml")
"""Permitted suffixes of a new description."""


@dataclass(frozen=True)
class Place:
    """Output location of a robot with new collisions.

    Attributes:
        target: The new description; the robot's own if ``in_place``.
        mesh_dir: Folder of the pieces; None for one in the target's folder.
        uri: ``"package"``, ``"relative"``, ``"file"``, or ``"auto"`` for that of the robot's
            meshes.
        mesh_format: ``"stl"`` or ``"obj"``.
        in_place: Whether to edit the robot's own source.
        bare: Whether to write only the pieces, and return the description as text.
        overwrite: Whether to replace mesh files not written by urdftool.
    """

    target: Path
    mesh_dir: Path | None = None
    uri: str = "auto"
    mesh_format: str = "stl"
    in_place: bool = False
    bare: bool = False
    overwrite: bool = False

    def __post_init__(self) -> None:
        """Raise ConfigError if a form or a format is unknown."""
        require_word("uri", self.uri, URIS)
        require_word("mesh_format", self.mesh_format, MESH_FORMATS)


@dataclass(frozen=True)
class Written:
    """Output of :func:`write_robot`."""

    layout: Layout
    plans: Sequence[LinkPlan]
    text: bytes = b""
    refused: Sequence[str] = field(default_factory=list)

    def list_unchanged(self, robot: Robot) -> list[str]:
        """Return the names of unchanged links."""
        touched = {item.link.name for item in self.plans}
        return [link.name for link in robot.links if link.name not in touched]


def collect_tasks(plans: Iterable[LinkPlan]) -> list[Task]:
    """Return the meshes to simplify."""
    return [use.task for item in plans for use in item.uses if use.task is not None]


def write_robot(
    robot: Robot, plans: Sequence[LinkPlan], results: Mapping[Task, Result], place: Place
) -> Written:
    """Write a robot with new collisions and the mesh files of its pieces, all or none.

    Raises:
        OutputError: A file cannot be written or is an input; existing files are unchanged.
        SourceError: The requested kind of URI is not possible.
    """
    layout = determine_layout(
        robot, place.target, place.mesh_dir, place.uri, f".{place.mesh_format}"
    )
    links: dict[Task, str] = {}
    for item in plans:
        for task in collect_tasks([item]):
            links.setdefault(task, item.link.name)
    name_pieces(layout, results, links)
    seen = _list_visual_meshes(robot)
    if place.in_place:
        from .in_place import edit_sources

        found = edit_sources(robot, plans, results, layout)
        keep = {path for task in found.used for path in _list_files(layout, results[task])}
        files = {path: data for path, data in layout.files.items() if path in keep}
        files.update({Path(name): data for name, data in found.files.items()})
        write_all(files, overwrite=place.overwrite, inputs=seen)
        return Written(layout, found.plans, refused=found.refused)
    text = rewrite_robot(robot, plans, results, layout)
    files = dict(layout.files)
    if not place.bare:
        files[place.target] = text
    assert robot.source is not None
    inputs = [*(file.path for file in robot.source.files), *seen]
    write_all(files, overwrite=place.overwrite, inputs=inputs)
    return Written(layout, plans, text)


def check_place(robot: Robot, place: Place) -> None:
    """Reject an output location that cannot be written, before computing anything.

    Raises:
        OutputError: It is an input or a folder.
    """
    if place.in_place or place.bare or robot.source is None:
        return
    if place.target.is_dir():
        raise OutputError("is a folder, not a file", path=place.target)
    real = os.path.realpath(place.target)
    if any(os.path.realpath(file.path) == real for file in robot.source.files):
        raise OutputError("is an input; write the output to another file", path=place.target)


def _list_visual_meshes(robot: Robot) -> list[str]:
    """Return visual meshes, which pieces must not replace, unlike pieces of an earlier run."""
    assert robot.source is not None
    meshes = [v.geometry for link in robot.links for v in link.visuals]
    names = {m.filename for m in meshes if isinstance(m, Mesh) and m.filename}
    return [str(path) for name in sorted(names) if (path := _find_file(robot, name)) is not None]


def _find_file(robot: Robot, name: str) -> Path | None:
    from ..errors import UrdftoolError

    assert robot.source is not None
    try:
        return Path(robot.source.resolve(name))
    except (UrdftoolError, ValueError):
        return None


def _list_files(layout: Layout, result: Result) -> list[Path]:
    uris = set(layout.names[id(result)])
    return [path for path in layout.files if make_uri(path, layout) in uris]
