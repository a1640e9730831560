"""How far the shapes of a link reach, meshes included: their points are read once."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...inputs import Remembered
from ...model.bounds import Bounds, bounds_of
from ...model.elements import Collision, Link, Mesh, Robot, Visual
from ...model.pose import pose_of
from ...source.description import GltfUp
from .uses import MeshUse, Stamp, mesh_uses, stamp

if TYPE_CHECKING:
    from ...meshes.outline import Outline

LARGEST = 10.0  # [m] a mesh that is longer is in millimetres
SMALLEST = 0.001


def outline_of(use: MeshUse) -> Outline | None:
    """The points of a mesh in the frame of its file, unscaled; None if it has none."""
    if use.path is None or not use.exists:
        return None
    try:
        return _outline((stamp(use.path), use.gltf_up))
    except OSError:
        return None


@Remembered
def _outline(key: tuple[Stamp, GltfUp]) -> Outline | None:
    from ...meshes.outline import outline

    (path, *_), gltf_up = key
    return outline(Path(path), gltf_up)


def box_of(use: MeshUse) -> Bounds | None:
    """The box around a mesh as scaled, in the frame of its link [m]."""
    found = outline_of(use)
    return None if found is None else Bounds(*found.box(use.mesh.scale, *pose_of(use.shape.origin)))


class Reaches:
    """The boxes around the shapes of a robot's links, each worked out when it is asked for."""

    def __init__(self, robot: Robot) -> None:
        """Know where the meshes are, and read none yet."""
        self.robot = robot
        self._uses: dict[int, MeshUse] | None = None
        self._boxes: dict[int, Bounds | None] = {}
        self._links: dict[int, Bounds | None] = {}

    def use_of(self, shape: Visual | Collision) -> MeshUse | None:
        """The file of a shape that is a mesh."""
        if self._uses is None:
            source = self.robot.source
            uses = mesh_uses(self.robot, source) if source is not None else []
            self._uses = {id(use.shape): use for use in uses}
        return self._uses.get(id(shape))

    def shape(self, shape: Visual | Collision) -> Bounds | None:
        """The box around one shape, in the frame of its link; None where it is not known."""
        if not isinstance(shape.geometry, Mesh):
            return bounds_of(shape)
        if id(shape) not in self._boxes:
            self._boxes[id(shape)] = self._mesh(shape)
        return self._boxes[id(shape)]

    def _mesh(self, shape: Visual | Collision) -> Bounds | None:
        use = self.use_of(shape)
        box = box_of(use) if use is not None and 0 not in use.mesh.scale else None
        if box is None:
            return None
        # one in another unit has findings of its own, and says nothing of the link
        return box if SMALLEST < max(box.size) < LARGEST else None

    def shapes(self, shapes: list[Visual] | list[Collision]) -> Bounds | None:
        """The box around several; None where there is none, or one whose box is not known."""
        box: Bounds | None = None
        for shape in shapes:
            other = self.shape(shape)
            if other is None:
                return None
            box = other if box is None else box.joined(other)
        return box

    def link(self, link: Link) -> Bounds | None:
        """The box around all that is seen of a link or touches; None where it is not known."""
        if id(link) not in self._links:
            self._links[id(link)] = self._link(link)
        return self._links[id(link)]

    def _link(self, link: Link) -> Bounds | None:
        boxes = [self.shapes(part) for part in (link.visuals, link.collisions) if part]
        box: Bounds | None = None
        for other in boxes:
            if other is None:
                return None
            box = other if box is None else box.joined(other)
        return box if box is not None and any(box.size) else None


_last: Reaches | None = None


def reaches(robot: Robot) -> Reaches:
    """The boxes of a robot; the same for all rules that ask."""
    global _last
    if _last is None or _last.robot is not robot:
        _last = Reaches(robot)
    return _last
