"""Find the mesh files that a robot uses."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from ...errors import AccessError, PackageNotFound
from ...file_access import IRREGULAR
from ...model.elements import Collision, Link, Mesh, Robot, Visual
from ...source.description import Description, GltfUp
from ...workspace import Workspace

_USES = "mesh uses"
_ABSOLUTE = re.compile(r"(file://)?(/|[A-Za-z]:[\\/]|~)")


@dataclass(slots=True)
class MeshUse:
    """A mesh of a visual or collision of a link.

    Attributes:
        workspace: Reads the file.
        path: The file; None if it is unknown.
        size: Size of the file [bytes]; None if it does not exist.
        missing_package: The package that was not found, if that is the cause.
        searched: Folders in which the package was searched.
        refusal: Why the description may not read the file, which is then unknown; empty if it may.
        refusal_reason: The part of it that is equal for files of one folder.
        gltf_up: Up axis of a glTF file.
    """

    link: Link
    shape: Visual | Collision
    mesh: Mesh
    workspace: Workspace
    path: Path | None = None
    size: int | None = None
    missing_package: str = ""
    searched: list[str] = field(default_factory=list)
    refusal: str = ""
    refusal_reason: str = ""
    gltf_up: GltfUp = "y"

    @property
    def exists(self) -> bool:
        """Whether the file exists."""
        return self.size is not None

    @property
    def is_unread(self) -> bool:
        """Whether it is a file that the description may not read, and so was not checked."""
        return bool(self.refusal_reason) and self.refusal_reason != IRREGULAR

    @property
    def uri(self) -> str:
        """The ``filename`` as expanded."""
        return self.mesh.filename

    @property
    def collides(self) -> bool:
        """Tell whether it is a collision."""
        return isinstance(self.shape, Collision)

    @property
    def is_absolute(self) -> bool:
        """Whether it is an absolute path."""
        return _ABSOLUTE.match(self.uri) is not None

    @property
    def is_fixed_path(self) -> bool:
        """Whether an absolute path is written as such; ``$(find NAME)`` depends on the machine."""
        return self.is_absolute and "$" not in self.written

    @property
    def written(self) -> str:
        """The ``filename`` as written in the source, with its xacro expressions."""
        place = self.mesh.locate_attribute("filename")
        data = place.file.data[place.start : place.end]
        return data.decode(place.file.encoding, "replace").partition("=")[2].strip(" \t\r\n\"'")


def is_concave(use: MeshUse) -> bool:
    """Tell whether PyBullet uses the triangles of a mesh: any value of ``concave`` does it."""
    return use.collides and use.shape.element.get("concave") is not None


def get_mesh_uses(robot: Robot, description: Description) -> list[MeshUse]:
    """List the meshes of a robot in the order of the file; cached for all rules."""
    return robot.memo.get(_USES, lambda: list(_locate_meshes(robot, description)))


def collect_unread_meshes(robot: Robot) -> dict[str, str]:
    """Collect the meshes that a robot uses, but may not read, so that no rule checks them.

    Returns:
        The reason, with a remedy, by the URI. Empty if no rule looked at meshes.
    """
    uses: list[MeshUse] = robot.memo.peek(_USES) or []
    return {use.uri: use.refusal_reason for use in uses if use.is_unread}


def _locate_meshes(robot: Robot, description: Description) -> Iterator[MeshUse]:
    found: dict[str, MeshUse] = {}
    lost: dict[str, list[str]] = {}
    for link, shape in robot.shapes:
        mesh = shape.geometry
        if not isinstance(mesh, Mesh):
            continue
        use = MeshUse(link, shape, mesh, description.workspace, gltf_up=description.gltf_up)
        known = found.setdefault(use.uri, use)
        if known is use:
            _locate(use, description, lost)
        else:
            use.path, use.size = known.path, known.size
            use.missing_package, use.searched = known.missing_package, known.searched
            use.refusal, use.refusal_reason = known.refusal, known.refusal_reason
        yield use


def _locate(use: MeshUse, description: Description, lost: dict[str, list[str]]) -> None:
    uri = use.uri
    scheme, separator, rest = uri.partition("://")
    if not uri.strip() or "${" in uri or "$(" in uri or re.match(r"[A-Za-z]:[\\/]|~", uri):
        return
    if separator and scheme not in ("package", "model", "file"):
        return
    package = rest.partition("/")[0] if scheme in ("package", "model") else ""
    if separator and scheme != "file" and not package:
        return
    if package in lost:
        use.missing_package, use.searched = package, lost[package]
        return
    try:
        use.path = description.resolve(uri.replace("\\", "/"))
    except AccessError as error:
        use.refusal, use.refusal_reason = error.message, error.data["reason"]
        return
    except PackageNotFound as error:
        if scheme == "package":
            use.missing_package, use.searched = package, list(error.notes)
            lost[package] = use.searched
        return
    use.size = use.workspace.get_size(use.path)


def find_actual_case(workspace: Workspace, path: Path) -> Path | None:
    """Find the file that differs from a path only in case; None if there is none."""
    known = path
    rest: list[str] = []
    while not workspace.exists(known):
        if known.parent == known:
            return None
        rest.append(known.name)
        known = known.parent
    for name in reversed(rest):
        try:
            names = [entry.name for entry in workspace.list_folder(known)]
        except OSError:
            return None
        same = next((n for n in names if n.casefold() == name.casefold()), None)
        if same is None:
            return None
        known = known / same
    return known if workspace.is_file(known) else None
