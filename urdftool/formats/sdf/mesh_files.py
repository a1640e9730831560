"""Meshes and textures: search, URIs in the model, and copies with their companion files."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path, PurePosixPath

from ...model.elements import Mesh, Robot
from ...source.packages import find_own_package
from ..common.asset_filter import explain_uncopied
from ..common.assets import find_companions, find_file, get_package_path
from ..common.naming import get_first_free, list_numbered_names
from .names import get_model_name
from .options import Options


@dataclass
class MeshFiles:
    """The mesh and texture files of a robot.

    Attributes:
        options: Options of the export.
        found: File of each URI; None if it is missing or refused.
        refused: Reason for each existing file that is not a mesh or image, by URI.
        places: Path of each file in the export, relative to the model.
        pictures: File names of the textures that an Ogre script uses.
        robot: Name of the model.
    """

    options: Options
    robot: str = ""
    found: dict[str, Path | None] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    places: dict[Path, str] = field(default_factory=dict)
    pictures: dict[Path, str] = field(default_factory=dict)

    def is_known(self, mesh: Mesh) -> bool:
        """Tell whether the file of a mesh exists."""
        return self.found.get(mesh.filename) is not None

    def get_uri(self, mesh: Mesh) -> str:
        """Return the URI of a mesh in the model."""
        return self._get_named(mesh.filename) or mesh.filename

    def get_texture(self, filename: str) -> str | None:
        """Return the URI of a texture in a model for gz; None if it is missing."""
        return self._get_named(filename)

    def get_script(self, filename: str) -> tuple[str, list[str]] | None:
        """Return the Ogre material of a texture, and the folders it needs; None for none."""
        picture = self.pictures.get(self.found.get(filename) or Path())
        if picture is None:
            return None
        folders = [self._format_placed(place) for place in (SCRIPTS, TEXTURES)]
        return get_material_name(self.robot, picture), folders

    def _get_named(self, filename: str) -> str | None:
        path = self.found.get(filename)
        if path is None:
            return None
        style = self.options.uri_style
        if style == "package":
            return _format_package_uri(filename, path)
        if style == "file":
            return path.resolve().as_uri()
        return self._format_placed(self.places[path])

    def _format_placed(self, place: str) -> str:
        relative = self.options.uri_style != "model"
        return place if relative else f"model://{self.options.folder}/{place}"

    @property
    def files(self) -> dict[str, bytes | Path]:
        """Return the files to copy, by their path in the export."""
        if self.options.uri_style in ("package", "file"):
            return {}
        files: dict[str, bytes | Path] = {place: path for path, place in self.places.items()}
        files |= {f"{TEXTURES}/{name}": path for path, name in self.pictures.items()}
        return files

    @property
    def scripts(self) -> dict[str, bytes]:
        """Return the Ogre script of the materials with a texture, by its path in the export."""
        if not self.pictures:
            return {}
        return {
            f"{SCRIPTS}/{replace_quoted(self.robot)}.material": create_script(
                self.robot, self.pictures
            )
        }


def find_meshes(robot: Robot, options: Options) -> MeshFiles:
    """Find every mesh and texture, and assign each a unique path in the export."""
    names = [s.geometry.filename for _, s in robot.shapes if isinstance(s.geometry, Mesh)]
    textures = [m.texture for m in robot.materials if m.texture]
    for link in robot.links:
        textures += [v.material.texture for v in link.visuals if v.material and v.material.texture]
    meshes = MeshFiles(options, get_model_name(robot))
    for name in dict.fromkeys([*names, *textures]):
        meshes.found[name] = path = find_file(robot, name)
        why = explain_uncopied(path, is_mesh=name in names) if path is not None else ""
        if why:
            meshes.found[name], meshes.refused[name] = None, why
    if options.classic:
        if options.uri_style in ("model", "relative"):
            meshes.pictures = choose_picture_names(meshes.robot, _get_there(meshes, textures))
    else:
        names += textures
    _give_places(robot, meshes, _get_there(meshes, names))
    return meshes


def _get_there(meshes: MeshFiles, names: list[str]) -> list[Path]:
    """Return the files of URIs, each once, without missing files."""
    found = (meshes.found[name] for name in names)
    return list(dict.fromkeys(path for path in found if path is not None))


def _format_package_uri(filename: str, path: Path) -> str:
    if filename.startswith("package://"):
        return filename
    own = find_own_package(Path(os.path.abspath(path)))
    if own is None:
        return path.resolve().as_uri()
    return f"package://{own[0]}/{path.resolve().relative_to(own[1].resolve()).as_posix()}"


def _give_places(robot: Robot, meshes: MeshFiles, needed: list[Path]) -> None:
    """Assign paths that keep the folders of a package, so that relative references stay valid."""
    homes = {path: get_package_path(path) for path in needed}
    several = len({package for package, _ in homes.values()}) > 1
    taken: set[str] = set()
    for path in needed:
        package, inner = homes[path]
        parts = [part for part in PurePosixPath(inner).parts if part not in ("", "..", "/")]
        if len(parts) > 1 and parts[0] == "meshes":
            parts = parts[1:]
        place = "/".join([meshes.options.mesh_dir, *([package] if several else []), *parts])
        place = _choose_free_path(place, taken)
        meshes.places[path] = place
        taken.add(place)
    for path in needed:
        _add_companions(robot, meshes, path, meshes.places[path])


def _choose_free_path(place: str, taken: set[str]) -> str:
    stem, dot, suffix = place.rpartition(".")
    return get_first_free(chain((place,), list_numbered_names(stem, suffix=dot + suffix)), taken)


def _add_companions(robot: Robot, meshes: MeshFiles, path: Path, place: str) -> None:
    """Add the textures and material files of a mesh at the same relative paths."""
    if meshes.options.uri_style in ("package", "file"):
        return
    for other, name in find_companions(robot, path):
        target = os.path.normpath(os.path.join(os.path.dirname(place), name))
        if other not in meshes.places and not target.startswith(".."):
            meshes.places[other] = Path(target).as_posix()
            _add_companions(robot, meshes, other, meshes.places[other])


SCRIPTS = "materials/scripts"
TEXTURES = "materials/textures"


def choose_picture_names(robot: str, pictures: list[Path]) -> dict[Path, str]:
    """Choose a file name for each texture; Ogre shares one namespace among all models."""
    names: dict[Path, str] = {}
    for path in pictures:
        stem, suffix = replace_quoted(f"{robot}_{path.stem}"), path.suffix.lower()
        candidates = chain((f"{stem}{suffix}",), list_numbered_names(stem, suffix=suffix))
        names[path] = get_first_free(candidates, set(names.values()))
    return names


def replace_quoted(name: str) -> str:
    """Replace characters that require quotes in a script."""
    return re.sub(r"[^\w.-]", "_", name)


def get_material_name(robot: str, picture: str) -> str:
    """Return the name of the material of a texture."""
    return f"{replace_quoted(robot)}/{picture.rpartition('.')[0]}"


def create_script(robot: str, pictures: Mapping[Path, str]) -> bytes:
    """Create the script with a white material for each texture; visuals set their own colors."""
    parts = [
        f"material {get_material_name(robot, name)}\n"
        "{\n  technique\n  {\n    pass\n    {\n"
        "      ambient 1 1 1 1\n      diffuse 1 1 1 1\n"
        f"      texture_unit\n      {{\n        texture {name}\n      }}\n"
        "    }\n  }\n}\n"
        for name in pictures.values()
    ]
    return "\n".join(parts).encode()
