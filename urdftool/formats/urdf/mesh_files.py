"""Mesh and texture files of an export to URDF."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from ...finding import Finding
from ...model.elements import Link, Mesh, Robot
from ..common.assets import find_companions, find_file
from ..common.missing_files import explain_missing_file
from ..common.naming import UniqueNames
from ..defects import make_defect
from .options import Options


class MeshFiles:
    """Files that are copied, with their paths in the export.

    Attributes:
        found: File of each URI; None where it does not exist.
        places: Path in the export of each file that is copied.
    """

    def __init__(self, robot: Robot, options: Options) -> None:
        """Find every mesh and texture, and choose unique paths."""
        self.found: dict[str, Path | None] = {}
        self.places: dict[Path, str] = {}
        taken = UniqueNames(fold=True)
        for uri in dict.fromkeys(_list_uris(robot)):
            path = self.found[uri] = find_file(robot, uri)
            if path is None or path in self.places:
                continue
            name = PurePosixPath(path.name)
            free = name.stem
            while f"{free}{name.suffix}" in taken:
                free += "_"
            self.places[path] = f"{options.mesh_dir}/{taken.take(free + name.suffix)}"
            for other, relative in find_companions(path):
                target = PurePosixPath(options.mesh_dir) / relative
                if ".." not in target.parts and str(target) not in self.places.values():
                    self.places.setdefault(other, str(target))

    def get_place(self, uri: str) -> str | None:
        """Return the path of a URI in the export; None if the file does not exist."""
        path = self.found.get(uri)
        return None if path is None else self.places[path]


def _list_uris(robot: Robot) -> Iterator[str]:
    for _, shape in robot.shapes:
        if isinstance(shape.geometry, Mesh):
            yield shape.geometry.filename
        material = getattr(shape, "material", None)
        if material is not None and material.texture:
            yield material.texture


def report_mesh_defects(robot: Robot, meshes: MeshFiles) -> Iterator[Finding]:
    """Yield a defect for each mesh whose file does not exist."""
    known: set[str] = set()
    for link, shape in robot.shapes:
        mesh = shape.geometry
        if isinstance(mesh, Mesh) and mesh.filename not in known:
            known.add(mesh.filename)
            if meshes.found[mesh.filename] is None:
                yield _make_missing(robot, link, mesh)


def _make_missing(robot: Robot, link: Link, mesh: Mesh) -> Finding:
    missing = explain_missing_file(robot, mesh.filename)
    return make_defect(
        "mesh-not-found",
        f"mesh '{mesh.filename}' of link '{link.name}' {missing.message}",
        mesh.locate_attribute("filename"),
        "link",
        link.name,
        missing.hint,
        {"not_found_because": missing.cause},
    )
