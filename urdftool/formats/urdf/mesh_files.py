"""Mesh and texture files of an export to URDF."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from ...finding import Finding
from ...model.elements import Link, Mesh, Robot
from ..common.asset_filter import explain_uncopied
from ..common.assets import find_companions, find_file
from ..common.missing_files import create_missing_mesh
from ..common.naming import UniqueNames
from ..defects import make_defect
from .options import Options


class MeshFiles:
    """Files that are copied, with their paths in the export.

    Attributes:
        found: File of each URI; None where it does not exist or is refused.
        refused: Reason for each existing file that is not a mesh or image, by URI.
        places: Path in the export of each file that is copied.
    """

    def __init__(self, robot: Robot, options: Options) -> None:
        """Find every mesh and texture, and choose unique paths."""
        self.found: dict[str, Path | None] = {}
        self.refused: dict[str, str] = {}
        self.places: dict[Path, str] = {}
        taken = UniqueNames(fold=True)
        uris: dict[str, bool] = {}
        for uri, is_mesh in _list_uris(robot):
            uris.setdefault(uri, is_mesh)
        for uri, is_mesh in uris.items():
            path = self.found[uri] = find_file(robot, uri)
            if path is not None and (why := explain_uncopied(path, is_mesh=is_mesh)):
                path = self.found[uri] = None
                self.refused[uri] = why
            if path is None or path in self.places:
                continue
            name = PurePosixPath(path.name)
            free = name.stem
            while f"{free}{name.suffix}" in taken:
                free += "_"
            self.places[path] = f"{options.mesh_dir}/{taken.take(free + name.suffix)}"
            for other, relative in find_companions(robot, path):
                target = PurePosixPath(options.mesh_dir) / relative
                if ".." not in target.parts and str(target) not in self.places.values():
                    self.places.setdefault(other, str(target))

    def get_place(self, uri: str) -> str | None:
        """Return the path of a URI in the export; None if the file does not exist."""
        path = self.found.get(uri)
        return None if path is None else self.places[path]


def _list_uris(robot: Robot) -> Iterator[tuple[str, bool]]:
    """Yield the URI of each mesh and texture, and whether it is a mesh."""
    for _, shape in robot.shapes:
        if isinstance(shape.geometry, Mesh):
            yield shape.geometry.filename, True
        material = getattr(shape, "material", None)
        if material is not None and material.texture:
            yield material.texture, False


def report_mesh_defects(robot: Robot, meshes: MeshFiles) -> Iterator[Finding]:
    """Yield a defect for each mesh whose file does not exist or is not a mesh."""
    known: set[str] = set()
    for link, shape in robot.shapes:
        mesh = shape.geometry
        if isinstance(mesh, Mesh) and mesh.filename not in known:
            known.add(mesh.filename)
            if meshes.found[mesh.filename] is None:
                yield _make_defect(robot, link, mesh, meshes.refused.get(mesh.filename, ""))


def _make_defect(robot: Robot, link: Link, mesh: Mesh, refused: str) -> Finding:
    if refused:
        message = f"mesh '{mesh.filename}' of link '{link.name}' cannot be used: {refused}"
        place = mesh.locate_attribute("filename")
        return make_defect("corrupt-mesh", message, place, "link", link.name)
    return create_missing_mesh(robot, link, mesh)
